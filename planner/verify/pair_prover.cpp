#include "planner/verify/pair_prover.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "planner/verify/curve_joins.h"
#include "planner/verify/path_problem.h"
#include "planner/verify/winding.h"

namespace corridor::verify {
namespace {

constexpr const char* kTooLarge =
    "a joint value or length is too large: its rounding may exceed the clearance";
constexpr const char* kErrorTooLarge = "the error of the piece may exceed the clearance";

/// Returns the sum, rounded up. Computed in long double, so that flush-to-zero loses nothing.
double sumUp(double a, double b) {
  const Real sum = (Real(a) + Real(b)) * (b > 0 ? 1 + 0x1p-60L : 1);
  const auto rounded = static_cast<double>(sum);
  return rounded < sum ? std::nextafter(rounded, HUGE_VAL) : rounded;
}

}  // namespace

PairProver::PairProver(const PathProblem& problem, const std::vector<Configuration>& states)
    : PairProver(problem) {
  if (states.empty()) refuse("states must not be empty");
  const std::size_t edges = std::max<std::size_t>(states.size() - 1, 1);
  for (std::size_t e = 0; e < edges; ++e)
    addEdge(states[e], states[std::min(e + 1, states.size() - 1)]);
}

PairProver::PairProver(const PathProblem& problem, std::span<const CurvePiece> pieces)
    : PairProver(problem) {
  if (pieces.empty()) refuse("pieces must not be empty");
  const CurvePiece* before = nullptr;
  for (const CurvePiece& piece : pieces) {
    requireValid(problem, piece);
    addPiece(piece, before);
    before = &piece;
  }
}

PairProver::PairProver(const PathProblem& problem) : problem_(problem) {
  requireValid(problem);
  std::map<const TriangleMesh*, std::size_t> known;
  for (const VerifyBody& body : problem.bodies) {
    const auto [same, isNew] = known.try_emplace(body.mesh, trees_.size());
    if (body.mesh && !isNew) {
      treeOf_.push_back(same->second);
      continue;
    }
    treeOf_.push_back(trees_.size());
    body.mesh ? trees_.emplace_back(*body.mesh) : trees_.emplace_back(body.parts);
  }
  for (const VerifyPair& pair : problem.pairs) addPair(pair);
  for (const VerifyPair& pair : problem.heldPairs) {
    addPair(pair);
    for (const std::size_t chain : {pairs_.back().chainA, pairs_.back().chainB})
      for (const std::size_t frame : chains_[chain].path)
        if (problem.tree->frames[frame].moves())
          refuse("a pair of heldPairs has a joint that moves between its bodies");
  }
  frameStates_.resize(chains_.size());
}

void PairProver::addPair(const VerifyPair& pair) {
  const std::size_t fa = problem_.bodies[pair.a].frame, fb = problem_.bodies[pair.b].frame;
  const std::size_t base = commonAncestor(*problem_.tree, fa, fb);
  // The factor covers the rounding of the sum.
  const Real margin = pair.padding > 0
                          ? (Real(problem_.margin) + Real(pair.padding)) * (1 + 0x1p-62L)
                          : Real(problem_.margin);
  pairs_.push_back({pair.a, pair.b, addChain(base, fa), addChain(base, fb), margin});
}

void PairProver::addEdge(const Configuration& from, const Configuration& to) {
  const bool valid = isState(from) && isState(to);
  const Configuration some = Configuration::Ones(problem_.tube.size());
  EdgeCurve curve(*problem_.tree, problem_.space->coordinates(), valid ? from : some,
                  valid ? to : some);
  const char* fault = nullptr;
  if (!valid)
    fault = "not a valid state";
  else if (curve.ambiguous())
    fault = "ambiguous half turn";
  else if (curve.jumps())
    fault =
        "a joint that mimics a continuous joint would jump: the two angles of the continuous joint "
        "differ by more than half a turn";
  addCurve(std::move(curve), Configuration::Zero(problem_.tube.size()), fault,
           isState(from) && !valid ? to : from);
}

void PairProver::addPiece(const CurvePiece& piece, const CurvePiece* before) {
  const bool valid = isPiece(piece);
  const CurvePiece some{Eigen::MatrixXd::Ones(problem_.tube.size(), 2), piece.error};
  EdgeCurve curve(*problem_.tree, problem_.space->coordinates(), valid ? piece : some);
  const char* fault = nullptr;
  if (!valid)
    fault = "not a valid state";
  else if (before && isPiece(*before) && !joins(problem_.space->coordinates(), *before, piece))
    fault = "jump";
  else if (curve.ambiguous())
    fault = "ambiguous half turn";
  addCurve(std::move(curve), piece.error, fault, piece.coefficients.col(0));
}

void PairProver::addCurve(EdgeCurve curve, const Configuration& error, const char* fault,
                          const Configuration& at) {
  const std::size_t edge = curves_.size();
  curves_.push_back(std::move(curve));
  noCurve_.emplace_back();
  if (fault) {
    PathFinding& finding = noCurve_.back().emplace();
    finding.verdict = PathVerdict::refuted;
    finding.edge = static_cast<int>(edge);
    finding.configuration = at;
    finding.reason = fault;
  }
  Configuration& tube = tubes_.emplace_back(problem_.tube);
  for (Eigen::Index i = 0; i < tube.size(); ++i) tube[i] = sumUp(tube[i], error[i]);
  std::vector<PairReach> reaches;
  const std::size_t count = edge == 0 ? allPairs() : pairs();
  for (std::size_t p = 0; p < count; ++p) reaches.push_back(reachOf(edge, p, error));
  reaches_.push_back(std::move(reaches));
}

bool PairProver::isPiece(const CurvePiece& piece) const {
  return piece.coefficients.allFinite() && isState(piece.coefficients.col(0)) &&
         isState(piece.coefficients.col(piece.degree()));
}

bool PairProver::isState(const Configuration& state) const {
  if (static_cast<std::size_t>(state.size()) != problem_.space->size() || !state.allFinite())
    return false;
  for (const Coordinate& c : problem_.space->coordinates())
    if (c.kind == Coordinate::Kind::rotation &&
        state.segment<4>(static_cast<Eigen::Index>(c.first)).isZero(0))
      return false;
  return true;
}

std::size_t PairProver::addChain(std::size_t base, std::size_t frame) {
  const auto [known, isNew] = chainIndex_.try_emplace({base, frame}, chains_.size());
  if (isNew) chains_.push_back(chainOf(*problem_.tree, base, frame));
  return known->second;
}

Reach PairProver::sumOf(std::size_t edge, std::size_t pair, const Configuration& tube,
                        const Segment& segment) const {
  const Pair& p = pairs_[pair];
  Reach sum;
  for (const auto& [chainIndex, body] : {std::pair{p.chainA, p.a}, std::pair{p.chainB, p.b}}) {
    const Reach one =
        curves_[edge].reach(chains_[chainIndex], treeOf(body).radius(), tube, segment);
    sum.speed += one.speed;
    sum.bend += one.bend;
    sum.tube += one.tube;
    sum.bendCross += one.bendCross;
    sum.bendTube += one.bendTube;
    sum.size += one.size;
    sum.lengths += one.lengths;
  }
  return sum;
}

PairProver::PairReach PairProver::reachOf(std::size_t edge, std::size_t pair,
                                          const Configuration& error) const {
  PairReach reach;
  reach.sum = sumOf(edge, pair, tubes_[edge], {});
  // Each chain has a rounding of up to 2^-50·size = 2^14·u·size. The relative placement, the boxes
  // (32u), the slabs (16u) and the displacements together add at most as much again.
  reach.rounding = 0x1p-49L * reach.sum.size;
  if (!error.isZero(0)) reach.stray = sumOf(edge, pair, error, {}).tube;
  reach.sharp =
      reach.rounding <= std::max<Real>(0x1p-48L * reach.sum.lengths, problem_.tolerance) &&
      reach.stray <= problem_.tolerance;
  return reach;
}

const Reach& PairProver::reach(const TimeInterval& interval, std::size_t pair) {
  const Segment segment = curves_[interval.edge].segmentOf(interval.middle, interval.half);
  if (segment.depth == 0) return reaches_[interval.edge][pair].sum;
  enter(interval.edge);
  const std::size_t place = (std::size_t(1) << segment.depth) + segment.index;
  const auto [known, isNew] = segments_.try_emplace({place, pair});
  if (isNew) known->second = sumOf(interval.edge, pair, tubes_[interval.edge], segment);
  return known->second;
}

void PairProver::enter(std::size_t edge) {
  if (currentEdge_ == edge) return;
  for (auto& [time, unused] : frameStates_) time = -1;
  segments_.clear();
  currentEdge_ = edge;
}

const FrameState& PairProver::stateOf(std::size_t edge, std::size_t chainIndex, Real t) {
  enter(edge);
  auto& [time, state] = frameStates_[chainIndex];
  if (time != t) {
    state = curves_[edge].at(chains_[chainIndex], t);
    time = t;
  }
  return state;
}

/// Returns an upper bound of the smallest distance that the pair has within the tube. For most
/// pairs this is the distance at the pose. It is smaller if the chain of one body begins with a
/// translation, and the other body is fixed in the base. The tube can displace the first body in
/// any direction (of the plane, for a planar translation) by the smallest number of the
/// translation's tube. The real curve may keep a larger distance, by up to the displacement that
/// the piece's `error` allows. This displacement is added to the result.
Real PairProver::leastInTube(std::size_t edge, std::size_t pair, const Measured& m) const {
  const RealVec between = m.gap.onB - m.gap.onA;
  const auto isFixed = [&](std::size_t chain) {
    return std::ranges::none_of(chains_[chain].path,
                                [&](std::size_t f) { return problem_.tree->frames[f].moves(); });
  };
  std::size_t mover = pairs_[pair].chainB, other = pairs_[pair].chainA;
  if (isFixed(mover)) std::swap(mover, other);
  const Real error = reaches_[edge][pair].stray, farthest = m.gap.upper + error;
  if (isFixed(mover) || !isFixed(other)) return farthest;
  const Frame& frame = problem_.tree->frames[chains_[mover].path.front()];
  if (frame.joint != Frame::Joint::translation || !frame.moves()) return farthest;
  const auto first = static_cast<Eigen::Index>(frame.variable);
  const Real stray =
      problem_.tube.segment(first, static_cast<Eigen::Index>(frame.count)).minCoeff();
  Real across = 0;
  if (frame.count == 2) {
    const Eigen::Quaternion<Real> q(frame.fixed.q.cast<Real>());
    across = std::abs(between.dot(q.normalized() * RealVec::UnitZ()));
  }
  const Real along = std::sqrt(std::max<Real>(0, between.squaredNorm() - across * across));
  return std::hypot(std::max<Real>(along - stray, 0), across) + error;
}

/// Returns why the path is refuted at these poses, or null if it is not. If the poses may be far
/// from the path (not `sharp`), they refute nothing. The function then returns why the pair is
/// undecided, or null.
const char* PairProver::whyRefuted(std::size_t edge, std::size_t pair, const Measured& m) const {
  const PairReach& reach = reaches_[edge][pair];
  const Real margin = pairs_[pair].margin;
  if (!reach.sharp) {
    const bool error = reach.stray > problem_.tolerance;
    return m.gap.upper <= margin + reach.rounding ? (error ? kErrorTooLarge : kTooLarge) : nullptr;
  }
  if (m.gap.touching) return "contact";
  if (margin > 0 && m.gap.upper <= margin)
    return margin > problem_.margin ? "closer than margin and padding" : "closer than the margin";
  // Some curve in the tube comes as close as leastInTube(), so it touches, or violates the margin.
  if (std::isfinite(m.gap.upper) && leastInTube(edge, pair, m) <= margin)
    return "a deviation within the tube comes too close";
  return nullptr;
}

/// Returns why an interval about this middle is not proved although it is short.
const char* PairProver::whyStuck(const PairReach& reach, std::size_t pair,
                                 const Measured& m) const {
  const Real clear = m.gap.lower - pairs_[pair].margin;
  if (clear - reach.rounding > problem_.tolerance) return "the tube may take all of the clearance";
  return clear > problem_.tolerance ? kTooLarge : "clearance below the tolerance";
}

PairProver::Measured PairProver::place(const TimeInterval& interval, std::size_t pair) {
  const Pair& p = pairs_[pair];
  Measured m;
  m.a = stateOf(interval.edge, p.chainA, interval.middle);
  m.b = stateOf(interval.edge, p.chainB, interval.middle);
  const RealMat back = m.a.at.rotation.transpose();
  m.X_AB = {back * m.b.at.rotation, back * (m.b.at.position - m.a.at.position)};
  distance_.place(treeOf(p.a), treeOf(p.b), m.X_AB);
  return m;
}

void PairProver::measure(const PairReach& reach, std::size_t pair, LeafPair guess, Real stop,
                         Measured& m) {
  const Pair& p = pairs_[pair];
  const auto touches = [&](LeafPair leaves) {
    if (!reach.sharp) return false;
    const LeafPrimitive &a = treeOf(p.a).leaf(leaves.a), &b = treeOf(p.b).leaf(leaves.b);
    if (a.part || b.part) return distance_.gap(leaves).upper <= reach.rounding;
    RigidPose pose;
    pose.p = m.X_AB.position.cast<double>();
    pose.q = Eigen::Quaternion<Real>(m.X_AB.rotation).cast<double>();
    m.contact = exactContact(pose, b.corners, a.corners);
    return m.contact.has_value();
  };
  m.gap =
      distance_.measure(guess, reach.sharp ? reach.rounding : 0, stop + reach.rounding, touches);
}

Real PairProver::secondOrder(const Reach& reach, Real half) const {
  return tubeMatters(reach)
             ? (half * half * reach.bend + half * reach.bendCross + reach.bendTube) / 2
             : half * half * reach.bend / 2 + reach.tube;
}

PairAnswer PairProver::decide(const TimeInterval& interval, const OpenPair& open,
                              Real usefulBound) {
  const PairReach& whole = reaches_[interval.edge][open.pair];
  const Reach& bounds = reach(interval, open.pair);
  const Real motionBound = bounds.speed * interval.half, pad = bounds.tube + whole.rounding;
  const Real margin = pairs_[open.pair].margin;
  Measured m = place(interval, open.pair);
  PairAnswer answer;
  if (open.bound <= margin && motionBound > problem_.tolerance) {
    // Each of the two bounds below subtracts at least `least` from the distance at the middle. If
    // the distance is at most margin + least, the interval can't be proved, and is halved without
    // measuring it. The distance of one pair of primitives is an upper bound that shows this for
    // most intervals that are too long. If this upper bound is at most margin + pad, the pair may
    // be refuted here, so its distance is measured. (Other primitives may touch at this middle; a
    // shorter interval finds them, if the contact is not at this time only.)
    const Real least =
        std::min(motionBound + pad, secondOrder(bounds, interval.half) + whole.rounding);
    const DistanceBounds guessed = distance_.gap(open.guess);
    const Real upper = guessed.upper;
    if (margin + pad < upper && upper <= margin + least) {
      answer.closest = open.guess;
      answer.bound = open.bound;
      answer.estimate = upper - motionBound - pad;
      answer.point = guessed.onB;
      answer.upper = upper;
      answer.reason = "no interval is short enough to be proved";
      return answer;
    }
  }
  measure(whole, open.pair, open.guess, std::max<Real>(margin, usefulBound) + motionBound + pad, m);
  answer.closest = m.gap.pair;
  answer.upper = m.gap.upper;
  answer.point = m.contact ? RealVec(m.contact->cast<Real>()) : m.gap.onB;
  answer.reason = whyRefuted(interval.edge, open.pair, m);
  if (answer.reason) {
    answer.verdict = whole.sharp ? PathVerdict::refuted : PathVerdict::undecided;
    return answer;
  }
  answer.bound = std::max(open.bound, m.gap.lower - motionBound - pad);
  answer.estimate = answer.bound;
  if (answer.bound <= margin && (interval.half > 0 || tubeMatters(bounds)))
    answer.bound = std::max(answer.bound, boundPiecewise(interval, open.pair, m, usefulBound));
  if (answer.bound > margin) {
    answer.verdict = PathVerdict::proved;
  } else {
    answer.reason = whyStuck(whole, open.pair, m);
    if (motionBound <= problem_.tolerance) answer.verdict = PathVerdict::undecided;
  }
  return answer;
}

Real PairProver::boundPiecewise(const TimeInterval& interval, std::size_t pair, const Measured& m,
                                Real usefulBound) {
  const Reach& bounds = reach(interval, pair);
  const Configuration& tube = tubes_[interval.edge];
  const Real half = interval.half;
  PairMotion motion;
  motion.half = half;
  motion.motionBound = bounds.speed * half;
  motion.tube = bounds.tube;
  motion.rounding = reaches_[interval.edge][pair].rounding;
  Perturbation a, b;
  motion.secondOrder = secondOrder(bounds, half);
  if (tubeMatters(bounds)) {
    const EdgeCurve& curve = curves_[interval.edge];
    a = curve.perturbationAt(chains_[pairs_[pair].chainA], interval.middle, tube);
    b = curve.perturbationAt(chains_[pairs_[pair].chainB], interval.middle, tube);
  }
  motion.a = motionSeenFrom(m.a.at, m.a, std::move(a));
  motion.b = motionSeenFrom(m.a.at, m.b, std::move(b));
  const Real margin = pairs_[pair].margin, little = margin + problem_.tolerance;
  return boundBySlabs(distance_, m.gap, motion, {margin, little, std::max(little, usefulBound)},
                      near_);
}

std::optional<Vec3> PairProver::pointInside(std::size_t solid, std::size_t other,
                                            const Placement& X_SolidOther) const {
  const VerifyBody &s = problem_.bodies[solid], &o = problem_.bodies[other];
  if (!s.mesh || !s.solid) return std::nullopt;
  const auto shells = componentsOf(*s.mesh);
  std::vector<Vec3> points;
  for (const ConvexPart& part : o.parts) points.push_back(part.points[0]);
  if (o.mesh) {
    for (const auto& component : componentsOf(*o.mesh))
      points.push_back(o.mesh->corner(component[0], 0));
  }
  const BodyTree::Node& box = treeOf(solid).node(0);
  const RealVec lower = box.lower.cast<Real>(), upper = box.upper.cast<Real>();
  // A point outside of the mesh's bounding box is outside of the mesh. `margin` is far above all
  // rounding.
  const Real size = lower.norm() + upper.norm() + X_SolidOther.position.norm();
  for (const Vec3& point : points) {
    const RealVec p = X_SolidOther.rotation * point.cast<Real>() + X_SolidOther.position;
    const Real margin = 0x1p-30L * (size + p.norm());
    if ((lower - p).maxCoeff() > margin || (p - upper).maxCoeff() > margin) continue;
    if (insideAny(*s.mesh, shells, p)) return Vec3(p.cast<double>());
  }
  return std::nullopt;
}

std::optional<PairAnswer> PairProver::insideAtStart(std::size_t pair) {
  const Pair& p = pairs_[pair];
  const FrameState a = stateOf(0, p.chainA, 0), b = stateOf(0, p.chainB, 0);
  const RealMat backA = a.at.rotation.transpose(), backB = b.at.rotation.transpose();
  const Placement X_AB{backA * b.at.rotation, backA * (b.at.position - a.at.position)};
  const Placement X_BA{backB * a.at.rotation, backB * (a.at.position - b.at.position)};
  PairAnswer answer;
  answer.verdict = PathVerdict::refuted;
  answer.reason = "inside";
  answer.upper = 0;
  if (const auto inA = pointInside(p.a, p.b, X_AB))
    answer.point = inA->cast<Real>();
  else if (const auto inB = pointInside(p.b, p.a, X_BA))
    answer.point = X_AB.rotation * inB->cast<Real>() + X_AB.position;
  else
    return std::nullopt;
  return answer;
}

PathFinding PairProver::finding(const TimeInterval& interval, std::size_t pair,
                                const PairAnswer& answer) const {
  const Pair& p = pairs_[pair];
  const EdgeCurve& curve = curves_[interval.edge];
  PathFinding finding;
  finding.verdict = *answer.verdict;
  finding.edge = static_cast<int>(interval.edge);
  finding.t = static_cast<double>(interval.middle);
  finding.configuration = curve.configuration(interval.middle);
  finding.a = problem_.bodies[p.a].name;
  finding.b = problem_.bodies[p.b].name;
  finding.primitiveA = treeOf(p.a).leaf(answer.closest.a).number;
  finding.primitiveB = treeOf(p.b).leaf(answer.closest.b).number;
  const KinematicChain fromRoot = chainOf(*problem_.tree, 0, problem_.bodies[p.a].frame);
  const Placement X_WA = curve.at(fromRoot, interval.middle).at;
  finding.point = (X_WA.rotation * answer.point + X_WA.position).cast<double>();
  finding.gap = static_cast<double>(answer.upper);
  finding.required = static_cast<double>(p.margin);
  finding.reason = answer.reason;
  return finding;
}

}  // namespace corridor::verify
