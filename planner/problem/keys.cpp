#include "planner/problem/keys.h"

namespace corridor {
namespace {

const std::vector<std::string> poseKeys{"at", "rpy_deg", "rpy", "quat_xyzw", "yaw_deg", "yaw"};

const char* const shapesAreMeshes =
    "shapes are meshes, as in {mesh: table.obj, unit: m, at: [0, 0, 0]}";
const char* const bodiesAreRigid =
    "robots are rigid bodies: rigid: SE3 (or SE2) and shapes: [{mesh: robot.obj, unit: m}]";
const char* const allIsChecked = "every part of the robot is kept from every obstacle";

std::vector<LaterKey> laterShapes() {
  std::vector<LaterKey> later;
  for (const char* key : {"box", "sphere", "cylinder", "capsule", "convex"})
    later.push_back({key, shapesAreMeshes});
  later.push_back({"solid", "meshes are surfaces, and touching them is contact"});
  return later;
}

}  // namespace

const std::map<std::string, MapKeys>& problemKeys() {
  static const std::map<std::string, MapKeys> keys{
      {"",
       {{"format", "robot", "world", "start", "goal", "bounds", "margin", "tube", "planner",
         "sampler", "simplify", "checker", "seed"},
        {{"robots", "one robot is planned for: robot: robot.yaml"},
         {"base", "rigid robots move freely: their place is given by start and goal"},
         {"allow", allIsChecked}}}},
      {"world.*", {{"mesh", "unit", "up", "at", "rpy_deg", "rpy", "quat_xyzw"}, laterShapes()}},
      {"start", {poseKeys, {}}},
      {"goal", {{"at", "rpy_deg", "rpy", "quat_xyzw", "yaw_deg", "yaw", "within"}, {}}},
      {"goal.within", {{"at", "angle_deg", "angle"}, {}}},
      {"bounds", {{"at"}, {}}},
      {"tube",
       {{"position", "rotation_deg", "rotation"},
        {{"joints", "rigid bodies have position (m) and rotation or rotation_deg"}}}},
      {"planner", {{"name", "time", "stop", "params"}, {}}},
      {"checker",
       {{"edges", "resolution", "tolerance", "fit"},
        {{"volume", "trees are of oriented boxes; leave it out"},
         {"peer", "Corridor's own checker is used; leave it out"}}}},
  };
  return keys;
}

const std::map<std::string, MapKeys>& robotKeys() {
  static const std::map<std::string, MapKeys> keys{
      {"",
       {{"format", "name", "rigid", "shapes", "reference", "weights"},
        {{"urdf", bodiesAreRigid},
         {"srdf", bodiesAreRigid},
         {"packages", bodiesAreRigid},
         {"group", bodiesAreRigid},
         {"joints", bodiesAreRigid},
         {"hold", bodiesAreRigid},
         {"states", "start and goal are given in the problem"},
         {"allow", allIsChecked}}}},
      {"shapes[]",
       {{"mesh", "unit", "up", "at", "rpy_deg", "rpy", "quat_xyzw", "name"}, laterShapes()}},
      {"weights",
       {{"rotation"}, {{"joints", "rigid bodies have one weight, rotation (metres per radian)"}}}},
  };
  return keys;
}

const std::map<std::string, std::vector<std::string>>& problemChoices() {
  static const std::map<std::string, std::vector<std::string>> choices{
      {"world.*.unit", {"m", "cm", "mm", "in"}},
      {"world.*.up", {"x", "y", "z"}},
      {"planner.stop", {"first", "time"}},
      {"checker.edges", {"certified", "discrete"}},
      {"checker.fit", {"vertices", "triangles", "hull"}},
  };
  return choices;
}

const std::map<std::string, std::vector<std::string>>& robotChoices() {
  static const std::map<std::string, std::vector<std::string>> choices{
      {"rigid", {"SE3", "SE2"}},
      {"shapes[].unit", {"m", "cm", "mm", "in"}},
      {"shapes[].up", {"x", "y", "z"}},
  };
  return choices;
}

}  // namespace corridor
