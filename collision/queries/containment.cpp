#include "collision/queries/containment.h"

#include <cassert>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>

#include "collision/core/floating_point.h"
#include "collision/core/rounding.h"
#include "collision/predicates/orientation.h"
#include "collision/queries/relative_pose.h"
#include "collision/volumes/overlap_obb_obb.h"

namespace corridor {
namespace {

using Component = MeshComponents::Component;

/// A ray that meets an edge or lies in a triangle's plane is cast again in another direction. The
/// directions are spread over the sphere: from one direction to the next, the angle about the z
/// axis grows by the golden angle. No mesh is likely to have an edge or a plane
/// along one of them.
constexpr int kCasts = 64;
Vec3 direction(int cast) {
  const double z = std::remainder(0.1234567 + 0.7548776662 * cast, 1.0) * 2,
               angle = 1 + cast * std::numbers::pi * (3 - std::sqrt(5.0)), r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

/// Numbers of the nodes still to visit.
struct RayStack {
  std::vector<std::uint32_t> nodes;
};

enum class Crossing { none, one, degenerate };

/// Tests whether the segment from q to `end` crosses the triangle. @pre `end` is on no triangle.
Crossing crossing(const MappedPoint& q, const MappedPoint& end, const Triangle& t,
                  const Transform& X_WS) {
  if (t[0] == t[1] && t[1] == t[2])
    return Crossing::none;  // a point: the surface is closed without it, too
  const MappedPoint v[3] = {{X_WS, t[0]}, {X_WS, t[1]}, {X_WS, t[2]}};
  int sum = 0, zeros = 0;
  for (int i = 0; i < 3; ++i) {
    const int side = orientationSign(q, end, v[i], v[(i + 1) % 3]);
    sum += side;
    zeros += side == 0;
  }
  if (std::abs(sum) + zeros < 3)
    return Crossing::none;  // the line passes left of one edge and right of another
  if (zeros > 0) return Crossing::degenerate;
  return orientationSign(v[0], v[1], v[2], q) == orientationSign(v[0], v[1], v[2], end)
             ? Crossing::none
             : Crossing::one;
}

/// Returns how often the segment crosses component `k`, or nullopt if it meets an edge or lies in a
/// triangle's plane. `q_S` is the segment's start in the solid's frame, off by at most `error`.
std::optional<int> crossings(const MeshWithComponents& solid, std::uint32_t k,
                             const Transform& X_WS, const MappedPoint& q, const Vec3& q_S,
                             double error, const Vec3& end_S, QueryContext& context) {
  const ObbTree& tree = solid.tree;
  const Vec3 x = (end_S - q_S).normalized(), y = x.unitOrthogonal();
  Mat3 axes;
  axes << x, y, x.cross(y);
  const Triangle segment = {q_S, q_S, end_S};
  const Obb box = enclosingObb(std::span(&segment, 1), axes);
  const BoxPairMargins margins =
      boxPairMargins(tree.axisDefect(), tree.centerReach(), orthonormalityDefect(axes),
                     roundedUp(box.center.norm()), {});
  const MappedPoint end{X_WS, end_S};
  int count = 0;
  const auto use = context.scratch.use<RayStack>();
  auto& stack = use->nodes;
  stack.assign(1, 0);
  while (!stack.empty()) {
    const std::uint32_t i = stack.back();
    stack.pop_back();
    const ObbTree::Node& node = tree.node(i);
    ++context.counters.boxTests;
    if (obbsSeparated(node.box, box, {}, margins, error)) continue;
    if (!node.isLeaf()) {
      stack.push_back(node.right);
      stack.push_back(i + 1);
      continue;
    }
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) {
      if (solid.components.of[tree.meshTriangle(t)] != k) continue;
      ++context.counters.primitiveTests;
      const Crossing found = crossing(q, end, tree.triangles()[t], X_WS);
      if (found == Crossing::degenerate) return std::nullopt;
      count += found == Crossing::one;
    }
  }
  return count;
}

}  // namespace

std::optional<std::uint32_t> containing(const Posed<MeshWithComponents>& posed, const Vec3& p,
                                        const Transform& X_WP, QueryContext& context) {
  const MeshWithComponents& solid = posed.shape;
  const Transform& X_WS = posed.X_W;
  assert(standardFloatingPoint());
  const Transform X_SP = rigidInverse(X_WS) * X_WP;
  const Vec3 q_S = X_SP * p;
  // The second term covers the rounding of the product: per coordinate at most 4.1u times the sum
  // of the magnitudes of its terms, and √3 times that for the vector.
  const double error = roundedUp(relativePoseError(X_WS, X_SP, X_WP, roundedUp(p.stableNorm())) +
                                 8 * kUnit * (X_SP.m.norm() * p.stableNorm() + X_SP.t.norm()));
  for (std::uint32_t k = 0; k < solid.components.components.size(); ++k) {
    const Component& component = solid.components.components[k];
    if (!component.watertight) continue;
    const Vec3 outside = (component.lower - q_S).cwiseMax(q_S - component.upper);
    if (outside.maxCoeff() >
        error + 2 * kUnit * (q_S.norm() + component.lower.norm() + component.upper.norm()))
      continue;
    const Vec3 center = component.lower + 0.5 * (component.upper - component.lower);
    const double far = 2 * (component.upper - component.lower).norm();
    std::optional<int> count;
    for (int cast = 0; cast < kCasts && !count; ++cast)
      count =
          crossings(solid, k, X_WS, {X_WP, p}, q_S, error, center + far * direction(cast), context);
    if (!count || *count % 2 == 1)
      return component.triangle;  // if all rays are undecided, "inside" is the safe answer
  }
  return std::nullopt;
}

std::optional<PrimitivePair> findEnclosed(const Posed<MeshWithComponents>& solid,
                                          const Posed<MeshWithComponents>& inner,
                                          QueryContext& context) {
  for (const Component& component : inner.shape.components.components)
    if (const auto triangle = containing(solid, component.corner, inner.X_W, context))
      return PrimitivePair{*triangle, component.triangle};
  return std::nullopt;
}

std::optional<PrimitivePair> findEnclosed(const Posed<MeshWithComponents>& solid,
                                          const Posed<ConvexPart>& inner, QueryContext& context) {
  if (const auto triangle = containing(solid, inner.shape.points[0], inner.X_W, context))
    return PrimitivePair{*triangle, 0};
  return std::nullopt;
}

namespace {

/// Finds a part that is inside the solid mesh. `around` is the mesh of the body `solid`. Parts
/// whose boxes are separated from the mesh's box are not tested; a tree excludes many of them at a
/// time.
std::optional<PrimitivePair> findEnclosedPart(const Posed<MeshWithComponents>& around,
                                              const Body& solid, const Posed<Body>& inner,
                                              QueryContext& context) {
  const std::vector<ConvexPart>& parts = inner.shape.parts();
  const Transform X_SP = rigidInverse(around.X_W) * inner.X_W;
  const double reach = inner.shape.radius();
  // Rounding of a box's centre and of the product with its half extents: bounded as in
  // `containing`, for points that are at most √3·reach from the origin.
  const double error = roundedUp(relativePoseError(around.X_W, X_SP, inner.X_W, 2 * reach) +
                                 32 * kUnit * (X_SP.m.norm() * reach + X_SP.t.norm()) +
                                 4 * kUnit * (solid.lower().norm() + solid.upper().norm()));
  const Mat3 extents = X_SP.m.cwiseAbs();
  const auto bound = [&](const BoundingBox& box) {
    const Vec3 half = 0.5 * (box.upper - box.lower), center_S = X_SP * Vec3(box.lower + half);
    const Vec3 reach_S = extents * half;
    const Vec3 apart =
        (solid.lower() - (center_S + reach_S)).cwiseMax(center_S - reach_S - solid.upper());
    return apart.maxCoeff() - error;
  };
  std::optional<PrimitivePair> found;
  const double touching = 0;
  inner.shape.partBoxes().walk(bound, touching, [&](std::size_t i) {
    found = findEnclosed(around, Posed(parts[i], inner.X_W), context);
    if (found) found->b = static_cast<std::uint32_t>(i);
    return found.has_value();
  });
  return found;
}

}  // namespace

std::optional<PrimitivePair> findEnclosed(const Posed<Body>& solid, const Posed<Body>& inner,
                                          QueryContext& context) {
  if (!solid.shape.isSolidMesh()) return std::nullopt;
  const auto meshOf = [](const Body& body) {
    return MeshWithComponents{body.binaryTree(), body.components()};
  };
  const MeshWithComponents around = meshOf(solid.shape);
  const Posed posed(around, solid.X_W);
  if (!inner.shape.isMesh()) return findEnclosedPart(posed, solid.shape, inner, context);
  const MeshWithComponents within = meshOf(inner.shape);
  return findEnclosed(posed, Posed(within, inner.X_W), context);
}

std::optional<PrimitivePair> findOneInsideOther(const Posed<Body>& a, const Posed<Body>& b,
                                                QueryContext& context) {
  if (!a.X_W.isFinite() || !b.X_W.isFinite())
    throw std::invalid_argument("the pose of a body must be finite");
  if (const auto hit = findEnclosed(a, b, context)) return hit;
  if (const auto hit = findEnclosed(b, a, context)) return PrimitivePair{hit->b, hit->a};
  return std::nullopt;
}

}  // namespace corridor
