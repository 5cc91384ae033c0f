#include "planner/trajectory/run_law.h"

#include <algorithm>
#include <cmath>

namespace corridor {
namespace {

/// An interval is halved if the law exceeds a limit in its middle by more than this fraction. If an
/// acceleration exceeds its limit by 5e-4, emitRows makes all times longer by about half of this
/// fraction, 0.025 %. The aim is to make them longer by at most 0.1 %.
constexpr double kGridExcess = 5e-4;
/// An interval is halved if a jump of u at one of its ends would change x within the interval by
/// more than this fraction. Where intervals are no longer halved, the position of the switch is
/// therefore accurate to about this fraction of x.
constexpr double kSwitch = 0.01;
/// An interval is halved if x changes by more than this factor within it.
constexpr double kSteep = 2;
constexpr int kRounds = 6;
constexpr double kShortest =
    1e-5;  ///< the shortest interval that is halved, as a fraction of its piece

struct Node {
  std::size_t part = 0;
  double tau = 0, s = 0;
};

class RunGrid {
 public:
  RunGrid(const PathView& view, const PathRun& run, const LimitBands& bands)
      : run_(run), bands_(bands) {
    for (const PathRun::Part& part : run.parts) begins_.push_back(total_), total_ += part.length;
    a_.resize(bands.count());
    b_.resize(bands.count());
    straight_ = run.parts.size() == 1 && view.isStraight(run.parts[0].piece);
    grid_.bands = bands.count();
  }

  bool isStraight() const { return straight_; }
  double length() const { return total_; }

  /// Sets the nodes of about `count` equal intervals of the run, with at least four intervals in
  /// each piece.
  void setUniform(int count) {
    nodes_.clear();
    for (std::size_t p = 0; p < run_.parts.size(); ++p) {
      const double share = run_.parts[p].length / total_;
      const int n =
          std::max(run_.parts.size() > 1 ? 4 : 8, static_cast<int>(std::ceil(count * share)));
      for (int i = 0; i <= n; ++i) {
        const double tau = static_cast<double>(i) / n;
        nodes_.push_back(nodeAt(p, tau));
        // Near the ends of a run, the robot is usually at rest and ṡ varies fast. So the first and
        // the last interval get more nodes.
        const bool first = p == 0 && i == 0, last = p + 1 == run_.parts.size() && i + 1 == n;
        for (int k = 1; k <= 5; ++k) {
          if (first) nodes_.push_back(nodeAt(p, std::ldexp(1.0 / n, k - 6)));
          if (last) nodes_.push_back(nodeAt(p, 1 - std::ldexp(1.0 / n, -k)));
        }
      }
    }
    fill();
  }

  /// For a straight line, sets nodes where the optimal law from x = `start` to x = `end` switches.
  /// The limits x ≤ xMax and |u| ≤ uMax are constant on the line, so the switches have a closed
  /// form, and the law on these nodes is optimal.
  void setSwitches(double start, double end) {
    nodes_ = {nodeAt(0, 0), nodeAt(0, 1)};
    fill();
    double uMax = INFINITY;
    for (const double a : grid_.a) uMax = std::min(uMax, 1 / std::abs(a));
    const double top = std::min(grid_.xMax[0], (start + end) / 2 + uMax * total_);
    std::vector<double> at{(top - start) / (2 * uMax), total_ - (top - end) / (2 * uMax)};
    nodes_ = {nodeAt(0, 0)};
    for (const double s : at)
      if (s > nodes_.back().s * (1 + 1e-12) && s < total_ * (1 - 1e-12))
        nodes_.push_back(nodeAt(0, s / total_));
    nodes_.push_back(nodeAt(0, 1));
    fill();
  }

  Profile solve(double start, double end) const { return fastestProfile(grid_, start, end); }

  /// Halves the intervals for which a condition at the constants above holds. @returns whether any
  /// interval was halved.
  bool refine(const Profile& profile) {
    // Whether interval i, from node i to node i + 1, is halved.
    std::vector<bool> marked(nodes_.size(), false);
    bool any = false;
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
      const double width = grid_.s[i + 1] - grid_.s[i];
      if (!(width > kShortest * run_.parts[nodes_[i].part].length)) continue;
      const double x = (profile.x[i] + profile.x[i + 1]) / 2;
      const Node middle = nodeAt(nodes_[i].part, (nodes_[i].tau + nodes_[i + 1].tau) / 2);
      marked[i] = steep(profile, i) || jumps(profile, i, x) || exceeds(middle, i, profile);
      any = any || marked[i];
    }
    if (!any) return false;
    std::vector<Node> finer;
    LimitGrid grid;
    grid.bands = grid_.bands;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      finer.push_back(nodes_[i]);
      copyNode(i, grid);
      if (!marked[i]) continue;
      finer.push_back(nodeAt(nodes_[i].part, (nodes_[i].tau + nodes_[i + 1].tau) / 2));
      addNode(finer.back(), grid);
    }
    nodes_ = std::move(finer);
    grid_ = std::move(grid);
    return true;
  }

