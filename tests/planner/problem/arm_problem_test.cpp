#include <cmath>
#include <numbers>

#include "collision/core/shortest.h"
#include "tests/planner/problem/arm_fixture.h"

namespace corridor::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::IsSupersetOf;
constexpr double kDegree = std::numbers::pi / 180;

class ArmProblem : public ArmTest {};

std::vector<std::string> namesOf(const Problem& p) {
  std::vector<std::string> names;
  for (const Coordinate& c : p.model.space.coordinates()) names.push_back(c.name);
  return names;
}

TEST_F(ArmProblem, GroupStatesAndPairs) {
  const Problem p = read(armHead + armStates);
  EXPECT_THAT(namesOf(p), ElementsAre("pan", "lift"));
  const auto& pan = p.model.space.coordinates()[0];
  EXPECT_EQ(pan.kind, Coordinate::Kind::circle);
  const auto& lift = p.model.space.coordinates()[1];
  EXPECT_EQ(lift.kind, Coordinate::Kind::line);
  EXPECT_EQ(lift.lower, -3.14159);
  EXPECT_TRUE(lift.angular);
  EXPECT_EQ(p.task.start, numbers({0, 0.5}));
  EXPECT_THAT(p.task.goals, ElementsAre(numbers({1, 0.3})));
  std::vector<std::string> bodies;
  for (const ModelBody& body : p.model.bodies) bodies.push_back(body.name);
  EXPECT_THAT(bodies, ElementsAre("base", "upper", "lower", "finger", "thumb", "post"));
  EXPECT_EQ(pairCount(p.model), 15) << "each pair once";
  EXPECT_EQ(skipped(p, "base", "upper"), "adjacent");
  EXPECT_EQ(skipped(p, "base", "lower"), "SRDF: Never");
  EXPECT_EQ(skipped(p, "lower", "finger"), "adjacent") << "through a link without shapes";
  EXPECT_EQ(skipped(p, "finger", "thumb"), "only held joints between them: tested once");
  EXPECT_EQ(skipped(p, "base", "post"), "never move relative to each other");
  EXPECT_EQ(skipped(p, "base", "finger"), "");
  EXPECT_EQ(skipped(p, "upper", "post"), "");
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("joints that are not planned for are held: slide 0.01"))
      << "the value nearest to 0 within its limits";
}

TEST_F(ArmProblem, OverTwoMovingJointsLinksAreNotAdjacent) {
  const std::string turns = "<axis xyz='0 0 1'/>";
  const std::string ball = "<sphere radius='0.1'/>";
  const auto chain = [&](const std::string& first, const std::string& second,
                         const std::string& third) {
    write("arm.urdf",
          "<robot name='armbot'>\n" + link("base", ball, 0) + "<link name='a'/><link name='b'/>" +
              link("hand", ball, 0) + joint("i", first, "base", "a", turns) +
              joint("j", second, "a", "b", turns) + joint("k", third, "b", "hand", turns) +
              joint("l", "continuous", "hand", "tip", turns) + link("tip", ball, 0) + "</robot>\n");
    std::string zero;
    int i = 0;
    for (const std::string& type : {first, second, third, std::string("continuous")})
      if (const char name = "ijkl"[i++]; type == "continuous")
        zero += (zero.empty() ? "{" : ", ") + std::string(1, name) + ": 0";
    const Problem p = read("format: corridor-problem-1\nrobot: arm.urdf\nstart: " + zero +
                           "}\ngoal: " + zero + "}\n");
    EXPECT_EQ(skipped(p, "hand", "tip"), "adjacent");
    EXPECT_EQ(skipped(p, "base", "tip"), "");
    return skipped(p, "base", "hand");
  };
  EXPECT_EQ(chain("continuous", "continuous", "continuous"), "");
  EXPECT_EQ(chain("continuous", "fixed", "continuous"), "");
  EXPECT_EQ(chain("fixed", "continuous", "fixed"), "adjacent");
  EXPECT_EQ(chain("fixed", "fixed", "continuous"), "adjacent");
  EXPECT_EQ(chain("fixed", "fixed", "fixed"), "adjacent");
}

