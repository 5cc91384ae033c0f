#include "collision/world/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <utility>

#include <Eigen/Geometry>

#include "collision/core/rounding.h"
#include "collision/motion/may_meet.h"
#include "collision/motion/rigid_motion.h"
#include "collision/world/body_queries.h"

namespace corridor {
namespace {

/// A frame at rest under any map, as the world sees it, and as another does under any map of its
/// own: windows for `sweptBall`.
MotionWindow atRest(const Transform& X_WB) {
  // No matrix of doubles is a rotation: |Mx| is between (1 − 3η)|x| and (1 + 3η)|x|.
  const double defect = orthonormalityDefect(X_WB.m);
  MotionWindow still;
  still.X_AB = X_WB;
  still.reachError = 3 * defect;
  // Far from rigid, M·centre may cancel and be small beside its rounding: nothing is skipped then.
  if (!(defect < 0x1p-10)) still.fixedError = HUGE_VAL;
  return still;
}
MotionWindow atRest(const Transform& X_WA, const Transform& X_WB) {
  const double defectA = orthonormalityDefect(X_WA.m), defectB = orthonormalityDefect(X_WB.m);
  MotionWindow still;
  still.X_AB = rigidInverse(X_WA) * X_WB;
  // What X_AB is off from M_A⁻¹(X_WB x − t_A): M_A⁻¹ = M_Aᵀ + (1 − M_AᵀM_A)M_A⁻¹, the latter below
  // 3η_A(1 + 4η_A) < 4η_A; and less than 32u of all terms. The sphere's radius grows by 3η_B, and
  // by M_A's defect.
  still.reachError = 5 * (defectA + defectB) + 32 * kUnit;
  still.fixedError =
      (4 * defectA + 32 * kUnit) * (X_WA.t.cwiseAbs().sum() + X_WB.t.cwiseAbs().sum());
  if (!(defectA < 0x1p-10 && defectB < 0x1p-10)) still.fixedError = HUGE_VAL;
  return still;
}

bool isSolidMesh(const Body& body) {
  return body.solid() && !body.part();
}

/// The one door for numbers of motion queries: a negative margin, say, would prove too much.
void require(const MotionOptions& options) {
  const auto finite = [](double x, bool zeroToo) {
    return std::isfinite(x) && (zeroToo ? x >= 0 : x > 0);
  };
  if (!finite(options.tolerance, false))
    throw std::invalid_argument("the tolerance of a motion query is to be positive and finite");
  if (!finite(options.margin, true) || !finite(options.reserve, true))
    throw std::invalid_argument("margin and reserve are to be finite and not negative");
  if (!finite(options.timeTolerance, false))
    throw std::invalid_argument("the time tolerance is to be positive and finite");
}

}  // namespace

Scene::Scene(std::vector<Placed> bodies, std::vector<Pair> pairs)
    : bodies_(std::move(bodies)), pairs_(std::move(pairs)) {
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> motions;
  std::vector<std::size_t> motionOf;
  motionOf.reserve(pairs_.size());
  for (Pair& pair : pairs_) {
    if (pair.a >= bodies_.size() || pair.b >= bodies_.size())
      throw std::invalid_argument("a pair of bodies that the scene doesn't have");
    if (bodies_[pair.b].frame < bodies_[pair.a].frame) std::swap(pair.a, pair.b);
    const FramePair frames{bodies_[pair.a].frame, bodies_[pair.b].frame};
    const auto [found, added] = motions.try_emplace({frames.a, frames.b}, framePairs_.size());
    if (added) framePairs_.push_back(frames);
    motionOf.push_back(found->second);
  }
  order_.resize(pairs_.size());
  std::iota(order_.begin(), order_.end(), std::size_t{0});
  std::stable_sort(order_.begin(), order_.end(), [&](std::size_t i, std::size_t k) {
    return std::pair(motionOf[i], pairs_[i].b) < std::pair(motionOf[k], pairs_[k].b);
  });
  solidMeshes_ = std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    return isSolidMesh(bodies_[pair.a].body) || isSolidMesh(bodies_[pair.b].body);
  });
  const auto motionFromWorld = [&](std::size_t frame) {
    const auto [found, added] = motions.try_emplace({0, frame}, framePairs_.size());
    if (added) framePairs_.push_back({0, frame});
    return found->second;
  };
  for (const std::size_t i : order_) {
    MotionPair pair{&bodies_[pairs_[i].a].body, &bodies_[pairs_[i].b].body, motionOf[i],
                    pairs_[i].a, pairs_[i].b};
    const std::size_t a = bodies_[pair.bodyA].frame, b = bodies_[pair.bodyB].frame;
    if (b != 0) pair.worldB = motionFromWorld(b);
    if (a != 0) pair.worldA = motionFromWorld(a);
    motionPairs_.push_back(pair);
  }
}

double Scene::defaultTolerance(double farthest) const {
  struct Bounds {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  };
  std::map<std::size_t, Bounds> sides;
  for (const Pair& pair : pairs_) sides[bodies_[pair.a].frame], sides[bodies_[pair.b].frame];
  for (const Placed& placed : bodies_)
    if (const auto side = sides.find(placed.frame); side != sides.end()) {
      side->second.lower = side->second.lower.cwiseMin(placed.body.lower());
      side->second.upper = side->second.upper.cwiseMax(placed.body.upper());
    }
  double radius = std::numeric_limits<double>::infinity(), size = 0;
  for (const auto& [frame, side] : sides) {
    radius = std::min(radius, 0.5 * (side.upper - side.lower).norm());
    size = std::max(size, farthest + side.lower.cwiseAbs().cwiseMax(side.upper.cwiseAbs()).norm());
  }
  if (sides.empty()) radius = 1;  // nothing is ever asked of it
  // A single point has no radius; any positive number will do.
  return std::max(1e-7 * std::max(radius, std::numeric_limits<double>::min() * 1e8),
                  RigidMotion::roundingTolerance(size));
}

