/// Compares the three fits of oriented boxes: `fit_benchmark [--most N] [--poses N] [--out FOLDER]
/// [--cpu N]`.
///
/// Gottschalk, Lin and Manocha 1996 place a box by a mean and a covariance: those of the vertices,
/// those of the triangles (as infinitely dense samples), or those of the triangles of the convex
/// hull. Vertices mislead if a mesh is unevenly tessellated; triangles mislead if parts of the mesh
/// are buried inside.
///
/// Models of some 10,000 triangles: a sphere, an ellipsoid with a finely tessellated end, and the
/// same ellipsoid, evenly tessellated, with small spheres buried in one quarter of it. The query is
/// interference with a torus with bumps of 5,000 triangles at random poses (500 by default) at
/// which the bounding spheres overlap. Prints CSV on stdout:
/// * for each model, tree (obb, obb-binary, rss) and fit: the means N_v and N_p, the mean time, and
///   the time to build the model's tree;
/// * for each model and fit: the sum of the volumes of the boxes at a level of the binary OBB tree,
///   relative to the volume of the boxes with the default fit at level 0;
/// * the time to build a binary OBB tree over tori of 1,000 to N triangles (100,000 by default),
///   with curves of n·log n and n·log² n through the first point.
///
/// FOLDER gets a plot of the building times.
#include <chrono>
#include <iostream>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "collision/course/query_timing.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/volumes/pair_tests.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/plot.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

using namespace bench;

const std::vector<std::pair<std::string, ObbFit>> kFits = {
    {"vertices", ObbFit::vertices}, {"triangles", ObbFit::triangles}, {"hull", ObbFit::hull}};

/// Returns an ellipsoid of half axes 1, 0.5 and 0.3. With `power` > 1 the triangles get finer
/// towards one end: rows of vertices are at the angles π·t^power from that end, for evenly spaced t
/// in [0, 1].
TriangleMesh ellipsoid(std::uint32_t rows, double power) {
  const std::uint32_t columns = rows;
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i <= rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const double u = std::numbers::pi * std::pow(static_cast<double>(i) / rows, power);
      const double v = 2 * std::numbers::pi * j / columns;
      mesh.vertices.push_back(
          {std::cos(u), 0.5 * std::sin(u) * std::cos(v), 0.3 * std::sin(u) * std::sin(v)});
    }
  for (std::uint32_t i = 0; i < rows; ++i)
    for (std::uint32_t j = 0; j < columns; ++j) {
      const std::uint32_t k = (j + 1) % columns;
      const auto at = [&](std::uint32_t row, std::uint32_t column) {
        return row * columns + column;
      };
      if (i + 1 < rows) mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, k)});
      if (i > 0) mesh.triangles.push_back({at(i, j), at(i + 1, k), at(i, k)});
    }
  return mesh;
}

