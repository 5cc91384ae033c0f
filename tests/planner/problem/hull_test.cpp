// Tests of meshes with `convex: true`, which are replaced by their convex hulls.
#include <algorithm>
#include <map>

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
                                           "wedge.obj: the model is the solid convex hull of the "
                                           "mesh, with 4 corners; everything inside it counts as "
                                           "occupied; its surface is at most")));
  const auto* corners = std::get_if<Convex>(&*shape.primitive);
  ASSERT_NE(corners, nullptr);
  EXPECT_EQ(corners->points, shape.parts[0].points);
  EXPECT_EQ(shape.at.p, Vec3(0, 0, 0)) << "the corners are placed already";
  EXPECT_NE(bodyOf(read(problem("{mesh: wedge.obj, convex: false}")), "rock").shapes.at(0).mesh,
            nullptr);
}

/// The middle of the face, (4, 4, 4)/3, is 0.5345 m or a little less from the inner faces. The dent
/// is a pyramid with the height h = 1/√3, and the centre of its base is h·r/√(h² + r²) from its
/// other faces, with r = 4/√6.
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
  EXPECT_THAT(complaintOf(problem("{mesh: dent.obj, convex: true, deviation: " + below + "}")),
              testing::EndsWith(" m or more away from the mesh, and " + below +
                                " m is allowed; leave out convex, or set deviation (metres)"));
  EXPECT_THAT(complaintOf(problem("{mesh: dent.obj, convex: true, deviation: 0.005}")),
              testing::HasSubstr(" and 0.005 m is allowed;"));
}

/// A second shape beside `mesh` and `convex` must be refused, not ignored: without it, proofs would
/// be about another world.
TEST_F(Hulls, NoOtherKindIsIgnored) {
  for (const std::string value : {"true", "false"})
    for (const auto& [kind, shape] :
         std::map<std::string, std::string>{{"box", "[1, 1, 1]"},
                                            {"sphere", "3"},
                                            {"polygon", "[[0, 0], [1, 0], [1, 1]]"},
                                            {"points", "{file: scan.xyz, radius: 0.1}"},
                                            {"octomap", "{file: map.bt}"}})
      EXPECT_EQ(complaintOf(problem("{mesh: wedge.obj, convex: " + value + ", " + kind + ": " +
                                    shape + "}")),
                "problem.yaml:4: world.rock." + kind +
                    ": one shape is needed, and mesh is given already; leave one out");
}

/// Because of rounding, the deviation can't be proved small; for a huge mesh it can't be computed
/// at all.
TEST_F(Hulls, ThatRoundingHides) {
  write("shallow.obj",
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nv 1 1 1e-18\n"
        "f 1 3 5\nf 3 2 5\nf 2 1 5\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_EQ(complaintOf(problem("{mesh: shallow.obj, convex: true, deviation: 1e-17}")),
            "problem.yaml:4: world.rock.convex: it can't be proved that the convex hull is within "
            "1e-17 m of the mesh, because of the rounding of the coordinates; set a deviation of "
            "at least 1.17e-10 m");  // 4·2^-35
  write("huge.obj",
        "v 0 0 0\nv 4e200 0 0\nv 0 4e200 0\nv 0 0 4e200\nv 1e200 1e200 1e200\n"
        "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n");
  EXPECT_EQ(complaintOf(problem("{mesh: huge.obj, convex: true}")),
            "problem.yaml:4: world.rock.convex: the mesh is too large to measure how far its "
            "convex hull is from it; leave it out");
}

TEST_F(Hulls, AndTheReferenceOfARobot) {
  write("dent.obj",
        "v 0 0 0\nv 4 0 0\nv 0 4 0\nv 0 0 4\nv 0.5 1 1\n"
        "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 5\nf 3 4 5\nf 4 2 5\n");
  const auto robot = [&](const std::string& shape, const std::string& reference) {
    write("robot.yaml",
          "format: corridor-robot-1\nname: rock\nrigid: SE3\nshapes: [{mesh: dent.obj" + shape +
              "}]\nreference: " + reference + "\n");
    const Problem p = read(
        "format: corridor-problem-1\nrobot: robot.yaml\nworld: {box: {box: [1, 1, "
        "1], at: [30, 0, 0]}}\n" +
        poses);
    return bodyOf(p, "rock").shapes.at(0);
  };
  EXPECT_EQ(robot(", convex: true, deviation: 1", "centroid").parts.at(0).points.at(0),
            Vec3(-1, -1, -1))
      << "only corners of the hull count";
  EXPECT_EQ(robot("", "centroid").mesh->mesh.vertices.at(0), Vec3(-4.5 / 5, -1, -1));
  const PlacedShape far = robot(", convex: true, deviation: 1, at: [0.1, 0, 0]", "[1e9, 0, 0]");
  EXPECT_EQ(far.parts.at(0).points.at(0), Vec3(0.1 - 1e9, 0, 0)) << "rounded once more";
  EXPECT_EQ(far.at.p, Vec3(-1e9, 0, 0));
  EXPECT_EQ(std::get<Convex>(*far.primitive).points.at(0), Vec3(0.1, 0, 0));
}

TEST_F(Hulls, Faults) {
  const auto rock = [&](const std::string& entry) { return complaintOf(problem(entry)); };
  EXPECT_EQ(rock("{mesh: flat.obj, convex: true}"),
            "problem.yaml:4: world.rock.convex: needs a mesh whose vertices are not all in one "
            "plane; leave out convex");
  EXPECT_EQ(
      rock("{mesh: wedge.obj, convex: true, solid: true}"),
      "problem.yaml:4: world.rock.solid: is for meshes without convex: true; a convex hull is "
      "always solid");
  EXPECT_EQ(rock("{mesh: wedge.obj, deviation: 0.1}"),
            "problem.yaml:4: world.rock.deviation: is for meshes with convex: true, whose convex "
            "hull is the model");
  EXPECT_THAT(rock("{mesh: wedge.obj, convex: true, deviation: 0}"),
              testing::HasSubstr("world.rock.deviation: "));
  const std::string at = "problem.yaml:4: world.rock.convex: ";
  EXPECT_EQ(rock("{mesh: wedge.obj, convex: wedge.obj}"),
            at + "beside mesh, true or false is needed, not \"wedge.obj\"");
  EXPECT_EQ(rock("{mesh: wedge.obj, convex: True}"),
            at + "beside mesh, true or false is needed, not \"True\"");
  EXPECT_THAT(rock("{mesh: wedge.obj, convex: 'true'}"),
              testing::StartsWith(at + "beside mesh, true or false is needed, not "));
  EXPECT_EQ(rock("{convex: true}"),
            at + "true is for a mesh, mesh: FILE beside it; without one, a mesh file or points "
                 "[[x, y, z], …] are needed");
}

}  // namespace
}  // namespace corridor::test
