#include <gmock/gmock.h>

#include "collision/geometry/mesh_file.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

struct Centre {
  const char* file;
  double centre[3];
  int importedVertices;
};

constexpr Centre centres[] = {
    {"2D/car1_planar_robot.dae", {0.0250001, 0, 3.93701}, 56},
    {"2D/car2_planar_robot.dae", {0.00999999, -0.15, 3.93701}, 80},
    {"3D/Abstract_robot.dae", {-8.01944, 0, -7.835296}, 112},
    {"3D/Easy_robot.dae", {270.4043, 160.6562, -297.8237}, 112},
    {"3D/Home_robot.dae", {-0.04602013, 0.05111809, 9.192626}, 280},
    {"3D/Twistycool_robot.dae", {270.4043, 160.6562, -297.8237}, 112},
    {"3D/alpha_robot.dae", {-21.90987, -11.10698, -14.13554}, 10248},
    {"3D/cubicles_robot.dae", {-4.958012, -40.62011, 70.56501}, 72},
};

TEST(ReadOmplAppMesh, RobotCentres) {
  const auto folder = omplAppFolder();
  if (!folder) GTEST_SKIP() << "set CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  for (const Centre& row : centres) {
    SCOPED_TRACE(row.file);
    const OmplAppMesh read = readOmplAppMesh(*folder / row.file);
    EXPECT_EQ(read.importedVertices, row.importedVertices);
    // The table has seven digits. The last digit is inexact, because assimp sums in float.
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(read.vertexAverage[i], row.centre[i],
                  2e-6 * std::max(1.0, std::abs(row.centre[i])));
  }
}

class OmplAppMeshContent : public MeshFileTest {
 protected:
  std::string refusal(const std::string& name, const std::string& bytes) const {
    return complaintOf([&] { readOmplAppMesh(write(name, bytes)); });
  }
};

/// assimp reads fewer faces than these files have, or other coordinates.
TEST_F(OmplAppMeshContent, WhatAssimpDropsIsRefused) {
  using testing::StartsWith;
  const std::string points = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n";
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const auto off = [&](const std::string& count, const std::string& between) {
    return "OFF\n4 " + count + " 0\n" + points + between + faces;
  };
  EXPECT_EQ(refusal("a.off", off("4", "")), "no complaint");
  EXPECT_EQ(refusal("a.off", off("4", "# x\n")),
            "a.off: assimp, which OMPL.app uses, reads 3 triangles of the file's 4; save it again "
            "as triangles, without comments among them");
  EXPECT_THAT(refusal("a.off", off("3", "")), StartsWith("a.off:"));
  const auto ply = [&](const std::string& elements, const std::string& lists) {
    const std::string list = "property list uchar int vertex_indices\n";
    std::string text =
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\n" +
        elements + list + "end_header\n" + points + lists;
    return text;
  };
  EXPECT_EQ(refusal("a.ply", ply("element face 4\n", faces)), "no complaint");
  EXPECT_THAT(refusal("a.ply", ply("element face 3\n", faces)), StartsWith("a.ply:"));
  // assimp reads one facet from the first line, and another from what is not in the file.
  const std::string oneLine = "3 0 2 1 3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const OmplAppMesh read = readOmplAppMesh(write("b.ply", ply("element face 4\n", oneLine)));
  EXPECT_EQ(read.mesh.triangles, readMeshFile(folder_ / "b.ply").mesh.triangles);
  EXPECT_THAT(refusal("a.ply", ply("element tristrips 1\n", "6 0 1 2 3 0 1\n")),
              StartsWith("a.ply:"));
  EXPECT_THAT(refusal("a.ply", ply("element face 2\nproperty list uchar int vertex_indices\n"
                                   "element face 2\n",
                                   faces)),
              StartsWith("a.ply:"));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 0 0.3d1\nf 1 2 3\n"),
              StartsWith("a.obj:3: "));
  std::string stl = asciiStlTetrahedron();
  EXPECT_EQ(refusal("a.stl", stl), "no complaint");
  stl.replace(stl.find("0 0 1\n endloop"), 5, "0 0 0.1d1");
  EXPECT_THAT(refusal("a.stl", stl), StartsWith("a.stl:"));
}

}  // namespace
}  // namespace corridor::test
