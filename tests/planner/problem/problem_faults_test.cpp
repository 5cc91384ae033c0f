#include "tests/planner/problem/problem_faults.h"

#include <random>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

constexpr const char* topKeys =
    " (known: format, robot, robots, base, world, allow, start, goal, moveit, bounds, margin, "
    "padding, prefer, tube, limits, "
    "planner, sampler, simplify, checker, trajectory, seed)";

TEST_F(ProblemFaults, Files) {
  EXPECT_EQ(complaint(folder_ / "nowhere.yaml"), "nowhere.yaml: no such file");
  EXPECT_EQ(complaint(folder_), folder_.string() + ": no problem.yaml in this folder");
  EXPECT_EQ(complaintOf(""),
            "problem.yaml: is empty; a problem (format: corridor-problem-1) is needed");
  EXPECT_EQ(complaintOf(" \n\n"),
            "problem.yaml: is empty; a problem (format: corridor-problem-1) is needed");
  EXPECT_EQ(complaintOf("# nothing\n"),
            "problem.yaml: a map (key: value) that begins with \"format: corridor-problem-1\" is "
            "needed, not nothing");
  EXPECT_EQ(complaintOf("[1, 2]"),
            "problem.yaml:1: a map (key: value) that begins with \"format: corridor-problem-1\" is "
            "needed, not a list");
  EXPECT_EQ(complaint(folder_ / "robot.yaml"),
            "robot.yaml:1: format: corridor-problem-1 is needed here, not \"corridor-robot-1\"");
}

TEST_F(ProblemFaults, AreOfOneLineWithoutControlCharacters) {
  const std::string text = complaintOf(
      "format: corridor-problem-1\nrobot: robot.yaml\nworld: {rock: {mesh: "
      "\"a\\e[2J\\nb.obj\"}}\n" +
      poses);
  EXPECT_THAT(text, testing::HasSubstr("a?[2J?b.obj: no such file"));
  EXPECT_EQ(text.find('\x1b'), text.npos);
}

