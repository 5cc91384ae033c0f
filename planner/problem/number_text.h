#pragma once

#include <string>
#include <string_view>

/// Numbers in the texts of files and options.
namespace corridor {

/// The ranges to which a number may be restricted.
enum class Range { Any, NotNegative, Positive, Resolution /**< see `isResolution` */ };

/// Parses the whole text as a decimal number. Returns "" and sets `value`, or returns an error
/// message ("a number is needed, not …"). A number that is too small for a double becomes the
/// nearest double. A number that is too large for a double, nan and inf give an error message.
std::string parseNumber(std::string_view text, Range range, double& value);

}  // namespace corridor
