#include "collision/queries/distance.h"

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <optional>
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
/// into a lower bound in the world: |Mx| ≥ √(1 − 3η)·|x| ≥ (1 − 3η)|x|, with η the matrix's
/// `orthonormalityDefect`.
double shrinkOf(const Transform& X_WA) {
  return std::max(0.0, roundedDown(1 - 3 * orthonormalityDefect(X_WA.m)));
}

/// The leaf tests. `Triangles` is for two trees of triangles; `Parts` is for trees of which at
/// least one has a convex part.
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

/// The query that `traverse` runs for `distance`.
template <class Volume, class Items>
class Nearest {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = BoundedPair;

  Nearest(const Posed<Tree>& a, const Posed<Tree>& b, const DistanceOptions& options,
          QueryContext& context)
      : a_(a.shape),
        b_(b.shape),
        volumes_(pairTestOf<Volume>(a, b)),
        shrink_(shrinkOf(a.X_W)),
        nearest_(a.X_W, a_.reach(), b.X_W, b_.reach(), options, context),
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
        ++counters_.primitiveTests;
        if (nearest_.testPair(s, Items::item(a_, s), t, Items::item(b_, t), counters_)) return true;
      }
    return false;
  }
  Distance result() { return nearest_.result(a_, b_); }
  void takeAsApart() { nearest_.takeAsApart(); }         // only `Parts`
  bool isDenied() { return nearest_.isDenied(a_, b_); }  // only `Parts`

 private:
  const Tree &a_, &b_;
  PairTest<Volume> volumes_;
  double shrink_;
  typename Items::Nearest nearest_;
  Counters& counters_;
};

/// The query that `traverse` runs for `closerThan`.
template <class Volume, class Items>
class Closer {
 public:
  using Tree = VolumeTree<Volume>;
  using Node = typename Tree::Node;
  using Item = NodePair;

  Closer(const Posed<Tree>& a, const Posed<Tree>& b, double d, QueryContext& context)
      : a_(a.shape),
        b_(b.shape),
        volumes_(pairTestOf<Volume>(a, b)),
        closer_(a.X_W, a_.reach(), b.X_W, b_.reach(), d),
        pad_(roundedUp(d / shrinkOf(a.X_W))),
        counters_(context.counters) {}

  bool enter(const Item&, const Node& na, const Node& nb) {
    ++counters_.boxTests;
    return !volumes_.separated(na.box, nb.box, pad_);
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) { stack.push_back({i, k}); }
  void opened(std::vector<Item>&, std::size_t) {}
  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count && !found; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count && !found; ++t) {
        ++counters_.primitiveTests;
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

/// The stack of distance searches.
using BoundedPairs = std::vector<BoundedPair>;

template <class Items, class Volume>
Distance nearest(const Posed<VolumeTree<Volume>>& a, const Posed<VolumeTree<Volume>>& b,
                 const DistanceOptions& options, QueryContext& context) {
  const auto search = [&](Nearest<Volume, Items>& query) {
    traverse(a.shape, b.shape, BoundedPair{0, 0, 0}, *context.scratch.use<BoundedPairs>(), query);
  };
  std::optional<Nearest<Volume, Items>> query(std::in_place, a, b, options, context);
  search(*query);
  if constexpr (std::same_as<Items, Parts>)
    if (query->isDenied()) {
      query.reset();  // returns its scratch memory
      query.emplace(a, b, options, context);
      query->takeAsApart();
      search(*query);
    }
  return query->result();
}

template <class Items, class Volume>
bool closer(const Posed<VolumeTree<Volume>>& a, const Posed<VolumeTree<Volume>>& b, double d,
            QueryContext& context) {
  Closer<Volume, Items> query(a, b, d, context);
  traverse(a.shape, b.shape, NodePair{0, 0}, *context.scratch.use<NodePairs>(), query);
  return query.found;
}

}  // namespace

template <BoundingVolume Volume>
Distance distance(const Posed<VolumeTree<Volume>>& a, const Posed<VolumeTree<Volume>>& b,
                  const DistanceOptions& options, QueryContext& context) {
  return a.shape.hasParts() || b.shape.hasParts() ? nearest<Parts>(a, b, options, context)
                                                  : nearest<Triangles>(a, b, options, context);
}

template <BoundingVolume Volume>
bool closerThan(const Posed<VolumeTree<Volume>>& a, const Posed<VolumeTree<Volume>>& b, double d,
                QueryContext& context) {
  if (d == 0) return interference(a, b, context).has_value();
  if (std::isnan(d)) return true;  // a NaN proves nothing
  return a.shape.hasParts() || b.shape.hasParts() ? closer<Parts>(a, b, d, context)
                                                  : closer<Triangles>(a, b, d, context);
}

#define CORRIDOR_DISTANCE(Volume)                                                                \
  template Distance distance(const Posed<VolumeTree<Volume>>&, const Posed<VolumeTree<Volume>>&, \
                             const DistanceOptions&, QueryContext&);                             \
  template bool closerThan(const Posed<VolumeTree<Volume>>&, const Posed<VolumeTree<Volume>>&,   \
                           double, QueryContext&);
CORRIDOR_EACH_VOLUME(CORRIDOR_DISTANCE)
#undef CORRIDOR_DISTANCE

}  // namespace corridor
