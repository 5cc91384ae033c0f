// Tests of columns of joints that are not planned for, and of states in messages: what a file says
// about such a joint is what the model says, or the file is refused.
#include "planner/trajectory/unplanned_columns.h"

#include <cmath>
#include <random>

#include "planner/solve/verify_solution.h"
#include "tests/planner/trajectory/trajectory_fixture.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// The planned joints are pan and lift. `slide` is held at 0.02, `follow` is -slide, and `wag` is
/// 0.5 - 2·lift. The wrist is fixed.
class UnplannedColumns : public TrajectoryTest {
 protected:
  std::vector<std::string> notes(const std::string& text) const {
    std::vector<std::string> all;
    for (const Note& note : rows(text).notes) all.push_back(note.text);
    return all;
  }
};

TEST_F(UnplannedColumns, HeldJointsMayNotMoveBetweenRows) {
  const std::string begin = "t.csv:2: \"slide\" is held at 0.02 in the problem, but has the ",
                    end =
                        " here, so it moves between the rows; plan for the joint (joints: in the "
                        "robot's file), or leave it out of the file and let margin cover its "
                        "motion";
  const std::string speeds = "time pan lift slide pan_vel lift_vel slide_vel\n";
  EXPECT_EQ(complaint(speeds + "0 0 0 0.02 0 0 1\n2 1 1 0.02 0 0 -1\n"),
            begin + "velocity 1" + end);
  EXPECT_EQ(complaint(speeds + "0 0 0 0.02 0 0 1e-9\n2 1 1 0.02 0 0 0\n"),
            begin + "velocity 1e-09" + end);
  EXPECT_EQ(complaint(speeds + "0 0 0 0.02 0 0 0\n2 1 1 0.02 0 0 0\n"), "");
  // The velocity alone, without a column of positions.
  EXPECT_EQ(complaint("time pan lift pan_vel lift_vel slide_vel\n0 0 0 0 0 1\n2 1 1 0 0 -1\n"),
            begin + "velocity 1" + end);
  EXPECT_EQ(complaint("time pan lift slide pan_vel lift_vel pan_acc lift_acc slide_acc\n"
                      "0 0 0 0.02 0 0 0 0 3\n2 1 1 0.02 0 0 0 0 0\n"),
            begin + "acceleration 3" + end);
  EXPECT_EQ(complaint("joint_names: [pan, lift, slide]\npoints:\n"
                      "- {positions: [0, 0, 0.02], velocities: [0, 0, 0], time_from_start: 0}\n"
                      "- {positions: [1, 1, 0.02], velocities: [0, 0, 2], time_from_start: 1}\n"),
            "t.csv:4" + begin.substr(7) + "velocity 2" + end);
}

TEST_F(UnplannedColumns, HeldPositionsMustBeEqualUpToRounding) {
  const auto file = [](const std::string& slide) {
    return "pan lift slide\n0 0 " + slide + "\n1 1 " + slide + "\n";
  };
  EXPECT_EQ(complaint(file("0.02")), "");
  EXPECT_EQ(complaint(file("0.020000000000000004")), "") << "one unit in the last place";
  EXPECT_EQ(complaint(file("0.020001")),
            "t.csv:2: \"slide\" is held at 0.02 in the problem, but is 0.020001 here: the proof "
            "would be about another robot; in the robot's file, write hold: {slide: 0.020001}");
  EXPECT_EQ(complaint("pan lift slide\n0 0 0.02\n1 1 0.02\n2 2 0.0200000001\n"),
            "t.csv:4: \"slide\" is held at 0.02 in the problem, but is 0.02 to 0.0200000001 in "
            "this file; plan for the joint (joints: in the robot's file), or leave it out of the "
            "file and let margin cover its motion");
}

TEST_F(UnplannedColumns, MimicJointsMayNotLeaveTheirRule) {
  const std::string end =
      " by the rule by which it follows \"lift\": the proof would be for the rule; leave its "
      "columns out if it follows the rule, or plan for it (remove <mimic> from the URDF)";
  EXPECT_EQ(complaint("pan lift wag\n0 0 0.5\n1 0.25 0.25\n"),
            "t.csv:3: \"wag\" is 0.25 here, and 0" + end);
  EXPECT_EQ(complaint("pan lift wag\n0 0 0.5\n1 0.25 1e-6\n"),
            "t.csv:3: \"wag\" is 1e-06 here, and 0" + end);
  const std::string speeds = "time pan lift wag pan_vel lift_vel wag_vel\n";
  EXPECT_EQ(complaint(speeds + "0 0 0 0.5 1 0.5 -1\n1 1 0.25 0 1 0 0\n"), "");
  EXPECT_EQ(complaint(speeds + "0 0 0 0.5 1 0.5 -1\n1 1 0.25 0 1 0 4\n"),
            "t.csv:3: \"wag\" has the velocity 4 here, and 0" + end);
  // `follow` mimics the held joint `slide`.
  EXPECT_THAT(complaint("pan lift follow\n0 0 -0.02\n1 0 -0.03\n"),
              HasSubstr("t.csv:3: \"follow\" is -0.03 here, and -0.02 by the rule by which it "
                        "follows \"slide\""));
}

