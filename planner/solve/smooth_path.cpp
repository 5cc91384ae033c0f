#include "planner/solve/smooth_path.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "planner/solve/curve_measure.h"
#include "planner/solve/smooth_pieces.h"
#include "planner/trajectory/curve_pieces.h"

namespace corridor {
namespace {

/// After a try that fails, the next try is half as large, at most this often. So the smallest curve
/// of a corner takes 1/64 of the shorter edge.
constexpr int kCurveHalvings = 5;
/// A curve takes at most this share of an edge at the beginning or end of the path, because a robot
/// that starts from rest needs a part of the edge to gain speed.
constexpr double kShareOfFirstEdge = 0.9;

/// Two directions that differ by at most this much count as the same: a state between two such
/// edges is no corner. The rounding of inserted states causes a difference of some 10^-15. The
/// curve without the state is proved like every other curve.
constexpr double kStraight = 1e-9;

/// A curve from a place on one edge to a place on a later edge. A place is a length from the begin
/// of its edge.
struct Blend {
  std::size_t first = 0, last = 0;  // edges
  double from = 0, to = 0;          // places on them
  CurvePiece piece;
};

class Smoother {
 public:
  Smoother(const ConfigurationSpace& space, const Path& path, const CurveTest& isFree,
           const SmoothOptions& options, const std::function<bool()>& stop)
      : space_(space),
        isFree_(isFree),
        deviation_(options.deviation),
        goal_(options.goal),
        ruler_(space, options.velocity, options.acceleration),
        stop_(stop) {
    unwrap(path, options.fractions);
  }

  SmoothPath run() {
    if (goal_ == Smoothing::none) return assemble();
    for (std::size_t k = 1; k < states_.size() - 1; ++k) roundCorner(k, 0.5);
    for (std::size_t k = 1; k < states_.size() - 1; ++k) roundCorner(k, 1);
    for (bool merged = true; merged;) {
      merged = false;
      for (std::size_t i = 0; i + 1 < blends_.size(); ++i) merged = merge(i) || merged;
    }
    return assemble();
  }

 private:
  /// Copies the states, without those that are equal to the state before. The angles of circles
  /// continue beyond ±π.
  void unwrap(const Path& path, const std::vector<double>& fractions) {
    states_.push_back(path.front());
    if (path.size() == 1) return;
    std::size_t k = 0;
    for (const CurvePiece& edge : curveOfPath(space_, path).pieces) {
      const double fraction = k < fractions.size() ? fractions[k] : 0;
      ++k;
      const Configuration next = edge.coefficients.col(1);
      const double length = ruler_.timeOf(next - states_.back());
      const bool turns = rotates(space_, states_.back(), next);
      if (length == 0 && !turns) continue;
      if (!edges_.empty() && !turns && !edges_.back().rotates && continues(next, length)) {
        states_.back() = next;
        edges_.back().length = ruler_.timeOf(next - states_[states_.size() - 2]);
        edges_.back().fraction = std::min(edges_.back().fraction, fraction);
        continue;
      }
      edges_.push_back({length, turns, fraction});
      states_.push_back(next);
    }
  }

  /// Returns whether the edge to a state continues the last edge in a straight line.
  bool continues(const Configuration& next, double length) const {
    const Configuration u = direction(edges_.size() - 1);
    return ruler_.timeOf((next - states_.back()) / length - u) <= kStraight;
  }

  Configuration at(std::size_t edge, double place) const {
    const double share = place / edges_[edge].length;
    return states_[edge] + share * (states_[edge + 1] - states_[edge]);
  }
  Configuration direction(std::size_t edge) const {
    return (states_[edge + 1] - states_[edge]) / edges_[edge].length;
  }
  bool isFirstOrLast(std::size_t edge) const { return edge == 0 || edge + 1 == edges_.size(); }

  /// Returns the curve of degree 5 between two places. Its first three coefficients are on the
  /// first edge, and its last three on the last edge, each `spacing` apart. So the second
  /// derivative is 0 at both ends.
  Blend blendOf(std::size_t first, double from, std::size_t last, double to, double spacing) const {
    Blend blend{first, last, from, to, {}};
    auto& c = blend.piece.coefficients;
    c.resize(states_[0].size(), 6);
    const Configuration u = direction(first), v = direction(last);
    const Configuration a = at(first, from), b = at(last, to);
    c << a, a + spacing * u, a + 2 * spacing * u, b - 2 * spacing * v, b - spacing * v, b;
    restRotations(space_, states_[first], blend.piece);
    blend.piece.error = Configuration::Zero(states_[0].size());
    return blend;
  }

  bool isProved(const Blend& blend) {
    if (stop_()) return false;
    if (!isWithinBounds(space_, blend.piece)) return false;
    ++result_.tests;
    return isFree_(blend.piece, fractionOf(blend));
  }

  double fractionOf(const Blend& blend) const {
    double least = 1;
    for (std::size_t k = blend.first; k <= blend.last; ++k)
      least = std::min(least, edges_[k].fraction);
    return least;
  }

  /// Returns the range of places on an edge that no curve except `own` takes.
  std::pair<double, double> freeRange(std::size_t edge, const Blend* own) const {
    double from = 0, to = edges_[edge].length;
    for (const Blend& blend : blends_) {
      if (&blend == own) continue;
      if (blend.last == edge) from = std::max(from, blend.to);
      if (blend.first == edge) to = std::min(to, blend.from);
    }
    if (edge == 0) from = std::max(from, (1 - kShareOfFirstEdge) * edges_[edge].length);
    if (edge + 1 == edges_.size()) to = std::min(to, kShareOfFirstEdge * edges_[edge].length);
    return {from, to};
  }

