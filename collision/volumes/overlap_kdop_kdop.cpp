#include "collision/volumes/overlap_kdop_kdop.h"

namespace corridor::internal {
namespace {

/// Returns the slab whose direction is d or −d, and the sign 1 or −1; the sign is 0 if there is no
/// such slab.
template <int K>
std::pair<std::size_t, double> slabOf(const Vec3& d) {
  const auto& n = slabDirections<K>();
  for (std::size_t i = 0; i < n.size(); ++i) {
    if (n[i] == d) return {i, 1.0};
    if (n[i] == -d) return {i, -1.0};
  }
  return {0, 0.0};
}

struct Term {
  double weight;
  // Entries of the slab direction along the axes of the vector's largest, middle and least
  // |component|, in this order.
  std::array<int, 3> direction;
};

/// Returns the terms for x ≥ y ≥ z ≥ 0. Other vectors are mirrored and permuted into this cone,
/// together with the slab directions. In each case the three directions span the part of the cone
/// that contains the vector, and so the weights are ≥ 0.
template <int K>
std::array<Term, 3> cone(double x, double y, double z) {
  if constexpr (K == 14)
    return {{{x - y, {1, 0, 0}}, {(y + z) / 2, {1, 1, 1}}, {(y - z) / 2, {1, 1, -1}}}};
  if constexpr (K == 26) return {{{x - y, {1, 0, 0}}, {y - z, {1, 1, 0}}, {z, {1, 1, 1}}}};
  if (x >= y + z) return {{{x - y - z, {1, 0, 0}}, {y, {1, 1, 0}}, {z, {1, 0, 1}}}};
  return {
      {{(x + y - z) / 2, {1, 1, 0}}, {(x + z - y) / 2, {1, 0, 1}}, {(y + z - x) / 2, {0, 1, 1}}}};
}

}  // namespace

template <int K>
SlabSum slabSum(const Vec3& n) {
  std::array<int, 3> order = {0, 1, 2};
  std::ranges::sort(order, [&](int i, int k) { return std::abs(n[i]) > std::abs(n[k]); });
  const auto terms = cone<K>(std::abs(n[order[0]]), std::abs(n[order[1]]), std::abs(n[order[2]]));
  SlabSum sum;
  Vec3 left = n;
  for (std::size_t k = 0; k < 3; ++k) {
    Vec3 d;
    for (int i = 0; i < 3; ++i)
      d[order[i]] = n[order[i]] < 0 ? -terms[k].direction[i] : terms[k].direction[i];
    const auto [slab, sign] = slabOf<K>(d);
    sum.slab[k] = slab;
    sum.weight[k] = sign * terms[k].weight;
    left -= terms[k].weight * d;
  }
  // Each component of `left` takes three differences, whose rounding is at most 3u of the numbers
  // involved. The error of the vector `left` is at most √3 times as large.
  sum.error = roundedUp(left.norm() + 8 * kUnit * (n.cwiseAbs().sum() + sum.size()));
  return sum;
}

template SlabSum slabSum<14>(const Vec3&);
template SlabSum slabSum<18>(const Vec3&);
template SlabSum slabSum<26>(const Vec3&);

}  // namespace corridor::internal
