#include "planner/solve/keep_clearance.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

namespace corridor {

namespace {

/// The share of an edge is the part of its clearance targets that it keeps, from 0 to 1
/// (keep_clearance.h). A change replaces some edges by others. It must raise the smallest share of
/// these edges by at least kLeastGain, or to at least kAlmost.
constexpr double kLeastGain = 0.05, kAlmost = 0.98;
/// The maximum number of times that a step away from obstacles is halved.
constexpr int kHalvings = 2;
/// If the smallest share is this near to an end of the edge (in t), moving this end is tried before
/// inserting a state.
constexpr double kNearEnd = 0.25;
/// The maximum number of times that `improve` is called.
constexpr int kTries = 60;

class PathMover {
 public:
  PathMover(const ClearanceTargets& targets, const ConfigurationSpace& space, double longest,
            EdgeMemory& edges, EdgeMemory& onTarget, const std::function<bool()>& stop)
      : targets_(targets),
        space_(space),
        longest_(longest),
        free_(edges),
        onTarget_(onTarget),
        stop_(stop) {}

  Path run(const Path& path);

 private:
  /// An edge of the path, from state `from` to the `from` of the next edge.
  struct Edge {
    Configuration from;
    double length = 0;
    bool kept = false;  // every pair is proved to keep its target
    ClearanceTargets::Worst worst;
    int halvings = 0;      // halvings of the next step away from obstacles
    bool changed = false;  // not an edge of the original path
  };

  const Configuration& endOf(std::size_t edge) const {
    return edge + 1 < edges_.size() ? edges_[edge + 1].from : last_;
  }
  /// @param enough see `ClearanceTargets::missedOn`.
  Edge measured(const Configuration& from, const Configuration& to, double enough = 0);
  /// Adds an edge that keeps all targets to both memories.
  void addKept(const Configuration& from, const Configuration& to) {
    free_.addFree(from, to);
    onTarget_.addFree(from, to);
  }
  std::optional<std::size_t> worstEdge() const;
  bool improve(std::size_t edge);
  bool replace(std::size_t first, std::size_t last, const Configuration& by);
  void removeStates();

  const ClearanceTargets& targets_;
  const ConfigurationSpace& space_;
  double longest_;
  EdgeMemory &free_, &onTarget_;
  const std::function<bool()>& stop_;
  std::vector<Edge> edges_;
  Configuration last_;
  double length_ = 0;
};

PathMover::Edge PathMover::measured(const Configuration& from, const Configuration& to,
                                    double enough) {
  std::optional<ClearanceTargets::Worst> missed;
  if (!onTarget_.knowsFree(from, to)) missed = targets_.missedOn(from, to, enough);
  if (!missed) addKept(from, to);
  return {from, space_.distance(from, to), !missed, missed.value_or(ClearanceTargets::Worst())};
}

/// Returns the edge with the smallest share among the edges that can be changed.
std::optional<std::size_t> PathMover::worstEdge() const {
  std::optional<std::size_t> worst;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Edge& edge = edges_[i];
    if (edge.kept || edge.halvings > kHalvings || edge.worst.share >= 1) continue;
    if (!worst || edge.worst.share < edges_[*worst].worst.share) worst = i;
  }
  return worst;
}

/// Replaces the states between the beginning of edge `first` and the end of edge `last` by one
/// state.
/// @returns false, and changes nothing, if the new edges are not free, not better or too long.
bool PathMover::replace(std::size_t first, std::size_t last, const Configuration& by) {
  double length = length_, share = 1;
  for (std::size_t i = first; i <= last; ++i) {
    length -= edges_[i].length;
    share = std::min(share, edges_[i].worst.share);
  }
  const Configuration from = edges_[first].from, to = endOf(last);
  length += space_.distance(from, by) + space_.distance(by, to);
  if (length > longest_) return false;
  const double enough = std::min(share + kLeastGain, kAlmost);
  std::vector<Edge> edges;
  for (const auto& [a, b] : {std::pair(from, by), std::pair(by, to)}) {
    if (stop_()) return false;
    edges.push_back(measured(a, b, enough));
    Edge& edge = edges.back();
    edge.changed = true;
    if (edge.kept) continue;
    if (edge.worst.share < enough) return false;
    if (!free_.isFree(a, b)) return false;
  }
  const auto begin = edges_.begin() + static_cast<std::ptrdiff_t>(first);
  edges_.erase(begin, edges_.begin() + static_cast<std::ptrdiff_t>(last) + 1);
  edges_.insert(edges_.begin() + static_cast<std::ptrdiff_t>(first), edges.begin(), edges.end());
  length_ = length;
  return true;
}

/// Tries to move the path away from obstacles, at the time of the smallest share on an edge.
/// @returns whether the path was changed.
bool PathMover::improve(std::size_t i) {
  const Configuration from = edges_[i].from, to = endOf(i);
  const double t = edges_[i].worst.t;
  const Configuration at = space_.interpolate(from, to, t);
  const auto apart = targets_.movedApart(at);
  if (!apart) return false;
  const double part = 1.0 / (1 << edges_[i].halvings);
  const Configuration by = part < 1 ? space_.interpolate(at, *apart, part) : *apart;
  if (t < kNearEnd && i > 0 && replace(i - 1, i, by)) return true;
  if (t > 1 - kNearEnd && i + 1 < edges_.size() && replace(i, i + 1, by)) return true;
  return replace(i, i, by);
}

void PathMover::removeStates() {
  for (std::size_t i = 1; i < edges_.size() && !stop_();) {
    const Configuration from = edges_[i - 1].from, to = endOf(i);
    const bool isNew = edges_[i - 1].changed || edges_[i].changed;
    if (!isNew || !onTarget_.isFree(from, to)) {
      ++i;
      continue;
    }
    free_.addFree(from, to);
    edges_[i - 1] = {from, space_.distance(from, to), true, {}, 0, true};
    edges_.erase(edges_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

Path PathMover::run(const Path& path) {
  last_ = path.back();
  for (std::size_t i = 0; i + 1 < path.size() && !stop_(); ++i) {
    edges_.push_back(measured(path[i], path[i + 1]));
    length_ += edges_.back().length;
  }
  if (edges_.size() + 1 < path.size() || edges_.empty()) return path;
  for (int n = 0; n < kTries && !stop_(); ++n) {
    const auto worst = worstEdge();
    if (!worst) break;
    if (!improve(*worst)) ++edges_[*worst].halvings;
  }
  removeStates();
  Path moved;
  for (const Edge& edge : edges_) moved.push_back(edge.from);
  moved.push_back(last_);
  return moved;
}

}  // namespace

double preferredClearance(const Problem& problem) {
  constexpr double kForArms = 0.005, kMost = 1e6;  // m
  const Settings& settings = problem.settings;
  if (whyNoClearance(problem.task.margin, settings)) return 0;
  const double byDefault = hasSingleJoints(problem.model.space) ? kForArms : 0;
  return std::min(settings.prefer.clearance.value_or(byDefault), kMost);
}

Path withClearance(const ClearanceTargets& targets, const ConfigurationSpace& space,
                   const Path& path, double longest, EdgeMemory& edges, EdgeMemory& onTarget,
                   const std::function<bool()>& stop) {
  return PathMover(targets, space, longest, edges, onTarget, stop).run(path);
}

}  // namespace corridor
