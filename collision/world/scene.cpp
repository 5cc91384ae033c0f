#include "collision/world/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include "collision/convex/convex_distance.h"
#include "collision/core/floating_point.h"
#include "collision/core/rounding.h"
#include "collision/motion/broad_phase.h"
#include "collision/motion/decide_interval.h"
#include "collision/motion/interval_motions.h"
#include "collision/motion/may_meet.h"
#include "collision/motion/motion_answer.h"
#include "collision/motion/moving_hulls.h"
#include "collision/motion/rigid_motion.h"
#include "collision/motion/swept_spheres.h"
#include "collision/queries/surface_distance.h"
#include "collision/world/body_queries.h"

namespace corridor {
namespace {

/// Returns whether the hulls of two bodies prove a distance of more than d. Walking the trees of
/// meshes takes ten times as long.
bool hullsAreBeyond(double d, const Posed<Body>& a, const Posed<Body>& b) {
  if (!haveHulls(a.shape, b.shape)) return false;
  return convexDistanceRange({*a.shape.hull(), a.X_W}, {*b.shape.hull(), b.X_W}, d, d).lower > d;
}

/// These two functions return a relative motion of zero length, for `sweptSphere`. The first
/// describes a frame as seen from the world, the second a frame as seen from another frame. Both
/// accept all affine maps, not only rigid ones.
RelativeMotion atRest(const Transform& X_WB) {
  // A matrix M of doubles is rarely an exact rotation. If η is its defect (`orthonormalityDefect`),
  // then |Mx| is between (1 − 3η)|x| and (1 + 3η)|x|.
  const double defect = orthonormalityDefect(X_WB.m);
  RelativeMotion still;
  still.X_AB = X_WB;
  still.reachError = 3 * defect;
  // If M is far from a rotation, the terms of M·centre may cancel, so that rounding dominates. Then
  // no pair is skipped.
  if (!(defect < 0x1p-10)) still.fixedError = HUGE_VAL;
  return still;
}
RelativeMotion atRest(const Transform& X_WA, const Transform& X_WB) {
  const double defectA = orthonormalityDefect(X_WA.m), defectB = orthonormalityDefect(X_WB.m);
  RelativeMotion still;
  still.X_AB = rigidInverse(X_WA) * X_WB;
  // X_AB approximates the map x ↦ M_A⁻¹(X_WB x − t_A). To bound the error of this approximation,
  // write M_A⁻¹ = M_Aᵀ + (1 − M_AᵀM_A)M_A⁻¹. The norm of the second term is below 3η_A(1 + 4η_A) <
  // 4η_A. Rounding adds less than 32u times the sum of the magnitudes of all terms. The sphere's
  // radius grows by 3η_B and by the defect of M_A.
  still.reachError = 5 * (defectA + defectB) + 32 * kUnit;
  still.fixedError =
      (4 * defectA + 32 * kUnit) * (X_WA.t.cwiseAbs().sum() + X_WB.t.cwiseAbs().sum());
  if (!(defectA < 0x1p-10 && defectB < 0x1p-10)) still.fixedError = HUGE_VAL;
  return still;
}

/// Returns a box that contains the body under X, and under every map that differs from X by at most
/// what `Scene::Placed` allows.
BoundingBox boxUnder(const Body& body, const Transform& X) {
  BoundingBox box;
  const auto add = [&](const Vec3& p, double radius) {
    box.lower = box.lower.cwiseMin(X * p - Vec3::Constant(radius));
    box.upper = box.upper.cwiseMax(X * p + Vec3::Constant(radius));
  };
  for (const Vec3& vertex : body.mesh().vertices) add(vertex, 0);
  for (const ConvexPart& part : body.parts())
    for (const Vec3& point : part.points) add(point, part.radius);
  // Let η be the defect of the map (`orthonormalityDefect`). The norm of its matrix is at most √(1
  // + 3η) ≤ 1 + 2η, so the image of a ball extends beyond the ball's radius by at most 2η times the
  // radius. Each coordinate of a mapped point is off by at most 4u(√3(1 + 2η)r + |t|), where u =
  // 2^-53, r is the radius of the body and t the translation of the map.
  const double error = roundedUp((2 * orthonormalityDefect(X.m) + 0x1p-45) * body.radius() +
                                 0x1p-45 * X.t.stableNorm());
  box.lower.array() -= error;
  box.upper.array() += error;
  // If the map overflows, a bound may have missed points (a minimum drops NaN), or be NaN itself.
  if (!(error < HUGE_VAL)) {
    box.upper.setConstant(HUGE_VAL);
    box.lower = -box.upper;
  }
  box.terms = box.lower.cwiseAbs().sum() + box.upper.cwiseAbs().sum();
  return box;
}

}  // namespace

Scene::Scene(std::vector<Placed> bodies, std::vector<Pair> pairs)
    : bodies_(std::move(bodies)), pairs_(std::move(pairs)) {
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (const auto& X_WF = bodies_[i].restX_WF) {
      if (!X_WF->isFinite())
        throw std::invalid_argument("the map of a frame at rest must be finite");
      restBoxes_[i] = boxUnder(bodies_[i].body, *X_WF);
    }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> motions;
  auto last = motions.end();  // most pairs have the same frames as the previous pair
  const auto motionOf = [&](std::size_t frameA, std::size_t frameB) {
    const std::pair frames(frameA, frameB);
    if (last != motions.end() && last->first == frames) return last->second;
    const auto [found, added] = motions.try_emplace(frames, framePairs_.size());
    if (added) framePairs_.push_back({frameA, frameB});
    last = found;
    return found->second;
  };
  std::size_t frameCount = 1;
  for (const Placed& placed : bodies_) frameCount = std::max(frameCount, placed.frame + 1);
  std::vector<char> isPosed(frameCount);
  std::vector<std::size_t> motionsOfPairs;
  motionsOfPairs.reserve(pairs_.size());
  for (Pair& pair : pairs_) {
    if (pair.a >= bodies_.size() || pair.b >= bodies_.size())
      throw std::invalid_argument("a pair names a body that the scene does not have");
    if (bodies_[pair.b].frame < bodies_[pair.a].frame) std::swap(pair.a, pair.b);
    if (bodies_[pair.b].restX_WF && bodies_[pair.a].frame != 0) std::swap(pair.a, pair.b);
    motionsOfPairs.push_back(motionOf(bodies_[pair.a].frame, bodies_[pair.b].frame));
    for (const std::size_t body : {pair.a, pair.b}) isPosed[frameOrWorld(body)] = true;
  }
  for (std::size_t frame = 0; frame < frameCount; ++frame)
    if (isPosed[frame]) posedFrames_.push_back(frame);
  solidMeshes_ = std::any_of(pairs_.begin(), pairs_.end(), [&](const Pair& pair) {
    return bodies_[pair.a].body.isSolidMesh() || bodies_[pair.b].body.isSolidMesh();
  });
  motionPairs_.reserve(pairs_.size());
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    const Placed &a = bodies_[pairs_[i].a], &b = bodies_[pairs_[i].b];
    MotionPair pair{&a.body, &b.body, motionsOfPairs[i], pairs_[i].a, pairs_[i].b};
    if (b.frame != 0) pair.worldMotionB = motionOf(0, b.frame);
    if (a.restX_WF)
      pair.restBox = &restBoxes_.at(pair.bodyA);
    else if (a.frame == 0)
      pair.restBox = &a.body.box();
    else
      pair.worldMotionA = motionOf(0, a.frame);
    motionPairs_.push_back(pair);
  }
  // All pairs of one moving body with bodies at rest are adjacent in the order, although their
  // motions may differ.
  const auto keyOf = [](const MotionPair& pair) {
    const bool atRest = pair.restBox && pair.worldMotionB != MotionPair::kNone;
    return std::tuple(atRest ? pair.worldMotionB : pair.motion, pair.bodyB, pair.motion);
  };
  const auto isBefore = [&](const MotionPair& x, const MotionPair& y) {
    return keyOf(x) < keyOf(y);
  };
  // Scenes of robot models usually list their pairs in this order already.
  if (!std::is_sorted(motionPairs_.begin(), motionPairs_.end(), isBefore))
    std::stable_sort(motionPairs_.begin(), motionPairs_.end(), isBefore);
  for (std::size_t i = 0; i < pairs_.size(); ++i)
    pairs_[i] = {motionPairs_[i].bodyA, motionPairs_[i].bodyB};
  broadPhase_ = std::make_unique<const BroadPhase>(motionPairs_);
}

