// The allowed collision matrix of a scene, goals of mimic joints, and empty texts of messages.
#include "tests/planner/import/moveit_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

using testing::Contains;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class MoveitMatrix : public Moveit {
 protected:
  /// Writes a scene with one obstacle, and a matrix of these names and rows.
  void matrix(const std::string& names, const std::string& rows, const std::string& more = "") {
    write(
        "scene.yaml",
        "world: {collision_objects: [{id: crate, primitives: [{type: sphere, dimensions: [0.1]}], "
        "primitive_poses: [{position: [5, 0, 0]}]}]}\nallowed_collision_matrix:\n  entry_names: "
        "[" +
            names + "]\n  entry_values: [" + rows + "]\n" + more);
  }
  /// The robot allows base ~ lower, which the SRDF also allows, and base ~ finger.
  void allowInRobot() {
    write("arm.yaml",
          "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\nallow: [[base, lower], "
          "[finger, base]]\n");
  }
  std::vector<std::string> notes(const Problem& p) const {
    std::vector<std::string> texts = textsOf(p.source.notes);
    for (std::string& text : texts)
      if (text.starts_with(folder_.string())) text.erase(0, folder_.string().size() + 1);
    return texts;
  }
};

TEST_F(MoveitMatrix, ReplacesThePairsOfTheSrdfOnly) {
  allowInRobot();
  matrix("upper, crate", "[false, true], [true, false]");
  const Problem p = read(head);
  EXPECT_EQ(skipped(p, "upper", "crate"), "allowed_collision_matrix");
  EXPECT_EQ(skipped(p, "base", "lower"), "robot.yaml: allow") << "the SRDF has this pair, too";
  EXPECT_EQ(skipped(p, "base", "finger"), "robot.yaml: allow");
  EXPECT_THAT(notes(p), Not(Contains(HasSubstr("allowed_collision_matrix"))));
  write("arm.yaml", "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\n");
  EXPECT_EQ(skipped(read(head), "base", "lower"), "") << "the matrix replaces the SRDF";
}

TEST_F(MoveitMatrix, FalseIsTestedAgainAndNoted) {
  allowInRobot();
  matrix("base, lower, finger, upper",
         "[0, 0, 1, False], [0, 0, 0, False], [True, 0, 0, 0], [0, 0, 0, 0]");
  const Problem p = read(head);
  EXPECT_EQ(skipped(p, "base", "lower"), "");
  EXPECT_EQ(skipped(p, "base", "finger"), "robot.yaml: allow");
  EXPECT_EQ(skipped(p, "base", "upper"), "adjacent");
  EXPECT_THAT(notes(p), Contains("scene.yaml: allowed_collision_matrix: tested, although "
                                 "robot.yaml allows them to touch: base ~ lower"));
  EXPECT_THAT(notes(p), Contains("scene.yaml: allowed_collision_matrix: not tested, although the "
                                 "matrix has false, because the links are adjacent: lower ~ "
                                 "finger, base ~ upper, "
                                 "lower ~ upper"));
}

TEST_F(MoveitMatrix, ItsNamesDiffer) {
  matrix("base, lower, base", "[0, 1, 0], [1, 0, 0], [0, 0, 0]");
  EXPECT_EQ(complaintOf(head),
            "scene.yaml:3: allowed_collision_matrix.entry_names: a name is listed twice, so its "
            "rows may disagree");
}

TEST_F(MoveitMatrix, ItsValuesAreTrueOrFalse) {
  matrix("base, lower", "[false, yes], [yes, false]");
  EXPECT_EQ(complaintOf(head),
            "scene.yaml:4: allowed_collision_matrix.entry_values[0]: true or false is needed, not "
            "\"yes\"");
}

TEST_F(MoveitMatrix, DefaultEntriesAreNoted) {
  matrix("base, lower", "[false, false], [false, false]",
         "  default_entry_names: [base]\n  default_entry_values: [true]\n");
  EXPECT_THAT(notes(read(head)),
              Contains("scene.yaml: not used: allowed_collision_matrix.default_entry_names (line "
                       "5), allowed_collision_matrix.default_entry_values (line 6)"));
}

