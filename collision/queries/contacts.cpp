#include "collision/queries/contacts.h"

#include <algorithm>

#include "collision/hierarchy/traverse.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/relative_pose.h"
#include "collision/queries/triangle_intersection.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {
namespace {

/// All leaf pairs whose volumes may meet, and of these all triangles that touch.
template <class Volume>
class AllContacts {
 public:
  using Tree = VolumeTree<Volume>;
  using Item = QueryContext::NodePair;

  AllContacts(const Tree& a, const Transform& X_WA, const Tree& b, const Transform& X_WB,
              const PairTest<Volume>& test, Counters& counters)
      : a_(a), b_(b), X_WA_(X_WA), X_WB_(X_WB), test_(test), counters_(counters) {}

  bool enter(const Item&, const typename Tree::Node& na, const typename Tree::Node& nb) {
    ++counters_.boxTests;
    return !test_.separated(na.box, nb.box, 0);
  }
  bool leaves(const typename Tree::Node& na, const typename Tree::Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        const Triangle &ta = a_.triangles()[s], &tb = b_.triangles()[t];
        if (!trianglesTouch(ta, X_WA_, tb, X_WB_, counters_)) continue;
        const Segment segment = triangleIntersection(ta, X_WA_, tb, X_WB_);
        found.push_back({a_.meshTriangle(s), b_.meshTriangle(t), segment.p, segment.q});
      }
    return false;
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) {
    stack.push_back({i, k, 0});
  }
  void opened(std::vector<Item>& stack, std::size_t first) {  // the first child first
    std::reverse(stack.begin() + static_cast<std::ptrdiff_t>(first), stack.end());
  }

  std::vector<TriangleContact> found;

 private:
  const Tree &a_, &b_;
  const Transform &X_WA_, &X_WB_;
  const PairTest<Volume>& test_;
  Counters& counters_;
};

}  // namespace

template <BoundingVolume Volume>
std::vector<TriangleContact> contacts(const VolumeTree<Volume>& a, const Transform& X_WA,
                                      const VolumeTree<Volume>& b, const Transform& X_WB,
                                      QueryContext& context) {
  ++context.counters.states;
  const Transform X_AB = rigidInverse(X_WA) * X_WB;
  const PairTest<Volume> test(a.bounds(), b.bounds(), X_AB,
                              relativePoseError(X_WA, X_AB, X_WB, b.reach()));
  AllContacts<Volume> query(a, X_WA, b, X_WB, test, context.counters);
  traverse(a, b, QueryContext::NodePair{0, 0, 0}, context.stack, query);
  return std::move(query.found);
}

#define CORRIDOR_CONTACTS(Volume)                                                             \
  template std::vector<TriangleContact> contacts(const VolumeTree<Volume>&, const Transform&, \
                                                 const VolumeTree<Volume>&, const Transform&, \
                                                 QueryContext&);
CORRIDOR_CONTACTS(Obb)
CORRIDOR_CONTACTS(Aabb)
CORRIDOR_CONTACTS(BoundingSphere)
CORRIDOR_CONTACTS(Rss)
CORRIDOR_CONTACTS(Kdop<14>)
CORRIDOR_CONTACTS(Kdop<18>)
CORRIDOR_CONTACTS(Kdop<26>)
#undef CORRIDOR_CONTACTS

}  // namespace corridor