TEST_F(ProblemFaults, UnknownAndDuplicateKeys) {
  EXPECT_EQ(
      with("checkr: {edges: certified}\n"),
      std::string("problem.yaml:8: unknown key \"checkr\" (did you mean \"checker\"?)") + topKeys);
  EXPECT_EQ(with("colour: red\n"), std::string("problem.yaml:8: unknown key \"colour\"") + topKeys);
  EXPECT_EQ(with("checker: {edges: discrete, rezolution: 0.1}\n"),
            "problem.yaml:8: unknown key \"rezolution\" in checker (did you mean \"resolution\"?) "
            "(known: edges, resolution, tolerance, volume, fit, overlap, build)");
  EXPECT_EQ(
      with("clearance: 0.1\n"),
      std::string("problem.yaml:8: unknown key \"clearance\" (did you mean prefer: {clearance: "
                  "…}, or margin: …, which every path must keep?)") +
          topKeys);
  EXPECT_THAT(complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld: {a: {box: {size: "
                          "[1, 1, 1]}, pos: [9, 9, 9]}}\n" +
                          poses),
              testing::AllOf(testing::HasSubstr("unknown key \"pos\" in world.a (did you mean "
                                                "\"at\"?)"),
                             testing::HasSubstr("world.a.box: three edge lengths are needed, such "
                                                "as box: [0.4, 0.4, 0.5], not a map")));
  EXPECT_EQ(with("seed: 1\nmargin: 0\nseed: 2\n"),
            "problem.yaml:10: duplicate key \"seed\", first on line 8");
  EXPECT_EQ(with("planner:\n  params:\n    range: 1\n    range: 2\n"),
            "problem.yaml:11: duplicate key \"range\" in planner.params, first on line 10");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  a: {mesh: "
                        "wedge.obj}\n  a: {mesh: wedge.obj}\n" +
                        poses),
            "problem.yaml:5: duplicate key \"a\" in world, first on line 4");
}

TEST_F(ProblemFaults, KeysInTheWrongPlace) {
  const auto expectHint = [&](const char* text, const char* hint) {
    EXPECT_THAT(with(text), testing::HasSubstr(hint)) << text;
  };
  expectHint("time: 3\n", "unknown key \"time\" (did you mean planner: {time: …}?)");
  expectHint("planner.time: 3\n",
             "unknown key \"planner.time\" (did you mean planner: {time: …}?)");
  expectHint("planner.params.range: 3\n",
             "unknown key \"planner.params.range\" (did you mean planner: {params: {range: …}}?)");
  expectHint("planner.range: 3\n",
             "unknown key \"planner.range\" (did you mean planner: {params: {range: …}}?)");
  expectHint("planner.tmie: 3\n", "unknown key \"planner.tmie\" (known: ");
  expectHint("planner: {range: 3}\n",
             "unknown key \"range\" in planner (did you mean planner: {params: {range: …}}?)");
  expectHint("planner: {seed: 3}\n",
             "unknown key \"seed\" in planner (did you mean seed: … at the top level?)");
  expectHint("name: mine\n", "unknown key \"name\" (known: ");
  expectHint(
      "limits: {velocity: 3}\n",
      "unknown key \"velocity\" in limits (did you mean limits: {default: {velocity: …}}, or "
      "limits: {joints: {NAME: {velocity: …}}}?)");
  expectHint("checker: {corner_deviation: 3}\n",
             "(did you mean trajectory: {corner_deviation: …}?)");
  expectHint("planner: name:RRT\n",
             "planner: a map such as {name: …} is needed, not \"name:RRT\"; write a blank after "
             "the colon");
  for (const char* at : {"[0 0 1]", "[0 0, 1, 2]"})
    EXPECT_THAT(complaintOf(head + "start: {at: " + at + "}\ngoal: {at: [0, 0, 1]}\n"),
                testing::HasSubstr("; write commas between the numbers"));
  expectHint("planner: C:\\x\n", "is needed, not \"C:\\x\"");
  EXPECT_THAT(with("planner: C:\\x\n"), testing::Not(testing::HasSubstr("blank")));
  EXPECT_EQ(complaintOf(head + "start: {at: [0, 0, 1]}\ngoal.at: [0, 0, 1]\n").find("missing"),
            std::string::npos);
}

TEST_F(ProblemFaults, AMistypedKeyIsNotAlsoMissing) {
  EXPECT_EQ(
      complaintOf("format: corridor-problem-1\nrobto: robot.yaml\nworld: {a: {mehs: wedge.obj}}\n" +
                  poses),
      std::string("problem.yaml:2: unknown key \"robto\" (did you mean \"robot\"?)") + topKeys +
          "\nproblem.yaml:3: unknown key \"mehs\" in world.a (did you mean \"mesh\"?) (known: "
          "mesh, "
          "box, sphere, capsule, cylinder, convex, polygon, points, octomap, unit, up, solid, "
          "deviation, at, rpy_deg, "
          "rpy, quat_xyzw, "
          "shapes)");
}

TEST_F(ProblemFaults, MissingKeys) {
  EXPECT_EQ(complaintOf("seed: 1\n"),
            "problem.yaml: missing key \"format\"; begin the file with format: corridor-problem-1\n"
            "problem.yaml: missing one of robot and robots: the robot's file, such as robot: "
            "../../robots/piano/robot.yaml\n"
            "problem.yaml: missing key \"world\": the obstacles, such as world: {table: {mesh: "
            "table.obj, unit: m}}");
  EXPECT_EQ(complaintOf(head),
            "problem.yaml: missing key \"start\": the robot's pose, such as start: {at: [0, 0, 1], "
            "rpy_deg: [0, 0, 90]}\n"
            "problem.yaml: missing key \"goal\": the robot's pose, such as goal: {at: [0, 0, 1], "
            "rpy_deg: [0, 0, 90]}");
  EXPECT_EQ(complaintOf(planarHead + "start: {at: [0, 0]}\n"),
            "problem.yaml: missing key \"goal\": the robot's pose, such as goal: {at: [0, 0], "
            "yaw_deg: 90}");
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld: {}\n" + poses),
            "problem.yaml:3: world: at least one obstacle is needed");
  EXPECT_EQ(
      complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld: {a: {unit: m}}\n" + poses),
      "problem.yaml:3: missing one shape in world.a: mesh: FILE, box: [x, y, z], sphere: radius, "
      "capsule or cylinder: {radius: …, length: …}, convex: FILE, polygon: [[x, y], …], points: "
      "{file: …, radius: …}, or octomap: {file: …}");
}

