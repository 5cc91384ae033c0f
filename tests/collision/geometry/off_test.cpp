#include <gmock/gmock.h>

#include "collision/geometry/assimp_process.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

using testing::HasSubstr;
using Off = MeshFileTest;
using Triangles = std::vector<std::array<std::uint32_t, 3>>;

TEST_F(Off, TrianglesAndPolygonsInDouble) {
  const MeshFile file =
      read("a.off",
           "# made by hand\nOFF\n# counts\n5 2 0  # no edges\n\n0 0 0\n1 0 0 # x\n"
           "1 1 0.1234567890123456789\n0 1 0\n+5 -5e0 .5\n4  0 1 2 3\n3 0 1 4  255 0 0\n");
  EXPECT_EQ(file.format, "OFF");
  EXPECT_EQ(file.mesh.triangles, Triangles({{0, 1, 2}, {0, 2, 3}, {0, 1, 4}}));
  EXPECT_EQ(file.mesh.vertices.at(2), Vec3(1, 1, 0.1234567890123456789));
  EXPECT_EQ(file.mesh.vertices.at(4), Vec3(5, -5, 0.5));
}

TEST_F(Off, KindsWithMoreNumbersAVertex) {
  const Triangles one = {{0, 1, 2}};
  EXPECT_EQ(read("c.off", "COFF 3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 0 0 0 0 0\n3 0 1 2")
                .mesh.triangles,
            one);
  EXPECT_EQ(
      read("n.OFF", "STCNOFF\r\n3 1 3\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n0 1 0 0 0 1\r\n3 0 1 2\r\n")
          .mesh.triangles,
      one);
}

TEST_F(Off, Faults) {
  const auto fault = [&](const std::string& text, const std::string& message) {
    EXPECT_EQ(complaint("a.off", text), "a.off:" + message);
  };
  const std::string points = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n";
  fault("solid\n", "1: begins with \"solid\"; \"OFF\", \"COFF\", \"NOFF\" or \"STOFF\" is needed");
  fault("4OFF\n", "1: begins with \"4OFF\"; \"OFF\", \"COFF\", \"NOFF\" or \"STOFF\" is needed");
  fault("OFF BINARY\n", "1: is binary, which is not supported; save it as text");
  fault("OFF\n3 x 0\n", "2: the number of faces is \"x\"; a whole number is needed");
  fault("OFF\n-3 1 0\n", "2: the number of vertices is \"-3\"; a whole number is needed");
  fault("OFF\n3\n          ", "3: the number of faces is \"\"; a whole number is needed");
  fault("OFF\n99999 1 0\n", "2: 99999 vertices are more than the file has bytes for");
  fault("OFF\n3 1\n          ",
        "2: the number of edges is missing; add a third number to the line, for example 0");
  // If this file were accepted, a coordinate of the first vertex would be read as the count of
  // edges, and the additional face would hide the error.
  fault("OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 1\n",
        "2: the number of edges is missing; add a third number to the line, for example 0");
  fault("OFF 3 1 0 0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n",
        "1: the numbers of vertices, faces and edges are followed by \"0\"; a new line is needed");
  fault("OFF\n3 1 0\n0 0 0\n1 0 0\n", "5: ends after 2 of 3 vertices");
  fault("OFF\n3 1 0\n0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "3: a vertex has 3 coordinates, found 2");
  fault("OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "3: coordinate \"nan\" is not finite");
  fault("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "7: ends after 1 of 2 faces");
  fault(points + "3 0 1 7\n", "6: face corner 7 is out of range: the file has 3 vertices, from 0");
  fault(points + "3 0 1 -1\n",
        "6: face corner -1 is out of range: the file has 3 vertices, from 0");
  fault(points + "3 0 1\n", "6: a face of 3 corners lists only 2");
  fault(points + "x 0 1 2\n", "6: a face begins with the number of its corners, not \"x\"");
  fault(points + "3 0 1 2\n3 0 1 2\n",
        "7: \"3\" comes after the last of the 1 faces: the counts are wrong");
  EXPECT_EQ(complaint("a.off", "OFF\n2 1 0\n0 0 0\n1 0 0\n2 0 1\n"),
            "a.off: the mesh has no faces; triangles or polygons are needed, lines and points are "
            "not read");
}

TEST_F(Off, WordsAfterTheVertices) {
  const auto with = [](const std::string& rest) {
    return "OFF\n3 1 0\n0 0 0 " + rest + "\n1 0 0\n0 1 0\n3 0 1 2\n";
  };
  for (const std::string rest : {"", "255 0 0", "0.5 1e-3 -1 nan", "# mm", "1 1 1 #mm"})
    EXPECT_EQ(complaint("a.off", with(rest)), "no complaint") << rest;
  for (const std::string rest : {"mm", "255 0 0 mm", "mm # a comment"})
    EXPECT_EQ(
        complaint("a.off", with(rest)),
        "a.off:3: \"mm\" comes after the coordinates of a vertex; only numbers (a colour or a "
        "normal) may follow")
        << rest;
}

/// If an assertion of assimp fails, the file is reported as faulty.
TEST_F(Off, AssimpsAssertionsAreFaults) {
  const auto file = write("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  try {
    readWithAssimp(file.string());
    FAIL() << "no complaint";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(": cannot be read by assimp: assimp's assertion fails: "));
  }
}

}  // namespace
}  // namespace corridor::test
