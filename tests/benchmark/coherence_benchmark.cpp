/// Measures what temporal coherence saves for convex polytopes that move in small steps:
/// `coherence_benchmark [--most N] [--steps N] [--cpu N]`.
///
/// Two polytopes of n vertices, hulls of random points on a sphere, pass each other at a gap of 5 %
/// of their size, or overlap by 5 % of their size, and rotate. For each length of a step (as a
/// fraction of the size), the program runs each query cold, and warm. A cold query starts
/// anew. A warm query begins with what the previous query has kept: the simplex of GJK
/// (collision/convex/convex_cache.h), the features of V-Clip, or the last separating axis. Prints
/// CSV: the mean time of a query in microseconds, the least of three runs; their ratio; and mean
/// numbers of steps. Steps are iterations of GJK, for V-Clip also pairs of features, and for
/// separating axes the axes tested.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/separating_axes.h"
#include "collision/course/vclip.h"
#include "tests/benchmark/arguments.h"

namespace corridor {
namespace {

struct Motion {
  std::vector<Transform> poses;
};

Motion passing(double gap, double step, std::size_t steps) {
  Motion motion;
  for (std::size_t i = 0; i < steps; ++i) {
    const double along = step * (static_cast<double>(i) - 0.5 * static_cast<double>(steps));
    // One polytope moves on a circle around the other, so that the gap stays the same.
    const double angle = along / (2 + gap);
    motion.poses.push_back({Eigen::AngleAxisd(along, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                            (2 + gap) * Vec3(std::cos(angle), std::sin(angle), 0)});
  }
  return motion;
}

/// What a query leaves for the next one.
struct Last {
  ConvexCache simplex;
  FeaturePair features;
  SeparatingAxis axis;
};

struct Mean {
  double microseconds = HUGE_VAL, steps = 0;
};

/// @param call runs query i as call(i, last), and returns the number of steps of the query.
template <class Call>
Mean meanOf(std::size_t count, bool warm, const Call& call) {
  Mean mean;
  for (int round = 0; round < 3; ++round) {
    Last last;
    std::size_t steps = 0;
    const auto before = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) {
      if (!warm) last = {};
      steps += call(i, last);
    }
    const std::chrono::duration<double, std::micro> time =
        std::chrono::steady_clock::now() - before;
    mean.microseconds = std::min(mean.microseconds, time.count() / static_cast<double>(count));
    mean.steps = static_cast<double>(steps) / static_cast<double>(count);
  }
  return mean;
}

/// Polytopes of more vertices are not tested by separating axes, because such a query takes O(n²)
/// time.
constexpr std::size_t kMostForAxes = 100;

void measure(std::size_t n, std::size_t steps) {
  std::mt19937_64 random(n);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points(n);
  for (Vec3& p : points) p = Vec3(normal(random), normal(random), normal(random)).normalized();
  const DobkinKirkpatrick hierarchy{Polytope(points)};
  const auto vertices = hierarchy.polytope().vertices();
  const ConvexPart part{{vertices.begin(), vertices.end()}, 0, false};
  const PolytopeFeatures features(hierarchy);
  std::size_t sink = 0;
  for (const double step : {0.0001, 0.001, 0.01, 0.1, 0.3})
    for (const double gap : {0.1, -0.1}) {
      const Motion motion = passing(gap, 2 * step, steps);
      const auto row = [&](const std::string& query, const std::string& by, const auto& call) {
        const Mean cold = meanOf(steps, false, call), warm = meanOf(steps, true, call);
        std::cout << n << ',' << query << ',' << by << ',' << step << ',' << cold.microseconds
                  << ',' << warm.microseconds << ',' << warm.microseconds / cold.microseconds << ','
                  << cold.steps << ',' << warm.steps << std::endl;
      };
      const std::string contact = gap > 0 ? "contact apart" : "contact overlapping";
      struct Way {
        std::string name;
        ConvexSet set;
      };
      for (const Way& way : {Way{"every vertex", part}, Way{"hill climbing", hierarchy.polytope()},
                             Way{"hierarchy", hierarchy}}) {
        row(contact, way.name, [&](std::size_t i, Last& last) {
          sink += convexSetsTouch({way.set, {}}, {way.set, motion.poses[i]}, &last.simplex);
          return static_cast<std::size_t>(last.simplex.rounds);
        });
        if (gap < 0) continue;
        row("distance", way.name, [&](std::size_t i, Last& last) {
          sink += convexDistance({way.set, {}}, {way.set, motion.poses[i]}, 0, 0, &last.simplex)
                      .distance > 1;
          return static_cast<std::size_t>(last.simplex.rounds);
        });
      }
      row(gap > 0 ? "distance" : contact, "V-Clip", [&](std::size_t i, Last& last) {
        const ClosestFeatures found =
            closestFeatures(features, {}, features, motion.poses[i], last.features);
        sink += found.distance.distance > 1;
        return static_cast<std::size_t>(found.steps + found.rounds);
      });
      if (n <= kMostForAxes)
        row(contact, "separating axes", [&](std::size_t i, Last& last) {
          last.axis = separatingAxis(features, {}, features, motion.poses[i], &last.axis);
          return last.axis.faces + last.axis.edgePairs;
        });
    }
  // Uses the results, so that the compiler can't remove the queries.
  if (sink == 1) std::cerr << ' ';
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  using namespace corridor;
  return bench::runWith(argc, argv, {"--most", "--steps", "--cpu"}, [](const bench::Arguments& a) {
    std::cerr << "pinned to CPU " << bench::pin(a) << "\n";
    std::cout << "vertices,query,by,step,cold,warm,ratio,cold_steps,warm_steps\n"
              << std::setprecision(4);
    const double most = a.number("--most", 1e5);
    for (std::size_t n = 10; static_cast<double>(n) <= most; n *= 10)
      measure(n, static_cast<std::size_t>(a.number("--steps", 300)));
  });
}
