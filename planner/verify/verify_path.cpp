#include "planner/verify/verify_path.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <queue>
#include <set>

#include "planner/verify/pair_prover.h"
#include "planner/verify/proved_range.h"

namespace corridor {
namespace {

using namespace verify;

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
constexpr int kFindings = 100;
/// The maximum number of times that an edge is halved. So t has 60 bits; EdgeCurve's bounds on
/// rounding allow 63 bits.
constexpr int kDepth = 60;
/// An edge is first halved into 2^kCoarse intervals. In this phase the interval with the smallest
/// estimate is always halved next: this order finds a deep collision quickly. Afterwards the
/// shortest interval is always halved next: this depth-first order finds an undecidable time
/// without halving all other intervals to the same length.
constexpr int kCoarse = 5;
/// After the proof, the bound of the clearance is refined. The refinement may take kRefinement
/// queries, plus four times the number of queries of the proof. It ends when the bound reaches
/// kRefined times the largest possible bound, or kNearly times if more is wanted than is possible.
constexpr std::uint64_t kRefinement = 4000;
constexpr Real kRefined = 0.9L, kNearly = 0.99L;
/// The search for the first contact may take as many queries as the refinement. It ends at
/// intervals of this half width, in t, if not before.
constexpr Real kShortest = 0x1p-31L;

/// A time interval of an edge, and the pairs that are not proved yet in this interval.
struct Interval {
  TimeInterval time;
  int depth = 0;  ///< time.half = 2^-(depth + 1), unless it is a single time
  std::vector<OpenPair> pairs;
  Real bound = -kInfinity;     ///< of a proved interval: the smallest bound of `pairs`
  Real estimate = -kInfinity;  ///< of an open interval: the smallest estimate of `pairs`
};

std::array<Interval, 2> halvesOf(const Interval& whole) {
  std::array<Interval, 2> halves = {whole, whole};
  const Real half = whole.time.half / 2;
  for (std::size_t i = 0; i < 2; ++i) {
    halves[i].time.middle += i == 0 ? -half : half;
    halves[i].time.half = half;
    ++halves[i].depth;
  }
  return halves;
}

struct NextOnTop {
  bool operator()(const Interval& a, const Interval& b) const {
    const bool coarseA = a.depth < kCoarse, coarseB = b.depth < kCoarse;
    if (coarseA != coarseB) return coarseB;
    return coarseA || a.depth == b.depth ? a.estimate > b.estimate : a.depth < b.depth;
  }
};
struct WorstOnTop {
  bool operator()(const Interval& a, const Interval& b) const { return a.bound > b.bound; }
};

/// Bisects all edges, or all pieces of a curve. If a pair is undecided somewhere on an edge, this
/// pair is not tested further on the edge. The other pairs are still tested, because one of them
/// may refute the edge.
class Verifier {
 public:
  Verifier(const PathProblem& problem, const std::vector<Configuration>& states)
      : problem_(problem), prover_(problem, states), single_(states.size() == 1) {
    for (std::size_t e = 0; e < prover_.edges(); ++e) {
      const Configuration &from = states[e], &to = states[std::min(e + 1, states.size() - 1)];
      if (const auto t = outsideProved(problem, from, to))
        addBeyondProofs(e, *t, *t > 0 ? to : from);
    }
  }
  Verifier(const PathProblem& problem, std::span<const CurvePiece> pieces)
      : problem_(problem), prover_(problem, pieces), single_(false) {
    for (std::size_t e = 0; e < pieces.size(); ++e)
      if (const auto t = outsideProved(problem, pieces[e]))
        addBeyondProofs(e, *t, prover_.configuration(e, *t));
  }
  PathReport run();

 private:
  Interval intervalOf(const TimeInterval& time) const;
  /// Tests the pair. Records a finding if the pair is refuted or undecided. @returns whether the
  /// pair is still open.
  bool test(const Interval& interval, OpenPair& open);
  /// Tests all pairs of the interval and keeps those that are still open.
  void testAll(Interval& interval);
  void proveAtRest();
  void proveStates();
  void proveEdge(std::size_t edge);
  void proveOutside();
  void refine();
  void findFirst(PathFinding& finding);
  void add(const PathFinding& finding);
  void addBeyondProofs(std::size_t edge, double t, const Configuration& at);
  PathReport report() const;
  bool outOfWork() const { return queries_ >= problem_.workLimit; }
  bool hasFinding(std::size_t edge) const { return findings_.count(static_cast<int>(edge)) > 0; }
  /// Returns whether the edge needs no more queries: it is refuted, or it is undecided and the work
  /// limit is reached.
  bool closed(std::size_t edge) const {
    const auto found = findings_.find(static_cast<int>(edge));
    return found != findings_.end() &&
           (found->second.verdict == PathVerdict::refuted || outOfWork());
  }
  /// Returns a bound of the clearance; larger bounds would not change the reported clearance. The
  /// result never increases from call to call.
  Real usefulBound() const { return goalFor(smallest_); }
  /// Returns the clearance at which refining ends, if the clearance is at most `most`.
  Real goalFor(Real most) const {
    const Real wanted = problem_.wantedClearance;
    return wanted < most ? std::max(kRefined * most, wanted) : kNearly * most;
  }

