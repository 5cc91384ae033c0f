#include "collision/queries/interference.h"

#include <cmath>
#include <limits>

#include "collision/convex/convex_contact.h"
#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/queries/relative_pose.h"
#include "collision/volumes/overlap_obb_obb.h"

namespace corridor {
namespace {

ConvexSet leafSet(const ObbTree& tree, std::uint32_t triangle) {
  return tree.part() ? ConvexSet(*tree.part()) : ConvexSet(tree.triangles()[triangle]);
}

/// Two leaves: all of the one's triangles, or its part, against all of the other's.
std::optional<TrianglePair> leafContact(const ObbTree& a, const ObbTree::Node& na,
                                        const Transform& X_WA, const ObbTree& b,
                                        const ObbTree::Node& nb, const Transform& X_WB,
                                        Counters& counters, std::uint64_t workEnd) {
  const auto spare = [&] { return counters.boxTests + counters.triangleTests < workEnd; };
  const auto number = [](const ObbTree& tree, std::uint32_t i) {
    return tree.part() ? 0 : tree.meshTriangle(i);
  };
  const bool meshes = !a.part() && !b.part();
  const std::uint32_t endA = a.part() ? 1 : na.first + na.count,
                      endB = b.part() ? 1 : nb.first + nb.count;
  for (std::uint32_t s = na.first; s < endA; ++s)
    for (std::uint32_t t = nb.first; t < endB && spare(); ++t)
      if (meshes ? trianglesTouch(a.triangles()[s], X_WA, b.triangles()[t], X_WB, counters)
                 : convexSetsTouch({leafSet(a, s), X_WA}, {leafSet(b, t), X_WB}, counters))
        return TrianglePair{number(a, s), number(b, t)};
  return std::nullopt;
}

std::optional<TrianglePair> walk(const ObbTree& a, const Transform& X_WA, const ObbTree& b,
                                 const Transform& X_WB, const Transform& X_AB,
                                 const BoxPairMargins& margins, const QueryContext::NodePair& root,
                                 QueryContext& context, std::uint64_t workEnd) {
  const auto work = [&] { return context.counters.boxTests + context.counters.triangleTests; };
  auto& stack = context.stack;
  stack.clear();
  stack.push_back(root);
  while (!stack.empty() && work() < workEnd) {
    const auto [i, j, unused] = stack.back();
    stack.pop_back();
    const ObbTree::Node &na = a.node(i), &nb = b.node(j);
    ++context.counters.boxTests;
    if (obbsSeparated(na.box, nb.box, X_AB, margins, 0)) continue;
    if (na.isLeaf() && nb.isLeaf()) {
      if (const auto hit = leafContact(a, na, X_WA, b, nb, X_WB, context.counters, workEnd))
        return hit;
    } else if (nb.isLeaf() || (!na.isLeaf() && na.radius >= nb.radius)) {
      stack.push_back({na.right, j, 0});
      stack.push_back({i + 1, j, 0});
    } else {
      stack.push_back({i, nb.right, 0});
      stack.push_back({i, j + 1, 0});
    }
  }
  return std::nullopt;
}

BoxPairMargins marginsOf(const ObbTree& a, const ObbTree& b, const Transform& X_AB) {
  return boxPairMargins(a.axisDefect(), a.centerReach(), b.axisDefect(), b.centerReach(), X_AB);
}

}  // namespace

std::optional<TrianglePair> interference(const ObbTree& a, const Transform& X_WA, const ObbTree& b,
                                         const Transform& X_WB, QueryContext& context) {
  ++context.counters.states;
  const Transform X_AB = rigidInverse(X_WA) * X_WB;
  BoxPairMargins margins = marginsOf(a, b, X_AB);
  margins.absolute += relativePoseError(X_WA, X_AB, X_WB, b.reach());
  return walk(a, X_WA, b, X_WB, X_AB, margins, {0, 0, 0}, context,
              std::numeric_limits<std::uint64_t>::max());
}

std::optional<TrianglePair> interferenceBelow(const ObbTree& a, const ObbTree& b,
                                              const Transform& X_AB,
                                              const QueryContext::NodePair& nodes,
                                              QueryContext& context, std::uint64_t workEnd) {
  return walk(a, {}, b, X_AB, X_AB, marginsOf(a, b, X_AB), nodes, context, workEnd);
}

}  // namespace corridor