/// Visits the pairs of bodies whose bounds don't keep them farther apart than `within` metres,
/// which may fall on the way, until the visitor returns true.
template <class Visit>
void Scene::forNearPairs(std::span<const Transform> X_WF, const double& within,
                         QueryContext& context, Visit visit) const {
  for (const FramePair& pair : framePairs_)
    for (const std::size_t frame : {pair.a, pair.b})
      if (frame >= X_WF.size() || !X_WF[frame].isFinite())
        throw std::invalid_argument("every frame is to have a finite pose");
  context.balls.makeRoom(bodies_.size());
  context.balls.forget();
  const auto worldBall = [&](std::size_t body) -> const SweptBall& {
    const Placed& placed = bodies_[body];
    return context.balls.of(body,
                            [&] { return sweptBall(placed.body, atRest(X_WF[placed.frame])); });
  };
  for (const MotionPair& pair : motionPairs_) {
    const FramePair& frames = framePairs_[pair.motion];
    const Transform &X_WA = X_WF[frames.a], &X_WB = X_WF[frames.b];
    if (X_WA == Transform()) {
      if (!mayMeet(*pair.a, worldBall(pair.bodyB), within)) continue;
    } else {
      if (clearanceBound(worldBall(pair.bodyA), worldBall(pair.bodyB), within) > within) continue;
      // The ball and the box are told in A's frame, whose map need not keep lengths.
      const double inA =
          within > 0 ? roundedUp(within * (1 + 4 * orthonormalityDefect(X_WA.m))) : within;
      if (!mayMeet(*pair.a, sweptBall(*pair.b, atRest(X_WA, X_WB)), inA)) continue;
    }
    if (visit(pair, X_WA, X_WB)) return;
  }
}

std::optional<Contact> Scene::interference(std::span<const Transform> X_WF, QueryContext& context,
                                           TreeKind trees) const {
  std::optional<Contact> contact;
  forNearPairs(
      X_WF, 0, context, [&](const MotionPair& pair, const Transform& X_WA, const Transform& X_WB) {
        const auto hit = corridor::interference(*pair.a, X_WA, *pair.b, X_WB, context, trees);
        if (hit) contact = Contact{pair.bodyA, pair.bodyB, hit->a, hit->b};
        return contact.has_value();
      });
  return contact;
}

double Scene::clearance(std::span<const Transform> X_WF, QueryContext& context,
                        TreeKind trees) const {
  double least = std::numeric_limits<double>::infinity();
  forNearPairs(X_WF, least, context,
               [&](const MotionPair& pair, const Transform& X_WA, const Transform& X_WB) {
                 const Distance d = distance(*pair.a, X_WA, *pair.b, X_WB, {}, context, trees);
                 least = std::min(least, d.distance);
                 return least == 0;
               });
  return least;
}

MotionResult Scene::certifyPairs(std::span<const MotionPair> pairs, MotionSource& motion,
                                 const MotionOptions& options, QueryContext& context,
                                 EdgeMethod method, MotionEvidence* evidence) const {
  MotionResult result = evidence ? certifyMotion(motion, pairs, options, context, evidence)
                                 : certifyMotionBy(method, motion, pairs, options, context);
  if (!solidMeshes_) return result;
  if (result.verdict != MotionVerdict::free && !(result.certifiedUntil > 0)) return result;
  // Surfaces that stay apart at t = 0 by more than all rounding: the rounded pose decides for the
  // real one, and for all of what is certified.
  for (const MotionPair& pair : pairs) {
    // A convex part has looked at what is inside it when it looked for contacts.
    if (!isSolidMesh(*pair.a) && !isSolidMesh(*pair.b)) continue;
    const MotionWindow start = motion.window(pair.motion, 0, 0);
    if (!mayMeet(*pair.a, sweptBall(*pair.b, start), 0)) continue;
    const auto hit = insideEachOther(*pair.a, {}, *pair.b, start.X_AB, context);
    if (!hit) continue;
    context.counters.undecided -= result.verdict == MotionVerdict::undecided;
    if (evidence) *evidence = {};
    result = {};
    result.verdict = MotionVerdict::contact;
    result.certifiedUntil = result.contactTime = 0;
    result.pair = Contact{pair.bodyA, pair.bodyB, hit->a, hit->b};
    break;
  }
  return result;
}

MotionResult Scene::certify(MotionSource& motion, const MotionOptions& options,
                            QueryContext& context, EdgeMethod method) const {
  require(options);
  return certifyPairs(motionPairs_, motion, options, context, method);
}

MotionResult Scene::certify(MotionSource& motion, const MotionOptions& options,
                            QueryContext& context, MotionEvidence& evidence) const {
  require(options);
  return certifyPairs(motionPairs_, motion, options, context, EdgeMethod::certified, &evidence);
}

std::vector<MotionResult> Scene::certifyEachPair(MotionSource& motion, const MotionOptions& options,
                                                 QueryContext& context) const {
  require(options);
  std::vector<MotionResult> results;
  results.resize(pairs_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    results[order_[i]] =
        certifyPairs({&motionPairs_[i], 1}, motion, options, context, EdgeMethod::certified);
  return results;
}

}  // namespace corridor