TEST_F(ArmProblem, OverAPlanarJointLinksAreNotAdjacent) {
  const std::string ball = "<sphere radius='0.1'/>";
  write("hall.urdf", "<robot name='hall'>\n" + link("hall", ball, 0) + "<link name='a'/>" +
                         link("cart", ball, 0) +
                         joint("drive", "planar", "hall", "a", "<axis xyz='0 0 1'/>") +
                         joint("k", "fixed", "a", "cart", "") + "</robot>\n");
  const Problem p = read(
      "format: corridor-problem-1\nrobot: hall.urdf\nstart: {drive: {at: [1, 1]}}\n"
      "goal: {drive: {at: [1, 0]}}\nbounds: {drive: {at: [[-3, -3], [3, 3]]}}\n");
  EXPECT_EQ(skipped(p, "hall", "cart"), "");
}

TEST_F(ArmProblem, FramesStandWhereTheJointsPutThem) {
  const Problem p = read(armHead + "base: {at: [1, 2, 3], rpy_deg: [0, 0, 90]}\nstart: ready\n" +
                         "goal: {pan: 1, lift: 0.3}\n");
  const auto frames = framePoses(p.model.tree, numbers({0, 90 * kDegree}));
  const auto& robot = p.model.robots.at(0);
  EXPECT_LT((frames[robot.linkFrames[0]].t - Vec3(1, 2, 3)).norm(), 1e-15);
  for (std::size_t l = 0; l < robot.description.links.size(); ++l) {
    const Vec3 at = frames[robot.linkFrames[l]].t;
    // The z axis of "lower" points along the x axis of "base", which is the world's y.
    if (robot.description.links[l].name == "flange") {
      EXPECT_LT((at - Vec3(1, 2.4, 3.7)).norm(), 1e-12);
    }
    if (robot.description.links[l].name == "finger") {
      EXPECT_LT((at - Vec3(1, 2.4, 3.69)).norm(), 1e-12) << "slide held at 0.01";
    }
    if (robot.description.links[l].name == "thumb") {
      EXPECT_LT((at - Vec3(1, 2.4, 3.71)).norm(), 1e-12) << "follows at -0.01";
    }
  }
}

TEST_F(ArmProblem, AllMovingJointsWithoutAGroup) {
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nweights: {joints: {lift: 2}}\n");
  const Problem p = read(armHead +
                         "start: {pan_deg: 30, lift: 0, slide: 0.02}\ngoal: {pan: 0, "
                         "lift_deg: 90, slide: 0.05}\ntube: {joints: 0.001}\n");
  EXPECT_THAT(namesOf(p), ElementsAre("pan", "lift", "slide"));
  EXPECT_EQ(p.task.start, numbers({30 * kDegree, 0, 0.02}));
  EXPECT_EQ(p.task.goals.at(0), numbers({0, 90 * kDegree, 0.05}));
  EXPECT_EQ(p.model.space.coordinates()[1].weight, 2);
  EXPECT_EQ(p.model.space.coordinates()[0].weight, 1);
  EXPECT_FALSE(p.model.space.coordinates()[2].angular);
  EXPECT_EQ(p.task.tube, numbers({0.001, 0.001, 0.001}));
  EXPECT_EQ(skipped(p, "finger", "thumb"), "") << "thumb mimics slide in the opposite direction";
  EXPECT_EQ(skipped(p, "base", "lower"), "") << "no SRDF";
}

TEST_F(ArmProblem, JointListKeepsItsOrderAndHoldIsHeld) {
  write("arm.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\njoints: [slide, pan]\nhold: {lift_deg: 90}\n"
        "states: {home: {pan: 1, slide: 0.02, lift: 0}}\nallow: [[finger, thumb]]\n");
  const Problem p = read(armHead + "start: home\ngoal: {from: home, pan_deg: 10}\n");
  EXPECT_THAT(namesOf(p), ElementsAre("slide", "pan"));
  EXPECT_EQ(p.task.start, numbers({0.02, 1}));
  EXPECT_EQ(p.task.goals.at(0), numbers({0.02, 10 * kDegree}));
  EXPECT_EQ(skipped(p, "finger", "thumb"), "robot.yaml: allow");
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("start: lift is held at 1.5707963267948966, but is 0 in state home"));
}

