// Fuzz target: URDF files, beside a small mesh.
#include "planner/robot/urdf_file.h"
#include "tests/stress/fuzz/small_world.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const bool ready = (fuzz::writeArm(folder), true);
  const auto file = folder.write("r.urdf", fuzz::textOf(data, ready ? size : 0));
  fuzz::readsOrRefuses([&] {
    std::vector<Fault> faults;
    std::vector<std::filesystem::path> files;
    const auto model = readUrdf(file, {.packages = {{"p", folder.path()}}}, faults, files);
    fuzz::checkFaults(faults);
    if (model.has_value() != faults.empty()) fuzz::fail("a model and faults, or neither");
    if (!model) return;
    if (model->joints.size() + 1 != model->links.size())
      fuzz::fail("the joints do not make a tree");
    for (const JointModel& joint : model->joints)
      if (!joint.axis.allFinite() || joint.axis.isZero(0) || !(joint.lower <= joint.upper) ||
          !joint.X_PJ.p.allFinite() || !(joint.X_PJ.q.norm() > 0.9))
        fuzz::fail("joint " + joint.name + " has an axis, limits or a pose that are not valid");
  });
  return 0;
}
