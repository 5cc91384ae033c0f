#include "collision/core/shortest.h"

#include <charconv>

namespace corridor {

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

}  // namespace corridor