TEST_F(ProblemFaults, WrongTypes) {
  EXPECT_EQ(with("margin: wide\n"), "problem.yaml:8: margin: a number is needed, not \"wide\"");
  EXPECT_EQ(with("margin: '0.1'\n"),
            "problem.yaml:8: margin: the number 0.1 is in quotes; remove them");
  EXPECT_EQ(with("margin: 0.1m\n"), "problem.yaml:8: margin: a number is needed, not \"0.1m\"");
  EXPECT_EQ(with("margin: [1]\n"),
            "problem.yaml:8: margin: a number or a map {self: …, world: …} is needed, not a list");
  EXPECT_EQ(with("margin:\n"), "problem.yaml:8: margin: a number is needed, not nothing");
  EXPECT_EQ(with("planner: RRT\n"),
            "problem.yaml:8: planner: a map such as {name: …} is needed, not \"RRT\"");
  EXPECT_EQ(with("planner: {params: {range: [1]}}\n"),
            "problem.yaml:8: planner.params.range: a word is needed, not a list");
  EXPECT_EQ(with("simplify: yes\n"),
            "problem.yaml:8: simplify: one of true, false, ompl is needed, not \"yes\"");
  EXPECT_EQ(with("seed: -1\n"),
            "problem.yaml:8: seed: a whole number from 0 to 2^64 - 1 is needed, not \"-1\"");
  EXPECT_EQ(with("seed: 1.5\n"),
            "problem.yaml:8: seed: a whole number from 0 to 2^64 - 1 is needed, not \"1.5\"");
  EXPECT_EQ(with("seed: 18446744073709551616\n"),
            "problem.yaml:8: seed: a whole number from 0 to 2^64 - 1 is needed, not "
            "\"18446744073709551616\"");
  EXPECT_EQ(with("checker: {edges: certain}\n"),
            "problem.yaml:8: checker.edges: one of certified, adaptive, advancement, discrete is "
            "needed, not "
            "\"certain\"");
  EXPECT_EQ(with("sampler: gausian\n"),
            "problem.yaml:8: sampler: one of uniform, gaussian, obstacle_based, bridge_test, "
            "max_clearance is needed, not \"gausian\" (did you mean \"gaussian\"?)");
  EXPECT_EQ(with("checker: {edges: advancment}\n"),
            "problem.yaml:8: checker.edges: one of certified, adaptive, advancement, discrete is "
            "needed, not \"advancment\" (did you mean \"advancement\"?)");
  EXPECT_EQ(with("checker: {fit: triangle}\n"),
            "problem.yaml:8: checker.fit: one of triangles, vertices, hull, plain is needed, not "
            "\"triangle\" (did you mean \"triangles\"?)");
  EXPECT_EQ(with("checker: {volume: spheres}\n"),
            "problem.yaml:8: checker.volume: one of obb, obb-binary, aabb, sphere, rss, kdop14, "
            "kdop18, kdop26, shell, ellipsoid, hull is needed, not \"spheres\" (did you mean "
            "\"sphere\"?)");
  EXPECT_EQ(with("checker: {volume: octree}\n"),
            "problem.yaml:8: checker.volume: octree can't prove motions: it has only `corridor "
            "query --volume octree`, for interference of two meshes; choose another volume, such "
            "as aabb");
  EXPECT_EQ(with("checker: {overlap: gkj}\n"),
            "problem.yaml:8: checker.overlap: one of sat, gjk, lp, edge-face, centers, rectangles, "
            "intervals, distances, contact is needed, not \"gkj\" (did you mean \"gjk\"?)");
  EXPECT_EQ(with("checker: {volume: aabb, build: bottomup}\n"),
            "problem.yaml:8: checker.build: one of top-down, median, bottom-up is needed, not "
            "\"bottomup\" (did you mean \"bottom-up\"?)");
  EXPECT_EQ(with("planner: {stop: never}\n"),
            "problem.yaml:8: planner.stop: one of first, time is needed, not \"never\"");
  EXPECT_EQ(complaintOf(head + "start: {at: [1, 2, 3, 4]}\ngoal: {at: [1, x, 3]}\n"),
            "problem.yaml:5: start.at: a list of 3 numbers is needed, not a list of 4\n"
            "problem.yaml:6: goal.at: a number is needed, not \"x\"");
}

