#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

class Shapes : public ProblemTest {
 protected:
  std::string rock(const std::string& entry) const {
    return complaintOf("format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock: " + entry +
                       "\n" + poses);
  }
};

TEST_F(Shapes, PrimitivesOfWorldAndRobot) {
  write("robot.yaml",
        "format: corridor-robot-1\nname: car\nrigid: SE3\nshapes:\n  - {box: [1, 2, 3], name: "
        "body}\n  - "
        "{sphere: {radius: 0.5}, at: [0, 0, 2]}\nreference: [0, 0, 1]\n");
  const Problem p = read(
      "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n"
      "  ball: {sphere: 0.25, at: [1, 2, 3]}\n"
      "  pill: {capsule: {radius: 0.1, length: 2}, rpy_deg: [0, 90, 0]}\n"
      "  can: {cylinder: {radius: 1, length: 2}, at: [0, 0, 5]}\n"
      "  gem: {convex: [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]}\n"
      "  hull: {convex: wedge.obj, unit: cm}\n"
      "  block: {mesh: wedge.obj, solid: true}\n"
      "  shelf: {at: [1, 0, 0], rpy_deg: [0, 0, 90], shapes: [{box: [1, 1, 1], at: [1, 0, 0]}, "
      "{mesh: "
      "wedge.obj, name: top}]}\nstart: {at: [5, 0, 0]}\ngoal: {at: [0, 5, 0]}\n");
  const auto& car = bodyOf(p, "car").shapes;
  ASSERT_EQ(car.size(), 2u);
  EXPECT_EQ(car[0].name, "car/body");
  EXPECT_TRUE(std::holds_alternative<Box>(*car[0].primitive));
  EXPECT_EQ(car[1].parts.at(0).points.at(0), Vec3(0, 0, 1)) << "the reference point is subtracted";
  EXPECT_EQ(car[1].at.p, Vec3(0, 0, 1));
  const PlacedShape& ball = bodyOf(p, "ball").shapes.at(0);
  EXPECT_EQ(ball.parts.at(0).radius, 0.25);
  EXPECT_EQ(ball.parts.at(0).points.at(0), Vec3(1, 2, 3));
  EXPECT_FALSE(ball.mesh);
  const ConvexPart& pill = bodyOf(p, "pill").shapes.at(0).parts.at(0);
  EXPECT_EQ(pill.points.size(), 2u);
  EXPECT_EQ(pill.points[0].cwiseAbs(), Vec3(1, 0, 0)) << "along x";
  EXPECT_TRUE(bodyOf(p, "can").shapes.at(0).parts.at(0).flatEnds);
  EXPECT_EQ(bodyOf(p, "gem").shapes.at(0).parts.at(0).points.size(), 4u);
  EXPECT_EQ(bodyOf(p, "hull").shapes.at(0).parts.at(0).points.at(1), Vec3(0.01, 0, 0));
  EXPECT_TRUE(bodyOf(p, "block").shapes.at(0).solid);
  const auto& shelf = bodyOf(p, "shelf").shapes;
  EXPECT_EQ(shelf.at(0).at.p, Vec3(1, 1, 0)) << "the group's placement, then its own";
  EXPECT_EQ(shelf.at(1).name, "shelf/top");
  EXPECT_EQ(shelf.at(1).mesh->mesh.vertices.at(1), Vec3(1, 1, 0));
  EXPECT_EQ(pairCount(p.model), 7) << "a body is tested as one, whatever the number of its shapes";
  EXPECT_EQ(lowerOf(p), Vec3(-1.1, -1, -0.5)) << "the world's bounds, round shapes as they are";
  EXPECT_EQ(upperOf(p), Vec3(5, 5, 6)) << "flat ends of the can";
}

TEST_F(Shapes, Faults) {
  EXPECT_EQ(
      rock("{box: [1, 0, 1]}"),
      "problem.yaml:4: world.rock.box: a box's three edge lengths must be positive and finite, "
      "not 1 0 1");
  EXPECT_EQ(rock("{box: 1}"),
            "problem.yaml:4: world.rock.box: a list of 3 numbers is needed, not \"1\"");
  EXPECT_EQ(rock("{sphere: {radius: -1}}"),
            "problem.yaml:4: world.rock.sphere: a sphere's radius must be positive and finite, not "
            "-1");
  EXPECT_EQ(rock("{cylinder: {radius: 1}}"),
            "problem.yaml:4: missing key \"length\" in world.rock.cylinder: metres along z");
  EXPECT_EQ(
      rock("{capsule: {radius: 1, lenght: 2}}"),
      "problem.yaml:4: unknown key \"lenght\" in world.rock.capsule (did you mean \"length\"?) "
      "(known: radius, length)");
  EXPECT_EQ(rock("{convex: []}"),
            "problem.yaml:4: world.rock.convex: a convex shape needs at least one point");
  EXPECT_EQ(
      rock("{convex: {a: 1}}"),
      "problem.yaml:4: world.rock.convex: a mesh file or points [[x, y, z], …] are needed, not "
      "a map");
  EXPECT_EQ(rock("{box: [1, 1, 1], sphere: 1}"),
            "problem.yaml:4: world.rock.sphere: one shape is needed, and box is given already; "
            "leave one out");
  EXPECT_EQ(rock("{box: [1, 1, 1], unit: mm, solid: true}"),
            "problem.yaml:4: world.rock.unit: is for mesh files; lengths of a box are in metres\n"
            "problem.yaml:4: world.rock.solid: is for meshes; a box is always solid");
  EXPECT_EQ(
      rock("{shapes: []}"),
      "problem.yaml:4: world.rock.shapes: a list of at least one shape, such as [{mesh: FILE}], "
      "is needed, not an empty one");
  EXPECT_EQ(
      rock("{mesh: wedge.obj, shapes: [{sphere: 1}]}"),
      "problem.yaml:4: world.rock.mesh: belongs to one shape; put it into the items of shapes");
  EXPECT_EQ(rock("{box: [1, 1, 1], at: [9e99, 0, 0], rpy_deg: [0, 0, 45]}"), "no complaint");
  EXPECT_EQ(
      rock("{box: [1, 1, 1], at: [1e308, 0, 0], rpy_deg: [0, 0, 45]}"),
      "problem.yaml: rock: a coordinate of 1e+308 m is too large; at most 1e+100 m is allowed");
  EXPECT_EQ(rock("{box: [1e308, 1e308, 1], at: [1.7e308, 0, 0]}"),
            "problem.yaml:4: world.rock.at: moves the shape out of the range of doubles");
  write("open.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  EXPECT_EQ(rock("{mesh: open.obj, solid: true}"),
            "problem.yaml:4: world.rock.solid: needs a watertight mesh, and open.obj is not "
            "watertight: 3 of "
            "its edges have a triangle on one side only; repair the mesh, or leave solid out");
}

}  // namespace
}  // namespace corridor::test
