// Tests of the readers of trajectory files: every format gives the same rows.
#include "planner/trajectory/trajectory_file.h"

#include "tests/planner/trajectory/trajectory_fixture.h"

namespace corridor {
namespace {

using test::numbers;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::StartsWith;

using TrajectoryFile = test::TrajectoryTest;

std::vector<std::string> texts(const TrajectoryRows& rows) {
  return textsOf(rows.notes);
}

TEST_F(TrajectoryFile, RowsWithoutAHeaderAreInTheOrderOfTheSpace) {
  const TrajectoryRows read = rows("# a comment\n0.5 1\n\n-7, 0.25  # another\n");
  EXPECT_FALSE(read.timed);
  EXPECT_FALSE(read.hasVelocities);
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(read.rows[0].positions, numbers({0.5, 1}));
  EXPECT_EQ(read.rows[1].positions, numbers({-7, 0.25}));  // literal, not reduced to [−π, π]
  EXPECT_EQ(read.rows[0].line, 2);
  EXPECT_EQ(read.rows[1].line, 4);
}

TEST_F(TrajectoryFile, AHeaderNamesColumnsInAnyOrder) {
  const TrajectoryRows read = rows("\xEF\xBB\xBF# lift time pan\n1 0.5 2\n3 0.75 4\n");
  EXPECT_TRUE(read.timed);
  EXPECT_EQ(read.rows[0].positions, numbers({2, 1}));
  EXPECT_EQ(read.rows[1].positions, numbers({4, 3}));
  EXPECT_EQ(read.rows[1].time, 0.75);
}

/// What comments may mean is tested with TableLines.
TEST_F(TrajectoryFile, CommentsThatMayMeanOtherColumns) {
  EXPECT_EQ(complaint("# a title\n# pan_deg, lift\n0.5 1\n0.25 1\n"),
            "t.csv:2: the comment seems to be a header, but is not one; write the names only, as "
            "in \"pan,lift\" (rad, m), or delete the comment");
  const TrajectoryRows read = rows("# pan [rad], lift [rad]\nlift,pan\n0.5 1\n0.25 1\n");
  EXPECT_EQ(read.rows[0].positions, numbers({1, 0.5}));
  EXPECT_THAT(texts(read),
              ElementsAre("t.csv: comments are not read: \" pan [rad], lift [rad]\" (line 1); "
                          "the columns are lift, pan, in this order, in m and rad"));
  EXPECT_THAT(complaint("0.5 1\n# in degrees\n0.25 1\n"), HasSubstr("the comment says"));
  EXPECT_EQ(complaint("# lift pan\ntime pan lift\n1 2 3\n"),
            "t.csv:2: names other columns than line 1, or in another order; delete one of the two "
            "lines");
  EXPECT_EQ(complaint("pan,lift\n1,,2\n3,4\n"), "t.csv:2: the field before comma 2 is empty");
}

TEST_F(TrajectoryFile, FixedJointsAreNotRead) {
  const TrajectoryRows read = rows("pan lift wrist\n1 2 0\n3 4 0\n");
  EXPECT_EQ(read.rows[1].positions, numbers({3, 4}));
  EXPECT_THAT(texts(read), testing::ElementsAre("t.csv: not read: wrist; these joints are fixed"));
}

TEST_F(TrajectoryFile, TheCommonNamesOfVelocitiesAreRead) {
  for (const char* const header :
       {"time,pan,lift,pan_velocity,lift_velocity,pan_acceleration,lift_acceleration",
        "t,pan,lift,pan.velocity,lift.velocity,pan.acceleration,lift.acceleration",
        "time_from_start,\"pan\",lift,vel_pan,vel_lift,acc_pan,acc_lift",
        "time,pan/position,lift/position,pan/velocity,lift/velocity,pan/accel,lift/accel",
        "time,pan_pos,pos_lift,pan_vel,velocity.lift,acceleration_pan,lift_acc"}) {
    const TrajectoryRows read =
        rows(std::string(header) + "\n0,1,2,3,4,5,6\n1,1.5,2.5,3.5,4.5,5.5,6.5\n");
    ASSERT_TRUE(read.hasVelocities && read.hasAccelerations) << header;
    EXPECT_EQ(read.rows[1].positions, numbers({1.5, 2.5})) << header;
    EXPECT_EQ(read.rows[1].velocities, numbers({3.5, 4.5})) << header;
    EXPECT_EQ(read.rows[1].accelerations, numbers({5.5, 6.5})) << header;
  }
}

TEST_F(TrajectoryFile, EffortsAreNotedAndNotUsed) {
  const TrajectoryRows read = rows("pan lift pan_effort lift_torque\n0 0 x 9\n1 1 - 9\n");
  EXPECT_EQ(read.rows[1].positions, numbers({1, 1}));
  EXPECT_THAT(texts(read), ElementsAre("t.csv: not used: pan_effort, lift_torque"));
}

/// A planner or controller that failed may have left a part of a trajectory.
TEST_F(TrajectoryFile, ErrorCodesOtherThanSuccessAreNoted) {
  const auto notes = [&](const std::string& code) {
    return texts(
        rows("trajectory: {joint_names: [pan, lift], points: [{positions: [0, 0]}, "
             "{positions: [1, 1]}]}\nerror_code: " +
             code + "\n"));
  };
  EXPECT_THAT(
      notes("{val: -2, message: 'x'}"),
      ElementsAre("t.csv: error_code.val: -2 is not success; the trajectory is judged as it "
                  "stands"));
  EXPECT_THAT(notes("-4"),
              ElementsAre("t.csv: error_code: -4 is not success; the trajectory is judged as it "
                          "stands"));
  EXPECT_THAT(notes("[1]"),
              ElementsAre("t.csv: error_code: a list is not success; the trajectory is judged as "
                          "it stands"));
  EXPECT_THAT(notes("{value: -4}"), ElementsAre("t.csv: not used: error_code.value (line 2)"));
  for (const char* const code : {"{val: 1, message: '', source: ''}", "{val: 0}", "0", "{}"})
    EXPECT_THAT(notes(code), testing::IsEmpty()) << code;
}

TEST_F(TrajectoryFile, MessagesOfRosAndMoveitAreTheSameRows) {
  const std::string ros1 =
      "header:\n  frame_id: ''\njoint_names: [lift, pan]\npoints:\n"
      "  -\n    positions: [1, 2]\n    velocities: [3, 4]\n    accelerations: []\n    effort: []\n"
      "    time_from_start:\n      secs: 0\n      nsecs: 0\n"
      "  -\n    positions: [1.5, 2.5]\n    velocities: [3.5, 4.5]\n    accelerations: []\n"
      "    effort: []\n    time_from_start:\n      secs: 2\n      nsecs: 100000000\n";
  const std::string json =
      "{\"joint_names\":[\"lift\",\"pan\"],\n\t\"points\":[\n{\"positions\":[1,2],\"velocities\":"
      "[3,4],\"time_from_start\":{\"sec\":0,\"nanosec\":0}},{\"positions\":[1.5,2.5],\"velocities\""
      ":[3.5,4.5],\"time_from_start\":2.1}]}";
  const auto indented = [](const std::string& text, const std::string& by) {
    std::string all = by;
    for (const char c : text) all += c == '\n' ? "\n" + by : std::string(1, c);
    return all.substr(0, all.size() - by.size());
  };
  for (const std::string& text :
       {ros1, ros1 + "---\n", json, "joint_trajectory:\n" + indented(ros1, "  "),
        "model_id: arm\ntrajectory:\n- joint_trajectory:\n" + indented(ros1, "    ") +
            "  multi_dof_joint_trajectory:\n    joint_names: []\n    points: []\n",
        "planned_trajectory: {joint_trajectory: " + json + "}\nerror_code: {val: 1}\n",
        "goal:\n  trajectory:\n" + indented(ros1, "    ")}) {
    ASSERT_EQ(trajectoryFormatOf(text), TrajectoryFormat::message) << text;
    const TrajectoryRows read = rows(text);
    ASSERT_EQ(read.rows.size(), 2u) << text;
    EXPECT_TRUE(read.timed && read.hasVelocities && !read.hasAccelerations && read.isMessage);
    EXPECT_EQ(read.rows[0].time, 0) << text;
    EXPECT_EQ(read.rows[1].time, 2.1) << text;  // the double nearest to 2100000000 ns
    EXPECT_EQ(read.rows[1].positions, numbers({2.5, 1.5})) << text;
    EXPECT_EQ(read.rows[1].velocities, numbers({4.5, 3.5})) << text;
    EXPECT_TRUE(read.notes.empty()) << texts(read).front();
  }
}

TEST_F(TrajectoryFile, AMessageThatBeginsLaterIsNoted) {
  const std::string names = "joint_names: [pan, lift]\npoints:\n- {positions: [0, 0], ";
  const std::string second = "- {positions: [1, 1], time_from_start: 2}\n";
  EXPECT_THAT(texts(rows(names + "time_from_start: 0.5}\n" + second)),
              ElementsAre("t.csv: the first point is at 0.5 s: a controller moves there from the "
                          "robot's state at 0 s, and this motion is not verified"));
}

TEST_F(TrajectoryFile, APlanWithoutTimesIsAPath) {
  const TrajectoryRows read = rows(
      "joint_names: [pan, lift]\npoints:\n- {positions: [0, 0], time_from_start: {secs: 0, nsecs: "
      "0}}\n- {positions: [1, 1], time_from_start: {secs: 0, nsecs: 0}}\n");
  EXPECT_FALSE(read.timed);
  EXPECT_THAT(texts(read), ElementsAre(HasSubstr("time_from_start is 0 at all points")));
}

TEST_F(TrajectoryFile, HeldAndMimicJointsMayBeInTheFile) {
  const TrajectoryRows read =
      rows("pan lift slide follow wag\n0 0 0.02 -0.02 0.5\n1 0.25 0.02 -0.02 0\n");
  EXPECT_EQ(read.rows[1].positions, numbers({1, 0.25}));
  EXPECT_THAT(texts(read), ElementsAre("t.csv: not read: follow, wag; mimic joints follow the rule "
                                       "of the robot"));
}

TEST_F(TrajectoryFile, TheNameOfTheRobotMayBeLeftOutIfOneRobotHasTheJoint) {
  std::string other = urdf;
  for (const auto& [from, to] : {std::pair{"'pan'", "'yaw'"}, std::pair{"'slide'", "'grip'"}})
    for (auto at = other.find(from); at != other.npos; at = other.find(from))
      other.replace(at, std::string(from).size(), to);
  write("other.urdf", other);
  write("other.yaml",
        "format: corridor-robot-1\nname: other\nurdf: other.urdf\njoints: [yaw, lift]\n");
  const Problem two = read(
      "format: corridor-problem-1\nrobots: {a: {file: arm.yaml}, b: {file: other.yaml, base: {at: "
      "[5, 0, 0]}}}\nstart: {a: {pan: 0, lift: 0}, b: {yaw: 0, lift: 0}}\n"
      "goal: {a: {pan: 1, lift: 0}, b: {yaw: 0, lift: 0}}\n");
  const TrajectoryRows read = readTrajectory(
      "t.csv", "b/lift yaw a/pan a/lift slide\n1 2 3 4 0.02\n1 2 3 4 0.02\n", two.model);
  EXPECT_EQ(read.rows[0].positions, numbers({3, 4, 2, 1}));
  EXPECT_EQ(complaint("lift yaw pan a/lift\n1 2 3 4\n1 2 3 4\n", two),
            "t.csv:1: more than one robot has the joint \"lift\"; write a/lift or b/lift");
  EXPECT_EQ(complaint("b/lift yaw pan a/lift a/pan\n1 2 3 4 5\n1 2 3 4 5\n", two),
            "t.csv:1: \"a/pan\" is there twice");
}

TEST_F(TrajectoryFile, FormatsAreRecognisedByTheirContent) {
  using enum TrajectoryFormat;
  EXPECT_EQ(trajectoryFormatOf("# A path\nformat: corridor-solution-1\n"), solution);
  EXPECT_EQ(trajectoryFormatOf("{format: corridor-solution-1, path: []}"), solution);
  EXPECT_EQ(trajectoryFormatOf("space: SE3\npath:\n- [1]\n"), solution);
  EXPECT_EQ(trajectoryFormatOf("---\njoint_names: [a]\n"), message);
  EXPECT_EQ(trajectoryFormatOf("- joint_trajectory:\n"), message);
  EXPECT_EQ(trajectoryFormatOf("\n{\"points\": []}"), message);
  EXPECT_EQ(trajectoryFormatOf("-0.5 1\n"), rows);
  EXPECT_EQ(trajectoryFormatOf("time,pan\n0,1\n"), rows);
  EXPECT_EQ(trajectoryFormatOf(""), rows);
}

TEST_F(TrajectoryFile, EveryFaultOfRowsIsOneLineWithItsPlace) {
  EXPECT_EQ(complaint(""), "t.csv: has no row of numbers");
  EXPECT_EQ(complaint("# nothing\n"), "t.csv: has no row of numbers");
  EXPECT_EQ(complaint("time pan lift\n"), "t.csv: has no row of numbers");
  EXPECT_EQ(complaint("0 0\n"),
            "t.csv:1: the trajectory has one row; it needs two or more (corridor check --states "
            "tests single states)");
  EXPECT_EQ(complaint("pan lifd\n0 0\n1 1\n"),
            "t.csv:1: the robot has no joint \"lifd\" (did you mean \"lift\"?) (known: pan, lift, "
            "wrist, slide, follow, wag)");
  for (const auto& [name, unit] :
       std::vector<std::pair<std::string, std::string>>{{"lift_deg", "deg"},
                                                        {"lift(deg)", "deg"},
                                                        {"lift[degrees]", "degrees"},
                                                        {"lift.mm", "mm"},
                                                        {"lift [deg]", "deg"}})
    EXPECT_THAT(
        complaint("pan," + name + "\n0,0\n1,1\n"),
        testing::AllOf(StartsWith("t.csv:1: the column \""),
                       HasSubstr("\" says \"" + unit +
                                 "\", but the numbers are read in rad, m and s; convert it, "
                                 "and name it by its joint only")));
  EXPECT_EQ(complaint("time pan\n0 0\n1 1\n"),
            "t.csv:1: there is no column for lift; all joints that are planned for need one");
  EXPECT_EQ(complaint("pan lift pan\n0 0 1\n1 1 1\n"), "t.csv:1: \"pan\" is there twice");
  EXPECT_EQ(complaint("t pan lift time\n0 0 0 0\n1 1 1 1\n"),
            "t.csv:1: the header has two columns of times: t and time");
  EXPECT_EQ(complaint("time pan lift pan_velocity\n0 0 0 0\n1 1 1 1\n"),
            "t.csv:1: there is no velocity of lift; give it for all joints that are planned for, "
            "or for none");
  EXPECT_EQ(complaint("pan lift pan_velocity lift_velocity\n0 0 0 0\n1 1 1 1\n"),
            "t.csv:1: there are velocities, but no times; add a column time, or leave the "
            "velocities out");
  EXPECT_EQ(complaint("time pan lift pan_acc lift_acc\n0 0 0 0 0\n1 1 1 1 1\n"),
            "t.csv:1: there are accelerations, but no velocities; add the velocities, or leave "
            "the accelerations out");
  EXPECT_EQ(complaint("0 0\n1 nan\n2 2\n"),
            "t.csv:2: \"lift\": a finite number is needed, not \"nan\"");
  EXPECT_EQ(complaint("time pan lift\nO.5 0 0\n1 1 1\n2 2 2\n"),
            "t.csv:2: time: a number is needed, not \"O.5\"");
  EXPECT_EQ(complaint("0 0\n1 1 1\n2 2\n"),
            "t.csv:2: a row has 2 numbers (pan, lift), not 3; if there are times or velocities, "
            "the first line must name the columns");
  EXPECT_EQ(complaint("time pan lift\n0 0 0\n1 1\n2 2 2\n"),
            "t.csv:3: the row has 2 numbers, but the header names 3 columns");
  EXPECT_EQ(complaint("time pan lift\n0 0 0\n1 1 1\n1 2 2\n"),
            "t.csv:4: the time 1 s is not after that of the row before, 1 s; times must ascend");
  EXPECT_EQ(complaint("time pan lift\n1 0 0\n0.5 1 1\n"),
            "t.csv:3: the time 0.5 s is not after that of the row before, 1 s; times must ascend");
  EXPECT_EQ(complaint("pan lift slide\n0 0 0.02\n1 1 0.04\n2 2 0.04\n"),
            "t.csv:3: \"slide\" is held at 0.02 in the problem, but is 0.02 to 0.04 in this file; "
            "plan for the joint (joints: in the robot's file), or leave it out of the file and let "
            "margin cover its motion");
  EXPECT_EQ(complaint("pan lift slide\n0 0 0.04\n1 1 0.04\n"),
            "t.csv:2: \"slide\" is held at 0.02 in the problem, but is 0.04 here: the proof would "
            "be about another robot; in the robot's file, write hold: {slide: 0.04}");
}

/// A fault that all rows have gives one line.
TEST_F(TrajectoryFile, FaultsOfManyRowsAreOneLine) {
  const auto rows = [](const std::string& row, int count) {
    std::string all;
    for (int i = 0; i < count; ++i) all += row + "\n";
    return all;
  };
  const std::string semicolon =
      "\";\" separates the numbers; separate them by commas or blanks, and write decimal points, "
      "not commas";
  EXPECT_EQ(complaint("time;pan;lift\n" + rows("0,5;1;2", 30)), "t.csv:1: " + semicolon);
  EXPECT_EQ(complaint("# made by hand; do not edit\n" + rows("0;1", 30)), "t.csv:2: " + semicolon);
  EXPECT_EQ(complaint(rows("0 1 2", 30)),
            "t.csv:1: a row has 2 numbers (pan, lift), not 3; if there are times or velocities, "
            "the first line must name the columns (29 more rows have faults)");
  EXPECT_EQ(complaint("time pan lift\n" + rows("0 1", 2)),
            "t.csv:2: the row has 2 numbers, but the header names 3 columns (1 more row has "
            "faults)");
  EXPECT_EQ(complaint("pan lift\n" + rows("0 ok", 30)),
            "t.csv:2: \"lift\": a number is needed, not \"ok\" (29 more rows have faults)");
  EXPECT_EQ(complaint("time pan lift\n" + rows("0 0 0", 30)),
            "t.csv:3: the time 0 s is not after that of the row before, 0 s; times must ascend (28 "
            "more rows have faults)");
  const std::string names = "joint_names: [pan, lift]\npoints:\n";
  EXPECT_EQ(complaint(names + rows("- {positions: [0, 0, 0], time_from_start: 1}", 30)),
            "t.csv:3: points[0].positions: a list of 2 numbers is needed, not a list of 3 (29 more "
            "rows have faults)");
  EXPECT_EQ(complaint(names + rows("- {positions: [0, 0], time_from_start: 1}", 3) +
                      rows("- {positions: [0, 0]}", 30)),
            "t.csv:6: points[3].time_from_start: are missing here, but the first point has them; "
            "give them for all points or for none (29 more rows have faults)");
}

TEST_F(TrajectoryFile, EveryFaultOfMessagesIsOneLineWithItsPlace) {
  const std::string names = "joint_names: [pan, lift]\npoints:\n";
  const std::string first = "- {positions: [0, 0], velocities: [0, 0], time_from_start: 0}\n";
  EXPECT_EQ(complaint("a: 1\n"),
            "t.csv: has no trajectory: joint_names and points are needed, in a JointTrajectory or "
            "in a message that has one (joint_trajectory, trajectory, planned_trajectory)");
  EXPECT_EQ(complaint("joint_names: [pan, lift]\n"),
            "t.csv: missing key \"points\": the rows of the trajectory");
  EXPECT_EQ(complaint(names + "  []\n"), "t.csv:2: points: has no point");
  EXPECT_EQ(complaint("joint_names: []\npoints: [{positions: [0]}]\n"),
            "t.csv:1: joint_names: has no name");
  EXPECT_EQ(complaint("joint_names: [pan, arm]\npoints: [{positions: [0, 0]}, {positions: [1, "
                      "1]}]\n"),
            "t.csv:1: the robot has no joint \"arm\" (known: pan, lift, "
            "wrist, slide, follow, wag)");
  EXPECT_EQ(complaint(names + first + "- {positions: [0], time_from_start: 1}\n"),
            "t.csv:4: points[1].positions: a list of 2 numbers is needed, not a list of 1");
  EXPECT_EQ(complaint(names + first + "- {positions: [0, .nan], time_from_start: 1}\n"),
            "t.csv:4: points[1].positions: a finite number is needed, not \".nan\"");
  EXPECT_EQ(complaint(names + first + "- {velocities: [0, 0], time_from_start: 1}\n"),
            "t.csv:4: points[1].positions: are missing");
  EXPECT_EQ(complaint(names + first + "- {positions: [0, 0], time_from_start: 1}\n"),
            "t.csv:4: points[1].velocities: are missing here, but the first point has them; give "
            "them for all points or for none");
  EXPECT_EQ(complaint(names + first + "- {positions: [0, 0], velocities: [0, 0]}\n"),
            "t.csv:4: points[1].time_from_start: are missing here, but the first point has them; "
            "give them for all points or for none");
  EXPECT_EQ(complaint(names + first +
                      "- {positions: [0, 0], velocities: [0, 0], time_from_start: {sec: 1, "
                      "nanosec: 1000000000}}\n"),
            "t.csv:4: points[1].time_from_start.nanosec: a whole number from 0 to 999999999 is "
            "needed, not \"1000000000\"");
  EXPECT_EQ(complaint(names + first +
                      "- {positions: [0, 0], velocities: [0, 0], time_from_start: {secs: 1, "
                      "nanosec: 1}}\n"),
            "t.csv:4: points[1].time_from_start.sec: secs and nsecs are given, too; keep one pair");
  EXPECT_EQ(complaint(names + first + "- {position: [0, 0]}\n").substr(0, 58),
            "t.csv:4: unknown key \"position\" in points[1] (did you mean");
  EXPECT_EQ(complaint(names + first + "- {positions: [0, '...'], time_from_start: 1}\n"),
            "t.csv:4: points[1].positions: the list is cut off (...); record it by ros2 topic echo "
            "--full-length");
  EXPECT_EQ(complaint(names + first + "---\n" + names + first),
            "t.csv:4: has more than one YAML document (---); keep one");
  EXPECT_EQ(complaint("trajectory:\n- {joint_names: [pan], points: [{}]}\n- {joint_names: [pan], "
                      "points: [{}]}\n"),
            "t.csv:3: has 2 trajectories; keep one of them");
  EXPECT_EQ(complaint("multi_dof_joint_trajectory: {points: [{}]}\n"),
            "t.csv:1: multi_dof_joint_trajectory: trajectories of poses are not read from "
            "messages; write rows of numbers (CSV)");
}

TEST_F(TrajectoryFile, RotationsHaveNoVelocities) {
  const Problem cube = read(head + poses);
  EXPECT_EQ(complaint("x y z qx qy qz qw\n0 0 0 0 0 0 1\n1 0 0 0 0 0 2\n", cube), "");
  EXPECT_EQ(complaint("0 0 0 0 0 0 1\n1 0 0 0 0 0 0\n", cube),
            "t.csv:2: a quaternion of zeros is no rotation");
  EXPECT_EQ(complaint("time x y z qx qy qz qw vel_x vel_y vel_z vel_qx\n0 0 0 0 0 0 0 1 0 0 0 0\n"
                      "1 0 0 0 0 0 0 1 0 0 0 0\n",
                      cube),
            "t.csv:1: velocity of \"qx\": a rotation has none here: it goes by slerp from row to "
            "row; leave it out");
}

}  // namespace
}  // namespace corridor
