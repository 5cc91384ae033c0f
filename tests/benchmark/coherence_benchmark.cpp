/// Measures what temporal coherence saves for convex polytopes that move in small steps:
/// `coherence_benchmark [--most N] [--steps N] [--cpu N]`.
///
/// Two polytopes of n vertices, hulls of random points on a sphere, pass each other at a gap of 5 %
/// of their size, or with an overlap of as much, and rotate. For each motion per step (as a share
/// of the size), the program runs each query cold and with a cache
/// (collision/convex/convex_cache.h). Prints CSV: mean times in microseconds, each the least of
/// three runs, and their ratio.
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
#include "collision/convex/dobkin_kirkpatrick.h"
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
    // On a circle around the other body, so that the gap stays the same.
    const double angle = along / (2 + gap);
    motion.poses.push_back({Eigen::AngleAxisd(along, Vec3(1, 2, 3).normalized()).toRotationMatrix(),
                            (2 + gap) * Vec3(std::cos(angle), std::sin(angle), 0)});
  }
  return motion;
}

template <class Call>
double meanMicroseconds(std::size_t count, const Call& call) {
  double least = HUGE_VAL;
  for (int round = 0; round < 3; ++round) {
    ConvexCache cache;
    const auto before = std::chrono::steady_clock::now();
    for (std::size_t i = 0; i < count; ++i) call(i, &cache);
    const std::chrono::duration<double, std::micro> time =
        std::chrono::steady_clock::now() - before;
    least = std::min(least, time.count() / static_cast<double>(count));
  }
  return least;
}

void measure(std::size_t n, std::size_t steps) {
  std::mt19937_64 random(n);
  std::normal_distribution<double> normal;
  std::vector<Vec3> points(n);
  for (Vec3& p : points) p = Vec3(normal(random), normal(random), normal(random)).normalized();
  const DobkinKirkpatrick hierarchy{Polytope(points)};
  const auto vertices = hierarchy.polytope().vertices();
  const ConvexPart part{{vertices.begin(), vertices.end()}, 0, false};
  struct Way {
    std::string name;
    ConvexSet set;
  };
  std::size_t sink = 0;
  for (const Way& way : {Way{"every vertex", part}, Way{"hill climbing", hierarchy.polytope()},
                         Way{"hierarchy", hierarchy}})
    for (const double step : {0.001, 0.01, 0.1}) {
      const auto row = [&](const std::string& query, const auto& call) {
        const double cold =
            meanMicroseconds(steps, [&](std::size_t i, ConvexCache*) { call(i, nullptr); });
        const double warm = meanMicroseconds(steps, call);
        std::cout << n << ',' << query << ',' << way.name << ',' << step << ',' << cold << ','
                  << warm << ',' << warm / cold << std::endl;
      };
      for (const double gap : {0.1, -0.1}) {
        const Motion motion = passing(gap, 2 * step, steps);
        row(gap > 0 ? "contact apart" : "contact overlapping",
            [&](std::size_t i, ConvexCache* cache) {
              sink += convexSetsTouch({way.set, {}}, {way.set, motion.poses[i]}, cache);
            });
        if (gap > 0)
          row("distance", [&](std::size_t i, ConvexCache* cache) {
            sink +=
                convexDistance({way.set, {}}, {way.set, motion.poses[i]}, 0, 0, cache).distance > 1;
          });
      }
    }
  if (sink == 1) std::cerr << ' ';  // keeps the results
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  using namespace corridor;
  return bench::runWith(argc, argv, {"--most", "--steps", "--cpu"}, [](const bench::Arguments& a) {
    std::cerr << "pinned to CPU " << bench::pin(a) << "\n";
    std::cout << "vertices,query,by,step,cold,warm,ratio\n" << std::setprecision(4);
    const double most = a.number("--most", 1e5);
    for (std::size_t n = 10; static_cast<double>(n) <= most; n *= 10)
      measure(n, static_cast<std::size_t>(a.number("--steps", 300)));
  });
}