/// The joints of a named state that are not planned for are held as `hold` or the start says.
TEST_F(ArmProblem, NamedStatesHoldJoints) {
  const std::string robotHead = "format: corridor-robot-1\nurdf: arm.urdf\n";
  const std::string states =
      "states: {near: {pan: 1, lift: 0.5, slide: 0.02}, far: {pan: 2, lift: 0.5, slide: 0.04}, "
      "closed: {slide: 0.03}}\n";
  const auto heldIn = [&](const std::string& robot, const std::string& ends) {
    write("arm.yaml", robotHead + robot + states);
    const Problem p = read(armHead + ends);
    std::string text;
    for (const auto& [j, value] : p.model.robots[0].held)
      text += p.model.robots[0].description.joints[j].name + " " + shortest(value) + "; ";
    for (const std::string& note : textsOf(p.source.notes))
      if (note.find("held") != note.npos) text += note + "; ";
    return text;
  };
  const std::string values = "start: {pan: 0, lift: 0}\ngoal: {pan: 1, lift: 0}\n";
  EXPECT_EQ(heldIn("joints: [pan, lift]\n", values),
            "slide 0.01; joints that are not planned for are held: slide 0.01; ");
  EXPECT_EQ(heldIn("joints: [pan, lift]\nhold: far\n", values), "slide 0.04; ");
  EXPECT_EQ(
      heldIn("joints: [pan]\nhold: {from: far, lift: 0.25}\n", "start: {pan: 0}\ngoal: {pan: 1}\n"),
      "lift 0.25; slide 0.04; ");
  EXPECT_EQ(heldIn("hold: closed\n", values), "slide 0.03; ")
      << "without a choice of joints, the others are planned for";
  const std::string fromStart =
      "slide 0.02; joints that are not planned for are held: slide 0.02; ";
  EXPECT_EQ(heldIn("joints: [pan, lift]\n", "start: near\ngoal: {pan: 1, lift: 0}\n"), fromStart);
  EXPECT_EQ(
      heldIn("joints: [pan, lift]\n", "start: {from: near, pan: 0}\ngoal: {pan: 1, lift: 0}\n"),
      fromStart);
  EXPECT_EQ(
      heldIn("joints: [pan, lift]\nhold: {slide: 0.05}\n", "start: near\ngoal: far\n"),
      "slide 0.05; start: slide is held at 0.05, but is 0.02 in state near; goal: slide is held "
      "at 0.05, but is 0.04 in state far; ");

  write("arm.yaml", robotHead + "joints: [pan, lift]\n" + states);
  EXPECT_EQ(complaintOf(armHead + "start: near\ngoal: far\n"),
            "problem.yaml:6: goal: slide is held at 0.02, but is 0.04 in state far; the joint is "
            "not planned for, so it cannot move: start from a state with the goal's value, or set "
            "this value in hold");
  write("arm.yaml", robotHead + "joints: [pan, lift]\nhold: fer\n" + states);
  EXPECT_THAT(complaintOf(armHead + values),
              testing::StartsWith("arm.yaml:4: hold: there is no state \"fer\" (did you mean "
                                  "\"far\"?)"));
}

