#include "collision/queries/distance.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/hierarchy/traverse.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/closest_points.h"
#include "collision/queries/interference.h"
#include "collision/queries/relative_pose.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {
namespace {

/// What the volumes and the triangles of one query share. Volumes are told apart in frame A, where
/// distances are at most 1/shrink of those in the world: |Mx| ≥ √(1 − 3η)·|x| ≥ (1 − 3η)|x|.
template <class Volume>
struct Measures {
  Transform X_AB;
  PairTest<Volume> volumes;
  TriangleDistances triangles;
  double shrink;

  Measures(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
           const Transform& X_WB)
      : X_AB(rigidInverse(X_WA) * X_WB),
        volumes(a.bounds(), b.bounds(), X_AB, relativePoseError(X_WA, X_AB, X_WB, b.reach())),
        triangles(X_WA, a.reach(), X_WB, b.reach()),
        shrink(std::max(0.0, roundedDown(1 - 3 * orthonormalityDefect(X_WA.m)))) {}
};

template <class Volume>
class Nearest {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = QueryContext::BoundedPair;

  Nearest(const Tree& a, const Transform& X_WA, const Tree& b, const Transform& X_WB,
          const DistanceOptions& options, QueryContext& context)
      : a_(a),
        b_(b),
        X_WA_(X_WA),
        X_WB_(X_WB),
        options_(options),
        measures_(a, X_WA, b, X_WB),
        counters_(context.counters),
        candidates_(context.candidates) {
    candidates_.clear();
  }

  bool enter(const Item& item, const Node&, const Node&) { return canImprove(item.bound); }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    ++counters_.boxTests;
    const double bound =
        measures_.volumes.distanceBound(a_.node(i).box, b_.node(k).box) * measures_.shrink;
    if (canImprove(bound)) stack.push_back({i, k, bound});
  }
  void opened(std::vector<Item>& stack, std::size_t first) {  // the nearest first
    std::ranges::sort(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end(),
                      std::ranges::greater(), &Item::bound);
  }
  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        const DistanceRange range = measures_.triangles(a_.triangles()[s], b_.triangles()[t]);
        if (range.lower > 0) {
          ++counters_.triangleTests;
        } else if (trianglesTouch(a_.triangles()[s], X_WA_, b_.triangles()[t], X_WB_, counters_)) {
          candidates_.assign(1, {s, t, 0});
          contact_ = true;
          return true;
        }
        if (!canImprove(range.lower)) continue;
        candidates_.push_back({s, t, range.lower});
        if (!(range.upper < upper_)) continue;
        upper_ = range.upper;
        std::erase_if(candidates_, [&](const Item& c) { return c.bound >= upper_; });
      }
    return false;
  }

  Distance result() {
    Distance best;
    best.distance = HUGE_VAL;
    std::ranges::sort(candidates_, {}, &Item::bound);
    for (const auto& [s, t, bound] : candidates_) {
      if (bound >= best.distance) break;
      const WitnessPoints w = closestPoints(a_.triangles()[s], X_WA_, b_.triangles()[t], X_WB_);
      if (!(w.distance < best.distance)) continue;
      best = {w.distance, w.p_WA, w.p_WB, a_.meshTriangle(s), b_.meshTriangle(t)};
    }
    // Only contact is 0, and what is not contact is not.
    best.distance = contact_ ? 0 : std::max(best.distance, std::numeric_limits<double>::min());
    return best;
  }

 private:
  /// Might something at least `bound` away be closer than the best by more than the options allow?
  /// What may touch always might, so that only contact is 0; and so might a NaN.
  bool canImprove(double bound) const {
    return bound == 0 || !(bound * (1 + options_.relative) + options_.absolute >= upper_);
  }

  const Tree &a_, &b_;
  const Transform &X_WA_, &X_WB_;
  const DistanceOptions& options_;
  Measures<Volume> measures_;
  Counters& counters_;
  std::vector<Item>& candidates_;
  double upper_ = HUGE_VAL;
  bool contact_ = false;
};

