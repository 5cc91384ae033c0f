#include "collision/course/matrix_game.h"

#include <algorithm>
#include <cmath>

namespace corridor {

void MatrixGame::solve() {
  // All entries are scaled and moved to [1, 3], so that the value of the game is above 0. Then z =
  // λ/value maximises Σ z subject to Σ_j a_ij z_j ≤ 1, and the dual solution is μ/value.
  double size = 0;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t j = 0; j < columns; ++j) size = std::max(size, std::abs(entry[i][j]));
  const double scale = size > 0x1p-1000 ? 1 / size : 0;
  // The tableau has a row for each basic variable and a column for each other variable. Its last
  // row has the costs, its last column the values of the basic variables.
  std::array<std::array<double, kMost + 1>, kMost + 1> t;
  // Indices of variables: below `columns` the z_j, from `columns` on the slack variables.
  std::array<std::size_t, kMost> basic, other;
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t j = 0; j < columns; ++j) t[i][j] = 2 + scale * entry[i][j];
    t[i][columns] = 1;
    basic[i] = columns + i;
  }
  for (std::size_t j = 0; j < columns; ++j) t[rows][j] = -1, other[j] = j;
  t[rows][columns] = 0;
  // Usual games take some ten pivots. The limit is needed because rounding may make the method
  // cycle.
  for (int pivots = 0; pivots < 60; ++pivots) {
    std::size_t c = columns;
    double lowest = -1e-13;  // costs are off by some 100u: sums of a few terms up to 3
    for (std::size_t j = 0; j < columns; ++j)
      if (t[rows][j] < lowest) lowest = t[rows][j], c = j;
    if (c == columns) break;
    std::size_t r = rows;
    for (std::size_t i = 0; i < rows; ++i)
      if (t[i][c] > 1e-13 && (r == rows || t[i][columns] * t[r][c] < t[r][columns] * t[i][c]))
        r = i;
    if (r == rows) break;
    const double by = 1 / t[r][c];
    for (std::size_t j = 0; j <= columns; ++j)
      if (j != c) t[r][j] *= by;
    for (std::size_t i = 0; i <= rows; ++i) {
      if (i == r) continue;
      const double factor = t[i][c];
      if (factor != 0)
        for (std::size_t j = 0; j <= columns; ++j)
          if (j != c) t[i][j] -= factor * t[r][j];
      t[i][c] = -factor * by;
    }
    t[r][c] = by;
    std::swap(basic[r], other[c]);
  }
  rowWeight.fill(0);
  columnWeight.fill(0);
  double rowSum = 0, columnSum = 0;
  for (std::size_t i = 0; i < rows; ++i)
    if (basic[i] < columns) {
      const double z = std::max(0.0, t[i][columns]);
      columnWeight[basic[i]] = z;
      columnSum += z;
    }
  for (std::size_t j = 0; j < columns; ++j)
    if (other[j] >= columns) {
      const double y = std::max(0.0, t[rows][j]);
      rowWeight[other[j] - columns] = y;
      rowSum += y;
    }
  for (std::size_t i = 0; i < rows; ++i) rowWeight[i] /= rowSum;
  for (std::size_t j = 0; j < columns; ++j) columnWeight[j] /= columnSum;
}

}  // namespace corridor