/// Each of the values is known, but the values can't be combined.
TEST_F(ProblemFaults, VolumesThatCannotBeCombined) {
  EXPECT_EQ(with("checker:\n  volume: sphere\n  overlap: gjk\n"),
            "problem.yaml:10: checker.overlap: \"gjk\" is for volumes obb-binary, hull; volume "
            "sphere has: "
            "centers");
  EXPECT_EQ(
      with("checker: {overlap: lp}\n"),
      "problem.yaml:8: checker.overlap: \"lp\" is for volume obb-binary; volume obb has: sat");
  EXPECT_EQ(with("checker: {volume: aabb, fit: hull}\n"),
            "problem.yaml:8: checker.fit: \"hull\" is for volumes obb, obb-binary, rss, ellipsoid; "
            "volume aabb "
            "has: plain");
  EXPECT_THAT(with("checker: {build: bottom-up}\n"),
              testing::AllOf(testing::StartsWith("problem.yaml:8: checker.build: \"bottom-up\" is "
                                                 "for volumes obb-binary, aabb, "),
                             testing::EndsWith("; volume obb has: top-down")));
  EXPECT_EQ(with("checker: {edges: adaptive, volume: obb-binary, overlap: gjk}\n"),
            "problem.yaml:8: checker.overlap: \"gjk\" can't be used with edges: adaptive, which "
            "measures distances between volumes; leave overlap out, or use edges: certified");
}

TEST_F(ProblemFaults, Ranges) {
  EXPECT_EQ(with("margin: .nan\n"),
            "problem.yaml:8: margin: a finite number is needed, not \".nan\"");
  EXPECT_EQ(with("margin: nan\n"),
            "problem.yaml:8: margin: a finite number is needed, not \"nan\"");
  EXPECT_EQ(with("margin: .inf\n"),
            "problem.yaml:8: margin: a finite number is needed, not \".inf\"");
  EXPECT_EQ(with("margin: 1e999\n"),
            "problem.yaml:8: margin: a finite number is needed, not \"1e999\"");
  EXPECT_EQ(with("margin: 1e-999\n"), "no complaint");
  EXPECT_EQ(with("margin: -0.1\n"), "problem.yaml:8: margin: must be 0 or more, not -0.1");
  EXPECT_EQ(with("tube: {position: -1, rotation: -2}\n"),
            "problem.yaml:8: tube.position: must be 0 or more, not -1\n"
            "problem.yaml:8: tube.rotation: must be 0 or more, not -2");
  EXPECT_EQ(with("tube: {rotation: 1, rotation_deg: 2}\n"),
            "problem.yaml:8: tube.rotation_deg: say rotation (radians) or rotation_deg (degrees), "
            "not both");
  EXPECT_EQ(with("planner: {time: 0}\n"), "problem.yaml:8: planner.time: must be above 0, not 0");
  EXPECT_EQ(with("checker: {tolerance: 0}\n"),
            "problem.yaml:8: checker.tolerance: must be above 0, not 0");
  EXPECT_EQ(with("checker: {resolution: 1}\n"),
            "problem.yaml:8: checker.resolution: must be from 1e-9 to below 1, not 1");
  EXPECT_EQ(with("checker: {resolution: 1e-10}\n"),
            "problem.yaml:8: checker.resolution: must be from 1e-9 to below 1, not 1e-10");
  EXPECT_EQ(
      complaintOf(head + "start: {at: [5, .nan, 0]}\ngoal: {at: [0, 5, 0], within: {at: -1}}\n"),
      "problem.yaml:5: start.at: a finite number is needed, not \".nan\"\n"
      "problem.yaml:6: goal.within.at: must be 0 or more, not -1");
}

