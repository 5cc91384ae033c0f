#pragma once

#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "planner/verify/body_tree.h"
#include "planner/verify/edge_curve.h"
#include "planner/verify/moved_slab.h"
#include "planner/verify/verify_path.h"

namespace corridor::verify {

/// The times [middle − half, middle + half] of an edge or a piece, with t in [0, 1]. half = 0 is a
/// single time. The intervals are those that halving [0, 1] makes.
struct TimeInterval {
  std::size_t edge = 0;
  Real middle = 0.5L, half = 0.5L;
};

/// A pair of bodies that is not yet proved in a time interval, and the results from the longer
/// interval around it.
struct OpenPair {
  std::size_t pair = 0;
  LeafPair guess;  ///< a pair of leaf primitives that is likely close
  Real bound = -std::numeric_limits<Real>::infinity();     ///< proved for the longer interval; see
                                                           ///< PairAnswer::bound
  Real estimate = -std::numeric_limits<Real>::infinity();  ///< see PairAnswer::estimate
};

/// The answer about a pair of bodies in a time interval. Lengths in metres.
struct PairAnswer {
  /// - proved: `bound` exceeds the margin and padding.
  /// - refuted: `reason` says why.
  /// - undecided: the motion bound in the interval is at most the tolerance, or the poses may be
  ///   far from the path. The interval is not halved again; `reason` says why it is not proved.
  /// - empty: halve the interval.
  std::optional<PathVerdict> verdict;
  /// In the whole interval, every curve in the tube keeps at least this distance.
  Real bound = -std::numeric_limits<Real>::infinity();
  /// An estimate of `bound`, for the order of tests only. It is not proved.
  Real estimate = -std::numeric_limits<Real>::infinity();
  Real upper = std::numeric_limits<Real>::infinity();  ///< ≥ the distance at the middle
  LeafPair closest;                 ///< the closest pair of leaf primitives at the middle
  RealVec point = RealVec::Zero();  ///< a contact, or the closest point of b; in a's frame
  /// Without a verdict: the reason to report if the interval can't be halved.
  const char* reason = nullptr;
};

/// Decides one pair of bodies in one time interval of one edge. verifyPath() calls it for
/// shorter and shorter intervals. No answer depends on earlier queries. For verifyCurve(), the
/// pieces of the curve take the place of the edges.
///
/// The object stores all data that depend only on the problem (box trees, kinematic chains), and
/// what depends on the current edge alone (its curve, reach weights, the states of the frames at
/// the latest time). A query of another edge computes the latter again, so memory does not grow
/// with the number of edges. The states or pieces must outlive the object.
class PairProver {
 public:
  /// @throws std::invalid_argument as verifyPath() does.
  PairProver(const PathProblem& problem, const std::vector<Configuration>& states);
  /// @throws std::invalid_argument as verifyCurve() does.
  PairProver(const PathProblem& problem, std::span<const CurvePiece> pieces);

  std::size_t edges() const { return edges_; }
  /// Returns the configuration at t of an edge or piece, rounded.
  Configuration configuration(std::size_t edge, double t) {
    enter(edge);
    return curve_->configuration(t);
  }
  /// Returns the number of `PathProblem::pairs`. They have the numbers from 0 to pairs() − 1.
  std::size_t pairs() const { return problem_.pairs.size(); }
  /// Returns the number of all pairs. Those of `PathProblem::heldPairs` have the numbers from
  /// pairs() on, and may only be passed to the functions below with the first edge.
  std::size_t allPairs() const { return pairs_.size(); }
  /// Returns a finding `refuted` if the edge defines no curve, else null. An edge defines no
  /// curve if an end is not a state, a half turn is ambiguous, or a joint jumps; a piece also if it
  /// does not begin where the piece before it ends. Such an edge must not be passed to the
  /// functions below.
  const PathFinding* noCurve(std::size_t edge) const {
    const auto found = noCurve_.find(edge);
    return found == noCurve_.end() ? nullptr : &found->second;
  }

  /// Decides a pair of bodies in an interval.
  /// @param usefulBound a bound of the clearance above this value is of no use.
  PairAnswer decide(const TimeInterval& interval, const OpenPair& open, Real usefulBound);

  /// Refutes a pair if, at t = 0 of the first edge, a point of one body is inside the other body,
  /// and the other body is a solid mesh. Returns nullopt otherwise. @pre the bodies do not touch
  /// there.
  std::optional<PairAnswer> insideAtStart(std::size_t pair);

  /// Returns the finding that reports an answer. @pre the answer has a verdict.
  PathFinding finding(const TimeInterval& interval, std::size_t pair, const PairAnswer& answer);

  /// Returns the bounds of the pair's motion that decide() uses in the interval.
  const Reach& reach(const TimeInterval& interval, std::size_t pair);

