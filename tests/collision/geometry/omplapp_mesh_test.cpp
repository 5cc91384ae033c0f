#include <gmock/gmock.h>

#include "collision/geometry/mesh_file.h"
#include "tests/collision/geometry/collada_fixture.h"
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

/// assimp reads fewer faces of these files, which are those of Corridor's readers.
TEST_F(OmplAppMeshContent, TrianglesThatAssimpDrops) {
  const auto triangles = [&](const std::string& name, const std::string& bytes) {
    return readOmplAppMesh(write(name, bytes)).mesh.triangles.size();
  };
  const std::string points = "0 0 0\n1 0 0\n0 2 0\n0 0 3\n";
  const std::string faces = "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  EXPECT_EQ(triangles("a.off", "OFF\n4 4 0\n" + points + "# x\n" + faces), 4u);
  const std::string oneLine = "3 0 2 1 3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  EXPECT_EQ(
      triangles("a.ply",
                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
                "property float z\nelement face 4\nproperty list uchar int vertex_indices\n"
                "end_header\n" +
                    points + oneLine),
      4u);
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  for (const std::string line : {"", "cstype bezier", "# C:\\", "#\\\r", "g a \\\r\nfo\r",
                                 "vn 0 0 \\\n1", "deg 1", " # f 9"})
    EXPECT_EQ(triangles("a.obj", triangle + line + "\nf 3 2 1\n"), 2u) << line;
  EXPECT_EQ(triangles("a.obj", triangle + " f 3 2 1\n"), 2u);
  EXPECT_EQ(triangles("a.obj", "\xEF\xBB\xBF# c\n" + triangle), 1u);
}

TEST_F(OmplAppMeshContent, FaultsOfCorridorsReaders) {
  using testing::StartsWith;
  EXPECT_THAT(refusal("a.off", "OFF\n3 2 0\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n"), StartsWith("a.off:"));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 0 0.3d1\nf 1 2 3\n"),
              StartsWith("a.obj:3: "));
  EXPECT_EQ(
      refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\nfo 1 2 3\n"),
      "a.obj:5: the keyword \"fo\" is not supported, and may be or move geometry; write faces "
      "with v and f");
  std::string stl = asciiStlTetrahedron();
  EXPECT_EQ(refusal("a.stl", stl), "no complaint");
  stl.replace(stl.find("0 0 1\n endloop"), 5, "0 0 0.1d1");
  EXPECT_THAT(refusal("a.stl", stl), StartsWith("a.stl:"));
}

/// OMPL.app would plan with another mesh than the file has.
TEST_F(OmplAppMeshContent, GeometryThatAssimpMisplaces) {
  const std::string other =
      "a.dae: assimp, which OMPL.app uses, reads other geometry than the file has; save it again "
      "as triangles";
  ColladaParts parts;
  EXPECT_EQ(refusal("a.dae", colladaOf(parts)), "no complaint");
  parts.inScene = R"(<node id="B" name="A"><translate>100 0 0</translate></node><node id="A">)"
                  R"(<translate>0 5 0</translate><instance_geometry url="#g"/></node>)"
                  R"(<node><translate>0 0 7</translate><instance_node url="#A"/></node>)";
  EXPECT_EQ(refusal("a.dae", colladaOf(parts)), other);
  parts = {};
  parts.node = "<rotate>0 0 10 90</rotate>";
  EXPECT_EQ(refusal("a.dae", colladaOf(parts)), other);
}

/// assimp lays the meshes of 3DS files on their side: OMPL.app's rules read them so, ROS's do not.
TEST_F(OmplAppMeshContent, ThreeDs) {
  const auto half = [](std::size_t n) { return bytesOf(static_cast<std::uint16_t>(n)); };
  const auto chunk = [&](std::size_t id, const std::string& content) {
    return half(id) + bytesOf(static_cast<std::uint32_t>(content.size() + 6)) + content;
  };
  std::string points = half(3);
  for (const float x : {0.f, 0.f, 5.f, 1.f, 0.f, 5.f, 0.f, 2.f, 5.f}) points += bytesOf(x);
  const std::string faces = half(1) + half(0) + half(1) + half(2) + half(7);
  const std::string mesh = chunk(0x4110, points) + chunk(0x4120, faces);
  const std::string bytes =
      chunk(0x4D4D, chunk(0x3D3D, chunk(0x4000, std::string("a\0", 2) + chunk(0x4100, mesh))));
  EXPECT_EQ(complaint("a.3ds", bytes),
            "a.3ds: the extension \".3ds\" is not supported; save the mesh as OBJ, STL, PLY, OFF, "
            "Collada, glTF or 3MF");
  const OmplAppMesh read = readOmplAppMesh(folder_ / "a.3ds");
  EXPECT_THAT(read.mesh.vertices,
              testing::UnorderedElementsAre(Vec3(0, 5, 0), Vec3(1, 5, 0), Vec3(0, 5, -2)));
  // Each importer reads files of its extensions only, whatever their content.
  write("a.dae", bytes);
  EXPECT_THROW(readOmplAppMesh(folder_ / "a.dae"), InputError);
}

}  // namespace
}  // namespace corridor::test
