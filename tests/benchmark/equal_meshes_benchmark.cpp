/// Measures what it costs, and what it saves, if obstacles with equal meshes share one mesh:
/// `equal_meshes_benchmark [--robot URDF] [--out FOLDER] [--uses N] [--largest N] [--edges N]
/// [--length L]`.
///
/// N bumpy balls (default 20) of 0.1 m stand about an arm at random poses, 0.3 m to 0.9 m from its
/// base. All balls have equal meshes of 8·4^k triangles, for k = 1, 2, … up to about --largest
/// triangles (default 327,680). Either each ball is a copy of the mesh in world coordinates, or
/// each has a frame of its own and all share the mesh and its tree. States and edges are random,
/// and the same for all meshes.
///
/// Prints CSV on stdout; the plot is written to FOLDER. Memory is what the checker and the model
/// hold, all trees of the obstacles included; set-up time includes the building of these trees.
#include <chrono>
#include <cmath>
#include <iostream>
#include <malloc.h>
#include <numbers>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/problem/problem.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/median_time.h"
#include "tests/benchmark/plot.h"
#include "tests/benchmark/random_edges.h"

namespace corridor {
namespace {

using namespace bench;

struct Options {
  std::filesystem::path out;
  std::string robot;
  double length = 0;
  int uses = 0, edges = 0;
};

/// Returns a ball with bumps, made of the 8·4^depth triangles of a divided octahedron.
TriangleMesh bumpyBall(int depth) {
  const int n = 1 << depth;
  TriangleMesh mesh;
  const auto add = [&](double x, double y, double z) {
    const Vec3 p = Vec3(x, y, z).normalized();
    mesh.vertices.push_back(0.1 * (1 + 0.05 * std::sin(9 * p.x()) * std::sin(7 * p.y())) * p);
    return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? 1 : -1, sy = octant & 2 ? 1 : -1, sz = octant & 4 ? 1 : -1;
    std::vector<std::vector<std::uint32_t>> grid;
    for (int i = 0; i <= n; ++i) {
      grid.emplace_back();
      for (int k = 0; k <= n - i; ++k) grid.back().push_back(add(sx * i, sy * k, sz * (n - i - k)));
    }
    for (std::size_t i = 0; i + 1 < grid.size(); ++i)
      for (std::size_t k = 0; k < grid[i + 1].size(); ++k) {
        mesh.triangles.push_back({grid[i][k], grid[i + 1][k], grid[i][k + 1]});
        if (k + 1 < grid[i + 1].size())
          mesh.triangles.push_back({grid[i][k + 1], grid[i + 1][k], grid[i + 1][k + 1]});
      }
  }
  return mesh;
}

std::vector<RigidPose> randomPoses(int count) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> real(0, 1);
  std::normal_distribution<double> normal;
  std::vector<RigidPose> poses;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * std::numbers::pi * real(random), out = 0.3 + 0.6 * real(random);
    const double height = real(random);
    const Eigen::Quaterniond q(normal(random), normal(random), normal(random), normal(random));
    poses.push_back({{out * std::cos(angle), out * std::sin(angle), height}, q.normalized()});
  }
  return poses;
}

std::size_t bytesInUse() {
  const auto info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

struct Figures {
  std::size_t triangles = 0;
  double megabytes = 0, setUp = 0, state = 0, edge = 0;
  int free = 0, undecided = 0;
};

Figures measure(const TriangleMesh& mesh, bool shared, const Options& o) {
  Figures figures;
  figures.triangles = mesh.triangles.size();
  const std::size_t bytesBefore = bytesInUse();
  const auto before = std::chrono::steady_clock::now();
  ModelBuilder builder;
  builder.addRobot(o.robot);
  const PlacedShape shape = shapeOf("ball", mesh);
  int number = 0;
  for (const RigidPose& pose : randomPoses(o.uses)) {
    const std::string name = "ball" + std::to_string(++number);
    if (shared) {
      builder.addObstacle(name, {shape}, pose);
      continue;
    }
    TriangleMesh moved = mesh;
    const Transform X{pose.q.toRotationMatrix(), pose.p};
    for (Vec3& p : moved.vertices) p = X * p;
    builder.addObstacle(name, {shapeOf(name, std::move(moved))});
  }
  Problem problem;
  problem.model = builder.build();
  problem.task.tube = tubeOf(problem.model.space);
  const Checker checker(problem);
  for (const Scene::Placed& placed : checker.scene().bodies()) placed.body.tree();
  const std::chrono::duration<double, std::milli> setUp = std::chrono::steady_clock::now() - before;
  figures.setUp = setUp.count();
  figures.megabytes = static_cast<double>(bytesInUse() - bytesBefore) / 1e6;

  RandomEdges random(problem, 7);
  std::vector<RandomEdges::Edge> edges;
  for (int i = 0; i < o.edges; ++i) edges.push_back(random.next(o.length));
  for (const auto& [from, to] : edges) {
    const MotionVerdict verdict = checker.certifyEdge(from, to).verdict;
    figures.free += verdict == MotionVerdict::free;
    figures.undecided += verdict == MotionVerdict::undecided;
  }
  figures.state =
      medianMicroseconds(edges.size(), [&](std::size_t i) { checker.certifyState(edges[i].from); });
  figures.edge = medianMicroseconds(
      edges.size(), [&](std::size_t i) { checker.certifyEdge(edges[i].from, edges[i].to); });
  return figures;
}

void run(const Arguments& arguments) {
  Options o;
  o.out = arguments.text("--out");
  o.robot = arguments.text("--robot", "robots/arm7/arm7.urdf");
  o.uses = static_cast<int>(arguments.number("--uses", 20));
  o.edges = static_cast<int>(arguments.number("--edges", 500));
  o.length = arguments.number("--length", 0.3);
  const double largest = arguments.number("--largest", 327'680);
  std::cout << "triangles,shared,megabytes,set_up_ms,state_us,edge_us,free_edges,undecided_edges\n";
  Plot plot{"equal_meshes", "Obstacles of one mesh: a copy for each, or one mesh for all",
            "triangles",    "µs per query (one core)",
            true,           true};
  std::vector<PlotPoint> curves[2][2];
  for (int depth = 1; 8 * std::pow(4, depth) < 1.1 * largest; ++depth)
    for (const bool shared : {false, true}) {
      const Figures f = measure(bumpyBall(depth), shared, o);
      const auto n = static_cast<double>(f.triangles);
      curves[shared][0].push_back({n, f.state});
      curves[shared][1].push_back({n, f.edge});
      std::cout << f.triangles << "," << shared << "," << f.megabytes << "," << f.setUp << ","
                << f.state << "," << f.edge << "," << f.free << "," << f.undecided << std::endl;
    }
  addLine(plot, "edge, one mesh", curves[1][1]);
  addLine(plot, "edge, copies", curves[0][1]);
  addLine(plot, "state, one mesh", curves[1][0]);
  addLine(plot, "state, copies", curves[0][0]);
  if (!o.out.empty()) writePlot(plot, o.out);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(
      argc, argv, {"--robot", "--out", "--uses", "--largest", "--edges", "--length"},
      corridor::run);
}
