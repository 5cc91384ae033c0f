// Fuzz target: SRDF files of a small arm.
#include "planner/robot/urdf_file.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const RobotDescription arm = [] {
    fuzz::writeArm(folder);
    std::vector<Fault> faults;
    std::vector<std::filesystem::path> files;
    return readUrdf(folder.path() / "arm.urdf", {}, faults, files).value();
  }();
  const auto file = folder.write("r.srdf", fuzz::textOf(data, size));
  fuzz::readsOrRefuses([&] {
    RobotDescription model = arm;
    std::vector<Fault> faults;
    readSrdf(file, model, faults);
    fuzz::checkFaults(faults);
  });
  return 0;
}