/// Returns the ellipsoid, evenly tessellated, with spheres buried in one quarter of it.
TriangleMesh buried() {
  TriangleMesh mesh = ellipsoid(50, 1);
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> real(-1, 1);
  const TriangleMesh sphere = icosphere(4);
  for (int i = 0; i < 16; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3 at(0.5 + 0.2 * real(random), 0.2 + 0.05 * real(random), 0.1 * real(random));
    for (const Vec3& v : sphere.vertices) mesh.vertices.push_back(at + 0.05 * v);
    for (const auto& t : sphere.triangles)
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return mesh;
}

template <class Make>
double buildMilliseconds(const Make& make) {
  double least = HUGE_VAL;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    const auto tree = make();
    const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
    least = std::min(least, time.count());
    // One measurement is enough for a long build, because long builds vary little.
    if (least > 2'000) break;
  }
  return least;
}

template <class Make>
void measure(const std::string& label, const TriangleMesh& model, const TriangleMesh& torus,
             const std::vector<Transform>& poses, const Make& make) {
  const auto a = make(model), b = make(torus);
  QueryContext context;
  double boxes = 0, triangles = 0, ns = 0;
  for (const Transform& X : poses) {
    const auto query = [&] {
      context.counters = {};
      interference(Posed(a), Posed(b, X), context);
    };
    double least = nanosecondsOf(query, query);
    for (int i = 0; i < 2; ++i) least = std::min(least, nanosecondsOf(query, query));
    ns += least;
    boxes += static_cast<double>(context.counters.boxTests);
    triangles += static_cast<double>(context.counters.primitiveTests);
  }
  const auto n = static_cast<double>(poses.size());
  std::cout << label << ',' << boxes / n << ',' << triangles / n << ',' << ns / n / 1e3 << ','
            << buildMilliseconds([&] { return make(model); }) << std::endl;
}

/// Returns, for each level, the sum of the volumes of the boxes at this level.
std::vector<double> volumesByLevel(const VolumeTree<Obb>& tree) {
  std::vector<double> sums;
  std::vector<std::pair<std::uint32_t, std::size_t>> stack = {{0, 0}};
  while (!stack.empty()) {
    const std::uint32_t i = stack.back().first;
    const std::size_t level = stack.back().second;
    stack.pop_back();
    if (sums.size() <= level) sums.resize(level + 1);
    sums[level] += 8 * tree.node(i).box.half.prod();
    if (!tree.node(i).isLeaf())
      tree.forEachChildBackwards(i, [&](std::uint32_t c) { stack.push_back({c, level + 1}); });
  }
  return sums;
}

/// Returns poses of b at which the bounding spheres of a and b about their origins overlap. The
/// pose of a is the identity.
std::vector<Transform> nearPoses(int count) {
  std::mt19937_64 random(1996);
  std::uniform_real_distribution<double> real(-2.4, 2.4);
  std::vector<Transform> poses;
  while (poses.size() < static_cast<std::size_t>(count)) {
    const Vec3 at(real(random), real(random), real(random));
    if (at.norm() < 2.4) poses.push_back({randomRotation(random), at});
  }
  return poses;
}

void growth(double most, const std::filesystem::path& out) {
  std::cout << "\nfit,triangles,build_ms,n_log_n,n_log2_n\n";
  Plot plot{"fit_building", "Building a binary OBB tree over a torus",
            "triangles",    "ms (one core)",
            true,           true};
  for (const auto& [name, fit] : kFits) {
    std::vector<PlotPoint> times, linear, squared;
    for (double n = 1e3; n <= 1.01 * most; n *= std::sqrt(10)) {
      const TriangleMesh mesh = bumpyTorus(static_cast<std::size_t>(n));
      const auto count = static_cast<double>(mesh.triangles.size());
      const TreeParams params{fit};
      const double ms = buildMilliseconds([&] { return VolumeTree<Obb>(mesh, params); });
      times.push_back({count, ms});
      const double first = times[0].x, log = std::log(count), firstLog = std::log(first);
      linear.push_back({count, times[0].y * count * log / first / firstLog});
      squared.push_back({count, linear.back().y * log / firstLog});
      std::cout << name << ',' << count << ',' << ms << ',' << linear.back().y << ','
                << squared.back().y << std::endl;
    }
    addLine(plot, name, times);
    if (fit == ObbFit::triangles) addLine(plot, "n log n", linear);
    if (fit == ObbFit::hull) addLine(plot, "n log² n", squared);
  }
  if (!out.empty()) writePlot(plot, out);
}

void run(const Arguments& arguments) {
  pin(arguments);
  const auto poses = nearPoses(static_cast<int>(arguments.number("--poses", 500)));
  const TriangleMesh torus = bumpyTorus(5'000);
  const std::vector<std::pair<std::string, TriangleMesh>> models = {
      {"sphere", icosphere(22)}, {"uneven", ellipsoid(70, 3)}, {"buried", buried()}};
  std::cout << "model,triangles,tree,fit,bv_tests,triangle_tests,us,build_ms\n";
  for (const auto& [name, model] : models)
    for (const auto& [fitName, fit] : kFits) {
      const TreeParams params{fit};
      const std::string start = name + ',' + std::to_string(model.triangles.size()) + ',';
      const std::string end = ',' + fitName;
      measure(start + "obb" + end, model, torus, poses,
              [&](const TriangleMesh& mesh) { return Obb4Tree(mesh, params.fit); });
      measure(start + "obb-binary" + end, model, torus, poses,
              [&](const TriangleMesh& mesh) { return VolumeTree<Obb>(mesh, params); });
      measure(start + "rss" + end, model, torus, poses,
              [&](const TriangleMesh& mesh) { return VolumeTree<Rss>(mesh, params); });
    }
  std::cout << "\nmodel,fit,level,volume\n";
  for (const auto& [name, model] : models) {
    double unit = 0;
    for (const auto& [fitName, fit] : {kFits[1], kFits[0], kFits[2]}) {
      const auto sums = volumesByLevel(VolumeTree<Obb>(model, TreeParams{fit}));
      if (unit == 0) unit = sums[0];
      for (std::size_t level = 0; level < sums.size() && level <= 9; level += 3)
        std::cout << name << ',' << fitName << ',' << level << ',' << sums[level] / unit << '\n';
    }
  }
  growth(arguments.number("--most", 1e5), arguments.text("--out"));
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--most", "--poses", "--out", "--cpu"},
                                  corridor::run);
}
