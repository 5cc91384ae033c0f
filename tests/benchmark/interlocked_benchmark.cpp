/// Measures whole queries of two large interlocked models along a path in close proximity, for
/// every volume: `interlocked_benchmark [--triangles N] [--steps N] [--cpu N]`.
///
/// Gottschalk, Lin and Manocha 1996 had a wrinkled torus that moves among pipes. Here a torus with
/// bumps (N triangles, 100,000 by default) moves through eight pipes that are bent to rings (N/5
/// triangles in all). Each ring is a link of a chain with the torus. The bumps come as close to the
/// rings as 0.02 of the torus' radius. During all steps (1,000 by default) the torus makes one turn
/// about its axis, and sways by up to 0.02, so that it comes close to the rings. The query is
/// interference. It uses nothing from the previous step.
///
/// Prints CSV on stdout, one row for each volume:
/// * steps, contacts: the number of steps, and at how many of them the models touch;
/// * bv_tests, triangle_tests: N_v and N_p, means over the steps;
/// * us: the mean time of a step;
/// * bv_test_ns, triangle_test_ns, traversal_ns: C_v and C_p, measured test by test, and the time
///   of the traversal per volume test. These are measured at even steps;
/// * predicted_us, measured_us: the mean time of a query at odd steps, once predicted by these
///   costs, once measured;
/// * bytes, build_ms: memory and building time of both trees together.
///
/// For the 4-wide OBB tree (obb), single tests can't be measured separately, so the columns from
/// bv_test_ns to measured_us are empty. The cost of triangle tests is empty if no triangles are
/// tested.
#include <chrono>
#include <cstdio>
#include <numbers>
#include <random>
#include <type_traits>
#include <vector>

#include "collision/course/cost_model.h"
#include "collision/course/query_timing.h"
#include "collision/course/test_costs.h"
#include "collision/hierarchy/with_trees.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

/// Returns eight rings around the tube of `bench::bumpyTorus`.
TriangleMesh rings(std::size_t triangles) {
  constexpr int kRings = 8;
  constexpr double kRadius = 0.52, kPipe = 0.06;  // the inner radius is 0.46; the bumps reach 0.44
  const auto around = static_cast<std::uint32_t>(
      std::max(6.0, std::sqrt(static_cast<double>(triangles) / kRings / 2 / 4)));
  const std::uint32_t along = 4 * around;
  TriangleMesh mesh;
  for (int ring = 0; ring < kRings; ++ring) {
    const double angle = kTurn * ring / kRings;
    const Vec3 out(std::cos(angle), std::sin(angle), 0), up = Vec3::UnitZ(), side = out.cross(up);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t i = 0; i < along; ++i)
      for (std::uint32_t j = 0; j < around; ++j) {
        const double u = kTurn * i / along, v = kTurn * j / around;
        const Vec3 radial = std::cos(u) * out + std::sin(u) * up;
        mesh.vertices.push_back(out + (kRadius + kPipe * std::cos(v)) * radial +
                                kPipe * std::sin(v) * side);
      }
    const auto at = [&](std::uint32_t i, std::uint32_t j) {
      return first + i % along * around + j % around;
    };
    for (std::uint32_t i = 0; i < along; ++i)
      for (std::uint32_t j = 0; j < around; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
        mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return mesh;
}

/// Returns the poses of the torus.
std::vector<Transform> path(int steps) {
  std::vector<Transform> poses;
  for (int i = 0; i < steps; ++i) {
    const double t = kTurn * i / steps;
    Transform X;
    X.m << std::cos(t), -std::sin(t), 0, std::sin(t), std::cos(t), 0, 0, 0, 1;
    X.t = 0.012 * Vec3(std::sin(3 * t), std::sin(5 * t), std::sin(7 * t));
    poses.push_back(X);
  }
  return poses;
}

template <class Tree>
void measure(const char* name, const TriangleMesh& meshA, const TriangleMesh& meshB,
             const std::vector<Transform>& poses) {
  const auto start = std::chrono::steady_clock::now();
  const Tree a(meshA), b(meshB);
  const std::chrono::duration<double, std::milli> build = std::chrono::steady_clock::now() - start;
  QueryContext context;
  std::vector<QueryCost> costs;
  int contacts = 0;
  QueryCost sum;
  for (const Transform& X : poses) {
    bool hit = false;
    const auto query = [&] {
      context.counters = {};
      hit = interference(Posed(a), Posed(b, X), context).has_value();
    };
    double ns = nanosecondsOf(query, query);
    for (int i = 0; i < 2; ++i) ns = std::min(ns, nanosecondsOf(query, query));
    contacts += hit;
    costs.push_back({static_cast<double>(context.counters.boxTests),
                     static_cast<double>(context.counters.primitiveTests), ns});
    sum.boxTests += costs.back().boxTests;
    sum.primitiveTests += costs.back().primitiveTests;
    sum.ns += ns;
  }
  const auto n = static_cast<double>(poses.size());
  std::printf("%s,%zu,%d,%.1f,%.1f,%.3f,", name, poses.size(), contacts, sum.boxTests / n,
              sum.primitiveTests / n, sum.ns / n / 1e3);
  if constexpr (std::is_same_v<Tree, Obb4Tree>) {
    std::printf(",,,,,");
  } else {
    std::vector<QueryCost> seen;
    std::vector<Transform> posesSeen;
    for (std::size_t i = 0; i < costs.size(); i += 2) {
      seen.push_back(costs[i]);
      posesSeen.push_back(poses[i]);
    }
    std::shuffle(posesSeen.begin(), posesSeen.end(), std::mt19937_64(1));
    const TestCosts tests = testCosts<StandardOverlap>(a, b, posesSeen);
    CostModel model{tests.box.value_or(0), tests.triangle.value_or(0)};
    const double traversal = traversalShare(seen, model, 0);
    model.box += traversal;
    double predicted = 0, measured = 0;
    for (std::size_t i = 1; i < costs.size(); i += 2) {
      predicted += model.predicted(costs[i]);
      measured += costs[i].ns;
    }
    const auto odd = static_cast<double>(costs.size() / 2);
    std::printf("%.2f,", tests.box.value_or(0));
    if (tests.triangle) std::printf("%.2f", *tests.triangle);
    std::printf(",%.2f,%.3f,%.3f,", traversal, predicted / odd / 1e3, measured / odd / 1e3);
  }
  std::printf("%zu,%.1f\n", a.bytes() + b.bytes(), build.count());
  std::fflush(stdout);
}

void run(const bench::Arguments& arguments) {
  const auto triangles = static_cast<std::size_t>(arguments.number("--triangles", 100'000));
  bench::pin(arguments);
  const TriangleMesh a = rings(triangles / 5), b = bench::bumpyTorus(triangles);
  const auto poses = path(static_cast<int>(arguments.number("--steps", 1'000)));
  std::fprintf(stderr, "%zu and %zu triangles\n", b.triangles.size(), a.triangles.size());
  std::puts(
      "volume,steps,contacts,bv_tests,triangle_tests,us,bv_test_ns,triangle_test_ns,traversal_ns,"
      "predicted_us,measured_us,bytes,build_ms");
  for (const VolumeKind& kind : volumeKinds()) {
    if (kind.trees == TreeKind::obb4)
      measure<Obb4Tree>("obb", a, b, poses);
    else
      withVolume(kind.trees, [&]<class Volume, class Overlap>() {
        measure<VolumeTree<Volume>>(kind.name.c_str(), a, b, poses);
      });
  }
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--triangles", "--steps", "--cpu"}, corridor::run);
}
