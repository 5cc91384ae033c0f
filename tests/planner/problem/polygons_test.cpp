// Polygons in robots and worlds of the plane: how they are read, and their faults.
#include "planner/checker/checker.h"
#include "tests/planner/problem/problem_fixture.h"
#include "tests/support/planar.h"

namespace corridor::test {
namespace {

class PolygonsInFiles : public ProblemTest {
 protected:
  void SetUp() override {
    ProblemTest::SetUp();
    write("t.yaml", robot("{polygon: [[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]}"));
  }
  static std::string robot(const std::string& shape, const std::string& more = "") {
    return "format: corridor-robot-1\nrigid: SE2\nshapes: [" + shape + "]\n" + more;
  }
  static std::string problem(const std::string& entry, const std::string& robotFile = "t.yaml") {
    return "format: corridor-problem-1\nrobot: " + robotFile + "\nworld:\n  rock: " + entry + "\n" +
           planarPoses;
  }
  std::string rock(const std::string& entry) const { return complaintOf(problem(entry)); }
};

TEST_F(PolygonsInFiles, AreCutIntoConvexParts) {
  const Problem p =
      read(problem("{polygon: [[0, 0], [0, 4], [1, 4], [1, 1], [4, 1], [4, 0]], "
                   "at: [10, 0, 0], rpy_deg: [0, 0, 90]}"));
  const PlacedShape& shape = bodyOf(p, "rock").shapes.at(0);
  EXPECT_EQ(shape.polygon.at(1), Vec2(6, 0)) << "turned by 90 degrees, then moved";
  ASSERT_EQ(shape.parts.size(), 2u);
  std::vector<Vec2> all;
  for (const ConvexPart& part : shape.parts) {
    EXPECT_EQ(part.radius, 0);
    for (const Vec3& point : part.points) {
      EXPECT_EQ(point.z(), 0);
      EXPECT_EQ(std::count(shape.polygon.begin(), shape.polygon.end(), point.head<2>()), 1);
    }
  }
  EXPECT_EQ(bodyOf(p, "t").shapes.at(0).parts.size(), 2u);
  EXPECT_THAT(p.source.notes, testing::IsEmpty());
}

TEST_F(PolygonsInFiles, SeveralOfOneBody) {
  const Problem p =
      read(problem("{shapes: [{polygon: [[0, 0], [1, 0], [0, 1]]}, {polygon: [[1, 0], [1, 1], [0, "
                   "1]], name: top}], at: [3, 0, 0]}"));
  const ModelBody& body = bodyOf(p, "rock");
  ASSERT_EQ(body.shapes.size(), 2u);
  EXPECT_EQ(body.shapes[0].polygon[0], Vec2(3, 0));
  EXPECT_EQ(body.shapes[1].polygon[0], Vec2(4, 0));
}

/// Verdicts of the checker against rationals: the robot at start and goal.
TEST_F(PolygonsInFiles, VerdictsAreThoseOfThePolygons) {
  const Problem p =
      read(problem("{polygon: [[0, 0], [0, 4], [1, 4], [1, 1], [4, 1], [4, 0]], at: [1, 1, 0]}"));
  const Checker checker(p);
  const auto valid = [&](double x, double y, double yaw) {
    return checker.certifyState(numbers({x, y, yaw})).verdict == MotionVerdict::free;
  };
  EXPECT_FALSE(valid(2, 2, 0)) << "the robot's outer corner touches the inner corner";
  EXPECT_TRUE(valid(2.001, 2.001, 0));
  EXPECT_FALSE(valid(0, 0, 0)) << "its inner corner touches the outer corner of the rock";
  EXPECT_TRUE(valid(-0.001, -0.001, 0));
}

TEST_F(PolygonsInFiles, Faults) {
  const std::string at = "problem.yaml:4: world.rock.polygon: ";
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0]]}"), at + "at least 3 points [x, y] are needed, not 2");
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1], [0, 0]]}"),
            at + "the last point is the first one again; leave it out, since the last point is "
                 "joined to the first");
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1], [1, 0], [0, 1]]}"),
            at + "points 1 and 3 (counted from 0) are equal; each point may be given once");
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [2, 0]]}"),
            at + "all points are on one line; the polygon needs an area");
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 1], [1, 0], [0, 1]]}"),
            at + "edge 0 (from point 0 to point 1) meets edge 2 (from point 2 to point 3), counted "
                 "from 0; edges may share only the point where one follows the other");
  EXPECT_EQ(rock("\n    polygon:\n    - [0, 0]\n    - [1, 1]\n    - [1, 0]\n    - [0, 1]"),
            "problem.yaml:8: world.rock.polygon: edge 0 (from point 0 to point 1) meets edge 2 "
            "(from point 2 to point 3), counted from 0; edges may share only the point where one "
            "follows the other")
      << "the line of the second edge";
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, .nan], [1, 1]]}"),
            at + "a finite number is needed, not \".nan\"");
  EXPECT_EQ(rock("{polygon: [[0, 0, 0], [1, 0, 0], [1, 1, 0]]}"),
            at + "a list of 2 numbers is needed, not a list of 3");
  EXPECT_EQ(rock("{polygon: walls.txt}"),
            at + "a list of points [[x, y], …] is needed, not \"walls.txt\"");
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1]], solid: true}"),
            "problem.yaml:4: world.rock.solid: is for meshes; a polygon is always solid");
  EXPECT_EQ(
      rock("{polygon: [[0, 0], [1, 0], [1, 1]], unit: mm}"),
      "problem.yaml:4: world.rock.unit: is for mesh files; lengths of a polygon are in metres");
  const std::string leaves =
      at +
      "lies in the plane z = 0, but at or the rotation moves it out of this plane or turns it "
      "over; "
      "write at: [x, y, 0], and rotate about z only, such as rpy_deg: [0, 0, 90]";
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1]], at: [0, 0, 0.1]}"), leaves);
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1]], rpy_deg: [90, 0, 0]}"), leaves);
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1]], rpy_deg: [180, 0, 0]}"), leaves);
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1]], quat_xyzw: [1, 0, 0, 0]}"), leaves);
}