Scene::~Scene() = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

double Scene::defaultTolerance(double farthest) const {
  struct Bounds {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
  };
  std::map<std::size_t, Bounds> boundsOfFrames;
  for (const std::size_t frame : posedFrames_) boundsOfFrames[frame];
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    if (const auto found = boundsOfFrames.find(frameOrWorld(i)); found != boundsOfFrames.end()) {
      const auto rest = restBoxes_.find(i);
      const Body& body = bodies_[i].body;
      Bounds& bounds = found->second;
      bounds.lower =
          bounds.lower.cwiseMin(rest == restBoxes_.end() ? body.lower() : rest->second.lower);
      bounds.upper =
          bounds.upper.cwiseMax(rest == restBoxes_.end() ? body.upper() : rest->second.upper);
    }
  double radius = std::numeric_limits<double>::infinity(), size = 0;
  for (const auto& [frame, bounds] : boundsOfFrames) {
    radius = std::min(radius, 0.5 * (bounds.upper - bounds.lower).norm());
    size =
        std::max(size, farthest + bounds.lower.cwiseAbs().cwiseMax(bounds.upper.cwiseAbs()).norm());
  }
  if (boundsOfFrames.empty()) radius = 1;  // without pairs, no query uses the tolerance
  // If the bodies of a frame are a single point, the radius is 0. Then any positive tolerance is
  // suitable.
  return std::max(1e-7 * std::max(radius, std::numeric_limits<double>::min() * 1e8),
                  RigidMotion::roundingTolerance(size));
}