/// Half widths of the tube for prismatic joints, and for joints by name.
TEST_F(ArmProblem, TubeOfSingleJoints) {
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\n");
  const std::string ends =
      armHead + "start: {pan: 0, lift: 0, slide: 0.02}\ngoal: {pan: 1, lift: 0, slide: 0.02}\n";
  const auto tube = [&](const std::string& text) {
    return read(ends + "tube: {" + text + "}\n").task.tube;
  };
  EXPECT_EQ(tube("joints: 0.001, slides: 0.0005, lift: 0.002"), numbers({0.001, 0.002, 0.0005}));
  EXPECT_EQ(tube("joints: 0.001, lift_deg: 90, slide: 0.25"), numbers({0.001, 90 * kDegree, 0.25}));
  EXPECT_EQ(tube("joints_deg: 90, slides: 0.5"), numbers({90 * kDegree, 90 * kDegree, 0.5}));
  EXPECT_EQ(tube("joints_deg: 90, slide: 0.5"), numbers({90 * kDegree, 90 * kDegree, 0.5}));
  const auto complaint = [&](const std::string& text) {
    return complaintOf(ends + "tube: {" + text + "}\n");
  };
  EXPECT_EQ(complaint("joints_deg: 1"),
            "problem.yaml:7: tube.joints_deg: slide is prismatic; add the key slides (m), or use "
            "the key joints (rad, and m for prismatic joints) instead");
  EXPECT_EQ(complaint("lift: -1, slide_deg: 1, pan: 1, pan_deg: 1"),
            "problem.yaml:7: tube.lift: must be 0 or more, not -1\n"
            "problem.yaml:7: tube.slide_deg: slide is prismatic; use slide, in metres\n"
            "problem.yaml:7: tube.pan_deg: pan is given twice, in radians and in degrees");
  EXPECT_THAT(
      complaint("lft: 1"),
      testing::StartsWith("problem.yaml:7: tube.lft: this is no key of tube, and no planned "
                          "joint has this name (did you mean \"lift\"?)"));
  write("arm.yaml", arm);
  EXPECT_EQ(complaintOf(armHead + armStates + "tube: {slides: 1}\n"),
            "problem.yaml:7: tube.slides: there is no planned prismatic joint");
}

/// The base of a mobile manipulator is often a virtual joint of the SRDF.
TEST_F(ArmProblem, AGroupIsUsedWithoutItsVirtualJoints) {
  write("mobile.srdf",
        "<robot name='armbot'>\n"
        "<virtual_joint name='world' type='planar' parent_frame='odom' child_link='base'/>\n"
        "<group name='cart'><joint name='world'/></group>\n"
        "<group name='all'><group name='cart'/><joint name='pan'/><joint name='lift'/></group>\n"
        "</robot>\n");
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: mobile.srdf\ngroup: all\n");
  const Problem p = read(armHead + "start: {pan: 0, lift: 0.5}\ngoal: {pan: 1, lift: 0.3}\n");
  EXPECT_THAT(namesOf(p), ElementsAre("pan", "lift"));
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("the group \"all\" is used without world, which is a virtual joint of the "
                       "SRDF"));
  EXPECT_THAT(textsOf(p.source.notes),
              Contains(testing::HasSubstr("mobile.srdf:2: virtual joint \"world\" (planar) is not "
                                          "used: the robot stands still")));
}

TEST_F(ArmProblem, AUrdfAloneIsARobot) {
  const Problem p = read(
      "format: corridor-problem-1\nrobot: arm.urdf\nstart: {pan: 0, lift: 0, slide: 0.02}\n"
      "goal: {pan: 1, lift: 0, slide: 0.02}\n");
  EXPECT_EQ(p.model.robots.at(0).description.name, "armbot");
  EXPECT_EQ(p.model.bodies.size(), 5u) << "there are no bodies of a world";
}

TEST_F(ArmProblem, ValuesARoundingBeyondTheirLimitAreClampedAndReported) {
  const Problem p =
      read(armHead + "start: {pan: 0, lift: 3.1416}\ngoal: {pan: 4, lift: -3.14159}\n");
  EXPECT_EQ(p.task.start, numbers({0, 3.14159}));
  EXPECT_DOUBLE_EQ(p.task.goals.at(0)[0], 4 - 2 * std::numbers::pi);
  EXPECT_EQ(p.task.goals.at(0)[1], -3.14159) << "limits are inclusive";
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("start.lift: 3.1416 is read as its limit, 3.14159"));
  EXPECT_THAT(
      textsOf(p.source.notes),
      Contains("goal.pan: 4 is read as -2.2831853071795867, the same angle up to full turns"));
  const Problem d =
      read(armHead + "start: {pan_deg: -180, lift: 0}\ngoal: {pan_deg: 270, lift: 0}\n");
  EXPECT_EQ(d.task.start[0], std::numbers::pi);
  EXPECT_EQ(d.task.goals.at(0)[0], -90 * kDegree);
  EXPECT_THAT(textsOf(d.source.notes),
              Contains("goal.pan_deg: 270 is read as -90, the same angle up to full turns"));
}

