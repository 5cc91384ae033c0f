#include "planner/verify/verify_path.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <stdexcept>

#include "planner/verify/box_tree.h"
#include "planner/verify/edge_curve.h"
#include "planner/verify/moved_slab.h"
#include "planner/verify/winding.h"

namespace corridor {
namespace {

using namespace verify;

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
constexpr int kFindings = 100;
/// Halvings of an edge: t keeps 60 bits, which EdgeCurve's count of roundings allows.
constexpr int kDepth = 60;
/// Every edge is first looked at in 2^kCoarse parts, the worst first, so that a deep collision is
/// found at once. Then the deepest part is next, so that a place that can't be decided is found
/// without halving all others as far.
constexpr int kCoarse = 5;
/// Once all is proved, the bound of the clearance may take this many queries more, and four times
/// those of the proof.
constexpr std::uint64_t kRefinement = 4000;
constexpr Real kRefined = 0.9L;

/// A pair of bodies along one edge: what its reach weights allow.
struct PairReach {
  Reach sum;
  Real rounding = 0;  ///< metres; of every computed distance and displacement
  bool sharp = true;  ///< a contact at a computed pose says something about the path
};

constexpr const char* kTooLarge = "value too large: its rounding exceeds the clearance";

/// A pair of bodies in a part of an edge.
struct OpenPair {
  std::size_t pair = 0;
  PiecePair guess;
  Real bound = -kInfinity;  ///< proved: the clearance of every curve in the tube, all over the part
};

/// A part of an edge, to be looked at at its middle.
struct Interval {
  std::size_t edge = 0;
  int depth = 0;  ///< half = 2^-(depth + 1), unless it is a single t
  Real middle = 0.5L, half = 0.5L;
  std::vector<OpenPair> pairs;  ///< not proved yet
  Real bound = -kInfinity;      ///< the least of theirs
};

struct NextOnTop {
  bool operator()(const Interval& a, const Interval& b) const {
    const bool coarseA = a.depth < kCoarse, coarseB = b.depth < kCoarse;
    if (coarseA != coarseB) return coarseB;
    return coarseA || a.depth == b.depth ? a.bound > b.bound : a.depth < b.depth;
  }
};
struct WorstOnTop {
  bool operator()(const Interval& a, const Interval& b) const { return a.bound > b.bound; }
};

/// A pair as it was measured at a time.
struct Measured {
  BodyGap gap;
  FrameState a, b;
};

class Verifier {
 public:
  Verifier(const PathProblem& problem, const std::vector<Configuration>& states);
  PathReport run();

 private:
  struct Pair {
    std::size_t a, b, limbA, limbB;
  };
  void require(const std::vector<Configuration>& states) const;
  bool isState(const Configuration& state) const;
  std::size_t limb(std::size_t base, std::size_t frame);
  const FrameState& stateOf(std::size_t edge, std::size_t limb, Real t);
  PairReach reachOf(std::size_t edge, std::size_t pair) const;
  /// Looks at one pair in [middle − half, middle + half]: its bound, unless the edge is refuted.
  Real look(const Interval& part, OpenPair& pair);
  /// The bound by a slab for each pair of pieces that comes near.
  Real lookClosely(const Interval& part, std::size_t pair, const Measured& m);
  const char* whyRefuted(const PairReach& reach, std::size_t pair, const Measured& m) const;
  const char* whyStuck(const PairReach& reach, const Measured& m) const;
  /// Bounding the tube by direction may bring a verdict: it takes more than the tolerance.
  bool tubeMatters(const PairReach& reach) const { return reach.sum.tube > problem_.tolerance; }
  void close(const Interval& part, std::size_t pair, const Measured& m, PathVerdict verdict,
             const std::string& reason);
  void closeInvalid(std::size_t edge, const Configuration& state, const std::string& reason);
  bool closed(std::size_t edge) const { return findings_.count(static_cast<int>(edge)) > 0; }
  /// Looks at all pairs of `part`; what isn't proved stays in it.
  void lookAtAll(Interval& part);
  void proveStates();
  void proveEdge(std::size_t edge);
  void proveOutside();
  std::optional<Vec3> pointInside(std::size_t solid, std::size_t other,
                                  const Placement& X_SolidOther);
  void refine();
  Real leastInTube(std::size_t pair, const Measured& m) const;
  /// Bounds beyond this tell nothing more about the clearance.
  Real interesting() const { return kRefined * smallest_; }