/// Visits the pairs of bodies, except pairs whose bounds prove a distance of more than `within`
/// metres. Stops when the visitor returns true. The visitor may lower `within`.
template <class Visit>
void Scene::forNearPairs(std::span<const Transform> X_WF, const double& within,
                         QueryContext& context, Visit visit,
                         const std::vector<std::uint32_t>* only) const {
  for (const std::size_t frame : posedFrames_)
    if (frame >= X_WF.size() || !X_WF[frame].isFinite())
      throw std::invalid_argument("every frame must have a finite pose");
  const auto use = context.scratch.use<SweptSpheres>();
  SweptSpheres& spheres = *use;
  spheres.makeRoom(bodies_.size());
  spheres.forget();
  const auto worldSphere = [&](std::size_t body) -> const SweptSphere& {
    return spheres.of(body,
                      [&] { return sweptSphere(bodies_[body].body, atRest(mapOf(body, X_WF))); });
  };
  const auto visitPair = [&](std::size_t k) {
    const MotionPair& pair = motionPairs_[k];
    const Transform &X_WA = mapOf(pair.bodyA, X_WF), &X_WB = mapOf(pair.bodyB, X_WF);
    if (X_WA == Transform()) {  // then the box of body a is also a box in the world
      if (!mayMeet(*pair.a, worldSphere(pair.bodyB), within)) return false;
    } else {
      const SweptSphere& b = worldSphere(pair.bodyB);
      // The box of a body on frame 0 holds only while frame 0 is at the identity. Here the map of
      // body a is not the identity, so only a body on another frame at rest has a valid box.
      const bool boxed = bodies_[pair.bodyA].restX_WF.has_value();
      if ((boxed ? clearanceBound(*pair.restBox, b, within)
                 : clearanceBound(worldSphere(pair.bodyA), b, within)) > within)
        return false;
      // The sphere and the box are measured in A's frame, whose map need not preserve lengths.
      const double inA =
          within > 0 ? roundedUp(within * (1 + 4 * orthonormalityDefect(X_WA.m))) : within;
      if (!mayMeet(*pair.a, sweptSphere(*pair.b, atRest(X_WA, X_WB)), inA)) return false;
    }
    return visit(pair, Posed(*pair.a, X_WA), Posed(*pair.b, X_WB), context.lastPair(k));
  };
  if (only) {
    for (const std::uint32_t k : *only)
      if (visitPair(k)) return;
    return;
  }
  if (X_WF.empty() || X_WF[0] == Transform()) {
    broadPhase_->forEach([&](const MotionPair& pair) { return worldSphere(pair.bodyB); }, within,
                         visitPair);
    return;
  }
  for (std::size_t k = 0; k < motionPairs_.size(); ++k)  // frame 0 is not at the identity
    if (visitPair(k)) return;
}

std::optional<Contact> Scene::interference(std::span<const Transform> X_WF, QueryContext& context,
                                           TreeKind trees) const {
  ++context.counters.states;
  std::optional<Contact> contact;
  forNearPairs(
      X_WF, 0, context,
      [&](const MotionPair& pair, const Posed<Body>& a, const Posed<Body>& b, LastPair& last) {
        if (const auto hit = corridor::interference(a, b, context, trees, &last))
          contact = Contact{pair.bodyA, pair.bodyB, hit->a, hit->b};
        return contact.has_value();
      });
  return contact;
}