TEST_F(ArmProblem, SeveralGoalsAndARegion) {
  Problem p = read(armHead +
                   "start: ready\ngoal: {any: [ready, {pan: 1, lift: 0}], within: {joints_deg: "
                   "2}}\n");
  EXPECT_THAT(p.task.goals, ElementsAre(numbers({0, 0.5}), numbers({1, 0})));
  ASSERT_TRUE(p.task.goalRegion);
  EXPECT_DOUBLE_EQ(p.task.goalRegion->joint, 2 * kDegree);
  p = read(armHead + "start: ready\ngoal: [ready, {pan: 1, lift: 0}]\n");
  EXPECT_EQ(p.task.goals.size(), 2u);
  EXPECT_FALSE(p.task.goalRegion);
  p = read(armHead + "start: ready\ngoal: {from: ready, within: {joints: 0.1}}\n");
  EXPECT_THAT(p.task.goals, ElementsAre(numbers({0, 0.5})));
  EXPECT_EQ(p.task.goalRegion->joint, 0.1);
  p = read(head + "start: {at: [5, 0, 0]}\ngoal: [{at: [0, 5, 0]}, {at: [1, 5, 0]}]\n");
  EXPECT_EQ(p.task.goals.size(), 2u) << "of a rigid robot, too";
}

TEST_F(ArmProblem, BoundsNarrowLimits) {
  const Problem p = read(armHead + armStates + "bounds: {pan: [-1, 2], lift_deg: [-90, 90]}\n");
  const auto& pan = p.model.space.coordinates()[0];
  EXPECT_EQ(pan.kind, Coordinate::Kind::line) << "with bounds, it doesn't go round";
  EXPECT_EQ(pan.upper, 2);
  EXPECT_EQ(p.model.space.coordinates()[1].lower, -90 * kDegree);
}

TEST_F(ArmProblem, AllowListsMayUseTheRobotsName) {
  Problem p =
      read(armHead + armStates + "allow: [[arm7/base, post], [lower, post], [flange, post]]\n");
  EXPECT_EQ(skipped(p, "base", "post"), "allow");
  EXPECT_EQ(skipped(p, "lower", "post"), "allow");
  EXPECT_EQ(skipped(p, "upper", "post"), "");
  p = read(armHead + armStates + "allow: [[base, arm7/base], [post, post]]\n");
  EXPECT_THAT(textsOf(p.source.notes),
              IsSupersetOf({"allow: [base, arm7/base] names one body twice; name two bodies, or "
                            "remove the pair",
                            "allow: [post, post] names one body twice; name two bodies, or remove "
                            "the pair"}));
}

TEST_F(ArmProblem, TwoRobotsAndTheirPairs) {
  const Problem p = read(
      "format: corridor-problem-1\nrobots:\n  left: {file: arm.yaml}\n  right: {file: arm.yaml, "
      "base: {at: [1, 0, 0]}}\n  block: {file: robot.yaml}\nworld: {post: {sphere: 0.1, at: [0, 0, "
      "3]}}\n"
      "start: {left: ready, right: {pan: 0, lift: 1}, block: {at: [9, 0, 0]}}\n"
      "goal: {left: ready, right: {pan: 2, lift: 1}, block: {at: [9, 0, 1]}, within: {joints: 0.1, "
      "at: "
      "0.2}}\nbounds: {left: {pan: [-1, 1]}}\nallow: [[left/upper, right/upper]]\n");
  EXPECT_THAT(namesOf(p), ElementsAre("left/pan", "left/lift", "right/pan", "right/lift", "block/x",
                                      "block/y", "block/z", "block/rotation"));
  EXPECT_EQ(p.task.start, numbers({0, 0.5, 0, 1, 9, 0, 0, 0, 0, 0, 1}));
  EXPECT_EQ(p.model.space.groups().size(), 2u) << "all joints, and the block";
  EXPECT_EQ(skipped(p, "left/upper", "right/upper"), "allow");
  EXPECT_EQ(skipped(p, "left/upper", "right/lower"), "");
  EXPECT_EQ(skipped(p, "left/base", "right/base"), "never move relative to each other");
  EXPECT_EQ(skipped(p, "left/base", "left/lower"), "SRDF: Never");
  EXPECT_EQ(skipped(p, "right/upper", "block"), "");
  EXPECT_EQ(p.task.goalRegion->position, 0.2);
  const auto frames = framePoses(p.model.tree, p.task.start);
  EXPECT_EQ(frames[p.model.robots[1].linkFrames[0]].t, Vec3(1, 0, 0));
  EXPECT_EQ(frames[p.model.robots[2].linkFrames[0]].t, Vec3(9, 0, 0));
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("bounds of block: those of the world, start and goal, since none "
                       "are given"));
}

