#include "collision/motion/broad_phase.h"

#include <algorithm>
#include <numeric>

namespace corridor {
namespace {

/// The least number of pairs for a tree. With fewer pairs, a test of each pair is as fast as a walk
/// of the tree. With trees, an arm's edge took 1.1 times as long at 24 obstacles, and 0.4 times as
/// long at 88 (many_bodies_benchmark).
constexpr std::size_t kLeastPairs = 32;

bool haveSameBodiesA(std::span<const MotionPair> x, std::span<const MotionPair> y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const MotionPair& p, const MotionPair& q) { return p.a == q.a; });
}

}  // namespace

BroadPhase::BroadPhase(std::span<const MotionPair> pairs) : pairs_(pairs) {
  for (const MotionPair& pair : pairs)
    if (pair.worldMotionB != MotionPair::kNone)
      bodies_ = std::max({bodies_, pair.bodyA + 1, pair.bodyB + 1});
  const auto isTested = [&](const MotionPair& pair) {
    return pair.restBox && pair.worldMotionB != MotionPair::kNone;
  };
  const auto followsIn = [&](const MotionPair& first, const MotionPair& pair) {
    return isTested(first) ? isTested(pair) && pair.bodyB == first.bodyB
                           : pair.motion == first.motion && pair.bodyB == first.bodyB;
  };
  std::size_t lastTree = runs_.size();  // the index of the last run with a tree
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    const MotionPair& first = pairs[begin];
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
    if (!tree && !runs_.empty() && !runs_.back().tree)
      runs_.back().end = end;
    else
      runs_.push_back({begin, end, std::move(tree)});
  }
}

void BroadPhase::find(IntervalMotions& motions, double within,
                      std::vector<std::uint32_t>& found) const {
  found.clear();
  if (!hasTrees_) {
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