double Scene::clearance(std::span<const Transform> X_WF, QueryContext& context,
                        TreeKind trees) const {
  ++context.counters.states;
  double least = std::numeric_limits<double>::infinity();
  forNearPairs(X_WF, least, context,
               [&](const MotionPair&, const Posed<Body>& a, const Posed<Body>& b, LastPair& last) {
                 least = std::min(least, distance(a, b, {}, context, trees, &last).distance);
                 return least == 0;
               });
  return least;
}

std::vector<Scene::NearPair> Scene::pairsWithin(std::span<const Transform> X_WF,
                                                const PairMargins& within,
                                                const DistanceOptions& options,
                                                QueryContext& context, const NearSearch& search,
                                                TreeKind trees) const {
  if (within.size() != pairs_.size())
    throw std::invalid_argument("margins of pairs: one for each pair is required");
  ++context.counters.states;
  std::vector<NearPair> near;
  forNearPairs(
      X_WF, search.scale * within.largest(), context,
      [&](const MotionPair& pair, const Posed<Body>& a, const Posed<Body>& b, LastPair& last) {
        const auto k = static_cast<std::size_t>(&pair - motionPairs_.data());
        DistanceOptions own = options;
        own.upTo = search.scale * within[k];
        // This changes no result: the distance would be beyond the limit, too.
        if (hullsAreBeyond(own.upTo, a, b)) return false;
        const Distance found = distance(a, b, own, context, trees, &last);
        if (found.distance <= own.upTo) near.push_back({k, found});
        return false;
      },
      search.pairs);
  std::sort(near.begin(), near.end(),
            [](const NearPair& x, const NearPair& y) { return x.pair < y.pair; });
  return near;
}

namespace {

/// Returns a relative pose at a time in [0, until] at which the surfaces of the two bodies are
/// farther apart than the pose's rounding and tube. Returns nullopt if no such pose is found at the
/// times that are tried. Nearly all motions have such a pose at t = 0.
std::optional<Transform> poseApart(const MotionPair& pair, MotionSource& motion, double until,
                                   QueryContext& context) {
  for (const double t : {0.0, until, until / 2, until / 4, until / 8}) {
    const RelativeMotion relative = motion.relativeMotion(pair.motion, t, 0);
    const double reach = (relative.X_AB.m * pair.b->sphereCenter()).norm() + pair.b->sphereRadius();
    const double error = roundedUp(relative.fixedError + relative.reachError * roundedUp(reach));
    if (!surfacesCloserThan(Posed(*pair.a), Posed(*pair.b, relative.X_AB), error, context))
      return relative.X_AB;
  }
  return std::nullopt;
}

/// Returns true if no part of the motion is proved free. Then containment is not tested, because a
/// test is valid only for a time interval in which the surfaces are proved apart.
bool provesNothingFree(const MotionResult& result) {
  return result.verdict != MotionVerdict::free && !(result.certifiedUntil > 0);
}

/// Scratch memory: the indices of the pairs of bodies that may come near each other in an interval.
struct NearPairs {
  std::vector<std::uint32_t> pairs;
};

}  // namespace

MotionResult Scene::certifyPairs(MotionSource& motion, const MotionOptions& options,
                                 QueryContext& context, EdgeMethod method,
                                 MotionCertificate* certificate) const {
  const bool isDefault = method == EdgeMethod::certified;
  MotionResult result =
      isDefault
          ? certifyMotion(motion, motionPairs_, options, context, certificate, broadPhase_.get())
          : certifyMotionUncounted(method, motion, motionPairs_, options, context);
  if (!solidMeshes_ || provesNothingFree(result)) return result;
  if (options.only) return withContainment(result, *options.only, motion, context, certificate);
  IntervalMotions motions(motion, broadPhase_->bodies(), context);
  motions.select(0, 0);
  const auto use = context.scratch.use<NearPairs>();
  std::vector<std::uint32_t>& near = use->pairs;
  broadPhase_->find(motions, 0, near);
  return withContainment(result, near, motion, context, certificate);
}

