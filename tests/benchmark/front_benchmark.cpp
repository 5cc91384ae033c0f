/// Measures what a front saves for meshes that move in small steps:
/// `front_benchmark [--triangles N] [--steps N] [--cpu N]`.
///
/// Two tori with bumps (20,000 triangles each by default) pass each other at a gap of 0.1, 0.01 or
/// 0.001 of their size; b slides along a, back and forth, and rotates. For each length of a step,
/// as a fraction of the size, prints CSV: the mean microseconds and N_v per query without a front
/// (4-wide OBB tree, binary OBBs, RSSs) and with a front (binary OBBs, RSSs), and the number of
/// node pairs in the front.
#include <chrono>
#include <cstdio>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "collision/course/front.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/volumes/pair_tests.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/placement.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

struct Cost {
  double us = 0, boxTests = 0;
};

template <class Query>
Cost measure(const std::vector<Transform>& poses, const Query& query) {
  QueryContext context;
  const auto start = std::chrono::steady_clock::now();
  for (const Transform& X : poses) query(X, context);
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
  const auto n = static_cast<double>(poses.size());
  return {time.count() / n, static_cast<double>(context.counters.boxTests) / n};
}

void run(const bench::Arguments& arguments) {
  bench::pin(arguments);
  const TriangleMesh torus =
      bench::bumpyTorus(static_cast<std::size_t>(arguments.number("--triangles", 20'000)));
  const auto steps = static_cast<int>(arguments.number("--steps", 400));
  const double size = bench::diagonal(torus);
  const Obb4Tree wide(torus);
  const VolumeTree<Obb> obb(torus);
  const VolumeTree<Rss> rss(torus);
  std::mt19937_64 random(7);
  std::puts(
      "gap,step,obb4_us,obb4_tests,obb_us,obb_tests,rss_us,rss_tests,front_obb_us,front_obb_tests,"
      "front_rss_us,front_rss_tests,front_size,contacts");
  for (const double gap : {0.1, 0.01, 0.001}) {
    const Transform begin = bench::posesAtGap(wide, wide, gap * size, 1, random).front();
    const Vec3 across = begin.t.unitOrthogonal();
    for (const double step : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
      std::vector<Transform> poses;
      // b moves back and forth, orthogonally to the direction of the gap, by a quarter of the gap
      // or by four steps, whichever is more.
      const double reach = std::max(0.25 * gap, 4 * step) * size;
      for (int i = 0; i < steps; ++i) {
        const double along = std::abs(std::remainder(step * size * i, 4 * reach)) - reach;
        poses.push_back({Eigen::AngleAxisd(along / size, across).toRotationMatrix() * begin.m,
                         begin.t + along * across});
      }
      int contacts = 0;
      Front frontObb, frontRss;
      const Cost costs[] = {
          measure(poses,
                  [&](const Transform& X, QueryContext& context) {
                    contacts += interference(Posed(wide), Posed(wide, X), context).has_value();
                  }),
          measure(poses,
                  [&](const Transform& X, QueryContext& context) {
                    interference(Posed(obb), Posed(obb, X), context);
                  }),
          measure(poses,
                  [&](const Transform& X, QueryContext& context) {
                    interference(Posed(rss), Posed(rss, X), context);
                  }),
          measure(poses,
                  [&](const Transform& X, QueryContext& context) {
                    interference(obb, Posed(obb, X), frontObb, context);
                  }),
          measure(poses, [&](const Transform& X, QueryContext& context) {
            interference(rss, Posed(rss, X), frontRss, context);
          })};
      std::printf("%g,%g", gap, step);
      for (const Cost& c : costs) std::printf(",%.3g,%.4g", c.us, c.boxTests);
      std::printf(",%zu,%d\n", frontRss.size(), contacts);
      std::fflush(stdout);
    }
  }
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--triangles", "--steps", "--cpu"}, corridor::run);
}
