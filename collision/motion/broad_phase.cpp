#include "collision/motion/broad_phase.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "collision/core/rounding.h"

namespace corridor {
namespace {

/// The least number of pairs for a tree. With fewer pairs, a test of each pair is as fast as a walk
/// of the tree. With trees, an arm's edge took 1.1 times as long at 24 obstacles, and 0.4 times as
/// long at 88 (many_bodies_benchmark).
constexpr std::size_t kLeastPairs = 32;
/// The least number of pairs of two moving bodies for a sweep (many_bodies_benchmark --movers).
constexpr std::size_t kLeastMovingPairs = 300;

/// Whether both bodies move, and their motions as seen from the world are known.
bool isMovingPair(const MotionPair& pair) {
  return pair.worldMotionA != MotionPair::kNone && pair.worldMotionB != MotionPair::kNone;
}

bool haveSameBodiesA(std::span<const MotionPair> x, std::span<const MotionPair> y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const MotionPair& p, const MotionPair& q) { return p.a == q.a; });
}

}  // namespace

BroadPhase::BroadPhase(std::span<const MotionPair> pairs) : pairs_(pairs) {
  for (const MotionPair& pair : pairs)
    if (pair.worldMotionB != MotionPair::kNone)
      bodies_ = std::max({bodies_, pair.bodyA + 1, pair.bodyB + 1});
  if (std::ranges::count_if(pairs, isMovingPair) >= static_cast<std::ptrdiff_t>(kLeastMovingPairs))
    addMovers();
  const bool sweeps = !movers_.empty();
  const auto isTested = [&](const MotionPair& pair) {
    return pair.restBox && pair.worldMotionB != MotionPair::kNone;
  };
  const auto followsIn = [&](const MotionPair& first, const MotionPair& pair) {
    if (sweeps && isMovingPair(pair)) return false;
    return isTested(first) ? isTested(pair) && pair.bodyB == first.bodyB
                           : pair.motion == first.motion && pair.bodyB == first.bodyB;
  };
  std::size_t lastTree = runs_.size();  // the index of the last run with a tree
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const MotionPair& first = pairs[begin];
    if (sweeps && isMovingPair(first)) {
      end = begin + 1;
      continue;
    }
    for (end = begin + 1; end < pairs.size() && followsIn(first, pairs[end]);) ++end;
    std::shared_ptr<const BoxTree> tree;
    if (isTested(first) && end - begin >= kLeastPairs) {
      const auto own = pairs.subspan(begin, end - begin);
      const Run* const last = lastTree < runs_.size() ? &runs_[lastTree] : nullptr;
      if (last && haveSameBodiesA(own, pairs.subspan(last->begin, last->end - last->begin))) {
        tree = last->tree;
      } else {
        std::vector<BoundingBox> boxes;
        for (const MotionPair& pair : own) boxes.push_back(*pair.restBox);
        tree = std::make_shared<const BoxTree>(boxes);
      }
      lastTree = runs_.size();
      hasTrees_ = true;
    }
    if (!tree && !runs_.empty() && !runs_.back().tree && runs_.back().end == begin)
      runs_.back().end = end;
    else
      runs_.push_back({begin, end, std::move(tree)});
  }
}

void BroadPhase::addMovers() {
  std::map<std::size_t, std::uint32_t> moverOfBody;
  const auto moverOf = [&](const Body* body, std::size_t index, std::size_t worldMotion) {
    const auto [found, added] =
        moverOfBody.try_emplace(index, static_cast<std::uint32_t>(movers_.size()));
    if (added) {
      MotionPair mover{nullptr, body};
      mover.bodyB = index;
      mover.worldMotionB = worldMotion;
      movers_.push_back(mover);
      partners_.emplace_back();
    }
    return found->second;
  };
  for (std::size_t k = 0; k < pairs_.size(); ++k) {
    const MotionPair& pair = pairs_[k];
    if (!isMovingPair(pair)) continue;
    const std::uint32_t a = moverOf(pair.a, pair.bodyA, pair.worldMotionA);
    const std::uint32_t b = moverOf(pair.b, pair.bodyB, pair.worldMotionB);
    partners_[std::min(a, b)].push_back({std::max(a, b), static_cast<std::uint32_t>(k)});
  }
  for (std::vector<Partner>& partners : partners_)
    std::ranges::stable_sort(partners, {}, &Partner::mover);
}

std::vector<std::uint32_t> BroadPhase::overlappingMovers(std::span<const SweptSphere> spheres,
                                                         double within) const {
  // The axis along which the centres vary most.
  Vec3 mean = Vec3::Zero(), spread = Vec3::Zero();
  for (const SweptSphere& sphere : spheres) mean += sphere.center;
  mean /= static_cast<double>(spheres.size());
  for (const SweptSphere& sphere : spheres) spread += (sphere.center - mean).cwiseAbs2();
  const int axis = spread[0] >= spread[1] && spread[0] >= spread[2] ? 0
                   : spread[1] >= spread[2]                         ? 1
                                                                    : 2;
  struct Extent {
    double lower, upper;  ///< `upper` is enlarged by `within`
    std::uint32_t mover;
  };
  std::vector<Extent> extents;
  extents.reserve(spheres.size());
  for (const SweptSphere& sphere : spheres) {
    // All points of the body stay within `reach` of the centre. Each of the two sums and two
    // differences below rounds by at most u times |centre| + reach, up to second order.
    const double reach = roundedUp(sphere.radius + sphere.isotropic);
    const double beyond = roundedUp(reach + within), center = sphere.center[axis];
    const double error = 4 * kUnit * (std::abs(center) + beyond);
    Extent extent{center - reach - error, center + beyond + error,
                  static_cast<std::uint32_t>(extents.size())};
    if (!std::isfinite(extent.lower) || !std::isfinite(extent.upper))
      extent.lower = -HUGE_VAL, extent.upper = HUGE_VAL;
    extents.push_back(extent);
  }
  std::ranges::sort(extents, [](const Extent& x, const Extent& y) {
    return x.lower < y.lower || (x.lower == y.lower && x.mover < y.mover);
  });
  std::vector<std::uint32_t> found;
  std::vector<Extent> open;  // the extents that begin before the current one, and may reach it
  for (const Extent& extent : extents) {
    std::erase_if(open, [&](const Extent& other) { return other.upper < extent.lower; });
    for (const Extent& other : open) {
      const auto [i, j] = std::minmax(extent.mover, other.mover);
      const std::vector<Partner>& all = partners_[i];
      auto of = std::ranges::lower_bound(all, j, {}, &Partner::mover);
      if (of == all.end() || of->mover != j ||
          clearanceBound(spheres[i], spheres[j], within) > within)
        continue;
      for (; of != all.end() && of->mover == j; ++of) found.push_back(of->pair);
    }
    open.push_back(extent);
  }
  std::ranges::sort(found);
  return found;
}

void BroadPhase::find(IntervalMotions& motions, double within,
                      std::vector<std::uint32_t>& found) const {
  found.clear();
  if (!hasTrees_ && movers_.empty()) {
    found.resize(pairs_.size());
    std::iota(found.begin(), found.end(), std::uint32_t{0});
    return;
  }
  forEach([&](const MotionPair& pair) { return motions.worldSphere(pair); }, within,
          [&](std::size_t k) {
            found.push_back(static_cast<std::uint32_t>(k));
            return false;
          });
  std::sort(found.begin(), found.end());
}

}  // namespace corridor