TEST_F(UnplannedColumns, FixedJointsMayNotMove) {
  EXPECT_THAT(notes("pan lift wrist\n0 0 0\n1 1 0\n"),
              ElementsAre("t.csv: not read: wrist; these joints are fixed"));
  EXPECT_THAT(notes("pan lift wrist\n0 0 0.3\n1 1 0.3\n"),
              ElementsAre("t.csv: \"wrist\" is fixed in the URDF; its position here, 0.3, is not "
                          "used",
                          "t.csv: not read: wrist; these joints are fixed"));
  EXPECT_EQ(complaint("pan lift wrist\n0 0 0\n1 1 1\n"),
            "t.csv:3: \"wrist\" is fixed in the URDF, but moves from 0 to 1 in this file; leave "
            "its columns out, or give the joint its type in the URDF");
  EXPECT_THAT(complaint("time pan lift wrist pan_vel lift_vel wrist_vel\n0 0 0 0 0 0 1\n"
                        "1 1 1 0 0 0 0\n"),
              HasSubstr("t.csv:2: \"wrist\" is fixed in the URDF, but has the velocity 1 here"));
}

/// Each cell of a file with columns for planned, held, mimic and fixed joints is changed by 1: the
/// rows change, or the file is refused.
TEST_F(UnplannedColumns, EveryCellCounts) {
  const std::vector<std::string> columns{
      "time",     "pan",      "lift",      "slide",      "follow",     "wag",       "wrist",
      "pan_vel",  "lift_vel", "wag_vel",   "slide_vel",  "follow_vel", "wrist_vel", "pan_acc",
      "lift_acc", "wag_acc",  "slide_acc", "follow_acc", "wrist_acc"};
  const std::vector<std::vector<double>> cells{
      {0, 0, 0, 0.02, -0.02, 0.5, 0, 0.5, 0.25, -0.5, 0, 0, 0, 0, 1, -2, 0, 0, 0},
      {2, 1, 0.5, 0.02, -0.02, -0.5, 0, 0.5, 0.25, -0.5, 0, 0, 0, 0, 0, 0, 0, 0, 0},
      {4, 2, 0.25, 0.02, -0.02, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}};
  const auto textOf = [&](const std::vector<std::vector<double>>& numbers) {
    std::string text;
    for (const std::string& column : columns) text += column + " ";
    for (const auto& row : numbers) {
      text += "\n";
      for (const double value : row) text += std::to_string(value) + " ";
    }
    return text + "\n";
  };
  const TrajectoryRows plain = rows(textOf(cells));
  for (std::size_t r = 0; r < cells.size(); ++r)
    for (std::size_t c = 0; c < columns.size(); ++c) {
      auto changed = cells;
      changed[r][c] += 1;
      try {
        const TrajectoryRows read = rows(textOf(changed));
        bool same = read.notes.size() == plain.notes.size();
        for (std::size_t i = 0; i < read.rows.size(); ++i)
          same = same && read.rows[i].time == plain.rows[i].time &&
                 read.rows[i].positions == plain.rows[i].positions &&
                 read.rows[i].velocities == plain.rows[i].velocities &&
                 read.rows[i].accelerations == plain.rows[i].accelerations;
        EXPECT_FALSE(same) << columns[c] << " of row " << r << " has no effect";
        EXPECT_TRUE(columns[c] == "time" || columns[c].starts_with("pan") ||
                    columns[c].starts_with("lift"))
            << columns[c] << " of row " << r << " is read, though it is not planned for";
      } catch (const InputError&) {
      }
    }
}