TEST_F(ProblemFaults, Rotations) {
  const auto start = [&](const std::string& rotation) {
    return complaintOf(head + "start: {at: [5, 0, 0], " + rotation + "}\ngoal: {at: [0, 5, 0]}\n");
  };
  EXPECT_EQ(start("quat_xyzw: [0, 0, 0, 0]"),
            "problem.yaml:5: start.quat_xyzw: a quaternion of zeros is no rotation; [0, 0, 0, 1] "
            "is the identity");
  EXPECT_EQ(start("quat_xyzw: [0, 0, 1, 1]"),
            "problem.yaml:5: start.quat_xyzw: [x, y, z, w] of norm 1 is needed, not of norm "
            "1.4142135623730951; a mistyped number?");
  EXPECT_EQ(start("quat_xyzw: [1e200, 0, 0, 0]"),
            "problem.yaml:5: start.quat_xyzw: [x, y, z, w] of norm 1 is needed, not of norm "
            "1e+200; a mistyped number?");
  EXPECT_EQ(start("quat_xyzw: [0, 0, 0.707, 0.707]"), "no complaint");
  for (const std::string key : {"quat_wxyz", "wxyz", "quaternion_wxyz"})
    EXPECT_EQ(start(key + ": [1, 0, 0, 0]"),
              "problem.yaml:5: \"" + key +
                  "\" in start is not supported yet; write quat_xyzw: [x, y, z, w], the scalar "
                  "last");
  EXPECT_EQ(start("rpy_deg: [0, 0]"),
            "problem.yaml:5: start.rpy_deg: a list of 3 numbers is needed, not a list of 2");
  EXPECT_EQ(start("rpy_deg: [0, 0, 0], rpy: [0, 0, 0]"),
            "problem.yaml:5: start.rpy: one rotation is needed, and rpy_deg is given already; "
            "leave one out");
  EXPECT_EQ(start("within: {at: 1}"),
            "problem.yaml:5: unknown key \"within\" in start (known: at, rpy_deg, rpy, quat_xyzw, "
            "yaw_deg, yaw)");
}

