// Fuzz target: problem files (corridor-problem-1), in a folder with small robots and meshes that
// they may name. The checker must accept every problem that the reader accepts.
#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeSmallWorld(folder), true);
  const auto file = folder.write("problems/p/problem.yaml", fuzz::textOf(data, ready ? size : 0));
  fuzz::readsOrRefuses([&] {
    const Problem problem = readProblem(file);
    const Checker checker(problem);
    if (!checker.inBounds(problem.task.start)) fuzz::fail("the start is out of bounds");
    checker.interference(problem.task.start);
    for (const Configuration& goal : problem.task.goals) checker.certifyState(goal);
  });
  return 0;
}
