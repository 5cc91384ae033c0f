#include "collision/hierarchy/cluster.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>

namespace corridor {
namespace {

constexpr std::size_t kSearch = 10;
/// A round has few merges if it has fewer than n / kFewMerges of them, where n is the number of
/// clusters.
constexpr std::size_t kFewMerges = 16;

struct Extent {
  Vec3 low, high;
};

Extent merged(const Extent& a, const Extent& b) {
  return {a.low.cwiseMin(b.low), a.high.cwiseMax(b.high)};
}

double halfSurface(const Extent& e) {
  const Vec3 s = e.high - e.low;
  return s[0] * s[1] + s[1] * s[2] + s[2] * s[0];
}

std::uint64_t spread(std::uint64_t x) {  // inserts two zeros between adjacent bits, for 21 bits
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Returns the indices of the boxes, in the order of the boxes' centres along a Morton curve.
std::vector<std::uint32_t> mortonOrder(std::span<const Obb> boxes, double unit, const Vec3& low) {
  std::vector<std::uint64_t> codes;
  for (const Obb& box : boxes) {
    std::uint64_t code = 0;
    for (int i = 0; i < 3; ++i) {
      const double x = (box.center[i] - low[i]) / unit * 0x1p21;
      code |= spread(static_cast<std::uint64_t>(std::clamp(x, 0.0, 0x1p21 - 1))) << i;
    }
    codes.push_back(code);
  }
  std::vector<std::uint32_t> order(boxes.size());
  std::iota(order.begin(), order.end(), 0U);
  std::ranges::stable_sort(order, {}, [&](std::uint32_t i) { return codes[i]; });
  return order;
}

}  // namespace

std::vector<Cluster> clustered(std::span<const Obb> boxes) {
  Vec3 low = boxes[0].center, high = low;
  for (const Obb& box : boxes) {
    low = low.cwiseMin(box.center - box.half);
    high = high.cwiseMax(box.center + box.half);
  }
  // Coordinates are in units of the size of all boxes together, so that surfaces neither overflow
  // nor underflow.
  const double size = (high - low).maxCoeff();
  const double unit = size > 0 && size < HUGE_VAL ? size : 1;

  struct Active {
    Extent extent;
    std::uint32_t cluster;
  };
  std::vector<Cluster> clusters(boxes.size());
  std::vector<Active> active, next;
  for (const std::uint32_t i : mortonOrder(boxes, unit, low)) {
    const Vec3 c = (boxes[i].center - low) / unit, h = boxes[i].half / unit;
    active.push_back({{c - h, c + h}, i});
  }
  std::vector<std::size_t> chosen;
  while (active.size() > 1) {
    const std::size_t n = active.size();
    chosen.assign(n, 0);
    std::size_t merges = 0;
    for (std::size_t i = 0; i < n; ++i) {
      // Ties go to the least i xor k. The two clusters of a pair then choose each other, and no
      // cluster in a chain of equal clusters has to wait for another.
      auto best = std::tuple(std::numeric_limits<double>::infinity(), n * 2, i);
      for (std::size_t k = i > kSearch ? i - kSearch : 0; k < std::min(n, i + kSearch + 1); ++k)
        if (k != i)
          best = std::min(
              best, std::tuple(halfSurface(merged(active[i].extent, active[k].extent)), i ^ k, k));
      chosen[i] = std::get<2>(best);
      merges += chosen[i] < i && chosen[chosen[i]] == i;
    }
    if (merges * kFewMerges < n)
      for (std::size_t i = 0; i < n; ++i) chosen[i] = std::min(i ^ 1, n - 1);
    next.clear();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t k = chosen[i];
      if (k == i || chosen[k] != i) {
        next.push_back(active[i]);
      } else if (i < k) {
        const std::uint32_t l = active[i].cluster, r = active[k].cluster;
        next.push_back({merged(active[i].extent, active[k].extent),
                        static_cast<std::uint32_t>(clusters.size())});
        clusters.push_back({l, r, clusters[l].count + clusters[r].count});
      }
    }
    active.swap(next);
  }
  return clusters;
}

}  // namespace corridor
