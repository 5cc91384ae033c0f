#pragma once

#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {

/// Writes an arm into the folder. Its chain of links and joints: base (box), pan (continuous),
/// upper (box), lift (revolute, limits ±3.14159), lower (cylinder), wrist (fixed), flange (no
/// shape), slide (prismatic), finger (sphere). A second sphere, thumb, is attached to flange by the
/// joint follow, which mimics slide.
class ArmTest : public ProblemTest {
 protected:
  void SetUp() override {
    ProblemTest::SetUp();
    write("arm.urdf", urdf);
    write("arm.srdf", srdf);
    write("arm.yaml", arm);
  }

  /// Returns a URDF link with a collision geometry at height z.
  static std::string link(const std::string& name, const std::string& geometry, double z) {
    return "<link name='" + name + "'><collision><origin xyz='0 0 " + std::to_string(z) +
           "'/><geometry>" + geometry + "</geometry></collision></link>\n";
  }
  static std::string joint(const std::string& name, const std::string& type,
                           const std::string& parent, const std::string& child,
                           const std::string& rest) {
    return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
           "'/><child link='" + child + "'/>" + rest + "</joint>\n";
  }

  inline static const std::string urdf =
      "<robot name='armbot'>\n" + link("base", "<box size='0.2 0.2 0.2'/>", 0.1) +
      link("upper", "<box size='0.1 0.1 0.5'/>", 0.25) +
      link("lower", "<cylinder radius='0.05' length='0.4'/>", 0.2) + "<link name='flange'/>\n" +
      link("finger", "<sphere radius='0.009'/>", 0) + link("thumb", "<sphere radius='0.009'/>", 0) +
      joint("pan", "continuous", "base", "upper", "<origin xyz='0 0 0.2'/><axis xyz='0 0 1'/>") +
      joint("lift", "revolute", "upper", "lower",
            "<origin xyz='0 0 0.5'/><axis xyz='0 1 0'/><limit lower='-3.14159' upper='3.14159' "
            "effort='1' velocity='1'/>") +
      joint("wrist", "fixed", "lower", "flange", "<origin xyz='0 0 0.4'/>") +
      joint("slide", "prismatic", "flange", "finger",
            "<axis xyz='1 0 0'/><limit lower='0.01' upper='0.05' effort='1' velocity='1'/>") +
      joint("follow", "prismatic", "flange", "thumb",
            "<axis xyz='1 0 0'/><limit lower='-0.05' upper='0' effort='1' velocity='1'/><mimic "
            "joint='slide' multiplier='-1'/>") +
      "</robot>\n";
  inline static const std::string srdf =
      "<robot name='armbot'>\n"
      "<group name='arm'><joint name='pan'/><joint name='lift'/></group>\n"
      "<group name='nothing'><joint name='wrist'/></group>\n"
      "<group_state name='ready' group='arm'><joint name='pan' value='0'/><joint name='lift' "
      "value='0.5'/></group_state>\n"
      "<disable_collisions link1='base' link2='lower' reason='Never'/>\n"
      "</robot>\n";
  inline static const std::string arm =
      "format: corridor-robot-1\nname: arm7\nurdf: arm.urdf\nsrdf: arm.srdf\ngroup: arm\n";
  /// Lines 1 to 4 of a problem file.
  inline static const std::string armHead =
      "format: corridor-problem-1\nrobot: arm.yaml\nworld:\n  post: {box: [0.1, 0.1, 1], at: [0.5, "
      "0.5, 0.5]}\n";
  /// Lines 5 and 6 of a problem file.
  inline static const std::string armStates = "start: ready\ngoal: {pan: 1, lift: 0.3}\n";

  std::string skipped(const Problem& p, const std::string& a, const std::string& b) const {
    std::string why = "no such pair";
    forEachPair(p.model, requiredBy(p.task),
                [&](std::size_t i, std::size_t j, std::string_view reason) {
                  const std::string &one = p.model.bodies[i].name, &other = p.model.bodies[j].name;
                  if ((one == a && other == b) || (one == b && other == a)) why = reason;
                });
    return why;
  }
};

}  // namespace corridor::test
