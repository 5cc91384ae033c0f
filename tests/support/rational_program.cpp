#include "tests/support/rational_program.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace corridor::test {
namespace {

/// Returns the doubles as integers, in units of one power of two.
std::vector<Integer> integers(const std::vector<double>& values) {
  int least = std::numeric_limits<int>::max();
  const auto split = [](double x) {
    int exponent = 0;
    const double mantissa = std::frexp(x, &exponent);
    return std::pair{static_cast<std::int64_t>(std::ldexp(mantissa, 53)), exponent - 53};
  };
  for (const double x : values)
    if (x != 0) least = std::min(least, split(x).second);
  std::vector<Integer> result;
  for (const double x : values) {
    const auto [digits, exponent] = split(x);
    result.push_back(x == 0 ? Integer(0) : Integer(digits) << (exponent - least));
  }
  return result;
}

}  // namespace

// The tableau is T/D, and the entries of T are minors of [M | r], so all divisions are exact.
// Bland's rule guarantees that the algorithm ends.
bool hasSolution(IntegerSystem T) {
  const std::size_t rows = T.size(), columns = T.empty() ? 0 : T[0].size() - 1;
  Integer D = 1;
  std::vector<std::size_t> basis(rows);
  for (std::size_t i = 0; i < rows; ++i) basis[i] = columns + i;  // artificial variables, of cost 1
  for (;;) {
    // The reduced cost of column j is −Σ T[i][j] over the rows i whose basic variable is
    // artificial.
    std::size_t enter = columns;
    for (std::size_t j = 0; j < columns && enter == columns; ++j) {
      Integer gain = 0;
      for (std::size_t i = 0; i < rows; ++i)
        if (basis[i] >= columns) gain += T[i][j];
      if (gain > 0) enter = j;
    }
    if (enter == columns) break;
    std::size_t leave = rows;
    for (std::size_t i = 0; i < rows; ++i) {
      if (T[i][enter] <= 0) continue;
      if (leave == rows) {
        leave = i;
        continue;
      }
      const Integer here = T[i][columns] * T[leave][enter], best = T[leave][columns] * T[i][enter];
      if (here < best || (here == best && basis[i] < basis[leave])) leave = i;
    }
    if (leave == rows) break;  // can't happen: the sum of artificial variables is bounded below
    const Integer pivot = T[leave][enter];
    for (std::size_t i = 0; i < rows; ++i) {
      if (i == leave) continue;
      const Integer factor = T[i][enter];
      for (std::size_t j = 0; j <= columns; ++j) {
        T[i][j] *= pivot;
        if (factor != 0) T[i][j] -= factor * T[leave][j];
        if (D != 1) T[i][j] /= D;
      }
    }
    D = pivot;
    basis[leave] = enter;
  }
  for (std::size_t i = 0; i < rows; ++i)
    if (basis[i] >= columns && T[i][columns] != 0) return false;
  return true;
}

bool hasSolution(const std::vector<std::vector<double>>& columns,
                 const std::vector<double>& right) {
  IntegerSystem system;
  for (std::size_t i = 0; i < right.size(); ++i) {
    std::vector<double> row;
    for (const std::vector<double>& column : columns) row.push_back(column[i]);
    row.push_back(right[i]);
    system.push_back(integers(row));
    if (system.back().back() < 0)
      for (Integer& x : system.back()) x = -x;
  }
  return hasSolution(std::move(system));
}

std::size_t rankOf(const std::vector<std::vector<double>>& rows) {
  IntegerSystem m;
  for (const std::vector<double>& row : rows) m.push_back(integers(row));
  std::size_t rank = 0;
  const std::size_t columns = rows.empty() ? 0 : rows[0].size();
  for (std::size_t c = 0; c < columns && rank < m.size(); ++c) {
    std::size_t pivot = rank;
    while (pivot < m.size() && m[pivot][c] == 0) ++pivot;
    if (pivot == m.size()) continue;
    std::swap(m[pivot], m[rank]);
    for (std::size_t i = rank + 1; i < m.size(); ++i) {
      const Integer factor = m[i][c];
      if (factor == 0) continue;
      for (std::size_t k = 0; k < columns; ++k)
        m[i][k] = m[i][k] * m[rank][c] - factor * m[rank][k];
    }
    ++rank;
  }
  return rank;
}

}  // namespace corridor::test
