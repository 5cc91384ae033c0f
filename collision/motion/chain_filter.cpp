#include "collision/motion/chain_filter.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/motion/chain_filter_kernel.h"

/// Derivation of the errors. Let u = 2^-24 be the unit roundoff of float. The kernels compute poses
/// of joints, places of points and motion bounds in float, from constants that are rounded to
/// float. The exact bounds are those of relative_motion.cpp, in the world's axes: a ball is fixed
/// to its link, so only the motion of its centre matters, and the ball's radius is added.
///
/// Poses. For joint j in the joint p above it, let ρ be the error of the matrix (operator norm), τ
/// the error of the translation, L the length of the translation, and R the sum of these lengths
/// from the world on, so that the real translation of j in the world is at most R_j long.
/// - The matrix of the joint alone: 6u for its three constants; its sine and versine are rounded to
///   float once, u of norms √2 and 2·√2; the sum has three roundings of terms of norms √3, √2,
///   2√2. Together below 32u. The product with the matrix of p: 3√3 u·√3 = 9u, and 3u for entries.
///   With `rotationError` (the error in double), ρ_j = ρ_p + rotationError + 64u.
/// - The translation: its rounding uL, that of t·slide 4uL; the product and the sum 4u(√3 L + R_j):
///   τ_j = τ_p + shiftError + ρ_p L + u(16 L + 8 R_j).
/// - A point at distance c from the origin of j: τ_j + ρ_j c + u(16 c + 8(R_j + c)).
/// E is the largest of these for all links; products of errors are below 2^-7 of the errors, which
/// the factor 1 + 2^-6 covers (ρ < 2^-7 is required).
///
/// Levers. Let D = 2 max(R_j + c): no two points are farther apart. The distance of a point from an
/// axis has the errors of the point and of the axis' point, 2E, the error of the axis, (ρ + 16u)D,
/// and the roundings of difference, product and root, 12uD: `lever` is 2E + (ρ + 32u) D.
///
/// First order. A joint that moves by δ displaces a point by δ times its lever: the displacement is
/// off by δ·lever. It is computed from the sums of ω = δa and p × ω over the joints of a chain, and
/// their differences for two chains. The terms are at most δD, and each of the n sums adds u of
/// them; products and cross products add 8u. The product with a vector from the obstacle, and the
/// root of its square, add 8uδD. For a joint that slides, D is replaced by 1. `firstOrder` is lever
/// + (2n + 32)u·max(D, 1) + ρ.
///
/// Obstacles. Centre, axes and half lengths are rounded to float. The vector from the obstacle has
/// the errors 8u(D + |centre|) for the difference and the product with the axes, and 4u of the half
/// lengths; its square and root add 4u of its length. Together they are below 64u(D + |centre| +
/// half lengths). This also covers the rounding of the gap, at most D + |centre|, in
/// `isApartAlong`.
///
/// The gap along the computed vector d is the length of d, up to this error: no point of the
/// obstacle is higher along d than the one from which d leads, since d is zero in each axis in
/// which the point is within the obstacle's half lengths.
///
/// Rates. The real rate differs from `rate` by a few 2^-53 of the joint's values; the reserves
/// above, some 20u of D for each radian, cover this.
///
/// Tube. Both bodies are bounded in the world, so the tubes of both count. A joint whose
/// perturbation is at most τ moves a point by at most τ times the distance of the point from the
/// joint, which is at most D at any time; for a joint that slides, by τ. Both bodies of a pair move
/// by the sum over their chains.
///
/// Hulls. The gap of the hulls along n, a vector fixed to the joint of a, is bounded as in
/// moving_sets.h: by the least (n·x) − |n·v(x)| over the points x of b, where v is the first-order
/// displacement, less the second order's bound for all of these points. The sphere or disc that
/// sweeps them moves with them, and is subtracted once. n·x is computed as
/// (Mᵀ n')·p + n'·(t − t_a), with n' = M_a n. The errors of x and t_a add 2E, that of n' adds ρD,
/// and the roundings of both products and of the sums 16uD: together less than `lever`. The product
/// with v has the same terms times δ: less than `firstOrder`. The height of a along n is computed
/// in double, by `PosedSet`, and rounded up; the float difference adds 4u of its magnitude.
namespace corridor {
namespace {

constexpr double kLargest = 0x1p20;
constexpr std::size_t kMostJoints = 64;
/// Radians (or metres) of joint motion for eight intervals: shorter intervals prove little more.
constexpr double kMotionOfSet = 0.9;

float downToFloat(double x) {
  return -upToFloat(-x);
}

bool isSmall(double x) {
  return std::abs(x) < kLargest;  // false for NaN
}

bool isSmall(const Vec3& v) {
  return isSmall(v[0]) && isSmall(v[1]) && isSmall(v[2]);
}

bool isSmall(const Transform& X) {
  return X.isFinite() && isSmall(X.t) && isSmall(X.m.cwiseAbs().maxCoeff());
}

template <class Matrix>
void copyRows(const Matrix& from, float* to) {
  for (int r = 0; r < from.rows(); ++r)
    for (int c = 0; c < from.cols(); ++c) to[r * from.cols() + c] = static_cast<float>(from(r, c));
}

ChainTables::Joint tableOf(const ChainScene::Joint& joint) {
  ChainTables::Joint out;
  out.parent = joint.parent;
  out.slides = joint.slides;
  copyRows(joint.fixed, out.fixed);
  copyRows(joint.sine, out.sine);
  copyRows(joint.versine, out.versine);
  copyRows(joint.axis, out.axis);
  return out;
}

ChainTables::Link tableOf(const ChainScene::Link& link) {
  ChainTables::Link out;
  out.joint = link.joint;
  const Vec3 center = link.X_JB * link.center;
  copyRows(center, out.center);
  const double moved = (Vec3(out.center[0], out.center[1], out.center[2]) - center).norm();
  // The centre is off by a few 2^-53 of its terms, since it was mapped.
  const double terms = center.norm() + link.X_JB.t.norm() + link.center.norm();
  out.radius = upToFloat(roundedUp(link.radius + moved + 0x1p-48 * terms));
  out.reach = roundedUp(center.norm() + moved + double{out.radius});
  if (!link.hull || link.hull->points.empty()) return out;
  const std::span<const Vec3> points = link.hull->points;
  const std::size_t stride = (points.size() + 7) / 8 * 8;
  out.points.resize(3 * stride);
  double core = 0, rounding = 0;  // the points are off by a few 2^-53 of their terms
  for (std::size_t i = 0; i < stride; ++i) {
    const Vec3& local = points[std::min(i, points.size() - 1)];
    const Vec3 p = link.X_JB * local;
    for (std::size_t k = 0; k < 3; ++k)
      out.points[k * stride + i] = static_cast<float>(p[static_cast<int>(k)]);
    out.reach = std::max(out.reach, roundedUp(p.norm()));
    core = std::max(core, (p - Vec3(out.center[0], out.center[1], out.center[2])).norm());
    rounding = std::max(rounding, 0x1p-48 * (p.norm() + link.X_JB.t.norm() + local.norm()));
  }
  out.core = upToFloat(roundedUp(core + rounding));
  out.swept = upToFloat(roundedUp(link.hull->ball + link.hull->disc + rounding));
  out.reach = roundedUp(out.reach + double{out.swept});
  return out;
}

ChainTables::Obstacle tableOf(const ChainScene::Obstacle& obstacle) {
  ChainTables::Obstacle out;
  out.isCylinder = obstacle.isCylinder;
  copyRows(obstacle.X_WO.t, out.center);
  copyRows(obstacle.X_WO.m, out.axes);
  for (int k = 0; k < 3; ++k) out.half[k] = upToFloat(obstacle.half[k]);
  out.pad = upToFloat(64 * kFloatUnit * (obstacle.X_WO.t.lpNorm<1>() + obstacle.half.lpNorm<1>()) +
                      0x1p-48 * obstacle.X_WB.t.lpNorm<1>());
  return out;
}

/// Returns the joints between two links, from the end of b to the end of a.
std::vector<std::uint32_t> pathOf(const ChainScene& scene, std::uint32_t a, std::uint32_t b) {
  std::vector<std::uint32_t> down, back;
  while (a != b) {
    // The joint of the larger number is not above the other one.
    const bool isB = a == ChainScene::kNone || (b != ChainScene::kNone && b > a);
    std::uint32_t& later = isB ? b : a;
    (isB ? down : back).push_back(later);
    later = scene.joints[later].parent;
  }
  down.insert(down.end(), back.rbegin(), back.rend());
  return down;
}

}  // namespace

bool ChainFilter::isUsable(const ChainScene& scene) {
  if (scene.joints.size() > kMostJoints || scene.obstacles.size() > ChainScene::kMostObstacles)
    return false;
  for (std::size_t j = 0; j < scene.joints.size(); ++j)
    if (scene.joints[j].parent != ChainScene::kNone && scene.joints[j].parent >= j) return false;
  const auto isSmallHull = [](const ConvexSet* hull) {
    return !hull || (!hull->points.empty() && isSmall(hull->ball) && isSmall(hull->disc) &&
                     std::ranges::all_of(hull->points, [](const Vec3& p) { return isSmall(p); }));
  };
  const auto isSmallJoint = [](const ChainScene::Joint& joint) {
    return std::ranges::all_of(std::array{joint.fixed, joint.sine, joint.versine},
                               [](const Mat3& m) {
                                 return isSmall(Transform{m, Vec3::Zero()});
                               }) &&
           isSmall(joint.axis);
  };
  const auto isSmallLink = [&](const ChainScene::Link& link) {
    return isSmall(link.X_JB) && isSmall(link.center) && isSmall(link.radius) &&
           isSmallHull(link.hull);
  };
  const auto isSmallObstacle = [&](const ChainScene::Obstacle& obstacle) {
    return isSmall(obstacle.X_WO) && isSmall(obstacle.X_WB) && isSmall(obstacle.half) &&
           isSmallHull(obstacle.hull);
  };
  return std::ranges::all_of(scene.joints, isSmallJoint) &&
         std::ranges::all_of(scene.links, isSmallLink) &&
         std::ranges::all_of(scene.obstacles, isSmallObstacle);
}

ChainFilter::ChainFilter(ChainScene scene) {
  if (!isUsable(scene)) throw std::invalid_argument("ChainFilter: the scene is not usable");
  auto tables = std::make_unique<ChainTables>();
  for (const ChainScene::Joint& joint : scene.joints) tables->joints.push_back(tableOf(joint));
  for (const ChainScene::Link& link : scene.links) tables->links.push_back(tableOf(link));
  const std::size_t count = (scene.obstacles.size() + 7) / 8 * 8;
  for (std::size_t k = 0; k < 3; ++k) {
    tables->lower[k].assign(count, std::numeric_limits<float>::infinity());
    tables->upper[k].assign(count, -std::numeric_limits<float>::infinity());
  }
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const ChainScene::Obstacle& obstacle = scene.obstacles[i];
    tables->obstacles.push_back(tableOf(obstacle));
    for (int k = 0; k < 3; ++k) {
      const double reach =
          obstacle.X_WO.m.row(k).cwiseAbs() * obstacle.half + double{tables->obstacles.back().pad};
      tables->lower[static_cast<std::size_t>(k)][i] = downToFloat(obstacle.X_WO.t[k] - reach);
      tables->upper[static_cast<std::size_t>(k)][i] = upToFloat(obstacle.X_WO.t[k] + reach);
    }
  }
  tables->worldPairs.assign(scene.links.size() * scene.obstacles.size(), ChainScene::kNone);
  for (std::uint32_t i = 0; i < scene.pairs.size(); ++i) {
    const ChainScene::Pair& pair = scene.pairs[i];
    if (pair.isWorld) {
      tables->worldPairs[pair.b * scene.obstacles.size() + pair.a] = i;
      tables->links[pair.b].hasObstacles = true;
    } else {
      tables->linkPairs.push_back(i);
    }
    const auto path = pathOf(scene, pair.isWorld ? ChainScene::kNone : scene.links[pair.a].joint,
                             scene.links[pair.b].joint);
    tables->pathJoints.insert(tables->pathJoints.end(), path.begin(), path.end());
    tables->pathEnds.push_back(static_cast<std::uint32_t>(tables->pathJoints.size()));
  }
  tables->scene = std::move(scene);
  tables_ = std::move(tables);
}