TEST_F(ProblemFaults, PosesOfTheWrongKind) {
  const std::string spatial =
      "goal of the wrong kind: the robot moves in SE3 (rigid: SE3), so {at: [x, y, z], rpy_deg: "
      "[roll, pitch, yaw]} is needed";
  for (const char* goal : {"{at: [0, 5]}", "{at: [0, 5], yaw: 1}", "{at: [0, 5, 0], yaw_deg: 1}",
                           "ready", "{pan_deg: 30}", "[0, 5, 0]"})
    EXPECT_EQ(complaintOf(head + "start: {at: [5, 0, 0]}\ngoal: " + goal + "\n"),
              "problem.yaml:6: " + spatial)
        << goal;
  const std::string planar =
      "goal of the wrong kind: the robot moves in SE2 (rigid: SE2), so {at: [x, y], yaw_deg: yaw} "
      "is needed";
  for (const char* goal : {"{at: [0, 5, 0]}", "{at: [0, 5], rpy_deg: [0, 0, 90]}", "ready",
                           "{quat_xyzw: [0, 0, 0, 1]}"})
    EXPECT_EQ(complaintOf(planarHead + "start: {at: [5, 0]}\ngoal: " + goal + "\n"),
              "problem.yaml:6: " + planar)
        << goal;
  EXPECT_EQ(
      complaintOf(planarHead + "start: {at: [5, 0], yaw: 1, yaw_deg: 2}\ngoal: {at: [0, 5]}\n"),
      "problem.yaml:5: start.yaw_deg: say yaw (radians) or yaw_deg (degrees), not both");
}

TEST_F(ProblemFaults, Bounds) {
  const std::string start = head + "start: {at: [5, 0, 0]}\ngoal: {at: [0, 5, -20]}\n";
  EXPECT_EQ(complaintOf(start + "bounds: {at: [[0, 0, 0], [1, 5, 1]]}\n"),
            "problem.yaml:5: start: outside of the bounds: x = 5 is not in [0, 1]\n"
            "problem.yaml:6: goal: outside of the bounds: z = -20 is not in [0, 1]");
  EXPECT_EQ(
      complaintOf(start + "bounds: {at: [[0, 3, 0], [9, 2, 1]]}\n"),
      "problem.yaml:7: bounds.at: lower corner first, then the upper one: in y, 3 is not below 2");
  EXPECT_EQ(complaintOf(start + "bounds: {at: [[-1e308, 0, 0], [1e308, 2, 1]]}\n"),
            "problem.yaml:7: bounds.at: in x, the range from -1e+308 to 1e+308 is larger than any "
            "double");
  EXPECT_EQ(complaintOf(start + "bounds: {at: [[0, 0], [9, 9]]}\n"),
            "problem.yaml:7: bounds.at: a list of 3 numbers is needed, not a list of 2");
  EXPECT_EQ(complaintOf(start + "bounds: {at: [0, 0, 0]}\n"),
            "problem.yaml:7: bounds.at: the lower and the upper corner are needed, at: [[x, y, z], "
            "[x, y, z]], not a list");
  EXPECT_EQ(complaintOf(start + "bounds: [[0, 0, 0], [1, 1, 1]]\n"),
            "problem.yaml:7: bounds: a map such as {at: …} is needed, not a list");
  EXPECT_EQ(complaintOf(
                planarHead +
                "start: {at: [5, 0]}\ngoal: {at: [0, 5]}\nbounds: {at: [[0, 0, 0], [9, 9, 9]]}\n"),
            "problem.yaml:7: bounds.at: a list of 2 numbers is needed, not a list of 3");
  write("wedge.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(complaintOf(head + "start: {at: [5, 0, 0]}\ngoal: {at: [0, 5, 0]}\n"),
            "problem.yaml: missing key \"bounds\": world, start and goal lie in a plane (z = 0), "
            "so bounds: {at: [[x, y, z], [x, y, z]]} is needed");
}

TEST_F(ProblemFaults, UnsupportedKeysAreReported) {
  EXPECT_EQ(with("checker: {peer: fcl}\n"),
            "problem.yaml:8: \"peer\" in checker is not supported yet; Corridor's own checker is "
            "used; leave it out");
}

