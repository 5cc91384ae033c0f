#include "collision/queries/distance.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <vector>

#include "collision/core/rounding.h"
#include "collision/hierarchy/traverse.h"
#include "collision/queries/closer_triangles.h"
#include "collision/queries/interference.h"
#include "collision/queries/nearest_parts.h"
#include "collision/queries/nearest_triangles.h"
#include "collision/queries/touching_pairs.h"

namespace corridor {
namespace {

/// Returns the factor that turns a lower bound of a distance in frame A, where volumes are tested,
/// into one in the world: |Mx| ≥ √(1 − 3η)·|x| ≥ (1 − 3η)|x|, with η the matrix's
/// `orthonormalityDefect`.
double shrinkOf(const Transform& X_WA) {
  return std::max(0.0, roundedDown(1 - 3 * orthonormalityDefect(X_WA.m)));
}

/// The leaf tests by what the leaves hold: triangles in both trees, or convex parts in at least
/// one.
struct Triangles {
  using Nearest = NearestTriangles;
  using Closer = CloserTriangles;
  template <class Tree>
  static const Triangle& item(const Tree& tree, std::uint32_t i) {
    return tree.triangle(i);
  }
};
struct Parts {
  using Nearest = NearestParts;
  using Closer = CloserParts;
  template <class Tree>
  static ConvexSet item(const Tree& tree, std::uint32_t i) {
    return convexSetOf(tree, i);
  }
};

template <class Volume, class Items>
class Nearest {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = QueryContext::BoundedPair;

  Nearest(const Tree& a, const Transform& X_WA, const Tree& b, const Transform& X_WB,
          const DistanceOptions& options, QueryContext& context)
      : a_(a),
        b_(b),
        volumes_(pairTestOf<Volume>(a, X_WA, b, X_WB)),
        shrink_(shrinkOf(X_WA)),
        nearest_(X_WA, a.reach(), X_WB, b.reach(), options, context),
        counters_(context.counters) {}

  bool enter(const Item& item, const Node&, const Node&) { return nearest_.canImprove(item.bound); }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    ++counters_.boxTests;
    const double bound = volumes_.distanceBound(a_.node(i).box, b_.node(k).box) * shrink_;
    if (nearest_.canImprove(bound)) stack.push_back({i, k, bound});
  }
  void opened(std::vector<Item>& stack, std::size_t first) {  // visit the nearest pair first
    std::ranges::sort(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end(),
                      std::ranges::greater(), &Item::bound);
  }
  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        ++counters_.triangleTests;
        if (nearest_.look(s, Items::item(a_, s), t, Items::item(b_, t), counters_)) return true;
      }
    return false;
  }
  Distance result() { return nearest_.result(a_, b_); }

 private:
  const Tree &a_, &b_;
  PairTest<Volume> volumes_;
  double shrink_;
  typename Items::Nearest nearest_;
  Counters& counters_;
};

template <class Volume, class Items>
class Closer {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = QueryContext::NodePair;

  Closer(const Tree& a, const Transform& X_WA, const Tree& b, const Transform& X_WB, double d,
         QueryContext& context)
      : a_(a),
        b_(b),
        volumes_(pairTestOf<Volume>(a, X_WA, b, X_WB)),
        closer_(X_WA, a.reach(), X_WB, b.reach(), d),
        pad_(roundedUp(d / shrinkOf(X_WA))),
        counters_(context.counters) {}

  bool enter(const Item&, const Node& na, const Node& nb) {
    ++counters_.boxTests;
    return !volumes_.separated(na.box, nb.box, pad_);
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>&, std::size_t) {}
  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count && !found; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count && !found; ++t) {
        ++counters_.triangleTests;
        found = closer_(Items::item(a_, s), Items::item(b_, t), counters_);
      }
    return found;
  }

  bool found = false;

 private:
  const Tree &a_, &b_;
  PairTest<Volume> volumes_;
  typename Items::Closer closer_;
  double pad_;
  Counters& counters_;
};

template <class Items, class Volume>
Distance nearest(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                 const Transform& X_WB, const DistanceOptions& options, QueryContext& context) {
  ++context.counters.states;
  Nearest<Volume, Items> query(a, X_WA, b, X_WB, options, context);
  traverse(a, b, QueryContext::BoundedPair{0, 0, 0}, context.bounded, query);
  return query.result();
}

template <class Items, class Volume>
bool closer(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
            const Transform& X_WB, double d, QueryContext& context) {
  ++context.counters.states;
  Closer<Volume, Items> query(a, X_WA, b, X_WB, d, context);
  traverse(a, b, QueryContext::NodePair{0, 0, 0}, context.stack, query);
  return query.found;
}

}  // namespace

template <BoundingVolume Volume>
Distance distance(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                  const Transform& X_WB, const DistanceOptions& options, QueryContext& context) {
  return a.part() || b.part() ? nearest<Parts>(a, X_WA, b, X_WB, options, context)
                              : nearest<Triangles>(a, X_WA, b, X_WB, options, context);
}

template <BoundingVolume Volume>
bool closerThan(const VolumeTree<Volume>& a, const Transform& X_WA, const VolumeTree<Volume>& b,
                const Transform& X_WB, double d, QueryContext& context) {
  if (d == 0) return interference(a, X_WA, b, X_WB, context).has_value();
  return a.part() || b.part() ? closer<Parts>(a, X_WA, b, X_WB, d, context)
                              : closer<Triangles>(a, X_WA, b, X_WB, d, context);
}

#define CORRIDOR_DISTANCE(Volume)                                                                  \
  template Distance distance(const VolumeTree<Volume>&, const Transform&,                          \
                             const VolumeTree<Volume>&, const Transform&, const DistanceOptions&,  \
                             QueryContext&);                                                       \
  template bool closerThan(const VolumeTree<Volume>&, const Transform&, const VolumeTree<Volume>&, \
                           const Transform&, double, QueryContext&);
CORRIDOR_EACH_VOLUME(CORRIDOR_DISTANCE)
#undef CORRIDOR_DISTANCE

}  // namespace corridor
