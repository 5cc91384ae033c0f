#pragma once

#include <cstdint>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Numbers points by exact equality of coordinates (-0 equals 0, and is stored as 0), in order of
/// first appearance.
class VertexWelder {
 public:
  explicit VertexWelder(std::size_t expectedPoints);

  /// The number of this (finite) point, new or seen before.
  std::uint32_t index(const Vec3& point);

  const std::vector<Vec3>& points() const { return points_; }
  std::vector<Vec3> takePoints() { return std::move(points_); }

 private:
  static constexpr std::uint32_t none_ = UINT32_MAX;

  std::size_t slotOf(const Vec3& point) const;  ///< where the point is or belongs
  void grow();

  std::vector<Vec3> points_;
  std::vector<std::uint32_t>
      slots_;  ///< open addressing; a power of two of them, at most half of them used
};

}  // namespace corridor