  const PathProblem& problem_;
  PairProver prover_;
  bool single_;                                                              // a path of one state
  std::priority_queue<Interval, std::vector<Interval>, WorstOnTop> proved_;  // each with one pair
  std::map<int, PathFinding> findings_;                                      // key: edge
  std::vector<PathFinding> heldFindings_;                                    // of `heldPairs`
  std::set<std::pair<std::size_t, std::size_t>> undecided_;                  // (edge, pair)
  Real smallest_ = kInfinity, leastAtStates_ = kInfinity;
  std::uint64_t queries_ = 0;
};

/// Records the first finding of an edge. A refutation replaces an undecided finding.
void Verifier::add(const PathFinding& finding) {
  const auto [place, first] = findings_.emplace(finding.edge, finding);
  if (!first && place->second.verdict == PathVerdict::undecided &&
      finding.verdict == PathVerdict::refuted)
    place->second = finding;
}

/// Records that an edge is undecided because it leaves the proved range.
void Verifier::addBeyondProofs(std::size_t edge, double t, const Configuration& at) {
  PathFinding finding;
  finding.edge = static_cast<int>(edge);
  finding.t = t;
  finding.configuration = at;
  finding.reason = kBeyondProofs;
  add(finding);
}

Interval Verifier::intervalOf(const TimeInterval& time) const {
  Interval interval{time, 0, {}, -kInfinity, -kInfinity};
  for (std::size_t p = 0; p < prover_.pairs(); ++p)
    interval.pairs.push_back({p, {}, -kInfinity, -kInfinity});
  return interval;
}

bool Verifier::test(const Interval& interval, OpenPair& open) {
  PairAnswer answer = prover_.decide(interval.time, open, usefulBound());
  ++queries_;
  open.guess = answer.closest;
  open.bound = answer.bound;
  open.estimate = answer.estimate;
  smallest_ = std::min(smallest_, answer.upper);
  if (!answer.verdict && (interval.depth >= kDepth || outOfWork())) {
    answer.verdict = PathVerdict::undecided;
    if (interval.depth < kDepth) answer.reason = kWorkLimit;
  }
  if (!answer.verdict) return true;
  if (*answer.verdict != PathVerdict::proved) {
    add(prover_.finding(interval.time, open.pair, answer));
    undecided_.emplace(interval.time.edge, open.pair);
  }
  return false;
}

void Verifier::testAll(Interval& interval) {
  const std::size_t edge = interval.time.edge;
  std::vector<OpenPair> left;
  interval.estimate = kInfinity;
  for (OpenPair& open : interval.pairs) {
    if (undecided_.count({edge, open.pair}) > 0) continue;
    if (test(interval, open)) {
      left.push_back(open);
      interval.estimate = std::min(interval.estimate, open.estimate);
    } else if (closed(edge)) {
      return;
    } else if (undecided_.count({edge, open.pair}) > 0) {
      continue;
    } else if (interval.time.half == 0) {
      leastAtStates_ = std::min(leastAtStates_, open.bound);
    } else if (open.bound < usefulBound()) {
      proved_.push({interval.time, interval.depth, {open}, open.bound, open.estimate});
    }
  }
  interval.pairs = std::move(left);
}

/// Tests the pairs of `heldPairs` at the first state. Their bodies are at rest relative to each
/// other, so the answer holds for every state. The queries do not count towards the work limit.
void Verifier::proveAtRest() {
  if (prover_.noCurve(0)) return;  // the path is refuted
  constexpr TimeInterval start{0, 0, 0};
  for (std::size_t pair = prover_.pairs(); pair < prover_.allPairs(); ++pair) {
    PairAnswer answer = prover_.decide(start, {pair, {}, -kInfinity, -kInfinity}, 0);
    if (answer.verdict == PathVerdict::proved)
      if (const auto inside = prover_.insideAtStart(pair)) answer = *inside;
    if (answer.verdict == PathVerdict::proved) continue;
    PathFinding finding = prover_.finding(start, pair, answer);
    finding.inEveryState = true;
    // Two bodies of several shapes each have many pairs. One finding is enough.
    const auto same = std::find_if(
        heldFindings_.begin(), heldFindings_.end(),
        [&](const PathFinding& each) { return each.a == finding.a && each.b == finding.b; });
    if (same == heldFindings_.end())
      heldFindings_.push_back(std::move(finding));
    else if (same->verdict == PathVerdict::undecided)
      *same = std::move(finding);
  }
}

/// Tests the states before the edges, for two reasons. First, bisection comes close to the states,
/// but never tests them. Second, the smallest distance at the states is an upper bound of the
/// clearance, and `usefulBound()` uses it.
void Verifier::proveStates() {
  for (std::size_t edge = 0; edge < prover_.edges(); ++edge)
    for (const Real t : {0, 1}) {
      const bool tested = t == 0 && edge > 0 && !hasFinding(edge - 1);
      if (closed(edge) || tested) continue;
      Interval state = intervalOf({edge, t, 0});
      testAll(state);
      if (edge == 0 && t == 0) proveOutside();
    }
}

void Verifier::proveEdge(std::size_t edge) {
  std::priority_queue<Interval, std::vector<Interval>, NextOnTop> open;
  Interval whole = intervalOf({edge, 0.5L, 0.5L});
  testAll(whole);
  if (!closed(edge) && !whole.pairs.empty()) open.push(std::move(whole));
  while (!open.empty()) {
    const Interval next = open.top();
    open.pop();
    for (Interval& half : halvesOf(next)) {
      testAll(half);
      if (closed(edge)) return;
      if (!half.pairs.empty()) open.push(std::move(half));
    }
  }
}

/// Tests for each pair whether one body is inside the other at the start. A body that is outside at
/// the start stays outside along a path without contact. A pair that is undecided at the start is
/// skipped, because its surfaces may touch.
void Verifier::proveOutside() {
  for (std::size_t pair = 0; pair < prover_.pairs() && !closed(0); ++pair) {
    if (undecided_.count({0, pair}) > 0) continue;
    if (const auto inside = prover_.insideAtStart(pair))
      add(prover_.finding({0, 0, 0}, pair, *inside));
  }
}

void Verifier::refine() {
  const std::uint64_t limit = 5 * queries_ + kRefinement;
  while (!proved_.empty() && queries_ < limit) {
    const Interval worst = proved_.top();
    const Reach& reach = prover_.reach(worst.time, worst.pairs[0].pair);
    if (worst.bound >= goalFor(smallest_ - reach.tube) ||
        reach.speed * worst.time.half <= problem_.tolerance || worst.depth >= kDepth)
      break;
    proved_.pop();
    for (Interval& half : halvesOf(worst)) {
      test(half, half.pairs[0]);
      if (hasFinding(worst.time.edge)) return;  // a contact within rounding of a proved clearance
      half.bound = half.pairs[0].bound;
      proved_.push(std::move(half));
    }
  }
}

/// Searches for the first refutation on the edge of a finding. It tests the intervals that begin
/// before the known refutation, the earliest first, and halves those that it cannot prove. It ends
/// at an undecided pair. The edge is always proved up to the interval on top of the stack.
void Verifier::findFirst(PathFinding& finding) {
  const std::uint64_t limit = 5 * queries_ + kRefinement;
  Real contact = finding.t;
  finding.freeUntil = 0;
  std::vector<Interval> open;
  if (contact > 0) open.push_back(intervalOf({static_cast<std::size_t>(finding.edge), 0.5L, 0.5L}));
  while (!open.empty()) {
    Interval next = std::move(open.back());
    open.pop_back();
    const TimeInterval& time = next.time;
    if (time.middle - time.half >= contact) continue;
    finding.freeUntil = static_cast<double>(time.middle - time.half);  // exact: at most 33 bits
    if (queries_ >= limit || time.half < kShortest) return;
    std::vector<OpenPair> left;
    for (OpenPair& pair : next.pairs) {
      const PairAnswer answer = prover_.decide(time, pair, 0);
      ++queries_;
      if (answer.verdict == PathVerdict::proved) continue;
      if (answer.verdict == PathVerdict::undecided && time.middle < contact) return;
      if (answer.verdict == PathVerdict::refuted && time.middle < contact) {
        contact = time.middle;
        const std::optional<double> freeUntil = finding.freeUntil;
        finding = prover_.finding(time, pair.pair, answer);
        finding.freeUntil = freeUntil;
      }
      pair.guess = answer.closest;
      pair.bound = answer.bound;
      pair.estimate = answer.estimate;
      left.push_back(pair);
    }
    if (left.empty()) continue;
    next.pairs = std::move(left);
    std::array<Interval, 2> halves = halvesOf(next);
    open.push_back(std::move(halves[1]));
    open.push_back(std::move(halves[0]));
  }
}

PathReport Verifier::run() {
  for (std::size_t edge = 0; edge < prover_.edges(); ++edge)
    if (prover_.noCurve(edge)) add(*prover_.noCurve(edge));
  proveAtRest();
  proveStates();
  for (std::size_t edge = 0; edge < prover_.edges(); ++edge)
    if (!closed(edge) && !single_) proveEdge(edge);
  if (findings_.empty()) refine();
  const auto refuted = std::find_if(findings_.begin(), findings_.end(), [](const auto& each) {
    return each.second.verdict == PathVerdict::refuted;
  });
  // Only a finding about two bodies has a first contact; a finding about an edge that defines no
  // curve has none.
  if (refuted != findings_.end() && !refuted->second.a.empty() && !single_)
    findFirst(refuted->second);
  return report();
}

PathReport Verifier::report() const {
  PathReport report;
  report.edges = static_cast<int>(prover_.edges());
  const bool isFreeAtRest = heldFindings_.empty();
  if (isFreeAtRest) report.edgesProved = report.edges - static_cast<int>(findings_.size());
  if (findings_.empty() && isFreeAtRest) {
    // A proved pair that is not in `proved_` had a bound of at least `usefulBound()`, and
    // `usefulBound()` never increases.
    Real least = single_ ? leastAtStates_ : usefulBound();
    if (!proved_.empty()) least = std::min(least, proved_.top().bound);
    least = std::max<Real>(least, problem_.margin);
    report.provedClearance = static_cast<double>(least);
    if (report.provedClearance > least)  // the conversion rounded up
      report.provedClearance = std::nextafter(report.provedClearance, 0);
  }
  const auto include = [&](const PathFinding& finding) {
    if (finding.verdict == PathVerdict::refuted) report.verdict = PathVerdict::refuted;
    if (report.verdict == PathVerdict::proved) report.verdict = PathVerdict::undecided;
    if (report.findings.size() < std::size_t{kFindings}) report.findings.push_back(finding);
  };
  for (const PathFinding& finding : heldFindings_) include(finding);
  for (const auto& [edge, finding] : findings_) include(finding);
  report.closestFound = static_cast<double>(smallest_);
  report.distanceQueries = queries_ + (prover_.allPairs() - prover_.pairs());
  return report;
}

/// Returns the report of a path that cannot be verified in this arithmetic.
/// @param startOf returns the configuration at the start of an edge.
template <class Start>
PathReport refusal(FloatingPoint arithmetic, std::size_t edges, const Start& startOf) {
  PathReport report;
  report.verdict = PathVerdict::undecided;
  report.edges = static_cast<int>(edges);
  for (int edge = 0; edge < std::min(report.edges, kFindings); ++edge) {
    PathFinding& finding = report.findings.emplace_back();
    finding.edge = edge;
    finding.configuration = startOf(static_cast<std::size_t>(edge));
    finding.reason = described(arithmetic);
  }
  return report;
}

}  // namespace

PathReport verifyPath(const PathProblem& problem, const std::vector<Configuration>& states) {
  const FloatingPoint arithmetic = floatingPoint();
  if (arithmetic == FloatingPoint::standard) return Verifier(problem, states).run();
  return refusal(arithmetic, std::max<std::size_t>(states.size(), 2) - 1,
                 [&](std::size_t edge) { return states.empty() ? Configuration() : states[edge]; });
}

PathReport verifyCurve(const PathProblem& problem, std::span<const CurvePiece> pieces) {
  const FloatingPoint arithmetic = floatingPoint();
  if (arithmetic == FloatingPoint::standard) return Verifier(problem, pieces).run();
  return refusal(arithmetic, pieces.size(), [&](std::size_t piece) -> Configuration {
    const Eigen::MatrixXd& coefficients = pieces[piece].coefficients;
    return coefficients.cols() > 0 ? Configuration(coefficients.col(0)) : Configuration();
  });
}

}  // namespace corridor
