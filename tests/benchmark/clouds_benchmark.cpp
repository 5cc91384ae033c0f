/// Measures the cost of states and edges among the same surface as a mesh, as a point cloud and as
/// an octree map: `clouds_benchmark [--robot URDF] [--out FOLDER] [--largest N] [--edges N]
/// [--length L]`.
///
/// An arm stands in a room of four wavy walls, each 2.4 m wide and 2 m high, some 0.7 m from its
/// base. Each wall is a grid of points; the four walls have 10^3 to N points together (default
/// 10^6). The mesh joins the points by triangles. The cloud has a ball about each point; its radius
/// is 0.8 of the distance between neighbouring points. The map has the cubic cells that contain a
/// point; the edge of a cell is as long as this distance. States and edges are random, and the same
/// for all three. If FCL is installed, it tests the same states: the mesh by its OBBRSS trees, and
/// the map by its octree.
///
/// Prints CSV on stdout; the plot is written to FOLDER.
#include <chrono>
#include <cmath>
#include <iostream>
#include <set>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/problem/problem.h"
#ifdef CORRIDOR_WITH_FCL
#include "planner/benchmark/fcl_scene.h"
#if FCL_HAVE_OCTOMAP
#include <fcl/geometry/octree/octree.h>
#endif
#endif
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/median_time.h"
#include "tests/benchmark/plot.h"
#include "tests/benchmark/random_edges.h"

namespace corridor {
namespace {

using namespace bench;
using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

/// The four walls.
struct Walls {
  TriangleMesh mesh;
  double spacing = 0;

  explicit Walls(std::size_t count) {
    const int across = static_cast<int>(std::sqrt(static_cast<double>(count) / 4 * 1.2));
    spacing = 2.4 / across;
    const int up = static_cast<int>(2 / spacing);
    for (int wall = 0; wall < 4; ++wall) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int i = 0; i <= across; ++i)
        for (int k = 0; k <= up; ++k) {
          const double along = -1.2 + spacing * i, z = -0.5 + spacing * k;
          const double out = (wall % 2 ? 1 : -1) * (0.7 + 0.03 * std::sin(9 * along + 7 * z));
          mesh.vertices.push_back(wall < 2 ? Vec3(out, along, z) : Vec3(along, out, z));
        }
      for (int i = 0; i < across; ++i)
        for (int k = 0; k < up; ++k) {
          const auto at = first + static_cast<std::uint32_t>(i * (up + 1) + k);
          const auto next = at + static_cast<std::uint32_t>(up + 1);
          mesh.triangles.push_back({at, next, at + 1});
          mesh.triangles.push_back({at + 1, next, next + 1});
        }
    }
  }

  std::vector<ConvexPart> balls() const {
    std::vector<ConvexPart> all;
    for (const Vec3& p : mesh.vertices) all.push_back({{p}, 0.8 * spacing, false});
    return all;
  }
  std::vector<ConvexPart> cubes() const {
    std::set<std::array<int, 3>> cells;
    for (const Vec3& p : mesh.vertices) {
      const Vec3 cell = (p / spacing).array().floor();
      cells.insert(
          {static_cast<int>(cell[0]), static_cast<int>(cell[1]), static_cast<int>(cell[2])});
    }
    std::vector<ConvexPart> all;
    for (const auto& [x, y, z] : cells)
      all.push_back(placed(Box{Vec3::Constant(spacing)},
                           {Mat3::Identity(), spacing * Vec3(x + 0.5, y + 0.5, z + 0.5)}));
    return all;
  }
};

Problem problemOf(const std::string& robot, PlacedShape walls) {
  ModelBuilder builder;
  builder.addRobot(robot);
  builder.addObstacle("walls", {std::move(walls)});
  Problem problem;
  problem.model = builder.build();
  problem.task.tube = Configuration::Zero(static_cast<Eigen::Index>(problem.model.space.size()));
  return problem;
}

using Edges = std::vector<RandomEdges::Edge>;

struct Costs {
  double tree = 0, megabytes = 0, state = 0, edge = 0;
  int free = 0;
};

Costs costsOf(const Checker& checker, const Edges& edges) {
  Costs costs;
  const Body& walls = checker.scene().bodies().back().body;
  const auto before = Clock::now();
  costs.megabytes = 1e-6 * static_cast<double>(walls.tree().bytes());
  costs.tree = millisecondsSince(before);
  for (const auto& [from, to] : edges)
    costs.free += checker.certifyEdge(from, to).verdict == MotionVerdict::free;
  costs.state =
      medianMicroseconds(edges.size(), [&](std::size_t i) { checker.certifyState(edges[i].from); });
  costs.edge = medianMicroseconds(
      edges.size(), [&](std::size_t i) { checker.certifyEdge(edges[i].from, edges[i].to); });
  return costs;
}

