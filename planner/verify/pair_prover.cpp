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
  states_ = states;
  edges_ = std::max<std::size_t>(states.size() - 1, 1);
  findFaults();
}

PairProver::PairProver(const PathProblem& problem, std::span<const CurvePiece> pieces)
    : PairProver(problem) {
  if (pieces.empty()) refuse("pieces must not be empty");
  for (const CurvePiece& piece : pieces) requireValid(problem, piece);
  pieces_ = pieces;
  edges_ = pieces.size();
  findFaults();
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
  reaches_.resize(pairs_.size(), {SIZE_MAX, {}});
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

bool PairProver::isValid(std::size_t edge) const {
  if (!pieces_.empty()) return isPiece(pieces_[edge]);
  return isState(states_[edge]) && isState(states_[std::min(edge + 1, states_.size() - 1)]);
}

EdgeCurve PairProver::curveOf(std::size_t edge, bool valid) const {
  const auto& coordinates = problem_.space->coordinates();
  const Eigen::Index size = problem_.tube.size();
  if (!pieces_.empty()) {
    const CurvePiece some{Eigen::MatrixXd::Ones(size, 2), pieces_[edge].error};
    return {*problem_.tree, coordinates, valid ? pieces_[edge] : some};
  }
  const Configuration some = Configuration::Ones(size);
  return {*problem_.tree, coordinates, valid ? states_[edge] : some,
          valid ? states_[std::min(edge + 1, states_.size() - 1)] : some};
}

const char* PairProver::faultOf(std::size_t edge, bool valid, const EdgeCurve& curve) const {
  if (!valid) return "not a valid state";
  if (!pieces_.empty()) {
    if (edge > 0 && isPiece(pieces_[edge - 1]) &&
        !joins(problem_.space->coordinates(), pieces_[edge - 1], pieces_[edge]))
      return "jump";
    return curve.ambiguous() ? "ambiguous half turn" : nullptr;
  }
  if (curve.ambiguous()) return "ambiguous half turn";
  if (curve.jumps())
    return "a joint that mimics a continuous joint would jump: the two angles of the continuous "
           "joint differ by more than half a turn";
  return nullptr;
}

void PairProver::findFaults() {
  for (std::size_t edge = 0; edge < edges_; ++edge) {
    const bool valid = isValid(edge);
    const char* const fault = faultOf(edge, valid, curveOf(edge, valid));
    if (!fault) continue;
    PathFinding& finding = noCurve_[edge];
    finding.verdict = PathVerdict::refuted;
    finding.edge = static_cast<int>(edge);
    finding.configuration = !pieces_.empty() ? Configuration(pieces_[edge].coefficients.col(0))
                            : isState(states_[edge]) && !valid
                                ? states_[std::min(edge + 1, states_.size() - 1)]
                                : states_[edge];
    finding.reason = fault;
  }
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

Reach PairProver::sumOf(std::size_t pair, const Configuration& tube, const Segment& segment) const {
  const Pair& p = pairs_[pair];
  Reach sum;
  for (const auto& [chainIndex, body] : {std::pair{p.chainA, p.a}, std::pair{p.chainB, p.b}}) {
    const Reach one = curve_->reach(chains_[chainIndex], treeOf(body).radius(), tube, segment);
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

const PairProver::PairReach& PairProver::reachOf(std::size_t edge, std::size_t pair) {
  enter(edge);
  auto& [ofEdge, reach] = reaches_[pair];
  if (ofEdge == edge) return reach;
  ofEdge = edge;
  reach = {};
  reach.sum = sumOf(pair, tube_, {});
  // Each chain has a rounding of up to 2^-50·size = 2^14·u·size. The relative placement, the boxes
  // (32u), the slabs (16u) and the displacements together add at most as much again.
  reach.rounding = 0x1p-49L * reach.sum.size;
  if (!pieces_.empty() && !pieces_[edge].error.isZero(0))
    reach.stray = sumOf(pair, pieces_[edge].error, {}).tube;
  reach.sharp =
      reach.rounding <= std::max<Real>(0x1p-48L * reach.sum.lengths, problem_.tolerance) &&
      reach.stray <= problem_.tolerance;
  return reach;
}

const Reach& PairProver::reach(const TimeInterval& interval, std::size_t pair) {
  enter(interval.edge);
  const Segment segment = curve_->segmentOf(interval.middle, interval.half);
  if (segment.depth == 0) return reachOf(interval.edge, pair).sum;
  const std::size_t place = (std::size_t(1) << segment.depth) + segment.index;
  const auto [known, isNew] = segments_.try_emplace({place, pair});
  if (isNew) known->second = sumOf(pair, tube_, segment);
  return known->second;
}

void PairProver::enter(std::size_t edge) {
  if (currentEdge_ == edge) return;
  for (auto& [time, unused] : frameStates_) time = -1;
  segments_.clear();
  curve_.emplace(curveOf(edge, isValid(edge)));
  tube_ = problem_.tube;
  for (Eigen::Index i = 0; i < tube_.size() && !pieces_.empty(); ++i)
    tube_[i] = sumUp(tube_[i], pieces_[edge].error[i]);
  currentEdge_ = edge;
}

const FrameState& PairProver::stateOf(std::size_t edge, std::size_t chainIndex, Real t) {
  enter(edge);
  auto& [time, state] = frameStates_[chainIndex];
  if (time != t) {
    state = curve_->at(chains_[chainIndex], t);
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
Real PairProver::leastInTube(std::size_t edge, std::size_t pair, const Measured& m) {
  const RealVec between = m.gap.onB - m.gap.onA;
  const auto isFixed = [&](std::size_t chain) {
    return std::ranges::none_of(chains_[chain].path,
                                [&](std::size_t f) { return problem_.tree->frames[f].moves(); });
  };
  std::size_t mover = pairs_[pair].chainB, other = pairs_[pair].chainA;
  if (isFixed(mover)) std::swap(mover, other);
  const Real error = reachOf(edge, pair).stray, farthest = m.gap.upper + error;
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
const char* PairProver::whyRefuted(std::size_t edge, std::size_t pair, const Measured& m) {
  const PairReach& reach = reachOf(edge, pair);
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
  const PairReach& whole = reachOf(interval.edge, open.pair);
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
  const Real half = interval.half;
  PairMotion motion;
  motion.half = half;
  motion.motionBound = bounds.speed * half;
  motion.tube = bounds.tube;
  motion.rounding = reachOf(interval.edge, pair).rounding;
  Perturbation a, b;
  motion.secondOrder = secondOrder(bounds, half);
  if (tubeMatters(bounds)) {
    a = curve_->perturbationAt(chains_[pairs_[pair].chainA], interval.middle, tube_);
    b = curve_->perturbationAt(chains_[pairs_[pair].chainB], interval.middle, tube_);
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
                                const PairAnswer& answer) {
  const Pair& p = pairs_[pair];
  enter(interval.edge);
  PathFinding finding;
  finding.verdict = *answer.verdict;
  finding.edge = static_cast<int>(interval.edge);
  finding.t = static_cast<double>(interval.middle);
  finding.configuration = curve_->configuration(interval.middle);
  finding.a = problem_.bodies[p.a].name;
  finding.b = problem_.bodies[p.b].name;
  finding.primitiveA = treeOf(p.a).leaf(answer.closest.a).number;
  finding.primitiveB = treeOf(p.b).leaf(answer.closest.b).number;
  const KinematicChain fromRoot = chainOf(*problem_.tree, 0, problem_.bodies[p.a].frame);
  const Placement X_WA = curve_->at(fromRoot, interval.middle).at;
  finding.point = (X_WA.rotation * answer.point + X_WA.position).cast<double>();
  finding.gap = static_cast<double>(answer.upper);
  finding.required = static_cast<double>(p.margin);
  finding.reason = answer.reason;
  return finding;
}

}  // namespace corridor::verify