TEST_F(ProblemFaults, KeysThatAreNotForRigidRobots) {
  EXPECT_EQ(with("base: {at: [0, 0, 0]}\ntube: {joints: 0.1}\n"),
            "problem.yaml:8: base: a rigid robot has no base: start and goal give its pose; leave "
            "base out\n"
            "problem.yaml:9: tube.joints: there are no revolute or prismatic joints here; use "
            "position (m) and rotation or rotation_deg");
  EXPECT_EQ(complaintOf(head + "start: {at: [5, 0, 0]}\ngoal: {at: [0, 5, 0], within: {joints: "
                               "1}}\n"),
            "problem.yaml:6: goal.within.joints: there are no revolute or prismatic joints here; "
            "use at and angle");
  EXPECT_EQ(complaintOfRobot(std::string(robot3) + "srdf: a.srdf\nweights: {joints: {pan: 1}}\n"),
            "robot.yaml:5: srdf: is for robots with joints (urdf: FILE); this one is rigid\n"
            "robot.yaml:6: weights.joints: this robot is rigid and has no joints");
}

TEST_F(ProblemFaults, Meshes) {
  const auto rock = [&](const std::string& entry) {
    return complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock: " + entry +
                       "\n" + poses);
  };
  EXPECT_EQ(rock("{mesh: no.obj}"), "problem.yaml:4: world.rock.mesh: no.obj: no such file");
  EXPECT_EQ(rock("{mesh: .}"), "problem.yaml:4: world.rock.mesh: .: is a folder; a file is needed");
  EXPECT_EQ(rock("{mesh: wedge.obj, unit: inch}"),
            "problem.yaml:4: world.rock.unit: one of m, cm, mm, in is needed, not \"inch\"");
  EXPECT_EQ(rock("{mesh: wedge.obj, unit: 0.001}"),
            "problem.yaml:4: world.rock.unit: one of m, cm, mm, in is needed, not \"0.001\"");
  EXPECT_EQ(rock("{mesh: wedge.obj, up: w}"),
            "problem.yaml:4: world.rock.up: one of x, y, z is needed, not \"w\"");
  EXPECT_EQ(rock("{mesh: wedge.obj, at: [9e99, 0, 0]}"), "no complaint");
  EXPECT_EQ(
      rock("{mesh: wedge.obj, at: [1e308, 0, 0]}"),
      "problem.yaml: rock: a coordinate of 1e+308 m is too large; at most 1e+100 m is allowed");
  write("bad.obj", "v 0 0 nan\nv 1 0 0\nf 1 2 9\n");
  EXPECT_THAT(rock("{mesh: bad.obj}"), testing::StartsWith("bad.obj:1: "))
      << "a mesh's faults name the mesh";
}

TEST_F(ProblemFaults, Robots) {
  EXPECT_EQ(
      complaintOf("format: corridor-problem-1\nrobot: no.yaml\nworld: {a: {mesh: wedge.obj}}\n" +
                  poses),
      "problem.yaml:2: robot: no.yaml: no such file");
  EXPECT_EQ(
      complaintOfRobot("format: corridor-robot-1\n"),
      "robot.yaml: missing one of rigid and urdf: rigid: SE3 (moves and rotates freely), rigid: "
      "SE2 (moves in x and y, rotates about z), or urdf: arm.urdf (has joints)");
  EXPECT_EQ(complaintOfRobot("format: corridor-robot-1\nrigid: SE3\n"),
            "robot.yaml: missing key \"shapes\": the robot's shapes, such as shapes: [{mesh: "
            "piano.obj, unit: m}]");
  EXPECT_EQ(
      complaintOfRobot("format: corridor-robot-1\nrigid: SE4\nshapes: []\n"),
      "robot.yaml:2: rigid: one of SE3, SE2 is needed, not \"SE4\" (did you mean \"SE3\"?)\n"
      "robot.yaml:3: shapes: a list of at least one shape, such as [{mesh: FILE}], is needed, not "
      "an empty one");
  EXPECT_EQ(
      complaintOfRobot(std::string(robot3) + "reference: middle\nweights: {rotation: 0}\n"),
      "robot.yaml:5: reference: a point [x, y, z] or the word centroid is needed, not \"middle\"\n"
      "robot.yaml:6: weights.rotation: must be above 0, not 0");
  EXPECT_EQ(complaintOfRobot("format: corridor-robot-1\nrigid: SE3\nshapes:\n  - {mesh: wedge.obj, "
                             "name: a}\n  - {mesh: wedge.obj, name: a}\n"),
            "robot.yaml:5: shapes[1].name: \"a\" is the name of another shape");
  EXPECT_EQ(complaintOfRobot("rigid: {\n"),
            "robot.yaml:1: is not YAML: a } or a ] is missing, here or above");
}