ChainFilter::~ChainFilter() = default;
ChainFilter::ChainFilter(ChainFilter&&) noexcept = default;

ChainFilter::Scratch::Scratch() : memory_(std::make_unique<ChainScratch>()) {}
ChainFilter::Scratch::~Scratch() = default;

namespace {

/// Sets the bounds of the edge's errors. Returns false if an error or a number is too large.
bool setErrors(const ChainTables& tables, std::span<const JointMotion> motions, ChainEdge& edge) {
  struct Chain {
    double reach = 0, rotation = 0, shift = 0, turnTube = 0, slideTube = 0;
  };
  std::array<Chain, kMostJoints> chains;
  constexpr double u = kFloatUnit;
  for (std::size_t j = 0; j < motions.size(); ++j) {
    const JointMotion& m = motions[j];
    const ChainTables::Joint& joint = tables.joints[j];
    const Chain above = joint.parent == ChainTables::kNone ? Chain() : chains[joint.parent];
    Chain& here = chains[j];
    here.reach = above.reach + m.length;
    here.rotation = above.rotation + m.rotationError + 64 * u;
    here.shift = above.shift + m.shiftError + above.rotation * m.length +
                 u * (16 * m.length + 8 * here.reach);
    here.turnTube = above.turnTube + (joint.slides ? 0 : m.tube);
    here.slideTube = above.slideTube + (joint.slides ? m.tube : 0);
    if (!(isSmall(here.reach) && here.rotation < 0x1p-7 && isSmall(here.shift) &&
          isSmall(here.turnTube) && isSmall(here.slideTube) && isSmall(m.angle) &&
          isSmall(m.rate) && isSmall(m.largestRate) && isSmall(m.shift.lpNorm<1>()) &&
          isSmall(m.slide.lpNorm<1>())))
      return false;
  }
  double error = 0, rotation = 0, reach = 0, tube = 0;
  for (const ChainTables::Link& link : tables.links) {
    const Chain chain = link.joint == ChainTables::kNone ? Chain() : chains[link.joint];
    const double c = link.reach, all = chain.reach + c;
    error = std::max(error, chain.shift + chain.rotation * c + u * (16 * c + 8 * all));
    rotation = std::max(rotation, chain.rotation);
    reach = std::max(reach, all);
    tube = std::max(tube, chain.turnTube * 2 * all + chain.slideTube);
  }
  error *= 1 + 0x1p-6;
  const double apart = 2 * reach;
  const double lever = 2 * error + (rotation + 32 * u) * apart;
  const double joints = static_cast<double>(motions.size());
  edge.pad = upToFloat(2 * error + 2 * tube + 64 * u * apart);
  edge.lever = upToFloat(lever);
  edge.firstOrder = upToFloat(lever + rotation + (2 * joints + 32) * u * std::max(apart, 1.0));
  return std::isfinite(edge.pad) && std::isfinite(edge.firstOrder);
}

}  // namespace

