#include "planner/view/path_samples.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>

namespace corridor::view {
namespace {

// Largest rotation of a body from sample to sample, rad.
constexpr double kTurn = std::numbers::pi / 90;
// Largest step from sample to sample, as a fraction of the path's length.
constexpr double kShare = 1.0 / 400;
constexpr double kMostSamples = 1500;
// The number of pieces of an edge, for an estimate of how far the bodies move on it.
constexpr int kPiecesForEstimate = 8;

/// Measures how far the moving bodies move from one configuration to another.
class Travel {
 public:
  explicit Travel(const Problem& problem) {
    for (const ModelBody& body : problem.model.bodies) {
      if (!body.robot) continue;
      Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;
      for (const PlacedShape& shape : body.shapes)
        forEachPoint(shape, [&](const Vec3& p, double radius) {
          lower = lower.cwiseMin(Vec3(p.array() - radius));
          upper = upper.cwiseMax(Vec3(p.array() + radius));
        });
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 p(corner & 1 ? upper.x() : lower.x(), corner & 2 ? upper.y() : lower.y(),
                     corner & 4 ? upper.z() : lower.z());
        corners_.push_back({body.frame, p});
      }
    }
  }

  /// Returns the largest distance that a corner of a body's bounds moves, metres.
  double between(const std::vector<Transform>& from, const std::vector<Transform>& to) const {
    double farthest = 0;
    for (const auto& [frame, p] : corners_)
      farthest = std::max(farthest, (to[frame] * p - from[frame] * p).norm());
    return farthest;
  }

 private:
  struct Corner {
    std::size_t frame;
    Vec3 p;
  };
  std::vector<Corner> corners_;
};

/// Returns the largest rotation of a frame, radians.
double turnBetween(const std::vector<Transform>& from, const std::vector<Transform>& to) {
  double largest = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    largest = std::max(largest,
                       Eigen::Quaterniond(from[i].m).angularDistance(Eigen::Quaterniond(to[i].m)));
  return largest;
}

/// Returns the parameters t of the samples of an edge: evenly spaced ones, and those of the
/// findings on the edge.
std::vector<double> parametersOf(std::size_t edge, double steps,
                                 const std::vector<PathFinding>& findings) {
  std::vector<double> all;
  const auto count = static_cast<int>(std::max(1.0, std::ceil(steps)));
  for (int k = 0; k <= count; ++k) all.push_back(static_cast<double>(k) / count);
  for (const PathFinding& finding : findings)
    if (static_cast<std::size_t>(finding.edge) == edge)
      all.push_back(std::clamp(finding.t, 0.0, 1.0));
  std::sort(all.begin(), all.end());
  all.erase(std::unique(all.begin(), all.end()), all.end());
  return all;
}

/// Sets `at` of each sample to the elapsed fraction of the duration.
void placeByTime(const std::vector<double>& times, std::vector<PathSample>& samples) {
  for (PathSample& s : samples) {
    const double begin = times[s.edge], end = times[s.edge + 1];
    const double time = s.t < 1 ? std::min(begin + s.t * (end - begin), end) : end;
    s.at = (time - times.front()) / (times.back() - times.front());
  }
}

/// Divides `at` of each sample, which is the distance moved so far, by the total distance. If
/// nothing moves, sets `at` to evenly spaced numbers.
void placeByDistance(std::vector<PathSample>& samples) {
  const double length = samples.back().at;
  for (std::size_t i = 1; i < samples.size(); ++i)
    samples[i].at = length > 0 ? samples[i].at / length
                               : static_cast<double>(i) / static_cast<double>(samples.size() - 1);
}

}  // namespace

PathSamples samplePath(const Problem& problem, std::size_t edges, const ConfigurationOnEdge& at,
                       const std::vector<double>& times, const std::vector<PathFinding>& findings) {
  const Travel travel(problem);
  const auto poses = [&](std::size_t edge, double t) {
    return framePoses(problem.model.tree, at(edge, t));
  };
  std::vector<double> ways(edges), turns(edges);
  double way = 0;
  for (std::size_t edge = 0; edge < edges; ++edge) {
    std::vector<Transform> from = poses(edge, 0);
    for (int k = 1; k <= kPiecesForEstimate; ++k) {
      std::vector<Transform> to = poses(edge, static_cast<double>(k) / kPiecesForEstimate);
      ways[edge] += travel.between(from, to);
      turns[edge] += turnBetween(from, to);
      from = std::move(to);
    }
    way += ways[edge];
  }
  std::vector<double> steps(edges);
  double sum = 0;
  for (std::size_t edge = 0; edge < edges; ++edge) {
    const double share = way > 0 ? ways[edge] / way : 0;
    sum += steps[edge] = std::max({4.0, share / kShare, turns[edge] / kTurn});
  }

  PathSamples result;
  result.samples.push_back({0, 0, 0, poses(0, 0)});
  result.states.push_back(0);
  for (std::size_t edge = 0; edge < edges; ++edge) {
    const double fewer = std::min(1.0, kMostSamples / sum);
    for (const double t : parametersOf(edge, fewer * steps[edge], findings)) {
      if (t == 0) continue;  // this state already is a sample: the last sample of the previous edge
      PathSample sample{edge, t, 0, poses(edge, t)};
      const PathSample& before = result.samples.back();
      sample.at = before.at + travel.between(before.X_WF, sample.X_WF);
      result.samples.push_back(std::move(sample));
    }
    result.states.push_back(result.samples.size() - 1);
  }
  if (times.empty())
    placeByDistance(result.samples);
  else
    placeByTime(times, result.samples);
  for (const PathFinding& finding : findings) {
    const auto edge = std::min(static_cast<std::size_t>(finding.edge), edges);
    std::size_t sample = result.states[edge];
    if (finding.t > 0 && edge < edges) {
      ++sample;
      while (sample < result.states[edge + 1] && result.samples[sample].t < finding.t) ++sample;
    }
    result.findings.push_back(sample);
  }
  return result;
}

PathSamples samplePath(const Problem& problem, const Path& path,
                       const std::vector<PathFinding>& findings) {
  const auto at = [&](std::size_t edge, double t) {
    return path.size() == 1 ? path[0]
                            : problem.model.space.interpolate(path[edge], path[edge + 1], t);
  };
  return samplePath(problem, path.size() - 1, at, {}, findings);
}

}  // namespace corridor::view