TEST_F(ProblemFaults, ReportsProblemAndRobotAtOnce) {
  write("robot.yaml",
        "format: corridor-robot-1\nrigid: SE3\nshapes: [{mesh: gone.stl, unti: mm}]\n");
  EXPECT_EQ(
      complaintOf(head + "start: {at: [1, 2]}\ngoal: {at: [0, 0, 0], quat_xyzw: [0, 0, 0, 0]}\n"
                         "margin: -1\nsimplfy: true\nseed: x\n"),
      std::string("problem.yaml:5: start of the wrong kind: the robot moves in SE3 (rigid: "
                  "SE3), so {at: [x, y, z], rpy_deg: [roll, pitch, yaw]} is needed\n"
                  "problem.yaml:6: goal.quat_xyzw: a quaternion of zeros is no rotation; "
                  "[0, 0, 0, 1] is the identity\n"
                  "problem.yaml:7: margin: must be 0 or more, not -1\n"
                  "problem.yaml:8: unknown key \"simplfy\" (did you mean \"simplify\"?)") +
          topKeys +
          "\nproblem.yaml:9: seed: a whole number from 0 to 2^64 - 1 is needed, not \"x\"\n"
          "robot.yaml:3: unknown key \"unti\" in shapes[0] (did you mean \"unit\"?) (known: "
          "mesh, box, sphere, capsule, cylinder, convex, polygon, points, octomap, unit, up, "
          "solid, deviation, at, "
          "rpy_deg, rpy, "
          "quat_xyzw, name)\n"
          "robot.yaml:3: shapes[0].mesh: gone.stl: no such file");
}

/// Files with random damage are read or refused by an InputError; nothing else may happen.
TEST_F(ProblemFaults, DamagedFilesAreReadOrRefused) {
  const std::string whole =
      head + poses +
      "margin: 0.005\ntube: {position: 1e-3, rotation_deg: 1}\nplanner: {name: "
      "RRT, time: 2, stop: time, params: {range: 0.6}}\nchecker:\n  edges: "
      "discrete\n  resolution: 0.02\nseed: 7\n";
  std::mt19937_64 random(testSeed(1));
  int refused = 0;
  const int count = test::casesOf(1'700, 3'000);
  for (int i = 0; i < count; ++i) {
    std::string text = whole;
    for (int changes = 1 + static_cast<int>(random() % 3); changes > 0; --changes) {
      const std::size_t at = random() % text.size();
      switch (random() % 3) {
        case 0:
          text[at] = "{}[]:,-#&*!|>'\"%@ \n\t0aA\xff"[random() % 24];
          break;
        case 1:
          text.erase(at, 1 + random() % 4);
          break;
        default:
          text.insert(at, text.substr(random() % text.size(), 1 + random() % 4));
      }
    }
    const std::string said = complaintOf(text);
    refused += said != "no complaint";
    ASSERT_FALSE(said.empty()) << text;
  }
  EXPECT_GT(refused, count / 3);
}

TEST_F(ProblemFaults, HostileFilesEnd) {
  EXPECT_THAT(complaintOf(std::string(100000, '[')), testing::StartsWith("problem.yaml:1: "));
  EXPECT_THAT(complaintOf(std::string("format: \0x", 10) + "\n"),
              testing::StartsWith("problem.yaml"));
  EXPECT_THAT(complaintOf(std::string(200, '\xff')), testing::StartsWith("problem.yaml"));
}

}  // namespace
}  // namespace corridor::test