#ifdef CORRIDOR_WITH_FCL
double fclMeshState(const Checker& checker, const Edges& edges) {
  FclScene scene(checker);
  return medianMicroseconds(edges.size(), [&](std::size_t i) {
    scene.touches(framePoses(checker.model().tree, edges[i].from));
  });
}
#endif

#if defined(CORRIDOR_WITH_FCL) && FCL_HAVE_OCTOMAP
/// Returns the median time in which FCL tests the links against its octree at one state. Pairs of
/// two links are left out.
double fclMapState(const Checker& checker, const Walls& walls, const Edges& edges) {
  auto map = std::make_shared<octomap::OcTree>(walls.spacing);
  for (const Vec3& p : walls.mesh.vertices)
    map->updateNode(octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()),
                                     static_cast<float>(p.z())),
                    true, true);
  map->updateInnerOccupancy();
  fcl::CollisionObjectd obstacle(
      std::make_shared<fcl::OcTree<double>>(std::shared_ptr<const octomap::OcTree>(map)));
  obstacle.computeAABB();
  std::vector<std::pair<fcl::CollisionObjectd, FclShape>> links;
  const Model& model = checker.model();
  const std::vector<std::size_t> movers = moversOf(model.tree);
  for (const ModelBody& body : model.bodies)
    if (body.robot && movers[body.frame] != 0)
      for (const PlacedShape& shape : body.shapes) {
        FclShape made = fclShape(shape, body.frame);
        links.emplace_back(fcl::CollisionObjectd(made.geometry), made);
      }
  const fcl::CollisionRequestd request;
  fcl::CollisionResultd result;
  return medianMicroseconds(edges.size(), [&](std::size_t i) {
    const std::vector<Transform> poses = framePoses(model.tree, edges[i].from);
    for (auto& [object, shape] : links) {
      fcl::Transform3d pose = fcl::Transform3d::Identity();
      pose.linear() = poses[shape.frame].m;
      pose.translation() = poses[shape.frame].t;
      object.setTransform(pose * shape.at);
      object.computeAABB();
      if (!object.getAABB().overlap(obstacle.getAABB())) continue;
      result.clear();
      if (fcl::collide(&object, &obstacle, request, result) > 0) return;
    }
  });
}
#endif

void run(const Arguments& arguments) {
  const std::string robot = arguments.text("--robot", "robots/arm7/arm7.urdf");
  const double largest = arguments.number("--largest", 1e6),
               length = arguments.number("--length", 0.3);
  const auto count = static_cast<int>(arguments.number("--edges", 300));
  const std::filesystem::path out = arguments.text("--out");
  std::vector<PlotPoint> lines[3];
  std::cout << "points,kind,items,free_edges,tree_ms,tree_mb,state_us,edge_us,fcl_state_us\n";
  for (double n = 1e3; n < 1.1 * largest; n *= 10) {
    const Walls walls(static_cast<std::size_t>(n));
    PlacedShape shapes[3] = {shapeOf("walls", walls.mesh), {}, {}};
    shapes[1].name = shapes[2].name = "walls";
    shapes[1].parts = walls.balls();
    shapes[2].parts = walls.cubes();
    Edges edges;
    for (int kind = 0; kind < 3; ++kind) {
      const std::size_t items = kind ? shapes[kind].parts.size() : walls.mesh.triangles.size();
      const Problem problem = problemOf(robot, std::move(shapes[kind]));
      if (edges.empty()) {
        RandomEdges random(problem, 7);
        for (int i = 0; i < count; ++i) edges.push_back(random.next(length));
      }
      const Checker checker(problem);
      const Costs costs = costsOf(checker, edges);
      double fcl = std::nan("");
#ifdef CORRIDOR_WITH_FCL
      if (kind == 0) fcl = fclMeshState(checker, edges);
#if FCL_HAVE_OCTOMAP
      if (kind == 2) fcl = fclMapState(checker, walls, edges);
#endif
#endif
      std::cout << walls.mesh.vertices.size() << ","
                << (kind == 0   ? "mesh"
                    : kind == 1 ? "balls"
                                : "cubes")
                << "," << items << "," << costs.free << "," << costs.tree << "," << costs.megabytes
                << "," << costs.state << "," << costs.edge << "," << fcl << std::endl;
      lines[kind].push_back({static_cast<double>(walls.mesh.vertices.size()), costs.edge});
    }
  }
  Plot plot{"clouds", "The same walls as mesh, balls and cubes",
            "points", "µs per edge (one core)",
            true,     true};
  addLine(plot, "mesh", lines[0]);
  addLine(plot, "balls", lines[1]);
  addLine(plot, "cubes", lines[2]);
  if (!out.empty()) writePlot(plot, out);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(
      argc, argv, {"--robot", "--out", "--largest", "--edges", "--length"}, corridor::run);
}
