#include "collision/geometry/isolated_points.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>

namespace corridor {

std::vector<bool> isolatedPoints(std::span<const Vec3> points, double distance,
                                 std::size_t neighbours) {
  if (!(distance > 0 && std::isfinite(distance)))
    throw std::invalid_argument("distance: a finite number above 0 is needed");
  using Cell = std::array<std::int64_t, 3>;
  const auto cellOf = [&](const Vec3& p) {
    const Vec3 scaled = (p / distance).array().floor();
    if (!(scaled.cwiseAbs().maxCoeff() < 0x1p52))
      throw std::invalid_argument("distance: too small for coordinates as large as these");
    return Cell{static_cast<std::int64_t>(scaled[0]), static_cast<std::int64_t>(scaled[1]),
                static_cast<std::int64_t>(scaled[2])};
  };
  std::map<Cell, std::vector<std::size_t>> cells;
  for (std::size_t i = 0; i < points.size(); ++i) cells[cellOf(points[i])].push_back(i);
  const auto isIsolated = [&](std::size_t i) {
    const Cell own = cellOf(points[i]);
    std::size_t found = 0;
    for (int k = 0; k < 27; ++k) {
      const auto cell =
          cells.find({own[0] + k % 3 - 1, own[1] + k / 3 % 3 - 1, own[2] + k / 9 - 1});
      if (cell == cells.end()) continue;
      for (const std::size_t other : cell->second) {
        found += other != i && (points[other] - points[i]).norm() <= distance;
        if (found >= neighbours) return false;
      }
    }
    return true;
  };
  std::vector<bool> isolated(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) isolated[i] = isIsolated(i);
  return isolated;
}

}  // namespace corridor