TEST_F(ArmProblem, PlanarAndFloatingJoints) {
  write("mobile.urdf",
        "<robot name='mobile'>\n<link name='world'/>\n" +
            link("cart", "<box size='0.5 0.5 0.2'/>", 0.1) +
            link("kite", "<sphere radius='0.1'/>", 0) +
            joint("drive", "planar", "world", "cart", "<origin xyz='0 0 1'/><axis xyz='0 0 1'/>") +
            joint("line", "floating", "cart", "kite", "<origin xyz='0 0 2'/>") + "</robot>\n");
  write("mobile.yaml", "format: corridor-robot-1\nurdf: mobile.urdf\nweights: {rotation: 0.3}\n");
  const std::string mobile =
      "format: corridor-problem-1\nrobot: mobile.yaml\nworld: {post: {sphere: 0.1}}\n"
      "start: {drive: {at: [1, 2], yaw_deg: 90}, line: {at: [0, 0, 1]}}\n"
      "goal: {drive: {at: [2, 2]}, line: {at: [1, 0, 1], rpy_deg: [0, 0, 180]}}\n";
  const Problem p =
      read(mobile +
           "bounds: {drive: {at: [[0, 0], [3, 3]]}, line: {at: [[-1, -1, -1], [1, 1, 1]]}}\n"
           "tube: {position: 0.01, rotation: 0.02}\n");
  EXPECT_THAT(namesOf(p), ElementsAre("drive/x", "drive/y", "drive/yaw", "line/x", "line/y",
                                      "line/z", "line/rotation"));
  EXPECT_EQ(skipped(p, "cart", "kite"), "") << "the kite goes anywhere, through the cart as well";
  EXPECT_EQ(p.model.space.coordinates()[2].weight, 0.3);
  EXPECT_EQ(p.model.space.coordinates()[6].weight, 0.6);
  EXPECT_EQ(p.task.tube, numbers({0.01, 0.01, 0.02, 0.01, 0.01, 0.01, 0.02, 0, 0, 0}));
  EXPECT_EQ(p.model.space.coordinates()[0].upper, 3);
  const auto frames = framePoses(p.model.tree, p.task.start);
  const auto& links = p.model.robots[0].linkFrames;
  EXPECT_LT((frames[links[1]].t - Vec3(1, 2, 1)).norm(), 1e-15);
  EXPECT_LT((frames[links[1]].m.col(0) - Vec3(0, 1, 0)).norm(), 1e-15);
  EXPECT_LT((frames[links[2]].t - Vec3(1, 2, 4)).norm(), 1e-15);
  EXPECT_EQ(
      complaintOf(mobile),
      "problem.yaml: missing bounds of the joint drive: bounds: {drive: {at: [[x, y], [x, y]]}} is "
      "needed, since it has no limits\n"
      "problem.yaml: missing bounds of the joint line: bounds: {line: {at: [[x, y, z], [x, y, "
      "z]]}} is needed, since it has no limits");
  EXPECT_EQ(
      complaintOf(mobile + "bounds: {drive: {at: [[0, 0], [1, 1]]}, line: {at: [[-1, -1, -1], "
                           "[1, 1, 1]]}}\n"),
      "problem.yaml:4: start.drive: outside of the bounds: y = 2 is not in [0, 1]\n"
      "problem.yaml:5: goal.drive: outside of the bounds: x = 2 is not in [0, 1]");
}

