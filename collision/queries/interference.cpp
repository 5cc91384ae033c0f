#include "collision/queries/interference.h"

#include <cmath>
#include <limits>

#include "collision/core/rounding.h"
#include "collision/predicates/triangle_contact.h"
#include "collision/volumes/overlap_obb_obb.h"

namespace corridor {
namespace {

/// How far X_WA·(X_AB·p) may be from X_WB·p for |p| ≤ reach, brought back to frame A: a contact in
/// W is, in A, a pair of points of the boxes at most this far apart, so boxes farther apart have
/// none.
double relativePoseError(const Transform& X_WA, const Transform& X_AB, const Transform& X_WB,
                         double reach) {
  const Transform back = X_WA * X_AB;
  // Each entry of `back` has at most 4 roundings of terms whose sizes sum up to `size`.
  const double size = (X_WA.m.cwiseAbs() * X_AB.m.cwiseAbs()).sum();
  const double sizeT =
      (X_WA.m.cwiseAbs() * X_AB.t.cwiseAbs() + X_WA.t.cwiseAbs() + X_WB.t.cwiseAbs()).sum();
  const double error = ((back.m - X_WB.m).norm() + 8 * kUnit * size) * reach +
                       (back.t - X_WB.t).norm() + 8 * kUnit * sizeT;
  // |M x| ≥ √(1 − 3η)·|x| ≥ (1 − 3η)|x|; where that is not positive nothing can be said and nothing
  // is pruned.
  const double shrink = 1 - 3 * orthonormalityDefect(X_WA.m);
  return shrink > 0.5 ? roundedUp(error / shrink) : HUGE_VAL;
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
      for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
        for (std::uint32_t t = nb.first; t < nb.first + nb.count && work() < workEnd; ++t)
          if (trianglesTouch(a.triangles()[s], X_WA, b.triangles()[t], X_WB, context.counters))
            return TrianglePair{a.meshTriangle(s), b.meshTriangle(t)};
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