/// The bound of `checkUnplanned` holds for an own evaluation of the quintic of Hermite.
TEST(UnplannedColumnsBound, ContainsTheCurve) {
  std::mt19937 random(testSeed(51));
  std::uniform_real_distribution<double> any(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const double p0 = any(random), v0 = any(random), a0 = any(random), p1 = any(random),
                 v1 = any(random), a1 = any(random), step = 2 + any(random);
    const auto bound = [&](double p, double v, double a) {
      return std::abs(p) + step * std::abs(v) + step * step * std::abs(a);
    };
    const double most = std::max(bound(p0, v0, a0), bound(p1, v1, a1));
    for (double s = 0; s <= 1; s += 0.05) {
      const double s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s, h = step;
      const double quintic =
          p0 * (1 - 10 * s3 + 15 * s4 - 6 * s5) + h * v0 * (s - 6 * s3 + 8 * s4 - 3 * s5) +
          h * h * a0 * (0.5 * s2 - 1.5 * s3 + 1.5 * s4 - 0.5 * s5) +
          p1 * (10 * s3 - 15 * s4 + 6 * s5) + h * v1 * (-4 * s3 + 7 * s4 - 3 * s5) +
          h * h * a1 * (0.5 * s3 - s4 + 0.5 * s5);
      EXPECT_LE(std::abs(quintic), most);
      const double cubic = p0 * (1 - 3 * s2 + 2 * s3) + h * v0 * (s - 2 * s2 + s3) +
                           p1 * (3 * s2 - 2 * s3) + h * v1 * (s3 - s2);
      EXPECT_LE(std::abs(cubic), std::max(bound(p0, v0, 0), bound(p1, v1, 0)));
    }
  }
}

/// Tests of the start state that a message of MoveIt has.
class StartOfTrajectory : public UnplannedColumns {
 protected:
  static std::string message(const std::string& start, const std::string& more = "") {
    return "trajectory_start: {" + start + "}\n" + more +
           "trajectory:\n- joint_trajectory:\n    joint_names: [pan, lift]\n    points:\n"
           "    - {positions: [0.5, 0.25], time_from_start: 0}\n"
           "    - {positions: [1, 1], time_from_start: 1}\n";
  }
  static std::string joints(const std::string& names, const std::string& values) {
    return "joint_state: {name: [" + names + "], position: [" + values + "]}";
  }
};

TEST_F(StartOfTrajectory, IsTheFirstPoint) {
  EXPECT_THAT(notes(message(joints("pan, lift, slide, follow, wag", "0.5, 0.25, 0.02, -0.02, 0"))),
              IsEmpty());
  EXPECT_THAT(notes(message(joints("pan, lift", std::to_string(0.5) + ", 0.25"))), IsEmpty());
  EXPECT_EQ(complaint(message(joints("pan, lift", "0.5, 0.75"))),
            "t.csv:1: trajectory_start: \"lift\" is 0.75, but the first point has 0.25: the motion "
            "between them is not in the file; begin the points at the start");
  EXPECT_THAT(notes(message(joints("pan", "6.783185307179586"))), IsEmpty())
      << "pan is continuous: a full turn is the same pose";
  EXPECT_THAT(notes(message(joints("lift", "0.250001"))),
              ElementsAre("t.csv: trajectory_start: lift of the start and of the first point "
                          "differ by up to 1e-05; the motion between them is not verified"));
}

TEST_F(StartOfTrajectory, HeldJointsAreAtTheirHeldValues) {
  EXPECT_EQ(complaint(message(joints("slide", "0.04"))),
            "t.csv:1: trajectory_start: \"slide\" is held at 0.02 in the problem, but is 0.04 "
            "here: the proof would be about another robot; in the robot's file, write hold: "
            "{slide: 0.04}");
  EXPECT_EQ(complaint(message(joints("wag", "1"))),
            "t.csv:1: trajectory_start: \"wag\" is 1, and 0 by the rule of this mimic joint: the "
            "proof would be for the rule; leave the value out if the joint follows the rule");
  EXPECT_THAT(notes(message(joints("ghost", "1"))),
              ElementsAre("t.csv: trajectory_start: the robot has no joint ghost; the values are "
                          "not used"));
}

TEST_F(StartOfTrajectory, FixedJointsAreNoted) {
  EXPECT_THAT(notes(message(joints("wrist", "0"))), IsEmpty());
  EXPECT_THAT(
      notes(message(joints("wrist", "1"))),
      ElementsAre("t.csv: trajectory_start: not used, because the joints are fixed or need a "
                  "pose: wrist"));
}

