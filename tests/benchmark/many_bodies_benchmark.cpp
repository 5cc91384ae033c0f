/// Measures the cost of states and edges as a scene is cut into more and more bodies:
/// `many_bodies_benchmark [--robot URDF] [--out FOLDER] [--largest N] [--edges N] [--length L]
/// [--far | --movers]`.
///
/// An arm stands in a room of four walls, each 2.4 m wide and 2 m high, 0.7 m from its base. The
/// walls are cut into 10 to N square boxes in all (default 10^5), so the boxes always fill the same
/// space. With --far, the boxes stand 10 m to 50 m away instead, out of the arm's reach, and the
/// walls are cut into only 10 boxes. States and edges are random, and the same for every number of
/// boxes. With --movers there is no robot: N boxes of 5 cm float in a room of N cubic metres, and
/// all move along each edge. Each state and edge is certified with the broad phase (as the planner
/// does), and by a test of each pair of bodies.
///
/// Prints CSV on stdout; the plot is written to FOLDER.
#include <chrono>
#include <cmath>
#include <iostream>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/problem/problem.h"
#include "planner/robot/edge_motion.h"
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
  double largest = 0, length = 0;
  int edges = 0;
  bool far = false, movers = false;
};

/// Adds four walls of about `count` boxes in all.
void addWalls(std::size_t count, ModelBuilder& builder) {
  const auto across =
      static_cast<int>(std::max(1.0, std::round(std::sqrt(static_cast<double>(count) / 4 * 1.2))));
  const double size = 2.4 / across;
  const auto up = static_cast<int>(std::round(2 / size));
  const double height = 2.0 / up;
  for (int wall = 0; wall < 4; ++wall)
    for (int i = 0; i < across; ++i)
      for (int k = 0; k < up; ++k) {
        const double along = -1.2 + size * (i + 0.5), z = -0.5 + height * (k + 0.5);
        const double out = wall % 2 ? 0.725 : -0.725;
        const bool inX = wall < 2;
        builder.addObstacle(
            "w" + std::to_string(wall) + "_" + std::to_string(i) + "_" + std::to_string(k),
            Box{inX ? Vec3(0.05, size, height) : Vec3(size, 0.05, height)},
            {inX ? Vec3(out, along, z) : Vec3(along, out, z), Eigen::Quaterniond::Identity()});
      }
}

void addFar(std::size_t count, ModelBuilder& builder) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> real(10, 50);
  for (std::size_t i = 0; i < count; ++i) {
    const double x = real(random), y = real(random), z = real(random) / 10;
    builder.addObstacle("far" + std::to_string(i), Box{Vec3(0.1, 0.1, 0.1)},
                        {Vec3(x, y, z), Eigen::Quaterniond::Identity()});
  }
}

/// Adds boxes that float in a room with one cubic metre for each.
void addMovers(std::size_t count, ModelBuilder& builder) {
  const double side = std::cbrt(static_cast<double>(count)) / 2;
  const Corners room{Vec3::Constant(-side), Vec3::Constant(side)};
  for (std::size_t i = 0; i < count; ++i)
    builder.addRigidBody("mover" + std::to_string(i), JointType::floating,
                         {shapeOf("box", Box{Vec3(0.05, 0.05, 0.05)})}, room);
}

struct Curves {
  std::vector<PlotPoint> states, edges, statesByPair, edgesByPair;
};

void measure(std::size_t count, const Options& o, Curves& curves) {
  ModelBuilder builder;
  if (o.movers) {
    addMovers(count, builder);
  } else {
    builder.addRobot(o.robot);
    addWalls(o.far ? 10 : count, builder);
    if (o.far) addFar(count, builder);
  }
  Problem problem;
  problem.model = builder.build();
  problem.task.tube = tubeOf(problem.model.space);
  const auto before = std::chrono::steady_clock::now();
  const Checker checker(problem);
  const std::chrono::duration<double, std::milli> setUp = std::chrono::steady_clock::now() - before;

  RandomEdges random(problem, 7);
  std::vector<RandomEdges::Edge> edges;
  for (int i = 0; i < o.edges; ++i) edges.push_back(random.next(o.length));
  const Scene& scene = checker.scene();
  EdgeMotion motion(problem.model.tree, problem.model.space, scene.framePairs(), checker.tube());
  QueryContext context;
  const auto byPair = [&](const Configuration& from, const Configuration& to) {
    motion.set(from, to);
    return certifyMotion(motion, scene.motionPairs(), checker.options(), context).verdict;
  };
  int free = 0;
  for (const auto& [from, to] : edges) {
    const MotionVerdict verdict = checker.certifyEdge(from, to).verdict;
    free += verdict == MotionVerdict::free;
    if (verdict != byPair(from, to)) throw std::runtime_error("the broad phase changed a verdict");
  }
  const auto n = static_cast<double>(o.far ? count : scene.bodies().size());
  const std::size_t items = edges.size();
  curves.states.push_back(
      {n, medianMicroseconds(items, [&](std::size_t i) { checker.certifyState(edges[i].from); })});
  curves.edges.push_back({n, medianMicroseconds(items, [&](std::size_t i) {
                            checker.certifyEdge(edges[i].from, edges[i].to);
                          })});
  curves.statesByPair.push_back(
      {n, medianMicroseconds(items, [&](std::size_t i) { byPair(edges[i].from, edges[i].from); })});
  curves.edgesByPair.push_back(
      {n, medianMicroseconds(items, [&](std::size_t i) { byPair(edges[i].from, edges[i].to); })});
  std::cout << n << "," << scene.pairs().size() << "," << free << "," << setUp.count() << ","
            << curves.states.back().y << "," << curves.edges.back().y << ","
            << curves.statesByPair.back().y << "," << curves.edgesByPair.back().y << std::endl;
}

void run(const Arguments& arguments) {
  Options o;
  o.out = arguments.text("--out");
  o.robot = arguments.text("--robot", "robots/arm7/arm7.urdf");
  o.largest = arguments.number("--largest", 1e5);
  o.edges = static_cast<int>(arguments.number("--edges", 500));
  o.length = arguments.number("--length", 0.3);
  o.far = arguments.has("--far");
  std::cout << "bodies,pairs,free_edges,set_up_ms,state_us,edge_us,state_by_pair_us,edge_by_pair_"
               "us\n";
  Curves curves;
  o.movers = arguments.has("--movers");
  for (double n = 10; n < 1.1 * o.largest; n *= o.movers ? 2 : 10)
    measure(static_cast<std::size_t>(n), o, curves);
  Plot plot{"many_bodies", "The same walls, cut into more and more boxes",
            "bodies",      "µs per query (one core)",
            true,          true};
  addLine(plot, "edge, broad phase", curves.edges);
  addLine(plot, "edge, each pair", curves.edgesByPair);
  addLine(plot, "state, broad phase", curves.states);
  addLine(plot, "state, each pair", curves.statesByPair);
  if (!o.out.empty()) writePlot(plot, o.out);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv,
                                  {"--robot", "--out", "--largest", "--edges", "--length"},
                                  corridor::run, {"--far", "--movers"});
}