/// A differential drive can't move sideways. Its paths are not planned for.
TEST_F(ArmProblem, APlanarJointMaySlide) {
  write("cart.urdf", "<robot name='cart'>\n<link name='world'/>\n" +
                         link("cart", "<box size='0.5 0.5 0.2'/>", 0.1) +
                         joint("drive", "planar", "world", "cart", "<axis xyz='0 0 1'/>") +
                         "</robot>\n");
  const auto property = [](const std::string& joint, const std::string& model) {
    return "<robot name='cart'>\n<joint_property joint_name='" + joint +
           "' property_name='motion_model' value='" + model + "'/>\n</robot>\n";
  };
  const std::string robot = "format: corridor-robot-1\nurdf: cart.urdf\nsrdf: cart.srdf\n",
                    problem =
                        "format: corridor-problem-1\nrobot: cart.yaml\nworld: {post: {sphere: "
                        "0.1}}\nstart: {drive: {at: [1, 2]}}\ngoal: {drive: {at: [2, 2]}}\n"
                        "bounds: {drive: {at: [[0, 0], [3, 3]]}}\n";
  write("cart.yaml", robot);
  for (const auto& text : {property("drive", "holonomic"), property("other", "diff_drive")}) {
    write("cart.srdf", text);
    EXPECT_THAT(
        textsOf(read(problem).source.notes),
        Contains("these planar joints move in any direction, so the base may slide: drive; paths "
                 "of differential drives and cars are not planned for"));
  }
  write("cart.srdf", property("drive", "diff_drive"));
  EXPECT_THAT(
      complaintOf(problem),
      testing::HasSubstr("cart.srdf:2: <joint_property>: the motion_model is \"diff_drive\"; "
                         "paths of differential drives and cars are not planned for: joint "
                         "\"drive\" would move in any direction"));
  write("cart.yaml", "format: corridor-robot-1\nurdf: cart.urdf\ndrive: differential\n");
  EXPECT_THAT(complaintOf(problem), testing::HasSubstr("cart.yaml:3: \"drive\" is not supported "
                                                       "yet; a base moves in any direction"));
}