  /// Rounds the corner at state k by the largest curve that is proved. On each edge, the curve
  /// takes at most `share` of the range that no other curve takes, or the whole range if no other
  /// corner needs the edge.
  void roundCorner(std::size_t k, double share) {
    if (edges_[k - 1].rotates || edges_[k].rotates) return;
    const auto known = std::find_if(blends_.begin(), blends_.end(), [&](const Blend& b) {
      return b.first == k - 1 && b.last == k;
    });
    Blend* const own = known == blends_.end() ? nullptr : &*known;
    const double before = edges_[k - 1].length - freeRange(k - 1, own).first;
    const double after = freeRange(k, own).second;
    const double shareBefore = isFirstOrLast(k - 1) ? 1 : share;
    const double shareAfter = isFirstOrLast(k) ? 1 : share;
    double most = std::min(shareBefore * before, shareAfter * after);
    // The middle of the curve is farthest from the path: `reach` times 7/64 of the difference of
    // the directions of the two edges.
    const double bend = (direction(k) - direction(k - 1)).cwiseAbs().maxCoeff();
    if (bend > 0) most = std::min(most, deviation_ / (7.0 / 64 * bend));
    const double least = own ? own->to : 0;
    double proved = 0;
    for (int i = 0; i <= kCurveHalvings && proved == 0; ++i) {
      const double reach = most / (1 << i);
      if (!(reach > 1.05 * least)) break;
      if (tryCorner(k, reach)) proved = reach;
      // `reach` is proved, and 2·reach has failed; so a reach between them is tried, too.
      if (proved > 0 && i > 0) tryCorner(k, 1.5 * reach);
    }
  }

  bool tryCorner(std::size_t k, double reach) {
    Blend blend = blendOf(k - 1, edges_[k - 1].length - reach, k, reach, reach / 2);
    if (!isProved(blend)) return false;
    const auto place =
        std::lower_bound(blends_.begin(), blends_.end(), k - 1,
                         [](const Blend& b, std::size_t first) { return b.first < first; });
    if (place != blends_.end() && place->first == k - 1 && place->last == k)
      *place = std::move(blend);
    else
      blends_.insert(place, std::move(blend));
    return true;
  }

  /// Replaces curve i, curve i + 1 and the edge between them by one curve, if this saves time.
  bool merge(std::size_t i) {
    const Blend &a = blends_[i], &b = blends_[i + 1];
    if (a.last != b.first || deviation_ < HUGE_VAL) return false;
    const auto [from, unused] = freeRange(a.first, &a);
    const double to = freeRange(b.last, &b).second;
    for (const double share : {1.0, 0.5, 0.0}) {  // share of the outer edges' free ranges
      const double begin = a.from + share * (from - a.from), end = b.to + share * (to - b.to);
      const double gap = ruler_.timeOf(at(b.last, end) - at(a.first, begin));
      const Blend whole = blendOf(a.first, begin, b.last, end, gap / 5);
      const double before = (a.from - begin) + ruler_.of(a.piece).time + (b.from - a.to) +
                            ruler_.of(b.piece).time + (end - b.to);
      if (!(ruler_.of(whole.piece).time < 0.99 * before) || !isProved(whole)) continue;
      blends_[i] = whole;
      blends_.erase(blends_.begin() + static_cast<std::ptrdiff_t>(i) + 1);
      return true;
    }
    return false;
  }

  SmoothPath assemble() {
    result_.corners = states_.size() > 2 ? states_.size() - 2 : 0;
    Configuration here = states_[0];
    auto next = blends_.begin();
    for (std::size_t edge = 0; edge < edges_.size();) {
      if (next != blends_.end() && next->first == edge) {
        const Configuration begin = next->piece.coefficients.col(0);
        // Two curves on one edge may meet up to rounding. The line between them would be an ulp
        // long, without a direction.
        if (ruler_.timeOf(begin - here) <= kStraight * edges_[edge].length)
          next->piece.coefficients.col(0) = here;
        else
          add(linearPiece(space_, here, begin), edges_[edge].fraction);
        add(next->piece, fractionOf(*next));
        result_.rounded += next->last - next->first;
        here = next->piece.coefficients.rightCols<1>();
        edge = next->last;
        ++next;
      } else {
        const Configuration& end = states_[edge + 1];
        if (end != here) add(linearPiece(space_, here, end), edges_[edge].fraction);
        here = end;
        ++edge;
      }
    }
    if (result_.pieces.empty()) add(linearPiece(space_, here, here), 0);
    return std::move(result_);
  }

  void add(CurvePiece piece, double fraction) {
    result_.pieces.push_back(std::move(piece));
    result_.fractions.push_back(fraction);
  }

  struct Edge {
    double length = 0;     // CurveRuler::timeOf the edge
    bool rotates = false;  // a rotation moves on it
    double fraction = 0;   // of the clearance targets, which it keeps
  };

  const ConfigurationSpace& space_;
  const CurveTest& isFree_;
  double deviation_;
  Smoothing goal_;
  CurveRuler ruler_;
  const std::function<bool()>& stop_;
  std::vector<Configuration> states_;
  std::vector<Edge> edges_;
  std::vector<Blend> blends_;  // in the order of the path
  SmoothPath result_;
};

}  // namespace

SmoothPath smoothedPath(const ConfigurationSpace& space, const Path& path, const CurveTest& isFree,
                        const SmoothOptions& options, const std::function<bool()>& stop) {
  return Smoother(space, path, isFree, options, stop).run();
}

}  // namespace corridor
