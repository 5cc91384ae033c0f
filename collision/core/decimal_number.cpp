#include "collision/core/decimal_number.h"

#include <charconv>
#include <cmath>
#include <limits>
#include <locale>
#include <sstream>
#include <string>

namespace corridor {

std::optional<double> decimalNumber(std::string_view word) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-') word.remove_prefix(1);
  const char* const end = word.data() + word.size();
  double value = 0;
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::invalid_argument || stop != end) return std::nullopt;
  if (error == std::errc::result_out_of_range) {
    // from_chars does not report whether the number is too large or too small. A stream does, for
    // any exponent.
    std::istringstream stream{std::string(word)};
    stream.imbue(std::locale::classic());
    if (!(stream >> value))
      value = std::copysign(std::numeric_limits<double>::infinity(), word[0] == '-' ? -1 : 1);
  }
  return value;
}

}  // namespace corridor
