// Meshes with `convex: true`, whose convex hull is the model.
#include <algorithm>

#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

class Hulls : public ProblemTest {
 protected:
  void SetUp() override {
    ProblemTest::SetUp();
    // A tetrahedron of 4 m with a corner pushed in by up to 0.5 m: vertex 5 is in the middle of
    // the face 2 3 4. Vertex 6 belongs to no triangle.
    write("dent.obj",
          "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nv 1 1 1\nv 9 9 9\n"
          "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n");
    write("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  }
  static std::string problem(const std::string& entry) {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock: " + entry + "\n" + poses;
  }
};

TEST_F(Hulls, AreTheModel) {
  const Problem p = read(problem("{mesh: wedge.obj, convex: true, at: [10, 0, 0]}"));
  const PlacedShape& shape = bodyOf(p, "rock").shapes.at(0);
  EXPECT_EQ(shape.mesh, nullptr);
  ASSERT_EQ(shape.parts.size(), 1u);
  EXPECT_EQ(shape.parts[0].points,
            (std::vector<Vec3>{{10, 0, 0}, {11, 0, 0}, {10, 2, 0}, {10, 0, 3}}));
  EXPECT_THAT(textsOf(p.source.notes), testing::Contains(testing::HasSubstr(
                                           "wedge.obj: the model is the convex hull of the "
                                           "mesh, with 4 corners; its surface is at most")));
  EXPECT_NE(bodyOf(read(problem("{mesh: wedge.obj, convex: false}")), "rock").shapes.at(0).mesh,
            nullptr);
}

/// The distance of the face's middle, (4, 4, 4)/3, from the inner faces is 0.5345 m or a little
/// less: the height of the pyramid is 1/√3, and the distance of its base's centre from the sides
/// is h·r/√(h² + r²), r = 4/√6.
TEST_F(Hulls, FarFromTheMeshAreRefused) {
  const double h = 1 / std::sqrt(3.0), r = 4 / std::sqrt(6.0), truth = h * r / std::hypot(h, r);
  const std::string complaint = complaintOf(problem("{mesh: dent.obj, convex: true}"));
  EXPECT_THAT(
      complaint,
      testing::MatchesRegex("problem.yaml:4: world.rock.convex: the convex hull is .* m or more "
                            "away from the mesh, and 0.0004 m is allowed; leave out convex, or set "
                            "deviation .metres."));
  const std::string above = std::to_string(1.02 * truth), below = std::to_string(0.98 * truth);
  const Problem p = read(problem("{mesh: dent.obj, convex: true, deviation: " + above + "}"));
  EXPECT_EQ(bodyOf(p, "rock").shapes.at(0).parts.at(0).points.size(), 4u)
      << "neither the dent nor a vertex without a triangle is a corner of the hull";
  EXPECT_NE(complaintOf(problem("{mesh: dent.obj, convex: true, deviation: " + below + "}")),
            "no complaint");
}

TEST_F(Hulls, Faults) {
  const auto rock = [&](const std::string& entry) { return complaintOf(problem(entry)); };
  EXPECT_EQ(rock("{mesh: flat.obj, convex: true}"),
            "problem.yaml:4: world.rock.convex: needs a mesh whose vertices are not all in one "
            "plane; leave it out");
  EXPECT_EQ(
      rock("{mesh: wedge.obj, convex: true, solid: true}"),
      "problem.yaml:4: world.rock.solid: is for meshes without convex: true; a convex hull is "
      "always solid");
  EXPECT_EQ(rock("{mesh: wedge.obj, deviation: 0.1}"),
            "problem.yaml:4: world.rock.deviation: is for meshes with convex: true, whose convex "
            "hull is the model");
  EXPECT_THAT(rock("{mesh: wedge.obj, convex: true, deviation: 0}"),
              testing::HasSubstr("world.rock.deviation: "));
  EXPECT_THAT(rock("{mesh: wedge.obj, convex: wedge.obj}"), testing::HasSubstr("one shape"));
}

}  // namespace
}  // namespace corridor::test
