#include "planner/problem/number_text.h"

#include <cmath>
#include <optional>

#include "collision/core/decimal_number.h"
#include "collision/core/spelling.h"
#include "planner/model/settings.h"

namespace corridor {
namespace {

/// Returns a hint for a text such as "1,5", which is a number with a decimal comma; "" for others.
std::string hintOnComma(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == text.npos || text.find(',', comma + 1) != text.npos) return "";
  std::string point(text);
  point[comma] = '.';
  double value = 0;
  return parseNumber(point, Range::Any, value).empty() ? "; decimals need a point, not a comma"
                                                       : "";
}

}  // namespace

std::string parseNumber(std::string_view text, Range range, double& value) {
  for (const char* name :
       {".nan", ".NaN", ".NAN", ".inf", "-.inf", "+.inf", ".Inf", "-.Inf", ".INF", "-.INF"})
    if (text == name) return "a finite number is needed, not " + quotedWord(text);
  const auto read = decimalNumber(text);
  if (!read) return "a number is needed, not " + quotedWord(text) + hintOnComma(text);
  const double number = *read;
  if (!std::isfinite(number)) return "a finite number is needed, not " + quotedWord(text);
  if (range == Range::NotNegative && number < 0)
    return "must be 0 or more, not " + std::string(text);
  if (range == Range::Positive && !(number > 0)) return "must be above 0, not " + std::string(text);
  if (range == Range::Resolution && !isResolution(number))
    return "must be from 1e-9 to below 1, not " + std::string(text);
  value = number;
  return "";
}

}  // namespace corridor
