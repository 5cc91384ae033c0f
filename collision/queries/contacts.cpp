#include "collision/queries/contacts.h"

#include <limits>

#include "collision/predicates/triangle_contact.h"
#include "collision/queries/relative_pose.h"
#include "collision/queries/triangle_intersection.h"
#include "collision/volumes/overlap_obb_obb.h"

namespace corridor {
namespace {

/// Calls `leaves(node of a, node of b)` for all pairs of leaves whose boxes may meet.
template <class Leaves>
void forOverlappingLeaves(const ObbTree& a, const Transform& X_WA, const ObbTree& b,
                          const Transform& X_WB, QueryContext& context, const Leaves& leaves) {
  const Transform X_AB = rigidInverse(X_WA) * X_WB;
  BoxPairMargins margins =
      boxPairMargins(a.axisDefect(), a.centerReach(), b.axisDefect(), b.centerReach(), X_AB);
  margins.absolute += relativePoseError(X_WA, X_AB, X_WB, b.reach());
  auto& stack = context.stack;
  stack.clear();
  stack.push_back({0, 0, 0});
  while (!stack.empty()) {
    const auto [i, j, unused] = stack.back();
    stack.pop_back();
    const ObbTree::Node &na = a.node(i), &nb = b.node(j);
    ++context.counters.boxTests;
    if (obbsSeparated(na.box, nb.box, X_AB, margins, 0)) continue;
    if (na.isLeaf() && nb.isLeaf()) {
      leaves(na, nb);
    } else if (nb.isLeaf() || (!na.isLeaf() && na.radius >= nb.radius)) {
      stack.push_back({na.right, j, 0});
      stack.push_back({i + 1, j, 0});
    } else {
      stack.push_back({i, nb.right, 0});
      stack.push_back({i, j + 1, 0});
    }
  }
}

}  // namespace

std::vector<TriangleContact> contacts(const ObbTree& a, const Transform& X_WA, const ObbTree& b,
                                      const Transform& X_WB, QueryContext& context) {
  ++context.counters.states;
  std::vector<TriangleContact> found;
  const auto leaves = [&](const ObbTree::Node& na, const ObbTree::Node& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        const Triangle &ta = a.triangles()[s], &tb = b.triangles()[t];
        if (!trianglesTouch(ta, X_WA, tb, X_WB, context.counters)) continue;
        const Segment segment = triangleIntersection(ta, X_WA, tb, X_WB);
        found.push_back({a.meshTriangle(s), b.meshTriangle(t), segment.p, segment.q});
      }
  };
  forOverlappingLeaves(a, X_WA, b, X_WB, context, leaves);
  return found;
}

}  // namespace corridor
