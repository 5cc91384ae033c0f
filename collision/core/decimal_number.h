#pragma once

#include <optional>
#include <string_view>

namespace corridor {

/// Returns the number that is all of a word: decimal digits with an optional sign, point and
/// exponent, or "inf", "infinity", "nan" or "nan(…)". The result is the nearest double; infinite
/// for a larger number. Returns nullopt for any other word. The locale has no influence.
std::optional<double> decimalNumber(std::string_view word);

}  // namespace corridor