/// Messages of ROS have all fields: an empty text is no value.
TEST_F(MoveitMatrix, EmptyTextsAreNoValues) {
  write("scene.yaml",
        "robot_model_name: ''\nworld:\n  collision_objects: [{header: {frame_id: ''}, id: crate, "
        "primitives: [{type: sphere, dimensions: [0.1]}], primitive_poses: [{position: [5, 0, "
        "0]}]}]\n  octomap: {header: {frame_id: ''}, origin: {position: [0, 0, 0], orientation: "
        "[0, 0, "
        "0, 0]}, octomap: {data: []}}\n");
  const Problem p = read(head + std::string("base: {at: [0, 0, 1]}\n"));
  EXPECT_EQ(p.model.bodies.back().shapes.at(0).parts.at(0).points[0], Vec3(5, 0, 0))
      << "in the world, not in the frame of the robot";
  write("arm.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\njoints: [pan, lift]\n");
  const auto notesOnGroup = [&] {
    std::vector<std::string> notes = textsOf(read(head).source.notes);
    std::erase_if(notes,
                  [](const std::string& note) { return !note.starts_with("the request's"); });
    return notes;
  };
  EXPECT_THAT(notesOnGroup(), testing::ElementsAre(
                                  "the request's group \"arm\" is not used: robot.yaml chooses the "
                                  "joints that are planned for"));
  std::string text = request;
  write("request.yaml", text.replace(text.find("group_name: arm"), 15, "group_name: ''"));
  EXPECT_THAT(notesOnGroup(), testing::IsEmpty());
  EXPECT_EQ(read(head).model.space.size(), 2);
}

TEST_F(MoveitMatrix, GoalsOfMimicJointsKeepTheirRule) {
  const auto withGoal = [&](const std::string& constraints) {
    std::string text = request;
    const std::string lift = "{joint_name: lift, position: 0.75}\n";
    text.insert(text.find(lift) + lift.size(), "      - " + constraints + "\n");
    write("request.yaml", text);
    return complaintOf(head);
  };
  // slide is held at 0.04.
  EXPECT_EQ(withGoal("{joint_name: follow, position: -0.04}"), "no complaint");
  EXPECT_EQ(withGoal("{joint_name: follow, position: -0.03}"),
            "request.yaml:8: goal_constraints[0].joint_constraints: follow follows slide (mimic), "
            "and is at -0.04 there, not at -0.03");
  EXPECT_EQ(withGoal("{joint_name: wrist, position: 0.3}"), "no complaint");
  EXPECT_THAT(notes(read(head)),
              Contains("request.yaml: goal_constraints[0].joint_constraints: not used, because the "
                       "joints are fixed or need a pose: wrist"));
  // slide is planned for.
  write("arm.yaml",
        "format: corridor-robot-1\nurdf: arm.urdf\nsrdf: arm.srdf\njoints: [pan, lift, slide]\n");
  write("request.yaml",
        "start_state: {joint_state: {name: [pan, lift, slide], position: [0, 0, 0.02]}}\n"
        "goal_constraints:\n- joint_constraints: [{joint_name: pan, position: 1}, {joint_name: "
        "lift, position: 0}, {joint_name: slide, position: 0.03}, {joint_name: follow, position: "
        "-0.02}]\n");
  EXPECT_EQ(complaintOf(head),
            "request.yaml:3: goal_constraints[0].joint_constraints: follow follows slide (mimic), "
            "and is at -0.03 there, not at -0.02");
}

/// A slide that is off by 2π m is elsewhere, even if the joint that it follows turns.
TEST_F(MoveitMatrix, GoalsOfSlidesDoNotTurn) {
  std::string follows = urdf, text = request;
  const std::string rule = "joint='slide' multiplier='-1'", lift = "lift, position: 0.75}\n";
  follows.replace(follows.find(rule), rule.size(), "joint='pan' multiplier='0' offset='-0.01'");
  write("arm.urdf", follows);
  text.insert(text.find(lift) + lift.size(),
              "      - {joint_name: follow, position: 6.273185307179586}\n");
  write("request.yaml", text);
  EXPECT_THAT(complaintOf(head), HasSubstr("follow follows pan (mimic), and is at -0.01 there"));
}

/// The key `lift_deg` is one of problem files, not of messages.
TEST_F(MoveitMatrix, MessagesGetNoAdviceOnDegrees) {
  std::string text = request;
  text.replace(text.find("position: 0.75"), 14, "position: 90");
  text.replace(text.find("position: 1,"), 12, "position: 90,");
  write("request.yaml", text);
  EXPECT_EQ(complaintOf(head),
            "request.yaml:8: goal_constraints[0].joint_constraints: lift: 90 is outside of its "
            "limits, [-3.14159, 3.14159]");
}

}  // namespace
}  // namespace corridor::test
