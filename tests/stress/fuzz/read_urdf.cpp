// Fuzz target: URDF files, in a folder with a small mesh that they may name. If a robot is built
// again from the links and joints that were read, it must equal the original.
#include <cmath>

#include "planner/robot/robot_parts.h"
#include "planner/robot/urdf_file.h"
#include "tests/stress/fuzz/small_world.h"

namespace {

using namespace corridor;

/// Returns the links and joints of a robot in the form in which a program passes them to
/// `makeRobot`.
RobotParts partsOf(const RobotDescription& model) {
  RobotParts parts;
  parts.links = model.links;
  for (const JointModel& joint : model.joints) {
    RobotParts::Joint part;
    part.name = joint.name;
    part.type = joint.type;
    part.parent = model.links[joint.parent].name;
    part.child = model.links[joint.child].name;
    part.X_PJ = joint.X_PJ;
    part.axis = joint.axis;
    if (joint.type == JointType::revolute || joint.type == JointType::prismatic) {
      part.lower = joint.lower;
      part.upper = joint.upper;
    }
    if (std::isfinite(joint.velocity)) part.velocity = joint.velocity;
    if (joint.mimic)
      part.mimic = {model.joints[joint.mimic->joint].name, joint.mimic->multiplier,
                    joint.mimic->offset};
    parts.joints.push_back(part);
  }
  return parts;
}

void compareWithParts(const RobotDescription& model) {
  std::vector<Fault> faults;
  const auto made = makeRobot(partsOf(model), faults);
  for (const Fault& fault : faults) fuzz::fail("refused as parts: " + fault.str());
  if (made->root != model.root || made->joints.size() != model.joints.size())
    fuzz::fail("another tree");
  for (std::size_t j = 0; j < model.joints.size(); ++j) {
    const JointModel &a = model.joints[j], &b = made->joints[j];
    if (a.name != b.name || a.parent != b.parent || a.child != b.child || a.X_PJ.p != b.X_PJ.p ||
        a.X_PJ.q.coeffs() != b.X_PJ.q.coeffs() || a.axis != b.axis || a.lower != b.lower ||
        a.upper != b.upper || a.velocity != b.velocity)
      fuzz::fail("joint " + a.name + " differs");
    if (a.mimic.has_value() != b.mimic.has_value() ||
        (a.mimic &&
         (a.mimic->joint != b.mimic->joint || a.mimic->multiplier != b.mimic->multiplier ||
          a.mimic->offset != b.mimic->offset)))
      fuzz::fail("the mimic of joint " + a.name + " differs");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
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
    compareWithParts(*model);
  });
  return 0;
}
