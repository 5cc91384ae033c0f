#include "collision/core/shortest.h"

#include <charconv>
#include <cstdio>
#include <cstdlib>

namespace corridor {

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string withDigits(double value, int digits) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", digits, value);
  return text;
}

OrderedTexts orderedTexts(double smaller, double larger) {
  for (const int digits : {4, 6, 9, 12}) {
    OrderedTexts texts{withDigits(smaller, digits), withDigits(larger, digits)};
    if (std::strtod(texts.smaller.c_str(), nullptr) < std::strtod(texts.larger.c_str(), nullptr))
      return texts;
  }
  return {withDigits(smaller, 17), withDigits(larger, 17)};
}

}  // namespace corridor
