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

bool isReadRightly(std::string_view word, double value, double largest) {
  // Some five roundings to floats have a relative error of 5 * 2^-24. The decimals after the 15th,
  // which assimp drops, and numbers near the least float are allowed to be lost.
  const double slack = 1e-6 * std::abs(value) + 1e-14 * largest + 1e-30;
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