MotionResult Scene::withContainment(MotionResult result, std::span<const std::uint32_t> pairs,
                                    MotionSource& motion, QueryContext& context,
                                    MotionCertificate* certificate) const {
  if (provesNothingFree(result)) return result;
  const double until = result.verdict == MotionVerdict::free ? 1 : result.certifiedUntil;
  // The surfaces do not meet on [0, until], so one pose decides containment for this whole
  // interval. The rounding of the pose must be too small to move a point through a surface
  // (`poseApart`).
  for (const std::uint32_t k : pairs) {
    const MotionPair& pair = motionPairs_[k];
    // No test is needed for a convex part: it is solid, so the motion query finds bodies inside it.
    if (!pair.a->isSolidMesh() && !pair.b->isSolidMesh()) continue;
    if (!mayMeet(*pair.a, sweptSphere(*pair.b, motion.relativeMotion(pair.motion, 0, 0)), 0))
      continue;
    const auto X_AB = poseApart(pair, motion, until, context);
    const auto hit =
        X_AB ? findOneInsideOther(Posed(*pair.a), Posed(*pair.b, *X_AB), context) : std::nullopt;
    if (X_AB && !hit) continue;
    if (certificate) *certificate = {};
    result = {};
    result.certifiedUntil = 0;
    if (hit) {
      result.verdict = MotionVerdict::contact;
      result.time = 0;
      result.pair = Contact{pair.bodyA, pair.bodyB, hit->a, hit->b};
    } else {
      result.verdict = MotionVerdict::undecided;
      result.reason = UndecidedReason::rounding;
      result.pair = Contact{pair.bodyA, pair.bodyB, 0, 0};
    }
    break;
  }
  return result;
}

MotionResult Scene::certify(MotionSource& motion, const MotionOptions& options,
                            QueryContext& context, EdgeMethod method) const {
  const MotionResult result = certifyPairs(motion, options, context, method);
  count(motion, result, context.counters);
  return result;
}

MotionResult Scene::certify(MotionSource& motion, const MotionOptions& options,
                            QueryContext& context, MotionCertificate& certificate) const {
  const MotionResult result =
      certifyPairs(motion, options, context, EdgeMethod::certified, &certificate);
  count(motion, result, context.counters);
  return result;
}

std::optional<MotionResult> Scene::contactAt(MotionSource& motion, std::size_t pair, double t,
                                             const MotionOptions& options, std::uint64_t workEnd,
                                             QueryContext& context) const {
  if (!standardFloatingPoint() || motion.ambiguous()) return std::nullopt;
  const MotionPair& bodies = motionPairs_[pair];
  const Transform X_AB = motion.relativeMotion(bodies.motion, t, 0).X_AB;
  const MotionQuery query{motionPairs_, options, context, nullptr, workEnd, nullptr};
  const auto hit = contactBelow(query, static_cast<std::uint32_t>(pair), X_AB, kWholeTrees);
  if (!hit) return std::nullopt;
  MotionResult result;
  result.verdict = MotionVerdict::contact;
  result.certifiedUntil = 0;
  result.time = t;
  result.pair = Contact{bodies.bodyA, bodies.bodyB, hit->a, hit->b};
  return result;
}

std::vector<std::uint32_t> Scene::pairsLeftByHulls(MotionSource& motion,
                                                   const MotionOptions& options,
                                                   QueryContext& context) const {
  return corridor::pairsLeftByHulls(motion, motionPairs_, options, context, broadPhase_.get());
}

std::vector<MotionResult> Scene::certifyEachPair(MotionSource& motion, const MotionOptions& options,
                                                 QueryContext& context) const {
  requireValid(options, pairs_.size());
  std::vector<MotionResult> results;
  results.resize(pairs_.size());
  MotionResult counted;  // counts as one query, which is undecided if any pair is
  const auto use = context.scratch.use<NearPairs>();
  std::vector<std::uint32_t>& near = use->pairs;
  const bool isCurve = standardFloatingPoint() && !motion.ambiguous();
  if (isCurve) {  // pairs that `find` leaves out are free
    IntervalMotions motions(motion, broadPhase_->bodies(), context);
    motions.select(0.5, 0.5);
    broadPhase_->find(motions, roundedUp(options.largestMargin() + options.clearanceSlack), near);
  } else {
    near.resize(pairs_.size());
    std::iota(near.begin(), near.end(), std::uint32_t{0});
  }
  for (const std::uint32_t i : near) {
    MotionResult& result = results[i];
    MotionOptions own = options;
    own.margin = options.marginOf(i);
    own.pairMargins = nullptr;
    own.only = nullptr;
    result = certifyMotion(motion, {&motionPairs_[i], 1}, own, context);
    if (solidMeshes_) result = withContainment(result, {&i, 1}, motion, context, nullptr);
    if (result.verdict == MotionVerdict::undecided) counted = result;
  }
  count(motion, counted, context.counters);
  return results;
}

}  // namespace corridor
