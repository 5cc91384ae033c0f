#include "collision/geometry/vertex_welder.h"

#include <bit>

namespace corridor {
namespace {

/// Returns a hash of the bits of a point. The products of the three coordinates do not wait for
/// each other; MurmurHash3's finaliser mixes them. (Without it, the low bits of the result would
/// not depend on numbers of few digits, whose bits are high.)
std::uint64_t hashOf(const Vec3& point) {
  const auto bits = [&](int i) { return std::bit_cast<std::uint64_t>(point[i]); };
  std::uint64_t h = bits(0) * 0x9e3779b97f4a7c15ULL;
  h ^= std::rotl(bits(1) * 0xc2b2ae3d27d4eb4fULL, 21);
  h ^= std::rotl(bits(2) * 0x165667b19e3779f9ULL, 42);
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
  std::size_t slot = hashOf(point) & (slots_.size() - 1);
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
  for (const std::uint32_t i : recent_)
    if (i < points_.size() && points_[i] == p) return i;
  const std::uint32_t found = addOrLookUp(p);
  recent_[next_++ % recent_.size()] = found;
  return found;
}

std::uint32_t VertexWelder::addOrLookUp(const Vec3& p) {
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
