/// Compares the cost of a certified edge with the cost of sampling it: `edge_cost_benchmark
/// PROBLEM… [--edges N]`.
///
/// For each problem (YAML, OMPL.app's .cfg, SET.json#INDEX), it draws random edges that start at
/// valid states. For a rigid body, the edges are 2, 5, 10 and 20 % of the scene's size long. For
/// joints, they are 0.1, 0.3, 1 and 3 long, in a random direction; this length is the root of the
/// sum of the squared changes of all joints, in rad and m.
///
/// For each edge it measures the certified query, and two discrete tests at n + 1 evenly spaced
/// poses, up to the first contact. The discrete tests use Corridor's own interference test and
/// FCL's (Debian's build; BVHModel<OBBRSS> and FCL's own primitives; poses by Corridor's
/// kinematics). All three tests use the same edges and pairs, and run in turn on one thread. Times
/// are medians of three repeats. They are summed separately over the edges with the verdict `free`
/// and over the other edges. Prints CSV on stdout.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <iostream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "planner/benchmark/fcl_scene.h"
#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "tests/benchmark/random_edges.h"

namespace corridor {
namespace {

using bench::RandomEdges;
using Edge = RandomEdges::Edge;

double seconds(const std::function<void()>& work) {
  std::vector<double> times;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    work();
    times.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  return times[1];
}

void run(const std::string& file, int count) {
  const Problem problem = readProblem(file);
  const Checker checker(problem);
  const auto certify = [&](const Edge& e) { return checker.certifyEdge(e.from, e.to); };
#ifdef CORRIDOR_WITH_FCL
  bench::FclScene fclScene(checker);
#endif
  RandomEdges random(problem, 20261121);
  for (const double length :
       random.rigid() ? std::vector{0.02, 0.05, 0.1, 0.2} : std::vector{0.1, 0.3, 1.0, 3.0}) {
    std::vector<Edge> free, other;
    int undecided = 0;
    while (static_cast<int>(free.size() + other.size()) < count) {
      const Edge e = random.next(length);
      if (!checker.inBounds(e.to) || checker.interference(e.from)) continue;
      const MotionVerdict verdict = certify(e).verdict;
      undecided += verdict == MotionVerdict::undecided;
      (verdict == MotionVerdict::free ? free : other).push_back(e);
    }
    for (const auto* edges : {&free, &other}) {
      if (edges->empty()) continue;
      const Counters before = checker.counters();
      int wrong = 0;
      const double n = static_cast<double>(edges->size());
      const double certified = seconds([&] {
                                 for (const Edge& e : *edges) certify(e);
                               }) /
                               n * 1e6;
      const Counters after = checker.counters();
      std::cout << problem.source.name << ',' << length << ','
                << (edges == &free ? "free" : "contact") << ',' << edges->size() << ',' << undecided
                << ',' << certified << ','
                << static_cast<double>(after.boxTests - before.boxTests) / 3 / n << ','
                << static_cast<double>(after.primitiveTests - before.primitiveTests) / 3 / n << ','
                << static_cast<double>(after.poses - before.poses) / 3 / n;
      for (const int samples : {10, 100}) {
        const auto discrete = [&](const auto& touches) {
          return seconds([&] {
                   for (const Edge& e : *edges)
                     for (int i = 0; i <= samples; ++i)
                       if (touches(problem.model.space.interpolate(
                               e.from, e.to, static_cast<double>(i) / samples))) {
                         wrong += edges == &free;
                         break;
                       }
                 }) /
                 n * 1e6;
        };
        std::cout << ',' << discrete([&](const Configuration& q) {
          return checker.interference(q).has_value();
        });
#ifdef CORRIDOR_WITH_FCL
        const double fcl = discrete([&](const Configuration& q) {
          return fclScene.touches(framePoses(problem.model.tree, q));
        });
        std::cout << ',' << fcl << ',' << fcl / certified;
#else
        std::cout << ",,";
#endif
      }
      std::cout << ',' << wrong << '\n' << std::flush;
    }
  }
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  int count = 500;
  std::vector<std::string> files;
  for (int i = 1; i < argc; ++i) {
    if (std::string(argv[i]) == "--edges" && i + 1 < argc) {
      count = std::atoi(argv[++i]);
    } else {
      files.emplace_back(argv[i]);
    }
  }
  if (files.empty() || count < 1) {
    std::cerr << "usage: edge_cost_benchmark PROBLEM… [--edges N]\n";
    return 2;
  }
  std::cout << "problem,length,verdict,edges,undecided,certified_us,box_tests,triangle_tests,poses,"
               "own10_us,fcl10_us,fcl10_ratio,own100_us,"
               "fcl100_us,fcl100_ratio,samples_in_contact_on_free\n";
  try {
    for (const std::string& file : files) corridor::run(file, count);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}