 private:
  struct Pair {
    std::size_t a, b, chainA, chainB;
    Real margin;  ///< metres that the pair must keep: margin and padding
  };
  /// Motion bounds of both bodies along an edge, by their reach weights.
  struct PairReach {
    Reach sum;          ///< the sum for both bodies, for the whole edge
    Real rounding = 0;  ///< metres; bound for every computed distance and displacement
    bool sharp = true;  ///< the computed poses are so close to the path that a contact refutes it
    Real stray = 0;     ///< metres; the displacement by CurvePiece::error
  };
  /// Both bodies at the middle of an interval.
  struct Measured {
    BodyGap gap;
    std::optional<Vec3> contact;  ///< a common point of two triangles, in a's frame
    FrameState a, b;
    Placement X_AB;
  };

  /// Sets the bodies and the pairs.
  explicit PairProver(const PathProblem& problem);
  bool isState(const Configuration& state) const;
  bool isPiece(const CurvePiece& piece) const;
  /// Returns whether the ends of an edge, or the numbers of a piece, are valid.
  bool isValid(std::size_t edge) const;
  /// Returns the curve of an edge or piece; if it is not valid, any curve.
  EdgeCurve curveOf(std::size_t edge, bool valid) const;
  /// Returns why the edge defines no curve; null if it does.
  const char* faultOf(std::size_t edge, bool valid, const EdgeCurve& curve) const;
  /// Fills `noCurve_`.
  void findFaults();
  void addPair(const VerifyPair& pair);
  std::size_t addChain(std::size_t base, std::size_t frame);
  const BodyTree& treeOf(std::size_t body) const { return trees_[treeOf_[body]]; }
  const PairReach& reachOf(std::size_t edge, std::size_t pair);
  /// Returns the sum of the reach of both bodies, for the current edge.
  Reach sumOf(std::size_t pair, const Configuration& tube, const Segment& segment) const;
  /// Makes `edge` the current edge, and forgets the data of any other edge.
  void enter(std::size_t edge);
  const FrameState& stateOf(std::size_t edge, std::size_t chainIndex, Real t);
  /// Places the bodies at the middle of the interval, in `distance_` and in the result.
  Measured place(const TimeInterval& interval, std::size_t pair);
  /// Measures the distance of the placed bodies.
  void measure(const PairReach& reach, std::size_t pair, LeafPair guess, Real stop, Measured& m);
  /// Returns an upper bound of the second-order terms, which reduce the distance in an interval in
  /// any direction. If the tube does not matter (`tubeMatters`), the result includes the whole
  /// displacement by the tube.
  Real secondOrder(const Reach& reach, Real half) const;
  /// Returns a lower bound of the clearance by boundBySlabs().
  Real boundPiecewise(const TimeInterval& interval, std::size_t pair, const Measured& m,
                      Real usefulBound);
  Real leastInTube(std::size_t edge, std::size_t pair, const Measured& m);
  const char* whyRefuted(std::size_t edge, std::size_t pair, const Measured& m);
  const char* whyStuck(const PairReach& reach, std::size_t pair, const Measured& m) const;
  std::optional<Vec3> pointInside(std::size_t solid, std::size_t other,
                                  const Placement& X_SolidOther) const;
  /// Returns whether the tube displaces points by more than the tolerance. Only then can a bound of
  /// the tube along one direction change a verdict.
  bool tubeMatters(const Reach& reach) const { return reach.tube > problem_.tolerance; }

  const PathProblem& problem_;
  std::vector<BodyTree> trees_;      // one per mesh; one per body of parts
  std::vector<std::size_t> treeOf_;  // for each body, its tree in `trees_`
  std::vector<KinematicChain> chains_;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> chainIndex_;  // key: (base, frame)
  std::vector<Pair> pairs_;  // those of problem_.pairs, then those of problem_.heldPairs
  // Either the states of a path or the pieces of a curve; the other span is empty.
  std::span<const Configuration> states_;
  std::span<const CurvePiece> pieces_;
  std::size_t edges_ = 0;
  std::map<std::size_t, PathFinding> noCurve_;  // key: edge
  // The curve of currentEdge_, and the problem's tube with the piece's error.
  std::optional<EdgeCurve> curve_;
  Configuration tube_;
  std::vector<std::pair<std::size_t, PairReach>>
      reaches_;  // for each pair, the edge and its bounds
  // Bounds in segments of currentEdge_; the key is {2^depth + index of the segment, pair}.
  std::map<std::pair<std::size_t, std::size_t>, Reach> segments_;
  // For each chain, a time of currentEdge_ and the state of the frame at this time.
  std::vector<std::pair<Real, FrameState>> frameStates_;
  std::size_t currentEdge_ = SIZE_MAX;
  BodyDistance distance_;
  std::vector<LeafPair> near_;  // scratch memory of boundPiecewise()
};

}  // namespace corridor::verify
