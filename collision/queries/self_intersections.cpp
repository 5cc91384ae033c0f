#include "collision/queries/self_intersections.h"

#include <algorithm>
#include <utility>

#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/traverse.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/predicates/orientation.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/touching_pairs.h"
#include "collision/volumes/aabb.h"

namespace corridor {
namespace {

/// A triangle's corners, in an order that begins with those that it shares with another triangle.
struct OrderedCorners {
  Triangle t;
  int shared = 0;
};

OrderedCorners sharedFirst(const Triangle& t, const Triangle& other) {
  OrderedCorners c{t};
  for (int i = 0; i < 3; ++i)
    if (std::find(other.begin(), other.end(), c.t[i]) != other.end())
      std::swap(c.t[i], c.t[c.shared++]);
  return c;
}

/// Tests whether two convex hulls, of up to three points each, touch.
bool touch(const Triangle& a, const Triangle& b, Counters& counters) {
  const PredicateResult result = trianglesTouch(a, {}, b, {});
  counters.addTest(result.exact);
  return result;
}
Triangle edge(const Vec3& p, const Vec3& q) {
  return {p, q, q};
}

/// Tests exactly whether the corners lie on a line: then every component of the normal is 0.
bool onALine(const Triangle& t) {
  const Transform here;
  for (int k = 0; k < 3; ++k) {
    const Transform above{Mat3::Identity(), Vec3::Unit(k)};
    if (orientationSign({here, t[0]}, {here, t[1]}, {here, t[2]}, {above, t[0]}) != 0) return false;
  }
  return true;
}

/// Tests whether two triangles that share one or two corners meet anywhere beyond what they share.
/// @pre Neither has its corners on a line.
bool meetBeyond(const OrderedCorners& a, const OrderedCorners& b, Counters& counters) {
  const auto& [s, count] = a;
  const Triangle& t = b.t;
  // Their intersection is convex. If it is more than the one shared corner, it extends from there
  // until it leaves one of the triangles through the edge opposite that corner.
  if (count == 1)
    return touch(edge(s[1], s[2]), t, counters) || touch(edge(t[1], t[2]), s, counters);
  // If their intersection is more than the shared edge, they overlap in one plane, on the same side
  // of that edge. Then one triangle contains the other's third corner, or edges to the third
  // corners cross.
  const Vec3 &p = s[0], &q = s[1], &c = s[2], &d = t[2];
  return touch(edge(c, c), t, counters) || touch(edge(d, d), s, counters) ||
         touch(edge(c, p), edge(d, q), counters) || touch(edge(c, q), edge(d, p), counters);
}

/// The query that `traverse` runs on a tree against itself. It tests each pair of leaves in one
/// order only.
class SelfPairs {
 public:
  using Item = NodePair;
  using Tree = VolumeTree<Aabb>;
  using Node = Tree::Node;

  /// @param qualities  indexed by a triangle's number in the mesh.
  SelfPairs(const Tree& tree, const std::vector<TriangleQuality>& qualities, Counters& counters)
      : tree_(tree), test_(pairTestOf<Aabb>(Posed(tree), Posed(tree))), counters_(counters) {
    // The quality `degenerate` includes small triangles of a large mesh. It means an area of at
    // most 1e-12 of the squared diagonal, and rounding is below 1e-15 of that square. So every
    // triangle whose corners lie on a line is `degenerate`, and the exact test finds these
    // triangles among the degenerate ones.
    for (std::uint32_t s = 0; s < qualities.size(); ++s)
      onALine_.push_back(qualities[tree.meshTriangle(s)] == TriangleQuality::degenerate &&
                         onALine(tree.triangle(s)));
  }

  bool enter(const Item&, const Node& na, const Node& nb) {
    if (na.first >= nb.first + nb.count) return false;  // the mirrored pair is tested instead
    ++counters_.boxTests;
    return !test_.separated(na.box, nb.box, 0);
  }
  bool leaves(const Node& na, const Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = std::max(nb.first, s + 1); t < nb.first + nb.count; ++t)
        if (intersect(s, t)) found_.push_back(numbered(s, t));
    return false;
  }
  void push(std::vector<Item>& stack, std::uint32_t i, std::uint32_t k) { stack.push_back({i, k}); }
  void opened(std::vector<Item>&, std::size_t) {}

  std::vector<PrimitivePair> found() && { return std::move(found_); }

 private:
  bool intersect(std::uint32_t s, std::uint32_t t) {
    if (onALine_[s] || onALine_[t]) return false;
    const OrderedCorners a = sharedFirst(tree_.triangle(s), tree_.triangle(t)),
                         b = sharedFirst(tree_.triangle(t), tree_.triangle(s));
    if (a.shared == 3) return false;
    return a.shared == 0 ? touch(a.t, b.t, counters_) : meetBeyond(a, b, counters_);
  }
  PrimitivePair numbered(std::uint32_t s, std::uint32_t t) const {
    const auto [low, high] = std::minmax({tree_.meshTriangle(s), tree_.meshTriangle(t)});
    return {low, high};
  }

  const Tree& tree_;
  PairTest<Aabb, StandardOverlap> test_;
  Counters& counters_;
  std::vector<bool> onALine_;  // indexed by a triangle's number in the tree
  std::vector<PrimitivePair> found_;
};

}  // namespace

std::vector<PrimitivePair> selfIntersections(const TriangleMesh& mesh, QueryContext& context) {
  if (mesh.triangles.empty()) return {};
  const std::vector<TriangleQuality> qualities = triangleQualities(mesh);
  const VolumeTree<Aabb> tree(mesh);
  SelfPairs query(tree, qualities, context.counters);
  traverse(tree, tree, NodePair{0, 0}, *context.scratch.use<NodePairs>(), query);
  std::vector<PrimitivePair> found = std::move(query).found();
  std::sort(found.begin(), found.end(), [](const PrimitivePair& x, const PrimitivePair& y) {
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  return found;
}

}  // namespace corridor
