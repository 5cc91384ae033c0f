#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "collision/core/transform.h"

namespace corridor {

/// Gives distinct points indices from 0, in the order of their first appearance. Points are equal
/// if their coordinates are exactly equal; -0 equals 0, and is stored as 0.
class VertexWelder {
 public:
  explicit VertexWelder(std::size_t expectedPoints);

  /// Returns the index of a point in `points()`. Adds the point if no equal point was added before.
  /// @pre the point is finite.
  std::uint32_t addOrFind(const Vec3& point);

  const std::vector<Vec3>& points() const { return points_; }
  std::vector<Vec3> takePoints() { return std::move(points_); }

 private:
  static constexpr std::uint32_t none_ = UINT32_MAX;

  /// Returns the slot that holds the point, or into which it is to be inserted.
  std::size_t slotOf(const Vec3& point) const;
  std::uint32_t addOrLookUp(const Vec3& point);
  void grow();

  std::vector<Vec3> points_;
  /// A hash table with open addressing. Its size is a power of two, and at most half of its slots
  /// are used.
  std::vector<std::uint32_t> slots_;
  /// The last points that the table gave, whatever their order. The facets of most files share a
  /// corner or two with the facets just before them, which need no look-up.
  std::array<std::uint32_t, 4> recent_ = {none_, none_, none_, none_};
  std::size_t next_ = 0;
};

}  // namespace corridor
