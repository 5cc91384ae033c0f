#include "planner/verify/verify_path.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <queue>
#include <stdexcept>

#include "planner/verify/box_tree.h"
#include "planner/verify/edge_curve.h"

namespace corridor {
namespace {

using namespace verify;

constexpr std::size_t kFindings = 100;
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

std::vector<SoupTriangle> soupOf(const std::vector<VerifyBody>& bodies) {
  std::vector<SoupTriangle> soup;
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    if (!bodies[i].mesh) throw std::invalid_argument("verifyPath: body without a mesh");
    const TriangleMesh& mesh = *bodies[i].mesh;
    for (std::uint32_t j = 0; j < mesh.triangles.size(); ++j) {
      soup.push_back({{mesh.corner(j, 0), mesh.corner(j, 1), mesh.corner(j, 2)}, i, j});
    }
  }
  return soup;
}

/// Radius about `centre` of all corners, rounded up.
Real radiusAbout(const RealVec& centre, const std::vector<SoupTriangle>& soup) {
  Real radius = 0;
  for (const SoupTriangle& triangle : soup) {
    for (const Vec3& corner : triangle.corners) {
      radius = std::max(radius, (corner.cast<Real>() - centre).norm());
    }
  }
  return radius * (1 + 0x1p-60L);
}

RealVec middleOf(const BoxTree& tree) {
  if (tree.empty()) return RealVec::Zero();
  return (tree.node(0).lower.cast<Real>() + tree.node(0).upper.cast<Real>()) / 2;
}

void requireLength(double value, const char* name) {
  if (!(value >= 0 && std::isfinite(value))) {
    throw std::invalid_argument(std::string("verifyPath: ") + name +
                                " must be finite and not negative");
  }
}

/// A part of an edge, measured at its middle.
struct Interval {
  int edge = 0;
  int depth = 0;  ///< half = 2^-(depth + 1), unless it is a single t
  Real middle = 0, half = 0;
  Real bound = 0;  ///< proved: the clearance of every curve in the tube, all over the interval
  SoupGap gap;     ///< at the middle
};

struct WorstOnTop {
  bool operator()(const Interval& a, const Interval& b) const { return a.bound > b.bound; }
};

struct NextOnTop {
  bool operator()(const Interval& a, const Interval& b) const {
    const bool coarseA = a.depth < kCoarse, coarseB = b.depth < kCoarse;
    if (coarseA != coarseB) return coarseB;
    return coarseA || a.depth == b.depth ? a.bound > b.bound : a.depth < b.depth;
  }
};

class Verifier {
 public:
  Verifier(const PathProblem& problem, const std::vector<PathState>& states, bool planar)
      : problem_(problem),
        planar_(planar),
        moving_(soupOf(problem.moving)),
        fixed_(soupOf(problem.fixed)),
        distance_(moving_, fixed_) {
    requireLength(problem.margin, "margin");
    requireLength(problem.tolerance, "tolerance");
    requireLength(problem.tube.position, "tube.position");
    requireLength(problem.tube.rotation, "tube.rotation");
    if (states.empty()) throw std::invalid_argument("verifyPath: no states");

    reach_ = radiusAbout(RealVec::Zero(), moving_.triangles());
    fixedSize_ = radiusAbout(RealVec::Zero(), fixed_.triangles());
    tolerance_ = problem.tolerance;
    if (tolerance_ == 0) {
      tolerance_ = 1e-7L * std::min(radiusAbout(middleOf(moving_), moving_.triangles()),
                                    radiusAbout(middleOf(fixed_), fixed_.triangles()));
    }
    // A displacement of each coordinate by ≤ τ moves a point by ≤ √3τ (√2τ in the plane), a
    // rotation by ≤ ρ by the chord.
    const Real rotation = std::min<Real>(problem.tube.rotation, 2);
    tube_ = (std::sqrt(Real(planar ? 2 : 3)) * problem.tube.position + rotation * reach_) *
            (1 + 0x1p-60L);
    for (std::size_t i = 0; i + 1 < states.size(); ++i) addEdge(states[i], states[i + 1]);
    if (states.size() == 1) addEdge(states[0], states[0]);
  }

  PathReport run();