TEST_F(ArmProblem, APlanarJointMovesInThePlaneOfItsAxis) {
  write("wall.urdf",
        "<robot name='wall'>\n<link name='world'/>\n" + link("disc", "<sphere radius='0.1'/>", 0) +
            joint("drift", "planar", "world", "disc", "<axis xyz='0 -1 0'/>") + "</robot>\n");
  const Problem p = read(
      "format: corridor-problem-1\nrobot: wall.urdf\nworld: {post: {sphere: 0.1}}\nbounds: {drift: "
      "{at: "
      "[[-3, -3], [3, 3]]}}\nstart: {drift: {at: [1, 2], yaw_deg: 90}}\ngoal: {drift: {at: [0, "
      "0]}}\n");
  const Transform X = framePoses(p.model.tree, p.task.start)[p.model.robots[0].linkFrames[1]];
  EXPECT_NEAR(X.t.y(), 0, 1e-15);
  EXPECT_NEAR(X.t.norm(), std::sqrt(5.0), 1e-15);
  EXPECT_LT((X.m * Vec3::UnitY() - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((X.m * Vec3::UnitX() - Vec3::UnitZ()).norm(), 1e-15) << "90 degrees about -y";
}

TEST_F(ArmProblem, NotesThatNoPairIsTested) {
  const Problem p = read(
      "format: corridor-problem-1\nrobot: arm.yaml\nstart: ready\ngoal: ready\nallow: [[base, "
      "finger], [base, thumb], [upper, finger], [upper, thumb]]\n");
  ASSERT_FALSE(p.source.notes.empty());
  EXPECT_THAT(textsOf(p.source.notes).front(),
              testing::HasSubstr("no pair of bodies is tested, so nothing can collide"));
}

TEST_F(ArmProblem, FilesInTheOrderOfNaming) {
  const Problem p = read(armHead + armStates);
  std::vector<std::string> names;
  for (const auto& file : p.source.files) names.push_back(file.filename().string());
  EXPECT_THAT(names, ElementsAre("problem.yaml", "arm.yaml", "arm.urdf", "arm.srdf"));
}

/// An obstacle may have the name of a link.
TEST_F(ArmProblem, AnObstacleWithTheNameOfALink) {
  const std::string problem =
      "format: corridor-problem-1\nrobot: arm.yaml\nworld: {lower: {sphere: 0.1, at: [0.5, 0.5, "
      "9]}}\n" +
      armStates;
  const Problem p = read(problem + "allow: [[upper, world/lower], [arm7/lower, base]]\n");
  EXPECT_EQ(p.model.bodies.back().name, "world/lower");
  EXPECT_EQ(skipped(p, "upper", "world/lower"), "allow");
  EXPECT_EQ(skipped(p, "lower", "world/lower"), "");
  EXPECT_THAT(textsOf(p.source.notes),
              Contains("no obstacle is within reach; are all lengths in metres?"));
  EXPECT_THAT(textsOf(read(armHead + armStates).source.notes),
              testing::Not(Contains(testing::HasSubstr("within reach"))));
}

/// A note reports lengths that seem to be in millimetres, even if other obstacles are within reach.
TEST_F(ArmProblem, ObstaclesThatAreFarTooLarge) {
  using testing::AllOf;
  using testing::EndsWith;
  using testing::HasSubstr;
  using testing::Not;
  using testing::StartsWith;
  write("shelf.obj", "v 0 0 0\nv 800 0 0\nv 0 600 0\nf 1 2 3\n");
  write("block.obj", "v 0 0 0\nv 90 0 0\nv 0 90 0\nv 0 0 90\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  write("dots.xyz", "0 0 0\n0 0 1900\n");
  const Problem p =
      read(armHead + "  shelf: {mesh: shelf.obj, at: [0.5, 0.5, 0]}\n  block: {mesh: block.obj}\n" +
           "  dots: {points: {file: dots.xyz, radius: 0.01}}\n  beam: {box: [400, 90, 90]}\n" +
           "  ball: {sphere: 0.1, at: [500, 0, 0]}\n" +
           "  floor: {box: [1000, 1000, 0.1], at: [0, 0, -1]}\n" +
           "  small: {mesh: shelf.obj, unit: mm, at: [0.5, 0.5, 0]}\n" + armStates);
  const std::vector<std::string> notes = textsOf(p.source.notes);
  const auto isNoted = [](const std::string& name, const std::string& what,
                          const std::string& hint) {
    return Contains(
        AllOf(StartsWith("obstacle \"" + name + "\" is " + what + ", while the robot reaches "),
              EndsWith(" m; " + hint)));
  };
  const std::string unit = "if its lengths are in millimetres, write unit: mm";
  EXPECT_THAT(notes, isNoted("shelf", "800 m long", unit));
  EXPECT_THAT(notes, isNoted("block", "90 m long", unit));
  EXPECT_THAT(notes, isNoted("dots", "1900.02 m long", unit));
  EXPECT_THAT(notes, isNoted("beam", "400 m long", "are its lengths in metres?"));
  EXPECT_THAT(notes, Contains(AllOf(StartsWith("obstacle \"ball\" is 49"), HasSubstr(" m away"),
                                    EndsWith("are its lengths in metres?"))));
  for (const char* const name : {"post", "floor", "small"})
    EXPECT_THAT(notes, Not(Contains(HasSubstr("\"" + std::string(name) + "\" is"))));
}

/// Two groups have a state of the same name. The state of the planned group needs no prefix.
TEST_F(ArmProblem, AStateOfThePlannedGroupNeedsNoPrefix) {
  std::string text = srdf;
  text.insert(text.find("<disable_collisions"),
              "<group_state name='ready' group='nothing'><joint name='slide' "
              "value='0.02'/></group_state>\n");
  write("arm.srdf", text);
  EXPECT_EQ(complaintOf(armHead + armStates), "no complaint");
  EXPECT_EQ(complaintOf(armHead + "start: arm/ready\ngoal: {pan: 1, lift: 0.3}\n"), "no complaint");
}

}  // namespace
}  // namespace corridor::test
