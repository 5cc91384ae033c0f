#include "collision/geometry/vertex_welder.h"

#include <bit>

namespace corridor {
namespace {

std::uint64_t mixed(std::uint64_t h) {  // MurmurHash3's finaliser
  h = (h ^ (h >> 33)) * 0xff51afd7ed558ccdULL;
  h = (h ^ (h >> 33)) * 0xc4ceb9fe1a85ec53ULL;
  return h ^ (h >> 33);
}

}  // namespace

VertexWelder::VertexWelder(std::size_t expectedPoints)
    : slots_(std::bit_ceil(2 * expectedPoints + 16), none_) {
  points_.reserve(expectedPoints);
}

std::size_t VertexWelder::slotOf(const Vec3& point) const {
  std::uint64_t hash = 0;
  for (int i = 0; i < 3; ++i) hash = mixed(hash ^ std::bit_cast<std::uint64_t>(point[i]));
  std::size_t slot = hash & (slots_.size() - 1);
  while (slots_[slot] != none_ && points_[slots_[slot]] != point)
    slot = (slot + 1) & (slots_.size() - 1);
  return slot;
}

void VertexWelder::grow() {
  slots_.assign(2 * slots_.size(), none_);
  for (std::uint32_t i = 0; i < points_.size(); ++i) slots_[slotOf(points_[i])] = i;
}

std::uint32_t VertexWelder::addOrFind(const Vec3& point) {
  const Vec3 p(point.x() + 0.0, point.y() + 0.0, point.z() + 0.0);
  std::size_t slot = slotOf(p);
  if (slots_[slot] != none_) return slots_[slot];
  if (2 * (points_.size() + 1) > slots_.size()) {
    grow();
    slot = slotOf(p);
  }
  slots_[slot] = static_cast<std::uint32_t>(points_.size());
  points_.push_back(p);
  return slots_[slot];
}

}  // namespace corridor