template <class Volume>
class Closer {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = QueryContext::NodePair;

  Closer(const Tree& a, const Transform& X_WA, const Tree& b, const Transform& X_WB, double d,
         QueryContext& context)
      : a_(a),
        b_(b),
        X_WA_(X_WA),
        X_WB_(X_WB),
        measures_(a, X_WA, b, X_WB),
        d_(d),
        pad_(measures_.shrink > 0 ? roundedUp(d / measures_.shrink) : HUGE_VAL),
        counters_(context.counters) {}

  bool enter(const Item&, const Node& na, const Node& nb) {
    ++counters_.boxTests;
    return !measures_.volumes.separated(na.box, nb.box, pad_);
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>&, std::size_t) {}
  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count && !found; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count && !found; ++t)
        found = close(a_.triangles()[s], b_.triangles()[t]);
    return found;
  }

  bool found = false;

 private:
  bool close(const Triangle& s, const Triangle& t) {
    const DistanceRange range = measures_.triangles(s, t);
    if (range.lower > d_) {
      ++counters_.triangleTests;
      return false;
    }
    if (range.upper <= d_) {
      ++counters_.triangleTests;
      return true;
    }
    if (trianglesTouch(s, X_WA_, t, X_WB_, counters_)) return true;
    const WitnessPoints w = closestPoints(s, X_WA_, t, X_WB_);
    return w.distance <= d_ + band(s, t, w);
  }
  double band(const Triangle& s, const Triangle& t, const WitnessPoints& w) const {
    double size = 0;
    for (const Vec3& p : s)
      size = std::max(size, (X_WA_.m.cwiseAbs() * p.cwiseAbs() + X_WA_.t.cwiseAbs()).maxCoeff());
    for (const Vec3& p : t)
      size = std::max(size, (X_WB_.m.cwiseAbs() * p.cwiseAbs() + X_WB_.t.cwiseAbs()).maxCoeff());
    return 2 * kUnit * (size + w.distance);
  }

  const Tree &a_, &b_;
  const Transform &X_WA_, &X_WB_;
  Measures<Volume> measures_;
  double d_, pad_;
  Counters& counters_;
};

}  // namespace

template <BoundingVolume Volume>
Distance distance(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                  const Transform& X_WB, const DistanceOptions& options, QueryContext& context) {
  ++context.counters.states;
  Nearest<Volume> query(a, X_WA, b, X_WB, options, context);
  traverse(a, b, QueryContext::BoundedPair{0, 0, 0}, context.bounded, query);
  return query.result();
}

template <BoundingVolume Volume>
bool closerThan(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                const Transform& X_WB, double d, QueryContext& context) {
  if (d == 0) return interference(a, X_WA, b, X_WB, context).has_value();
  ++context.counters.states;
  Closer<Volume> query(a, X_WA, b, X_WB, d, context);
  traverse(a, b, QueryContext::NodePair{0, 0, 0}, context.stack, query);
  return query.found;
}

#define CORRIDOR_DISTANCE(Volume)                                                                  \
  template Distance distance(const VolumeTree<Volume>&, const Transform&,                          \
                             const VolumeTree<Volume>&, const Transform&, const DistanceOptions&,  \
                             QueryContext&);                                                       \
  template bool closerThan(const VolumeTree<Volume>&, const Transform&, const VolumeTree<Volume>&, \
                           const Transform&, double, QueryContext&);
CORRIDOR_DISTANCE(Obb)
CORRIDOR_DISTANCE(Aabb)
CORRIDOR_DISTANCE(BoundingSphere)
CORRIDOR_DISTANCE(Rss)
CORRIDOR_DISTANCE(Kdop<14>)
CORRIDOR_DISTANCE(Kdop<18>)
CORRIDOR_DISTANCE(Kdop<26>)
#undef CORRIDOR_DISTANCE

}  // namespace corridor
