#include "collision/queries/interference.h"

#include <algorithm>
#include <limits>

#include "collision/convex/convex_contact.h"
#include "collision/hierarchy/traverse.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/relative_pose.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {
namespace {

template <class Tree>
ConvexSet leafSet(const Tree& tree, std::uint32_t item) {
  return tree.part(item) ? ConvexSet(*tree.part(item)) : ConvexSet(tree.triangles()[item]);
}

/// First contact: a pair whose volumes are apart is dropped; the first leaf pair that touches ends
/// it, and so does the work limit.
template <class TreeA, class TreeB, class Test>
class FirstContact {
 public:
  using Item = QueryContext::NodePair;

  FirstContact(const TreeA& a, const Transform& X_WA, const TreeB& b, const Transform& X_WB,
               const Test& test, Counters& counters, std::uint64_t workEnd)
      : a_(a),
        b_(b),
        X_WA_(X_WA),
        X_WB_(X_WB),
        test_(test),
        counters_(counters),
        workEnd_(workEnd) {}

  bool enter(const Item&, const typename TreeA::Node& na, const typename TreeB::Node& nb) {
    if (!spare()) return false;
    ++counters_.boxTests;
    return !test_.separated(na.box, nb.box, 0);
  }
  /// All of one leaf's items against all of the other's.
  bool leaves(const typename TreeA::Node& na, const typename TreeB::Node& nb) {
    const bool meshes = !a_.part() && !b_.part();
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count && spare(); ++t)
        if (meshes ? trianglesTouch(a_.triangles()[s], X_WA_, b_.triangles()[t], X_WB_, counters_)
                   : convexSetsTouch({leafSet(a_, s), X_WA_}, {leafSet(b_, t), X_WB_}, counters_)) {
          found = TrianglePair{a_.meshTriangle(s), b_.meshTriangle(t)};
          return true;
        }
    return !spare();
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>& stack, std::size_t first) {  // the first child first
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
  }

  std::optional<TrianglePair> found;

 private:
  bool spare() const { return counters_.boxTests + counters_.triangleTests < workEnd_; }

  const TreeA& a_;
  const TreeB& b_;
  const Transform &X_WA_, &X_WB_;
  const Test& test_;
  Counters& counters_;
  std::uint64_t workEnd_;
};

template <class Volume, class TreeA, class TreeB>
std::optional<TrianglePair> firstContact(const TreeA& a, const Transform& X_WA, const TreeB& b,
                                         const Transform& X_WB, QueryContext& context) {
  ++context.counters.states;
  const Transform X_AB = rigidInverse(X_WA) * X_WB;
  const PairTest<Volume> test(a.bounds(), b.bounds(), X_AB,
                              relativePoseError(X_WA, X_AB, X_WB, b.reach()));
  FirstContact query(a, X_WA, b, X_WB, test, context.counters,
                     std::numeric_limits<std::uint64_t>::max());
  traverse(a, b, QueryContext::NodePair{0, 0, 0}, context.stack, query);
  return query.found;
}

}  // namespace

template <BoundingVolume Volume>
std::optional<TrianglePair> interference(const VolumeTree<Volume>& a, const Transform& X_WA,
                                         const VolumeTree<Volume>& b, const Transform& X_WB,
                                         QueryContext& context) {
  return firstContact<Volume>(a, X_WA, b, X_WB, context);
}

#define CORRIDOR_INTERFERENCE(Volume)                                                            \
  template std::optional<TrianglePair> interference(const VolumeTree<Volume>&, const Transform&, \
                                                    const VolumeTree<Volume>&, const Transform&, \
                                                    QueryContext&);
CORRIDOR_INTERFERENCE(Obb)
CORRIDOR_INTERFERENCE(Aabb)
CORRIDOR_INTERFERENCE(BoundingSphere)
CORRIDOR_INTERFERENCE(Rss)
CORRIDOR_INTERFERENCE(Kdop<14>)
CORRIDOR_INTERFERENCE(Kdop<18>)
CORRIDOR_INTERFERENCE(Kdop<26>)
#undef CORRIDOR_INTERFERENCE

std::optional<TrianglePair> interferenceBelow(const ObbTree& a, const ObbTree& b,
                                              const Transform& X_AB,
                                              const QueryContext::NodePair& nodes,
                                              QueryContext& context, std::uint64_t workEnd) {
  const Transform identity;
  const PairTest<Obb> test(a.bounds(), b.bounds(), X_AB, 0);
  FirstContact query(a, identity, b, X_AB, test, context.counters, workEnd);
  traverse(a, b, nodes, context.stack, query);
  return query.found;
}

}  // namespace corridor