void ChainFilter::pairsLeft(std::span<const JointMotion> motions, const MotionOptions& options,
                            Scratch& scratch, std::vector<std::uint32_t>& left, TouchTest* test,
                            std::span<const std::uint8_t> proved) const {
  ChainScratch& memory = *scratch.memory_;
  ChainEdge& edge = memory.edge;
  left.clear();
  if (motions.size() != tables_->joints.size() || !setErrors(*tables_, motions, edge)) {
    for (const ChainScene::Pair& pair : tables_->scene.pairs) left.push_back(pair.number);
    std::sort(left.begin(), left.end());
    return;
  }
  edge.joints.resize(motions.size());
  double square = 0;
  edge.still = true;
  for (std::size_t j = 0; j < motions.size(); ++j) {
    const JointMotion& m = motions[j];
    ChainEdge::Joint& out = edge.joints[j];
    copyRows(m.shift, out.shift);
    copyRows(m.slide, out.slide);
    out.angle = m.angle;
    out.rate = m.rate;
    out.largestRate = upToFloat(m.largestRate);
    square += m.rate * m.rate;
    edge.still = edge.still && m.largestRate == 0;
  }
  edge.sets = 1;
  while (edge.sets < kMostChainSets && edge.sets * kMotionOfSet < std::sqrt(square)) edge.sets *= 2;
  const std::vector<ChainScene::Pair>& pairs = tables_->scene.pairs;
  // The clearance that `certifyMotion` certainly proves.
  const double beyond = std::max(options.clearanceSlack, options.tolerance) + options.tolerance;
  edge.margins.resize(pairs.size());
  edge.largestMargin = 0;
  edge.proved = proved;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    edge.margins[i] = upToFloat(roundedUp(options.marginOf(pairs[i].number) + beyond));
    edge.largestMargin = std::max(edge.largestMargin, edge.margins[i]);
  }
  memory.joints.resize(motions.size() * static_cast<std::size_t>(edge.sets));
  memory.links.resize(tables_->links.size());
  memory.open.resize(pairs.size());
  separateBalls(*tables_, memory);
  // The pair that is most likely in contact first.
  if (test) std::ranges::stable_sort(memory.openPairs, {}, &ChainScratch::OpenPair::closeness);
  bool touches = false;
  for (const auto& [i, closeness] : memory.openPairs) {
    if (edge.still) memory.open[i][0] = 1;  // all lanes are the same
    if (!touches) {
      const HullsAnswer answer = decideHulls(*tables_, memory, i, test);
      if (answer == HullsAnswer::open) left.push_back(pairs[i].number);
      touches = answer == HullsAnswer::touching;
    }
    memory.open[i] = {};
  }
  memory.openPairs.clear();
  if (touches) left.clear();
  std::sort(left.begin(), left.end());
}

}  // namespace corridor