  std::vector<LawSegment> segments(const Profile& profile) const {
    std::vector<LawSegment> result;
    double time = 0;
    for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
      const double width = grid_.s[i + 1] - grid_.s[i];
      if (!(width > 0)) continue;
      const PathRun::Part& part = run_.parts[nodes_[i].part];
      const double from = std::sqrt(profile.x[i]), to = std::sqrt(profile.x[i + 1]);
      const double duration = 2 * width / (from + to);
      result.push_back({time, duration, part.piece, nodes_[i].tau, from / part.length,
                        (to - from) / duration / part.length, 0});
      time += duration;
    }
    return result;
  }

  const Node& node(std::size_t i) const { return nodes_[i]; }

 private:
  Node nodeAt(std::size_t part, double tau) const {
    return {part, tau, begins_[part] + tau * run_.parts[part].length};
  }

  /// Returns whether x changes by more than the factor kSteep within interval i, and is above 0 at
  /// both ends.
  bool steep(const Profile& profile, std::size_t i) const {
    const double low = std::min(profile.x[i], profile.x[i + 1]);
    return low > 0 && std::max(profile.x[i], profile.x[i + 1]) > kSteep * low;
  }

  /// Returns whether u jumps between interval i and one of its neighbours, by more than kSwitch
  /// allows. @param x the value that the change of x is compared with.
  bool jumps(const Profile& profile, std::size_t i, double x) const {
    const double width = grid_.s[i + 1] - grid_.s[i], u = profile.u[i];
    const auto differs = [&](std::size_t k) {
      return std::abs(profile.u[k] - u) * width > kSwitch * x;
    };
    const auto isWide = [&](std::size_t k) { return grid_.s[k + 1] > grid_.s[k]; };
    return (i > 0 && isWide(i - 1) && differs(i - 1)) ||
           (i + 2 < nodes_.size() && isWide(i + 1) && differs(i + 1));
  }

  /// Returns whether interval i exceeds a limit of velocity in its middle, or a band in its middle
  /// or at the extremum of the parabola through the band's values at both ends and in the middle.
  /// `kGridExcess` is tolerated.
  bool exceeds(const Node& middle, std::size_t i, const Profile& profile) {
    const PathRun::Part& part = run_.parts[middle.part];
    const double x0 = profile.x[i], x1 = profile.x[i + 1], x = (x0 + x1) / 2, u = profile.u[i];
    if (x > (1 + 2 * kGridExcess) *
                bands_.at(part.piece, middle.tau, part.length, a_.data(), b_.data()))
      return true;
    for (std::size_t k = 0; k < a_.size(); ++k) {
      const std::size_t left = i * grid_.bands + k, right = left + grid_.bands;
      const double g0 = grid_.a[left] * u + grid_.b[left] * x0, g = a_[k] * u + b_[k] * x,
                   g1 = grid_.a[right] * u + grid_.b[right] * x1;
      if (std::abs(g) > 1 + kGridExcess) return true;
      // The parabola is g0 + slope·t + bend·t², for t in [0, 1]. Its extremum is at
      // −slope/(2·bend).
      const double slope = 4 * g - 3 * g0 - g1, bend = 2 * (g0 - 2 * g + g1);
      if (slope * bend < 0 && std::abs(slope) < 2 * std::abs(bend) &&
          std::abs(g0 - slope * slope / (4 * bend)) > 1 + kGridExcess)
        return true;
    }
    return false;
  }

  void fill() {
    grid_ = LimitGrid();
    grid_.bands = bands_.count();
    for (const Node& node : nodes_) addNode(node, grid_);
  }

  void addNode(const Node& node, LimitGrid& grid) const {
    const PathRun::Part& part = run_.parts[node.part];
    const std::size_t at = grid.a.size();
    grid.a.resize(at + grid.bands);
    grid.b.resize(at + grid.bands);
    grid.s.push_back(node.s);
    grid.xMax.push_back(
        bands_.at(part.piece, node.tau, part.length, grid.a.data() + at, grid.b.data() + at));
  }

  void copyNode(std::size_t i, LimitGrid& grid) const {
    grid.s.push_back(grid_.s[i]);
    grid.xMax.push_back(grid_.xMax[i]);
    const auto begin = static_cast<std::ptrdiff_t>(i * grid.bands),
               end = begin + static_cast<std::ptrdiff_t>(grid.bands);
    grid.a.insert(grid.a.end(), grid_.a.begin() + begin, grid_.a.begin() + end);
    grid.b.insert(grid.b.end(), grid_.b.begin() + begin, grid_.b.begin() + end);
  }

  const PathRun& run_;
  const LimitBands& bands_;
  std::vector<double> begins_;  // s at the start of each part
  double total_ = 0;
  bool straight_ = false;
  std::vector<Node> nodes_;
  LimitGrid grid_;
  std::vector<double> a_, b_;  // scratch memory
};

}  // namespace

RunLaw fastestLaw(const PathView& view, const PathRun& run, const LimitBands& bands, double start,
                  double end, int intervals) {
  RunGrid grid(view, run, bands);
  const bool closed = grid.isStraight() && !bands.varies();
  if (closed)
    grid.setSwitches(start * start, end * end);
  else
    grid.setUniform(intervals);
  Profile profile = grid.solve(start * start, end * end);
  for (int round = 0; !closed && round < kRounds; ++round) {
    if (profile.failure != Profile::Failure::none || !grid.refine(profile)) break;
    profile = grid.solve(start * start, end * end);
  }
  RunLaw law;
  if (profile.failure != Profile::Failure::none) {
    const Node& node = grid.node(profile.node);
    law.failure = profile.failure;
    law.piece = run.parts[node.part].piece;
    law.tau = node.tau;
    law.lower = std::sqrt(std::max(0.0, profile.lower));
    law.upper = std::sqrt(std::max(0.0, profile.upper));
    return law;
  }
  law.segments = grid.segments(profile);
  return law;
}

}  // namespace corridor
