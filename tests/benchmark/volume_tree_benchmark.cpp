/// Measures the cost of every bounding volume in generic trees: `volume_tree_benchmark WORKLOAD
/// [FOLDER]`.
///
/// WORKLOAD is the name of a shared collision workload in FOLDER (default:
/// $CORRIDOR_DATA/collision). Prints CSV on stdout, with one row per volume and build method, and
/// one row for the octree (a tree that divides space). Columns: milliseconds to build and to refit
/// the tree of the first mesh (least of three), the bytes of this tree, median microseconds of
/// interference, distance and "closer than 10^-3 of the size?" over the poses, and the means of N_v
/// and N_p of interference. For the octree, refitting and distances are not measured.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <limits>
#include <string>
#include <vector>

#include "collision/course/octree_interference.h"
#include "collision/queries/distance.h"
#include "collision/queries/interference.h"
#include "collision/volumes/pair_tests.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

template <class F>
double microseconds(F&& f) {
  const auto start = std::chrono::steady_clock::now();
  f();
  return std::chrono::duration<double, std::micro>(std::chrono::steady_clock::now() - start)
      .count();
}

/// Returns the median time over the poses, in microseconds.
template <class Query>
double median(const test::Workload& w, QueryContext& context, const Query& query) {
  context.counters = {};
  std::vector<double> times;
  for (const Transform& X : w.poses) times.push_back(microseconds([&] { query(X); }));
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return *middle;
}

void printTests(const test::Workload& w, const Counters& counters) {
  const auto n = static_cast<double>(w.poses.size());
  std::printf("%.1f,%.1f\n", static_cast<double>(counters.boxTests) / n,
              static_cast<double>(counters.primitiveTests) / n);
}

template <class Volume>
void measure(const char* name, const test::Workload& w, TreeBuilding building) {
  TreeParams params;
  params.building = building;
  VolumeTree<Volume> a(w.a, params);
  const VolumeTree<Volume> b(w.b, params);
  double build = std::numeric_limits<double>::infinity(), refit = build;
  for (int i = 0; i < 3; ++i) {
    build = std::min(build, microseconds([&] { a = VolumeTree<Volume>(w.a, params); }));
    refit = std::min(refit, microseconds([&] { a.refit(w.a); }));
  }
  QueryContext context;
  const double apart =
      median(w, context, [&](const Transform& X) { distance(Posed(a), Posed(b, X), {}, context); });
  const double tolerance = 1e-3 * a.node(0).radius;
  const double close = median(w, context, [&](const Transform& X) {
    closerThan(Posed(a), Posed(b, X), tolerance, context);
  });
  const double touch =
      median(w, context, [&](const Transform& X) { interference(Posed(a), Posed(b, X), context); });
  std::printf("%s,%s,%.3f,%.3f,%zu,%.2f,%.2f,%.2f,", name,
              building == TreeBuilding::topDown ? "top-down" : "bottom-up", build / 1e3,
              refit / 1e3, a.bytes(), touch, apart, close);
  printTests(w, context.counters);
}

void measureOctree(const test::Workload& w) {
  const Octree a(w.a), b(w.b);
  double build = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i)
    build = std::min(build, microseconds([&] { const Octree again(w.a); }));
  QueryContext context;
  const double touch =
      median(w, context, [&](const Transform& X) { interference(Posed(a), Posed(b, X), context); });
  std::printf("octree,over space,%.3f,,%zu,%.2f,,,", build / 1e3, a.bytes(), touch);
  printTests(w, context.counters);
}

void run(const test::Workload& w) {
  std::puts(
      "volume,building,build_ms,refit_ms,bytes,interference_us,distance_us,closer_us,bv_tests,"
      "triangle_tests");
  for (const TreeBuilding building : {TreeBuilding::topDown, TreeBuilding::bottomUp}) {
    measure<Obb>("obb", w, building);
    measure<Rss>("rss", w, building);
    measure<Aabb>("aabb", w, building);
    measure<BoundingSphere>("sphere", w, building);
    measure<Kdop<14>>("kdop14", w, building);
    measure<Kdop<18>>("kdop18", w, building);
    measure<Kdop<26>>("kdop26", w, building);
    measure<Shell>("shell", w, building);
    measure<Ellipsoid>("ellipsoid", w, building);
    measure<Hull>("hull", w, building);
  }
  measureOctree(w);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  const auto data = corridor::test::dataFolder();
  if (argc < 2 || (argc < 3 && !data)) {
    std::fputs("usage: volume_tree_benchmark WORKLOAD [FOLDER] (or set CORRIDOR_DATA)\n", stderr);
    return 2;
  }
  try {
    corridor::run(corridor::test::loadWorkload(
        argc > 2 ? std::filesystem::path(argv[2]) : *data / "collision", argv[1]));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
  return 0;
}
