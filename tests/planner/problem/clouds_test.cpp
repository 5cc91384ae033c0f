// Point clouds and octrees in problem files: how they are read, and their faults.
#include <cstdint>

#include "planner/problem/digest.h"
#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {
namespace {

class Clouds : public ProblemTest {
 protected:
  void SetUp() override {
    ProblemTest::SetUp();
    write("cloud.xyz", "1 0 0\n1 0 1\nnan 0 0\n1 1 1\n");
    write("map.bt", map(0x0002));
  }
  /// Returns an octree file with cells of 0.5 m, which are all in the octant +x +y +z next to the
  /// origin. @param last the flags of the last node.
  static std::string map(std::uint16_t last) {
    int leaves = 0;
    for (int child = 0; child < 8; ++child) leaves += (last >> 2 * child & 3) != 0;
    std::string bytes = "# Octomap OcTree binary file\nid OcTree\nsize " +
                        std::to_string(16 + leaves) + "\nres 0.5\ndata\n";
    const auto add = [&](unsigned bits) {
      bytes += static_cast<char>(bits & 255);
      bytes += static_cast<char>(bits >> 8);
    };
    add(3U << 14);
    for (int i = 0; i < 14; ++i) add(3);
    add(last);
    return bytes;
  }
  std::string problem(const std::string& entry) const {
    return "format: corridor-problem-1\nrobot: robot.yaml\nworld:\n  rock: " + entry + "\n" + poses;
  }
  std::string rock(const std::string& entry) const { return complaintOf(problem(entry)); }
};

TEST_F(Clouds, Points) {
  const Problem p =
      read(problem("{points: {file: cloud.xyz, radius: 0.25}, unit: cm, up: y, at: "
                   "[0, 0, 5], rpy_deg: [0, 0, 90]}"));
  const PlacedShape& shape = bodyOf(p, "rock").shapes.at(0);
  ASSERT_EQ(shape.parts.size(), 3u);
  EXPECT_LT((shape.parts[0].points.at(0) - Vec3(0, 0.01, 5)).norm(), 1e-15);
  EXPECT_LT((shape.parts[2].points.at(0) - Vec3(0.01, 0.01, 5.01)).norm(), 1e-15)
      << "y up: (1, 1, 1) becomes (1, -1, 1), and is turned by 90 degrees";
  EXPECT_EQ(shape.parts[2].radius, 0.25) << "metres, whatever the file's unit";
  EXPECT_EQ(shape.file.filename(), "cloud.xyz");
  EXPECT_THAT(textsOf(p.source.notes),
              testing::Contains(
                  testing::HasSubstr("cloud.xyz: 1 of 4 points are not finite, and are left out")));
  EXPECT_THAT(p.source.files, testing::Contains(folder_ / "cloud.xyz"));
  const std::string digest = digestOf(p);
  write("cloud.xyz", "1 0 0\n");
  EXPECT_NE(digestOf(readProblem(folder_ / "problem.yaml")), digest);
}

TEST_F(Clouds, Octomap) {
  const auto parts = [&](const std::string& entry) {
    return bodyOf(read(problem(entry)), "rock").shapes.at(0).parts;
  };
  const std::vector<ConvexPart> one = parts("{octomap: {file: map.bt}, at: [2, 0, 0]}");
  ASSERT_EQ(one.size(), 1u);
  Vec3 low = one[0].points.at(0), high = low;
  for (const Vec3& corner : one[0].points) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
  EXPECT_EQ(one[0].points.size(), 8u);
  EXPECT_EQ(low, Vec3(2, 0, 0));
  EXPECT_EQ(high, Vec3(2.5, 0.5, 0.5));
  write("map.bt", map(0x4002));  // also the free cell (1, 1, 1)
  EXPECT_EQ(parts("{octomap: {file: map.bt}}").size(), 1u);
  EXPECT_EQ(parts("{octomap: {file: map.bt, unknown: free, threshold: 0.7}}").size(), 1u);
  EXPECT_EQ(parts("{octomap: {file: map.bt, unknown: occupied}}").size(), 7u);
}

TEST_F(Clouds, NotesOnWhatIsNotAnObstacle) {
  const auto notesOf = [&](const std::string& entry) {
    return textsOf(read(problem(entry)).source.notes);
  };
  using testing::Contains;
  using testing::HasSubstr;
  EXPECT_THAT(notesOf("{octomap: {file: map.bt, threshold: 0.9}}"),
              testing::AllOf(Contains(HasSubstr("cells without a measurement count as free")),
                             Contains(HasSubstr("threshold has no effect"))));
  EXPECT_THAT(notesOf("{octomap: {file: map.bt, unknown: free}}"),
              Not(Contains(HasSubstr("map.bt"))));
  write("a.pcd", "FIELDS x y z\nVIEWPOINT 1 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_THAT(notesOf("{points: {file: a.pcd, radius: 0.1}}"),
              Contains(HasSubstr("its viewpoint (the sensor's pose) is not applied")));
  for (const std::string real : {"1", "-1"}) {
    write("a.pcd",
          "FIELDS x y z\nVIEWPOINT 0 0 0 " + real + " 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n");
    EXPECT_THAT(notesOf("{points: {file: a.pcd, radius: 0.1}}"), Not(Contains(HasSubstr("a.pcd"))));
  }
}

TEST_F(Clouds, NotesOnComments) {
  write("b.xyz", "# by hand\n1 2 3\n");
  const auto notesOf = [&](const std::string& unit) {
    return textsOf(read(problem("{points: {file: b.xyz, radius: 0.1}" + unit + "}")).source.notes);
  };
  const std::string note =
      (folder_ / "b.xyz").string() +
      ": line 1 is a comment, which is not read; the first three columns are x, y, z";
  EXPECT_THAT(notesOf(""), testing::Contains(note + " in metres"));
  EXPECT_THAT(notesOf(", unit: mm"), testing::Contains(note));
}

TEST_F(Clouds, NotesOnElementsThatAreNotPoints) {
  write("a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
        "float z\nelement face 1\nproperty list uchar int vertex_indices\nelement grid 0\n"
        "property int i\nend_header\n1 2 3\n3 0 0 0\n");
  EXPECT_THAT(textsOf(read(problem("{points: {file: a.ply, radius: 0.1}}")).source.notes),
              testing::Contains((folder_ / "a.ply").string() +
                                ": the element \"face\" is not read, only its points (the key mesh "
                                "reads faces)"));
}

/// The unit that a comment states is not applied. Text clouds are refused then; in PLY and PCD,
/// whose writers copy comments, it is noted.
TEST_F(Clouds, NotesOnUnits) {
  write("a.pcd", "# unit: cm\nFIELDS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n");
  const auto notesOf = [&](const std::string& unit) {
    return textsOf(read(problem("{points: {file: a.pcd, radius: 0.1}" + unit + "}")).source.notes);
  };
  const std::string note = (folder_ / "a.pcd").string() +
                           ": line 1 says \"unit: cm\", but coordinates are read with a unit of ";
  EXPECT_THAT(notesOf(""), testing::Contains(note + "1 m"));
  EXPECT_THAT(notesOf(", unit: mm"), testing::Contains(note + "0.001 m"));
  EXPECT_THAT(notesOf(", unit: cm"), Not(testing::Contains(testing::HasSubstr("a.pcd"))));
}

TEST_F(Clouds, OfARobot) {
  write("robot.yaml",
        "format: corridor-robot-1\nname: scan\nrigid: SE3\nshapes:\n"
        "  - {points: {file: cloud.xyz, radius: 0.1}}\n  - {octomap: {file: map.bt}, name: tray}\n"
        "reference: [1, 0, 0]\n");
  const Problem p = read(head + poses);
  EXPECT_EQ(bodyOf(p, "scan").shapes.at(0).parts.at(1).points.at(0), Vec3(0, 0, 1));
  EXPECT_EQ(bodyOf(p, "scan").shapes.at(1).name, "scan/tray");
}

/// If a cloud is given as a mesh, the message names the key for clouds.
TEST_F(Clouds, AsAMesh) {
  EXPECT_THAT(rock("{mesh: cloud.xyz}"),
              testing::StartsWith("problem.yaml:4: world.rock.mesh: for a cloud of points, write "
                                  "points: {file: cloud.xyz, radius: 0.01}\ncloud.xyz: "));
  write("cloud.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
        "float z\nend_header\n1 2 3\n");
  EXPECT_EQ(rock("{mesh: cloud.ply}"),
            "problem.yaml:4: world.rock.mesh: for a cloud of points, write points: {file: "
            "cloud.ply, radius: 0.01}\ncloud.ply: the header has no element \"face\"");
  EXPECT_EQ(rock("{points: {file: cloud.ply, radius: 0.01}}"), "no complaint");
  write("map.bt", "# Octomap OcTree binary file\n");
  EXPECT_THAT(rock("{mesh: map.bt}"),
              testing::StartsWith("problem.yaml:4: world.rock.mesh: for a map of OctoMap, write "
                                  "octomap: {file: map.bt}\nmap.bt: "));
}

TEST_F(Clouds, Faults) {
  EXPECT_EQ(rock("{points: cloud.xyz}"),
            "problem.yaml:4: world.rock.points: write points: {file: cloud.ply, radius: 0.01}");
  EXPECT_EQ(rock("{octomap: map.bt}"),
            "problem.yaml:4: world.rock.octomap: write octomap: {file: map.bt}");
  EXPECT_EQ(rock("{points: {file: cloud.xyz}}"),
            "problem.yaml:4: missing key \"radius\" in world.rock.points: metres, such as 0.01: "
            "each point becomes a ball");
  EXPECT_EQ(rock("{points: {radius: 1}}"),
            "problem.yaml:4: missing key \"file\" in world.rock.points: the file of the points: "
            ".ply, .pcd or .xyz");
  EXPECT_EQ(rock("{points: {file: cloud.xyz, radius: 0}}"),
            "problem.yaml:4: world.rock.points.radius: must be above 0, not 0");
  EXPECT_EQ(rock("{points: {file: none.xyz, radius: 1}}"),
            "problem.yaml:4: world.rock.points.file: none.xyz: no such file");
  EXPECT_EQ(rock("{points: {file: wedge.obj, radius: 1}}"),
            "wedge.obj: points are read from .ply, .pcd, .xyz, .txt, .asc, .pts and .csv, not from "
            "\".obj\"");
  EXPECT_EQ(rock("{points: {file: cloud.xyz, radius: 1}, solid: true}"),
            "problem.yaml:4: world.rock.solid: is for meshes; balls and cubes are always solid");
  EXPECT_EQ(
      rock("{octomap: {file: map.bt}, unit: mm}"),
      "problem.yaml:4: world.rock.unit: is for mesh files; an octomap is in metres, with z up");
  EXPECT_EQ(rock("{octomap: {file: map.bt, threshold: 1}}"),
            "problem.yaml:4: world.rock.octomap.threshold: a probability above 0 and below 1 is "
            "needed");
  EXPECT_EQ(rock("{octomap: {file: map.bt, unknown: solid}}"),
            "problem.yaml:4: world.rock.octomap.unknown: one of free, occupied is needed, not "
            "\"solid\"");
  EXPECT_EQ(rock("{octomap: {}}"),
            "problem.yaml:4: missing key \"file\" in world.rock.octomap: the map: .bt or .ot");
  write("map.bt", map(0x0001));
  EXPECT_EQ(rock("{octomap: {file: map.bt}}"),
            "problem.yaml:4: world.rock.octomap.file: map.bt: the map has no occupied cell");
  write("map.bt", "hello");
  EXPECT_EQ(rock("{octomap: {file: map.bt}}"),
            "map.bt:1: a map of OctoMap begins with \"# Octomap OcTree binary file\" or \"# "
            "Octomap OcTree file\"");
  EXPECT_EQ(
      rock("{points: {file: cloud.xyz, radius: 1}, at: [1e308, 0, 0], rpy_deg: [0, 0, 45], "
           "unit: m}"),
      "problem.yaml: rock: a coordinate of 1e+308 m is too large; at most 1e+100 m is allowed");
}

}  // namespace
}  // namespace corridor::test