TEST_F(StartOfTrajectory, ObjectsAndPosesAreRefused) {
  EXPECT_EQ(complaint(message("attached_collision_objects: [{link_name: finger}]")),
            "t.csv:1: trajectory_start.attached_collision_objects: is not supported; add the "
            "objects to the robot");
  EXPECT_EQ(complaint(message("multi_dof_joint_state: {joint_names: [base], transforms: "
                              "[{translation: [1, 0, 0], rotation: [0, 0, 0, 1]}]}")),
            "t.csv:1: trajectory_start.multi_dof_joint_state.transforms: \"base\": the base is at "
            "{at: [0, 0, 0], quat_xyzw: [0, 0, 0, 1]}, not at {at: [1, 0, 0], quat_xyzw: [0, 0, 0, "
            "1]} as here; give it by base in the problem");
  EXPECT_EQ(complaint(message("multi_dof_joint_state: {joint_names: [base], transforms: "
                              "[{translation: [0, 0, 0], rotation: [0, 0, 0, -1]}]}")),
            "");
  for (const std::string text : {"{points: [{}]}", "{points: {x: 1}}", "[{points: [{}]}]", "1"})
    EXPECT_EQ(complaint(message("", "multi_dof_trajectory: " + text + "\n")),
              "t.csv:2: multi_dof_trajectory: trajectories of poses are not read from messages; "
              "write rows of numbers (CSV)")
        << text;
}

/// As for single joints, a difference of at most 1e-5 between the start and the first point is
/// noted.
TEST_F(StartOfTrajectory, PosesThatArePlannedFor) {
  write("cube.yaml",
        "format: corridor-robot-1\nname: cube\nrigid: SE2\nshapes: [{box: [0.2, 0.2, 0.2]}]\n");
  const Problem rigid = readProblem(
      write("rigid.yaml",
            "format: corridor-problem-1\nrobot: cube.yaml\nworld: {rock: {box: [1, 1, 1]}}\n"
            "bounds: {at: [[-5, -5], [5, 5]]}\nstart: {at: [1, 2]}\ngoal: {at: [1, 3]}\n"));
  const auto at = [](const std::string& x) {
    return "trajectory_start: {multi_dof_joint_state: {joint_names: [base], transforms: "
           "[{translation: [" +
           x +
           ", 2, 0], rotation: [0, 0, 0, 1]}]}}\ntrajectory:\n- joint_trajectory:\n    "
           "joint_names: "
           "[x, y, yaw]\n    points:\n    - {positions: [1, 2, 0]}\n    - {positions: [1, 3, 0]}\n";
  };
  EXPECT_THAT(textsOf(readTrajectory("t.csv", at("1"), rigid.model).notes), IsEmpty());
  EXPECT_THAT(textsOf(readTrajectory("t.csv", at("1.000009"), rigid.model).notes),
              ElementsAre("t.csv: trajectory_start: base of the start and of the first point "
                          "differ by up to 1e-05; the motion between them is not verified"));
  EXPECT_THAT(complaint(at("1.00002"), rigid), HasSubstr("\"base\": the first point is at {at: "));
}

/// Fields of the messages around a trajectory that move nothing are ignored, and all others are
/// noted by their names.
TEST_F(StartOfTrajectory, OtherFieldsAreNotedByName) {
  EXPECT_THAT(notes(message("",
                            "header: {stamp: 3}\nmodel_id: x\ngroup_name: y\nplanning_time: 2\n"
                            "error_code: {val: 1}\n")),
              IsEmpty());
  EXPECT_THAT(notes(message("", "sped: 3\nempty: []\nzero: {a: 0, b: [false, \"\"]}\n")),
              ElementsAre("t.csv: not used: sped (line 2)"));
  EXPECT_THAT(notes(message("",
                            "multi_dof_joint_trajectory: {header: {stamp: 3}, joint_names: [], "
                            "points: [], waypoints: [1]}\n")),
              ElementsAre("t.csv: not used: multi_dof_joint_trajectory.waypoints (line 2)"));
  EXPECT_THAT(notes(message("", "path_tolerance: [{name: pan, position: 0.1}]\n")),
              ElementsAre("t.csv: path_tolerance: is not used; a proof covers the problem's tube "
                          "(key tube)"));
  EXPECT_THAT(notes(message("is_diff: true, joint_state: {name: [pan], position: [0.5], velocity: "
                            "[2]}")),
              ElementsAre(HasSubstr("trajectory_start.is_diff: the state is a difference"),
                          "t.csv: not used: trajectory_start.joint_state.velocity (line 1)"));
}

}  // namespace
}  // namespace corridor::test
