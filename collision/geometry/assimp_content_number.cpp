#include <algorithm>
#include <cmath>
#include <limits>

#include <assimp/fast_atof.h>

#include "collision/geometry/assimp_content.h"

namespace corridor {
namespace {

/// What assimp's function throws, instead of a class that assimp does not export.
struct NoNumber {
  template <class... Text>
  explicit NoNumber(const Text&...) {}
};

}  // namespace

bool isReadRightly(std::string_view word, double value, double slack) {
  // An exponent may make lost decimals large. Numbers near the least float are allowed to be lost.
  const auto exponent = word.find_first_of("eE");
  const bool grows =
      exponent != word.npos && exponent + 1 < word.size() && word[exponent + 1] != '-';
  slack = kNumberRounding * std::abs(value) + (grows ? 0 : slack) + 1e-30;
  const std::string text(word);
  ai_real read = 0;
  try {
    const char* const end = Assimp::fast_atoreal_move<ai_real, NoNumber>(text.c_str(), read);
    if (end != text.c_str() + text.size()) return false;
    // The import finds vertices that are not finite.
    if (std::isinf(read)) return std::abs(value) > double{std::numeric_limits<ai_real>::max()};
    return std::abs(double{read} - value) <= slack;
  } catch (const NoNumber&) {
    return false;
  }
}

}  // namespace corridor
