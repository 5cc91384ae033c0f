#pragma once

#include <string>

namespace corridor {

/// Returns the shortest decimal digits that read back as this double, for messages and files.
std::string shortest(double value);

/// Returns the value with so many significant digits, for messages.
std::string withDigits(double value, int digits = 4);

/// Two numbers as texts of a message, with the same number of significant digits.
struct OrderedTexts {
  std::string smaller, larger;
};
/// Returns both numbers with four digits, or with more if the texts would otherwise not show which
/// number is smaller. @pre smaller < larger.
OrderedTexts orderedTexts(double smaller, double larger);

}  // namespace corridor
