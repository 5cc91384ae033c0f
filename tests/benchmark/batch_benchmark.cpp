// The C++ side of `python_cost`: decides states, and the edges between consecutive ones, on one
// thread, and prints seconds for all states, the number of free states, seconds for all edges, and
// the number of free edges. Usage: `batch_benchmark PROBLEM STATES`. STATES is a binary file of
// doubles, which has the components of the configuration of each state.
#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>

#include "planner/checker/checker.h"
#include "planner/problem/problem.h"

namespace {

using namespace corridor;

/// Calls work(i) for each i below `count`, adds to `free` how many calls return true, and returns
/// the seconds of all calls together.
template <class Work>
double secondsOf(std::size_t count, std::size_t& free, const Work& work) {
  const auto before = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < count; ++i) free += work(i).verdict == MotionVerdict::free;
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 3) throw std::runtime_error("usage: batch_benchmark PROBLEM STATES");
  const Problem problem = readProblem(argv[1]);
  const Checker checker(problem);
  std::ifstream file(argv[2], std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  const std::size_t size = checker.space().size(), count = bytes.size() / sizeof(double) / size;
  if (count < 2) throw std::runtime_error(std::string(argv[2]) + ": two states are needed");
  const auto* const numbers = reinterpret_cast<const double*>(bytes.data());
  std::vector<Configuration> states;
  for (std::size_t i = 0; i < count; ++i)
    states.emplace_back(
        Eigen::Map<const Configuration>(numbers + i * size, static_cast<Eigen::Index>(size)));
  checker.certifyState(states[0]);  // makes the checker build what it builds only at its first use
  std::size_t freeStates = 0, freeEdges = 0;
  const double s =
      secondsOf(count, freeStates, [&](std::size_t i) { return checker.certifyState(states[i]); });
  const double e = secondsOf(count - 1, freeEdges, [&](std::size_t i) {
    return checker.certifyEdge(states[i], states[i + 1]);
  });
  std::printf("%.9g %zu %.9g %zu\n", s, freeStates, e, freeEdges);
} catch (const std::exception& error) {
  std::cerr << "batch_benchmark: " << error.what() << '\n';
  return 2;
}
