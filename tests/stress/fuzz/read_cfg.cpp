// Fuzz target: OMPL.app's .cfg files, in a folder with a small mesh that they may name.
#include "planner/problem/problem.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeArm(folder), true);
  const auto file = folder.write("problem.cfg", fuzz::textOf(data, ready ? size : 0));
  fuzz::readsOrRefuses([&] {
    const Problem problem = readProblem(file);
    if (!problem.model.space.isFinite(problem.task.start) ||
        !problem.model.space.inBounds(problem.task.start))
      fuzz::fail("the start is out of bounds");
  });
  return 0;
}
