// Fuzz target: robot files (corridor-robot-1), in a folder with the project's own robot files and
// their URDFs.
#include "planner/problem/robot_file.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeSmallWorld(folder), fuzz::writeArm(folder), true);
  const auto file = folder.write("robots/p/robot.yaml", fuzz::textOf(data, ready ? size : 0));
  fuzz::readsOrRefuses([&] {
    FaultList faults(file.string());
    std::vector<Note> notes;
    const auto robot = readRobotFile(file, faults, notes);
    if (!robot && faults.size() == 0) fuzz::fail("no robot, and no fault");
    faults.throwIfAny();
  });
  return 0;
}
