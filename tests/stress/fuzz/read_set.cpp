// Fuzz target: MotionBenchMaker's sets (mbm-scene-1, JSON), in a folder with a small arm that they
// may name.
#include "planner/problem/problem.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeArm(folder), true);
  const auto file = folder.write("sets/box.json", fuzz::textOf(data, ready ? size : 0));
  for (const char* index : {"#1", "#2", ""})
    fuzz::readsOrRefuses([&] {
      const Problem problem = readProblem(file.string() + index);
      if (!problem.model.space.isFinite(problem.task.start) ||
          !problem.model.space.inBounds(problem.task.start))
        fuzz::fail("the start is out of bounds");
    });
  return 0;
}