TEST_F(PolygonsInFiles, FaultsOfRoundingNameTheCause) {
  const std::string at = "problem.yaml:4: world.rock.polygon: ",
                    coarse = at +
                             "at coordinates of up to 1e+08 m, doubles are too coarse for "
                             "this polygon: ",
                    advice = "; move it nearer to the origin";
  EXPECT_EQ(rock("{polygon: [[0, 0], [1e-9, 1e-9], [0, 2e-9]], at: [1e8, 0, 0]}"),
            coarse + "all points come to be on one line" + advice);
  EXPECT_EQ(rock("{polygon: [[0, 0], [1, 0], [1, 1], [0, 1e-9]], at: [1e8, 1e8, 0]}"),
            coarse + "points 0 and 3 (counted from 0) become equal" + advice);
  EXPECT_THAT(rock("{polygon: [[0, 0], [2, 0], [2, 2], [1, 1e-9], [0, 2]], at: [0, 1e8, 0]}"),
              testing::AllOf(testing::StartsWith(
                                 coarse + "edge 0 (from point 0 to point 1) comes to meet edge "),
                             testing::EndsWith(", counted from 0" + advice)));
  EXPECT_EQ(rock("{polygon: [[0, 0], [1.7e308, 0], [0, 1]], at: [1.7e308, 0, 0]}"),
            at + "point 1 (counted from 0) is moved out of the range of doubles");
}

TEST_F(PolygonsInFiles, ForThePlaneOnly) {
  const std::string why =
      "polygon: is for robots in the plane (rigid: SE2) and their worlds; elsewhere, write box, "
      "convex or mesh";
  EXPECT_EQ(complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock: {polygon: "
                        "[[0, 0], [1, 0], [1, 1]]}\n" +
                        poses),
            "problem.yaml:4: world.rock." + why);
  EXPECT_EQ(complaintOfRobot("format: corridor-robot-1\nrigid: SE3\nshapes: [{polygon: [[0, 0], "
                             "[1, 0], [1, 1]]}]\n"),
            "robot.yaml:3: shapes[0]." + why);
  EXPECT_THAT(complaintOfRobot("format: corridor-robot-1\nrigid: SE4\nshapes: [{polygon: [[0, 0], "
                               "[1, 0], [1, 1]]}]\n"),
              testing::AllOf(testing::StartsWith("robot.yaml:2: rigid: "),
                             testing::Not(testing::HasSubstr("polygon"))));
  // Beside a robot in space, a robot with a polygon would be a sheet.
  const std::string sheet =
      "problem.yaml:2: robots: \"t\" has a polygon, which is for the plane, so all robots must be "
      "rigid: SE2; write box, convex or mesh";
  const auto robots = [&](const std::string& other) {
    return complaintOf(
        "format: corridor-problem-1\nrobots: {t: {file: t.yaml}, other: {file: " + other + "}}\n");
  };
  write("robot.yaml", robot3);
  EXPECT_THAT(robots("robot.yaml"), testing::HasSubstr(sheet));
  EXPECT_THAT(robots("flat.yaml"), testing::Not(testing::HasSubstr("polygon")));
}

TEST_F(PolygonsInFiles, BodiesBesideThePlaneAreNoted) {
  const Problem p = read(problem("{box: [1, 1, 1], at: [5, 5, 3]}"));
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains("\"rock\" does not reach the plane z = 0, so it never meets a "
                                "polygon"));
}

TEST_F(PolygonsInFiles, Reference) {
  const std::string square = "{polygon: [[1, 1], [2, 1], [3, 1], [3, 3], [1, 3]]}";
  const auto first = [&](const std::string& reference) {
    write("t.yaml", robot(square, "reference: " + reference + "\n"));
    return bodyOf(read(problem("{box: [1, 1, 1]}")), "t").shapes.at(0).polygon.at(0);
  };
  EXPECT_EQ(first("[1, 2]"), Vec2(0, -1));
  EXPECT_EQ(first("centroid"), Vec2(1 - 2.0, 1 - 9.0 / 5)) << "the average of all five points";
  write("t.yaml", robot(square, "reference: [0, 0, 1]\n"));
  EXPECT_EQ(complaintOf(problem("{box: [1, 1, 1]}")),
            "t.yaml:4: reference: moves a polygon out of the plane z = 0; write [x, y]");
  write("t.yaml", robot("{polygon: [[0, 0], [1e-9, 0], [0, 1e-9]]}", "reference: [1e9, 0]\n"));
  EXPECT_EQ(complaintOf(problem("{box: [1, 1, 1]}")),
            "t.yaml:4: reference: at coordinates of up to 1e+09 m, doubles are too coarse for this "
            "polygon: points 0 and 1 (counted from 0) become equal; choose a point nearer to the "
            "polygon");
}

}  // namespace
}  // namespace corridor::test
