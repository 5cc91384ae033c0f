#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "collision/predicates/exact_number.h"

/// Rationals, and elimination with them, for the few cases that doubles do not decide.
namespace corridor::seidel {

using Rational = boost::multiprecision::cpp_rational;

/// Returns a finite double as a rational, under any setting of flush-to-zero.
inline Rational rational(double value) {
  using boost::multiprecision::cpp_int;
  const exact::Dyadic d = exact::dyadic(value);
  const auto shift = static_cast<unsigned>(std::abs(d.exponent));
  if (d.exponent >= 0) return Rational(cpp_int(d.mantissa) << shift);
  return {cpp_int(d.mantissa), cpp_int(1) << shift};
}

/// Linearly independent rows of M rationals each, in echelon form.
template <std::size_t M>
class Echelon {
 public:
  using Row = std::array<Rational, M>;

  std::size_t rank() const { return rows_.size(); }

  /// Adds a row if it is independent of the rows added before. Returns whether it was added.
  bool add(Row row) {
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const Rational factor = row[pivots_[r]] / rows_[r][pivots_[r]];
      if (factor == 0) continue;
      for (std::size_t k = 0; k < M; ++k) row[k] -= factor * rows_[r][k];
    }
    const auto pivot =
        std::find_if(row.begin(), row.end(), [](const Rational& x) { return x != 0; });
    if (pivot == row.end()) return false;
    pivots_.push_back(static_cast<std::size_t>(pivot - row.begin()));
    rows_.push_back(row);
    return true;
  }

  /// Returns a vector other than 0 that is orthogonal to all rows. @pre the rank is below M.
  Row kernel() const {
    Row x{};
    std::size_t free = 0;
    while (std::find(pivots_.begin(), pivots_.end(), free) != pivots_.end()) ++free;
    x[free] = 1;
    // A row is 0 at the pivots of the rows before it.
    for (std::size_t r = rows_.size(); r-- > 0;) {
      Rational sum = 0;
      for (std::size_t k = 0; k < M; ++k)
        if (k != pivots_[r]) sum += rows_[r][k] * x[k];
      x[pivots_[r]] = -sum / rows_[r][pivots_[r]];
    }
    return x;
  }

 private:
  std::vector<Row> rows_;
  std::vector<std::size_t> pivots_;
};

}  // namespace corridor::seidel