 private:
  void addEdge(const PathState& from, const PathState& to);
  bool isState(const PathState& state) const;
  /// Measures `part` at its middle, and closes the edge if that refutes it.
  void measure(Interval& part, TrianglePair guess, Real atLeast);
  void close(const Interval& part, PathVerdict verdict, const std::string& reason);
  void closeInvalid(int edge, const PathState& state, const std::string& reason);
  bool closed(int edge) const { return findings_.count(edge) > 0; }
  /// Halves `part` and keeps the halves, unless they refute the edge.
  void bisect(const Interval& part);
  void keep(const Interval& part);
  void prove();
  void refine();
  /// How close the two closest points come when the body is displaced within the tube by at most
  /// tube.position, in the plane only where it can't leave it.
  Real leastInTube(const SoupGap& gap) const;
  Real travel(const Interval& part) const { return curves_[part.edge].travel(part.half, reach_); }

  const PathProblem& problem_;
  bool planar_;
  BoxTree moving_, fixed_;
  SoupDistance distance_;
  Real reach_ = 0, fixedSize_ = 0, tolerance_ = 0, tube_ = 0;
  std::vector<EdgeCurve> curves_;
  std::priority_queue<Interval, std::vector<Interval>, NextOnTop> open_;
  std::priority_queue<Interval, std::vector<Interval>, WorstOnTop> proved_;
  std::map<int, PathFinding> findings_;
  std::optional<Vec3> contact_;  ///< of the last measurement
  Real smallest_ = std::numeric_limits<Real>::infinity();
  std::uint64_t queries_ = 0;
};

bool Verifier::isState(const PathState& state) const {
  if (planar_) return state.xyYaw.allFinite();
  return state.pose.p.allFinite() && state.pose.q.coeffs().allFinite() &&
         !state.pose.q.coeffs().isZero(0);
}

void Verifier::addEdge(const PathState& from, const PathState& to) {
  const int edge = static_cast<int>(curves_.size());
  const bool valid = isState(from) && isState(to);
  curves_.emplace_back(valid ? from : PathState{}, valid ? to : PathState{}, planar_);
  if (!valid) {
    closeInvalid(edge, isState(from) ? to : from, "not a state");
  } else if (curves_.back().ambiguous()) {
    closeInvalid(edge, from, "ambiguous half turn");
  }
}

void Verifier::closeInvalid(int edge, const PathState& state, const std::string& reason) {
  PathFinding finding;
  finding.verdict = PathVerdict::refuted;
  finding.edge = edge;
  finding.pose = state.pose;
  if (planar_) {
    finding.pose.p = {state.xyYaw.x(), state.xyYaw.y(), 0};
    finding.pose.q = Eigen::AngleAxisd(state.xyYaw.z(), Vec3::UnitZ());
    finding.yaw = state.xyYaw.z();
  }
  finding.reason = reason;
  findings_.emplace(edge, finding);
}

void Verifier::close(const Interval& part, PathVerdict verdict, const std::string& reason) {
  const EdgeCurve::At at = curves_[part.edge].at(part.middle);
  PathFinding finding;
  finding.verdict = verdict;
  finding.edge = part.edge;
  finding.t = static_cast<double>(part.middle);
  finding.pose = at.pose;
  finding.yaw = at.yaw;
  const SoupTriangle& a = moving_.triangle(part.gap.pair.moving);
  const SoupTriangle& b = fixed_.triangle(part.gap.pair.fixed);
  finding.moving = problem_.moving[a.mesh].name;
  finding.fixed = problem_.fixed[b.mesh].name;
  finding.movingTriangle = a.triangle;
  finding.fixedTriangle = b.triangle;
  finding.point = contact_ ? *contact_ : Vec3(part.gap.onFixed.cast<double>());
  finding.gap = static_cast<double>(part.gap.upper);
  finding.reason = reason;
  findings_.emplace(part.edge, finding);
}

Real Verifier::leastInTube(const SoupGap& gap) const {
  if (std::isinf(gap.upper)) return gap.upper;  // one side is empty
  const RealVec between = gap.onFixed - gap.onMoving;
  const Real across = planar_ ? std::abs(between.z()) : 0;
  const Real along = planar_ ? between.head<2>().norm() : gap.upper;
  return std::hypot(std::max<Real>(along - problem_.tube.position, 0), across);
}

void Verifier::measure(Interval& part, TrianglePair guess, Real atLeast) {
  const EdgeCurve& curve = curves_[part.edge];
  const EdgeCurve::At at = curve.at(part.middle);
  // 2^-50 = 2^14 u: the placement, the boxes (32u) and the slabs (16u) of the same size.
  const Real rounding = 0x1p-50L * (curve.size(reach_) + fixedSize_);
  contact_.reset();
  part.gap = distance_.measure(at.placement, guess, rounding, [&](TrianglePair pair) {
    contact_ = exactContact(at.pose, moving_.triangle(pair.moving).corners,
                            fixed_.triangle(pair.fixed).corners);
    return contact_.has_value();
  });
  ++queries_;
  smallest_ = std::min(smallest_, part.gap.upper);
  part.bound = std::max(atLeast, part.gap.lower - travel(part) - tube_ - rounding);
  if (part.gap.touching) {
    close(part, PathVerdict::refuted, "contact");
  } else if (problem_.margin > 0 && part.gap.upper <= problem_.margin) {
    close(part, PathVerdict::refuted, "closer than the margin");
  } else if (leastInTube(part.gap) <= problem_.margin) {
    // A curve of the tube is the path displaced so far: it touches, or comes as close as the
    // margin.
    close(part, PathVerdict::refuted, "closer than the tube allows");
  }
}

void Verifier::keep(const Interval& part) {
  if (part.bound > problem_.margin) {
    proved_.push(part);
  } else {
    open_.push(part);
  }
}

void Verifier::bisect(const Interval& part) {
  for (const int side : {-1, 1}) {
    Interval child;
    child.edge = part.edge;
    child.depth = part.depth + 1;
    child.half = part.half / 2;
    child.middle = part.middle + side * child.half;
    measure(child, part.gap.pair, part.bound);
    if (closed(part.edge)) return;
    keep(child);
  }
}

void Verifier::prove() {
  const Real nothingKnown = -std::numeric_limits<Real>::infinity();
  for (int edge = 0; edge < static_cast<int>(curves_.size()); ++edge) {
    // The states first: bisection alone comes only close to them.
    for (const Real t : {0, 1}) {
      Interval state;
      state.edge = edge;
      state.middle = t;
      if (!closed(edge)) measure(state, {}, nothingKnown);
    }
    Interval whole;
    whole.edge = edge;
    whole.middle = whole.half = 0.5L;
    if (!closed(edge)) measure(whole, {}, nothingKnown);
    if (!closed(edge)) keep(whole);
  }
  while (!open_.empty()) {
    const Interval part = open_.top();
    open_.pop();
    if (closed(part.edge)) continue;
    contact_.reset();
    if (travel(part) <= tolerance_ || part.depth >= kDepth) {
      close(part, PathVerdict::undecided, "clearance below the tolerance");
    } else if (queries_ >= problem_.workLimit) {
      close(part, PathVerdict::undecided, "work limit reached");
    } else {
      bisect(part);
    }
  }
}

void Verifier::refine() {
  const std::uint64_t limit = 5 * queries_ + kRefinement;
  while (queries_ < limit) {
    const Interval worst = proved_.top();
    const bool fine = worst.bound >= kRefined * (smallest_ - tube_);
    if (fine || travel(worst) <= tolerance_ || worst.depth >= kDepth) break;
    proved_.pop();
    bisect(worst);
  }
}

PathReport Verifier::run() {
  prove();
  PathReport report;
  report.edges = static_cast<int>(curves_.size());
  report.edgesProved = report.edges - static_cast<int>(findings_.size());
  if (findings_.empty()) {
    refine();
    report.provenClearance = static_cast<double>(proved_.top().bound);
    // To the nearest double: down, if that was up.
    if (report.provenClearance > proved_.top().bound) {
      report.provenClearance = std::nextafter(report.provenClearance, 0);
    }
  }
  for (const auto& [edge, finding] : findings_) {
    if (finding.verdict == PathVerdict::refuted) report.verdict = PathVerdict::refuted;
    if (report.verdict == PathVerdict::proved) report.verdict = PathVerdict::undecided;
    if (report.findings.size() < kFindings) report.findings.push_back(finding);
  }
  report.smallestDistanceMet = static_cast<double>(smallest_);
  report.distanceQueries = queries_;
  return report;
}

}  // namespace

PathReport verifyPath(const PathProblem& problem, const std::vector<RigidPose>& states) {
  std::vector<PathState> path;
  for (const RigidPose& pose : states) path.push_back({pose, Vec3::Zero()});
  return Verifier(problem, path, false).run();
}

PathReport verifyPath(const PathProblem& problem, const std::vector<Eigen::Vector3d>& states) {
  std::vector<PathState> path;
  for (const Eigen::Vector3d& xyYaw : states) path.push_back({RigidPose{}, xyYaw});
  return Verifier(problem, path, true).run();
}

}  // namespace corridor