  const PathProblem& problem_;
  const std::vector<Configuration>& states_;
  std::vector<BoxTree> trees_;
  std::vector<Limb> limbs_;
  std::vector<Pair> pairs_;
  std::vector<EdgeCurve> curves_;
  std::vector<std::vector<PairReach>> reaches_;           // [edge][pair]
  std::vector<std::pair<Real, FrameState>> frameStates_;  // of each limb, at a time of edgeAt_
  std::size_t edgeAt_ = SIZE_MAX;
  BodyDistance distance_;
  std::vector<PiecePair> near_;
  std::priority_queue<Interval, std::vector<Interval>, WorstOnTop> proved_;  // one pair each
  std::map<int, PathFinding> findings_;
  std::optional<Vec3> contact_;  ///< of the last measurement, in a's frame
  Real smallest_ = kInfinity, leastAtStates_ = kInfinity;
  std::uint64_t queries_ = 0;
};

void Verifier::require(const std::vector<Configuration>& states) const {
  const auto refuse = [](const std::string& what) {
    throw std::invalid_argument("verifyPath: " + what);
  };
  if (!problem_.tree || !problem_.space) refuse("no tree or no space");
  if (states.empty()) refuse("no states");
  if (!(problem_.margin >= 0 && std::isfinite(problem_.margin)))
    refuse("margin must be finite and not negative");
  if (!(problem_.tolerance > 0 && std::isfinite(problem_.tolerance)))
    refuse("tolerance must be finite and positive");
  if (static_cast<std::size_t>(problem_.tube.size()) != problem_.space->size())
    refuse("tube must have a number for each of a configuration's");
  if (!problem_.tube.allFinite() || (problem_.tube.array() < 0).any())
    refuse("tube must be finite and not negative");
  for (const VerifyBody& body : problem_.bodies)
    if ((body.mesh == nullptr) == (body.part == nullptr) ||
        (body.mesh && body.mesh->triangles.empty()) || (body.part && body.part->points.empty()))
      refuse("body " + body.name + " needs a mesh or a part");
  for (const VerifyPair& pair : problem_.pairs)
    if (pair.a >= problem_.bodies.size() || pair.b >= problem_.bodies.size())
      refuse("a pair names a body that isn't there");
}

Verifier::Verifier(const PathProblem& problem, const std::vector<Configuration>& states)
    : problem_(problem), states_(states) {
  require(states);
  trees_.reserve(problem.bodies.size());
  for (const VerifyBody& body : problem.bodies)
    body.mesh ? trees_.emplace_back(*body.mesh) : trees_.emplace_back(*body.part);
  for (const VerifyPair& pair : problem.pairs) {
    const std::size_t fa = problem.bodies[pair.a].frame, fb = problem.bodies[pair.b].frame;
    const std::size_t base = commonAncestor(*problem.tree, fa, fb);
    pairs_.push_back({pair.a, pair.b, limb(base, fa), limb(base, fb)});
  }
  frameStates_.resize(limbs_.size());
  const std::size_t edges = std::max<std::size_t>(states.size() - 1, 1);
  for (std::size_t e = 0; e < edges; ++e) {
    const Configuration &from = states[e], &to = states[std::min(e + 1, states.size() - 1)];
    const bool valid = isState(from) && isState(to);
    const Configuration zero = Configuration::Ones(problem.tube.size());
    curves_.emplace_back(*problem.tree, problem.space->coordinates(), valid ? from : zero,
                         valid ? to : zero);
    if (!valid) {
      closeInvalid(e, isState(from) ? to : from, "not a state");
    } else if (curves_.back().ambiguous()) {
      closeInvalid(e, from, "ambiguous half turn");
    } else if (curves_.back().jumps()) {
      closeInvalid(e, from, "a joint that mimics a full circle by a fraction would jump");
    }
    std::vector<PairReach> reaches;
    for (std::size_t p = 0; p < pairs_.size(); ++p) reaches.push_back(reachOf(e, p));
    reaches_.push_back(std::move(reaches));
  }
}

bool Verifier::isState(const Configuration& state) const {
  if (static_cast<std::size_t>(state.size()) != problem_.space->size() || !state.allFinite())
    return false;
  for (const Coordinate& c : problem_.space->coordinates())
    if (c.kind == Coordinate::Kind::rotation &&
        state.segment<4>(static_cast<Eigen::Index>(c.first)).isZero(0))
      return false;
  return true;
}

std::size_t Verifier::limb(std::size_t base, std::size_t frame) {
  for (std::size_t i = 0; i < limbs_.size(); ++i)
    if (limbs_[i].base == base && limbs_[i].frame == frame) return i;
  limbs_.push_back(limbOf(*problem_.tree, base, frame));
  return limbs_.size() - 1;
}

PairReach Verifier::reachOf(std::size_t edge, std::size_t pair) const {
  const Pair& p = pairs_[pair];
  PairReach reach;
  Reach& sum = reach.sum;
  for (const auto& [limb, body] : {std::pair{p.limbA, p.a}, std::pair{p.limbB, p.b}}) {
    const Reach one = curves_[edge].reach(limbs_[limb], trees_[body].radius(), problem_.tube);
    sum.speed += one.speed;
    sum.bend += one.bend;
    sum.tube += one.tube;
    sum.bendCross += one.bendCross;
    sum.bendTube += one.bendTube;
    sum.size += one.size;
    sum.lengths += one.lengths;
  }
  // 2^-50 = 2^14 u for each limb; the relative placement, the boxes (32u) and the slabs (16u) and
  // displacements of as much.
  reach.rounding = 0x1p-49L * sum.size;
  reach.sharp = reach.rounding <= std::max<Real>(0x1p-48L * sum.lengths, problem_.tolerance);
  return reach;
}

const FrameState& Verifier::stateOf(std::size_t edge, std::size_t limb, Real t) {
  if (edgeAt_ != edge) {
    for (auto& [time, unused] : frameStates_) time = -1;
    edgeAt_ = edge;
  }
  auto& [time, state] = frameStates_[limb];
  if (time != t) {
    state = curves_[edge].at(limbs_[limb], t);
    time = t;
  }
  return state;
}

void Verifier::closeInvalid(std::size_t edge, const Configuration& state,
                            const std::string& reason) {
  PathFinding finding;
  finding.verdict = PathVerdict::refuted;
  finding.edge = static_cast<int>(edge);
  finding.configuration = state;
  finding.reason = reason;
  findings_.emplace(finding.edge, finding);
}

void Verifier::close(const Interval& part, std::size_t pair, const Measured& m, PathVerdict verdict,
                     const std::string& reason) {
  const Pair& p = pairs_[pair];
  PathFinding finding;
  finding.verdict = verdict;
  finding.edge = static_cast<int>(part.edge);
  finding.t = static_cast<double>(part.middle);
  finding.configuration = curves_[part.edge].configuration(part.middle);
  finding.a = problem_.bodies[p.a].name;
  finding.b = problem_.bodies[p.b].name;
  finding.triangleA = trees_[p.a].piece(m.gap.pair.a).triangle;
  finding.triangleB = trees_[p.b].piece(m.gap.pair.b).triangle;
  const FrameState world =
      curves_[part.edge].at(limbOf(*problem_.tree, 0, problem_.bodies[p.a].frame), part.middle);
  const RealVec point = contact_ ? RealVec(contact_->cast<Real>()) : m.gap.onB;
  finding.point = (world.at.rotation * point + world.at.position).cast<double>();
  finding.gap = static_cast<double>(m.gap.upper);
  finding.reason = reason;
  findings_.emplace(finding.edge, finding);
}

/// How close the two closest points come when a body that shifts as a whole is displaced within the
/// tube, in the plane only where it can't leave it.
Real Verifier::leastInTube(std::size_t pair, const Measured& m) const {
  const RealVec between = m.gap.onB - m.gap.onA;
  const Limb& limb = limbs_[pairs_[pair].limbB];
  if (limb.path.empty() || !limbs_[pairs_[pair].limbA].path.empty()) return m.gap.upper;
  const Frame& frame = problem_.tree->frames[limb.path.front()];
  if (frame.joint != Frame::Joint::shift) return m.gap.upper;
  const auto first = static_cast<Eigen::Index>(frame.variable);
  const Real stray =
      problem_.tube.segment(first, static_cast<Eigen::Index>(frame.count)).minCoeff();
  Real across = 0;
  if (frame.count == 2) {
    const Eigen::Quaternion<Real> q(frame.fixed.q.cast<Real>());
    across = std::abs(between.dot(q.normalized() * RealVec::UnitZ()));
  }
  const Real along = std::sqrt(std::max<Real>(0, between.squaredNorm() - across * across));
  return std::hypot(std::max<Real>(along - stray, 0), across);
}

/// Why the path is refuted at these poses; null: it is not. Poses that may be far from the path
/// refute nothing: then the reason is why they leave it undecided.
const char* Verifier::whyRefuted(const PairReach& reach, std::size_t pair,
                                 const Measured& m) const {
  if (!reach.sharp) return m.gap.upper <= problem_.margin + reach.rounding ? kTooLarge : nullptr;
  if (m.gap.touching) return "contact";
  if (problem_.margin > 0 && m.gap.upper <= problem_.margin) return "closer than the margin";
  // A curve of the tube is the path displaced so far: it touches, or comes as close as the margin.
  if (std::isfinite(m.gap.upper) && leastInTube(pair, m) <= problem_.margin)
    return "closer than the tube allows";
  return nullptr;
}

/// Why no shorter interval about these poses can be proved.
const char* Verifier::whyStuck(const PairReach& reach, const Measured& m) const {
  const Real clear = m.gap.lower - problem_.margin;
  if (clear - reach.rounding > problem_.tolerance) return "the tube may take all of the clearance";
  return clear > problem_.tolerance ? kTooLarge : "clearance below the tolerance";
}

Real Verifier::look(const Interval& part, OpenPair& open) {
  const Pair& p = pairs_[open.pair];
  const PairReach& reach = reaches_[part.edge][open.pair];
  Measured m;
  m.a = stateOf(part.edge, p.limbA, part.middle);
  m.b = stateOf(part.edge, p.limbB, part.middle);
  const RealMat back = m.a.at.rotation.transpose();
  const Placement X_AB{back * m.b.at.rotation, back * (m.b.at.position - m.a.at.position)};
  distance_.place(trees_[p.a], trees_[p.b], X_AB);
  const Real travel = reach.sum.speed * part.half, pad = reach.sum.tube + reach.rounding;
  const Real wanted = std::max<Real>(problem_.margin, interesting());
  contact_.reset();
  ++queries_;
  m.gap = distance_.measure(open.guess, reach.sharp ? reach.rounding : 0,
                            wanted + travel + pad + reach.rounding, [&](PiecePair pieces) {
                              if (!reach.sharp) return false;
                              const Piece &a = trees_[p.a].piece(pieces.a),
                                          &b = trees_[p.b].piece(pieces.b);
                              if (a.part || b.part)
                                return distance_.gap(pieces).upper <= reach.rounding;
                              RigidPose pose;
                              pose.p = X_AB.position.cast<double>();
                              pose.q = Eigen::Quaternion<Real>(X_AB.rotation).cast<double>();
                              contact_ = exactContact(pose, b.corners, a.corners);
                              return contact_.has_value();
                            });
  open.guess = m.gap.pair;
  smallest_ = std::min(smallest_, m.gap.upper);
  if (const char* why = whyRefuted(reach, open.pair, m)) {
    close(part, open.pair, m, reach.sharp ? PathVerdict::refuted : PathVerdict::undecided, why);
  } else {
    open.bound = std::max(open.bound, m.gap.lower - travel - pad);
    if (open.bound <= problem_.margin && (part.half > 0 || tubeMatters(reach)))
      open.bound = std::max(open.bound, lookClosely(part, open.pair, m));
    if (open.bound <= problem_.margin && (travel <= problem_.tolerance || part.depth >= kDepth))
      close(part, open.pair, m, PathVerdict::undecided, whyStuck(reach, m));
    else if (open.bound <= problem_.margin && queries_ >= problem_.workLimit)
      close(part, open.pair, m, PathVerdict::undecided, "work limit reached");
  }
  return open.bound;
}

Real Verifier::lookClosely(const Interval& part, std::size_t pair, const Measured& m) {
  const PairReach& reach = reaches_[part.edge][pair];
  const Real half = part.half;
  PairMotion motion;
  motion.half = half;
  motion.travel = reach.sum.speed * half;
  motion.tube = reach.sum.tube;
  motion.rounding = reach.rounding;
  Strays a, b;
  if (tubeMatters(reach)) {
    const EdgeCurve& curve = curves_[part.edge];
    a = curve.straysAt(limbs_[pairs_[pair].limbA], part.middle, problem_.tube);
    b = curve.straysAt(limbs_[pairs_[pair].limbB], part.middle, problem_.tube);
    motion.secondOrder =
        (half * half * reach.sum.bend + half * reach.sum.bendCross + reach.sum.bendTube) / 2;
  } else {
    motion.secondOrder = half * half * reach.sum.bend / 2 + reach.sum.tube;
  }
  motion.a = motionSeenFrom(m.a.at, m.a, std::move(a));
  motion.b = motionSeenFrom(m.a.at, m.b, std::move(b));
  const Real little = problem_.margin + problem_.tolerance;
  return boundBySlabs(distance_, m.gap, motion,
                      {problem_.margin, little, std::max(little, interesting())}, near_);
}

void Verifier::lookAtAll(Interval& part) {
  std::vector<OpenPair> left;
  part.bound = kInfinity;
  for (OpenPair& open : part.pairs) {
    const Real bound = look(part, open);
    if (closed(part.edge)) return;
    if (bound <= problem_.margin) {
      left.push_back(open);
      part.bound = std::min(part.bound, bound);
    } else if (part.half == 0) {
      leastAtStates_ = std::min(leastAtStates_, bound);
    } else if (bound < interesting()) {
      proved_.push({part.edge, part.depth, part.middle, part.half, {open}, bound});
    }
  }
  part.pairs = std::move(left);
}

/// The states first, and what is closest there: bisection alone comes only close to them, and what
/// is known of the clearance then tells what needn't be looked at.
void Verifier::proveStates() {
  for (std::size_t edge = 0; edge < curves_.size(); ++edge)
    for (const Real t : {0, 1}) {
      if (closed(edge) || (t == 0 && edge > 0 && !closed(edge - 1))) continue;  // seen
      Interval state{edge, 0, t, 0, {}, -kInfinity};
      for (std::size_t p = 0; p < pairs_.size(); ++p) state.pairs.push_back({p, {}, -kInfinity});
      lookAtAll(state);
    }
}

void Verifier::proveEdge(std::size_t edge) {
  std::priority_queue<Interval, std::vector<Interval>, NextOnTop> open;
  Interval whole;
  whole.edge = edge;
  for (std::size_t p = 0; p < pairs_.size(); ++p) whole.pairs.push_back({p, {}, -kInfinity});
  lookAtAll(whole);
  if (!closed(edge) && !whole.pairs.empty()) open.push(std::move(whole));
  while (!open.empty()) {
    const Interval part = open.top();
    open.pop();
    for (const int side : {-1, 1}) {
      Interval child{edge,          part.depth + 1, part.middle + side * part.half / 2,
                     part.half / 2, part.pairs,     -kInfinity};
      lookAtAll(child);
      if (closed(edge)) return;
      if (!child.pairs.empty()) open.push(std::move(child));
    }
  }
}

std::optional<Vec3> Verifier::pointInside(std::size_t solid, std::size_t other,
                                          const Placement& X_SolidOther) {
  const VerifyBody &s = problem_.bodies[solid], &o = problem_.bodies[other];
  if (!s.mesh || !s.solid) return std::nullopt;
  const auto shells = componentsOf(*s.mesh);
  std::vector<Vec3> points;
  if (o.part) {
    points.push_back(o.part->points[0]);
  } else {
    for (const auto& component : componentsOf(*o.mesh))
      points.push_back(o.mesh->corner(component[0], 0));
  }
  for (const Vec3& point : points) {
    const RealVec p = X_SolidOther.rotation * point.cast<Real>() + X_SolidOther.position;
    if (insideAny(*s.mesh, shells, p)) return Vec3(p.cast<double>());
  }
  return std::nullopt;
}

/// Along a path that touches nothing, whoever is outside at the start stays there.
void Verifier::proveOutside() {
  for (std::size_t i = 0; i < pairs_.size() && !closed(0); ++i) {
    const Pair& p = pairs_[i];
    const FrameState a = stateOf(0, p.limbA, 0), b = stateOf(0, p.limbB, 0);
    const RealMat backA = a.at.rotation.transpose(), backB = b.at.rotation.transpose();
    const Placement X_AB{backA * b.at.rotation, backA * (b.at.position - a.at.position)};
    const Placement X_BA{backB * a.at.rotation, backB * (a.at.position - b.at.position)};
    Measured m;
    m.a = a;
    m.b = b;
    m.gap.upper = 0;
    if (auto inA = pointInside(p.a, p.b, X_AB)) {
      contact_ = inA;
    } else if (auto inB = pointInside(p.b, p.a, X_BA)) {
      contact_ = Vec3((X_AB.rotation * inB->cast<Real>() + X_AB.position).cast<double>());
    } else {
      continue;
    }
    close({0, 0, 0, 0, {}, 0}, i, m, PathVerdict::refuted, "inside");
  }
}

void Verifier::refine() {
  const std::uint64_t limit = 5 * queries_ + kRefinement;
  while (!proved_.empty() && queries_ < limit) {
    const Interval worst = proved_.top();
    const PairReach& reach = reaches_[worst.edge][worst.pairs[0].pair];
    if (worst.bound >= kRefined * (smallest_ - reach.sum.tube) ||
        reach.sum.speed * worst.half <= problem_.tolerance || worst.depth >= kDepth)
      break;
    proved_.pop();
    for (const int side : {-1, 1}) {
      Interval child{worst.edge,     worst.depth + 1, worst.middle + side * worst.half / 2,
                     worst.half / 2, worst.pairs,     worst.bound};
      OpenPair& open = child.pairs[0];
      child.bound = look(child, open);
      if (closed(worst.edge)) return;  // the halves saw what the whole didn't
      proved_.push(std::move(child));
    }
  }
}

PathReport Verifier::run() {
  proveStates();
  if (!closed(0)) proveOutside();
  for (std::size_t edge = 0; edge < curves_.size(); ++edge)
    if (!closed(edge) && states_.size() > 1) proveEdge(edge);
  if (findings_.empty()) refine();
  PathReport report;
  report.edges = static_cast<int>(curves_.size());
  report.edgesProved = report.edges - static_cast<int>(findings_.size());
  if (findings_.empty()) {
    // What isn't in `proved_` had a bound that was `interesting()` or more, which only falls.
    Real least = states_.size() > 1 ? interesting() : leastAtStates_;
    if (!proved_.empty()) least = std::min(least, proved_.top().bound);
    least = std::max<Real>(least, problem_.margin);
    report.provenClearance = static_cast<double>(least);
    if (report.provenClearance > least)  // to the nearest double: down, if that was up
      report.provenClearance = std::nextafter(report.provenClearance, 0);
  }
  for (const auto& [edge, finding] : findings_) {
    if (finding.verdict == PathVerdict::refuted) report.verdict = PathVerdict::refuted;
    if (report.verdict == PathVerdict::proved) report.verdict = PathVerdict::undecided;
    if (report.findings.size() < std::size_t{kFindings}) report.findings.push_back(finding);
  }
  report.smallestDistanceMet = static_cast<double>(smallest_);
  report.distanceQueries = queries_;
  return report;
}

}  // namespace

PathReport verifyPath(const PathProblem& problem, const std::vector<Configuration>& states) {
  const FloatingPoint arithmetic = floatingPoint();
  if (arithmetic == FloatingPoint::standard) return Verifier(problem, states).run();
  PathReport report;
  report.verdict = PathVerdict::undecided;
  report.edges = static_cast<int>(std::max<std::size_t>(states.size(), 2)) - 1;
  for (int edge = 0; edge < std::min(report.edges, kFindings); ++edge) {
    PathFinding& finding = report.findings.emplace_back();
    finding.edge = edge;
    if (!states.empty()) finding.configuration = states[static_cast<std::size_t>(edge)];
    finding.reason = described(arithmetic);
  }
  return report;
}

}  // namespace corridor
