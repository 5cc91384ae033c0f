#include "collision/geometry/mesh_health.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "collision/geometry/mesh_file.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
  return mesh;
}

TEST(InspectMesh, ClosedMesh) {
  const MeshHealth health = inspectMesh(tetrahedron());
  EXPECT_EQ(health.triangles, 4u);
  EXPECT_EQ(health.distinctTriangles, 4u);
  EXPECT_EQ(health.degenerateTriangles, 0u);
  EXPECT_EQ(health.sliverTriangles, 0u);
  EXPECT_EQ(health.boundaryEdges, 0u);
  EXPECT_EQ(health.nonManifoldEdges, 0u);
  EXPECT_EQ(health.components, 1u);
  EXPECT_TRUE(health.watertight);
  EXPECT_DOUBLE_EQ(health.volume.value_or(0), 1.0 / 6);
  EXPECT_EQ(health.min, Vec3(0, 0, 0));
  EXPECT_EQ(health.max, Vec3(1, 1, 1));
}

TEST(InspectMesh, CornersCountByPositionNotByIndex) {
  TriangleMesh soup;
  const TriangleMesh mesh = tetrahedron();
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) soup.vertices.push_back(mesh.corner(t, i));
    const auto n = static_cast<std::uint32_t>(3 * t);
    soup.triangles.push_back({n, n + 1, n + 2});
  }
  soup.vertices[0] = {-0.0, 0, 0};
  EXPECT_TRUE(inspectMesh(soup).watertight);
}

TEST(InspectMesh, OpenTurnedAndDoubledMeshes) {
  TriangleMesh open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_EQ(inspectMesh(open).boundaryEdges, 3u);
  EXPECT_FALSE(inspectMesh(open).watertight);
  EXPECT_FALSE(inspectMesh(open).volume.has_value());

  TriangleMesh turned = tetrahedron();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(inspectMesh(turned).boundaryEdges, 0u);
  EXPECT_FALSE(inspectMesh(turned).watertight);

  TriangleMesh inwards = tetrahedron();
  for (auto& t : inwards.triangles) std::swap(t[0], t[1]);
  EXPECT_DOUBLE_EQ(inspectMesh(inwards).volume.value_or(0), -1.0 / 6);

  TriangleMesh doubled = tetrahedron();  // as SketchUp exports: both sides of each face
  for (const auto& t : tetrahedron().triangles) doubled.triangles.push_back({t[1], t[0], t[2]});
  const MeshHealth health = inspectMesh(doubled);
  EXPECT_EQ(health.triangles, 8u);
  EXPECT_EQ(health.distinctTriangles, 4u);
  EXPECT_EQ(health.nonManifoldEdges, 0u);
  EXPECT_FALSE(health.watertight);
}

TEST(InspectMesh, DefectsAreCounted) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.push_back({5, 0, 0});     // 4
  mesh.vertices.push_back({6, 0, 0});     // 5
  mesh.vertices.push_back({5, 1e-4, 0});  // 6: a sliver with 4, 5
  mesh.vertices.push_back({7, 0, 0});     // 7: collinear with 4, 5
  mesh.vertices.push_back({-1, -1, 0});   // 8: a third wing on the edge 0-1
  mesh.vertices.push_back({99, 99, 99});  // no triangle uses it: not in the bounds
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 5, 7});
  mesh.triangles.push_back({4, 4, 6});
  mesh.triangles.push_back({0, 1, 8});
  const MeshHealth health = inspectMesh(mesh);
  EXPECT_EQ(health.degenerateTriangles, 2u);
  EXPECT_EQ(health.sliverTriangles, 1u);
  EXPECT_EQ(health.components, 2u);
  EXPECT_EQ(health.nonManifoldEdges, 1u);
  EXPECT_EQ(health.boundaryEdges, 5u);
  EXPECT_EQ(health.min, Vec3(-1, -1, 0));
  EXPECT_EQ(health.max, Vec3(7, 1, 1));
}

TEST(InspectMesh, AnyScale) {
  for (const double scale : {1e-200, 1.0, 1e300}) {
    TriangleMesh mesh = tetrahedron();
    for (Vec3& v : mesh.vertices) v *= scale;
    const MeshHealth health = inspectMesh(mesh);
    EXPECT_EQ(health.degenerateTriangles, 0u) << scale;
    EXPECT_TRUE(health.watertight) << scale;
  }
  EXPECT_EQ(inspectMesh({}).triangles, 0u);
  const TriangleMesh point{{{1, 1, 1}}, {{0, 0, 0}}};
  EXPECT_EQ(inspectMesh(point).degenerateTriangles, 1u);
  EXPECT_FALSE(inspectMesh(point).watertight);
}

TEST(CheckMesh, Complains) {
  EXPECT_EQ(checkMesh(tetrahedron()), std::nullopt);
  TriangleMesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  EXPECT_EQ(checkMesh(mesh), "face 2 (from 0): index 4 is out of range: there are 4 vertices");
  mesh.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(checkMesh(mesh), "vertex 3 (from 0) is not finite");
}

// The tables that come with the shared data.

struct Row {
  const char* file;
  std::size_t triangles, distinct, degenerate, sliver, boundary, nonManifold;
  double min[3], max[3];
};

/// The tables give five digits.
void expectRow(const MeshHealth& health, const Row& row) {
  SCOPED_TRACE(row.file);
  EXPECT_EQ(health.triangles, row.triangles);
  EXPECT_EQ(health.distinctTriangles, row.distinct);
  EXPECT_EQ(health.degenerateTriangles, row.degenerate);
  EXPECT_EQ(health.sliverTriangles, row.sliver);
  EXPECT_EQ(health.boundaryEdges, row.boundary);
  EXPECT_EQ(health.nonManifoldEdges, row.nonManifold);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(health.min[i], row.min[i], 6e-5 * std::abs(row.min[i]));
    EXPECT_NEAR(health.max[i], row.max[i], 6e-5 * std::abs(row.max[i]));
  }
}

constexpr Row robotRows[] = {
    {"example-robot-data/robots/double_pendulum_description/meshes/base_link.stl",
     12072,
     12072,
     0,
     4,
     172,
     0,
     {-0.04, -0.0224, -1.4901e-10},
     {0.019087, 0.0224, 0.057304}},
    {"example-robot-data/robots/double_pendulum_description/meshes/link1.stl",
     758,
     758,
     0,
     0,
     108,
     0,
     {0, -0.025222, -0.03},
     {0.024, 0.025222, 0.1125}},
    {"example-robot-data/robots/double_pendulum_description/meshes/link2.stl",
     424,
     424,
     0,
     6,
     16,
     0,
     {-0.014811, -0.0105, -0.0105},
     {0.0048111, 0.0105, 0.22}},
    {"example-robot-data/robots/kinova_description/meshes/arm.dae",
     8194,
     8194,
     0,
     0,
     0,
     0,
     {-0.04125, -0.45125, -0.043},
     {0.04125, 0.04125, 0}},
    {"example-robot-data/robots/kinova_description/meshes/base.dae",
     16744,
     16744,
     0,
     0,
     0,
     0,
     {-0.04125, -0.04125, 0},
     {0.04125, 0.04125, 0.15675}},
    {"example-robot-data/robots/kinova_description/meshes/finger_distal.dae",
     1544,
     1544,
     0,
     0,
     0,
     0,
     {-0.0094982, -0.014583, -0.01125},
     {0.043662, 0.0054999, 0.01125}},
    {"example-robot-data/robots/kinova_description/meshes/finger_proximal.dae",
     2528,
     2528,
     0,
     0,
     0,
     0,
     {-0.0073445, -0.021266, -0.011471},
     {0.050602, 0.0052226, 0.011471}},
    {"example-robot-data/robots/kinova_description/meshes/forearm.dae",
     6982,
     6982,
     0,
     0,
     0,
     0,
     {-0.04125, -0.04125, -0.043},
     {0.041249, 0.20725, 0.02}},
    {"example-robot-data/robots/kinova_description/meshes/hand_2finger.dae",
     44578,
     44578,
     0,
     43,
     1,
     39,
     {-0.0315, -0.054266, -0.1204},
     {0.0315, 0.054266, 0}},
    {"example-robot-data/robots/kinova_description/meshes/shoulder.dae",
     8172,
     8172,
     0,
     0,
     0,
     0,
     {-0.04125, -0.041314, -0.15987},
     {0.04125, 0.04125, 0}},
    {"example-robot-data/robots/kinova_description/meshes/wrist_spherical_1.dae",
     7712,
     7712,
     0,
     0,
     0,
     0,
     {-0.0315, -0.031578, -0.13512},
     {0.0315, 0.047539, 0}},
    {"example-robot-data/robots/kinova_description/meshes/wrist_spherical_2.dae",
     7712,
     7712,
     0,
     0,
     0,
     0,
     {-0.0315, -0.0315, -0.047414},
     {0.0315, 0.10362, 0.031703}},
    {"panda/meshes/collision/finger.obj",
     32,
     32,
     0,
     0,
     0,
     0,
     {-0.010479, -0.00013264, 0.0001317},
     {0.010495, 0.026403, 0.053849}},
    {"panda/meshes/collision/hand.obj",
     200,
     200,
     0,
     0,
     0,
     0,
     {-0.031636, -0.10399, -0.025925},
     {0.031616, 0.10043, 0.065962}},
    {"panda/meshes/collision/link0.obj",
     200,
     200,
     0,
     0,
     0,
     0,
     {-0.15408, -0.094614, -3.2493e-05},
     {0.071567, 0.09467, 0.14}},
    {"panda/meshes/collision/link1.obj",
     300,
     300,
     0,
     0,
     0,
     0,
     {-0.054987, -0.12937, -0.192},
     {0.055161, 0.055192, 0.054973}},
    {"panda/meshes/collision/link2.obj",
     300,
     300,
     0,
     0,
     0,
     0,
     {-0.055153, -0.19401, -0.055097},
     {0.054985, 0.05522, 0.12949}},
    {"panda/meshes/collision/link3.obj",
     300,
     300,
     0,
     0,
     0,
     0,
     {-0.054646, -0.054917, -0.12102},
     {0.13756, 0.1112, 0.055156}},
    {"panda/meshes/collision/link4.obj",
     300,
     300,
     0,
     0,
     0,
     0,
     {-0.13761, -0.05515, -0.055207},
     {0.05514, 0.12401, 0.11105}},
    {"panda/meshes/collision/link5.obj",
     300,
     300,
     0,
     0,
     0,
     0,
     {-0.055017, -0.055128, -0.26455},
     {0.055083, 0.1299, 0.052168}},
    {"panda/meshes/collision/link6.obj",
     1308,
     1308,
     0,
     0,
     586,
     0,
     {-0.047922, -0.051209, -0.044242},
     {0.13231, 0.081648, 0.056396}},
    {"panda/meshes/collision/link7.obj",
     200,
     200,
     0,
     0,
     0,
     0,
     {-0.044035, -0.04403, 0.051991},
     {0.081306, 0.081187, 0.10684}},
    {"ur5/meshes/robotiq/inner_finger_fine.STL",
     2428,
     2428,
     0,
     3,
     24,
     0,
     {-0.0078019, -0.011, -0.012515},
     {0.023901, 0.011, 0.044}},
    {"ur5/meshes/robotiq/inner_knuckle_fine.STL",
     2048,
     2048,
     0,
     4,
     0,
     0,
     {-0.005993, -0.0195, -0.005993},
     {0.040578, 0.0195, 0.05149}},
    {"ur5/meshes/robotiq/outer_finger_fine.STL",
     1916,
     1916,
     0,
     0,
     0,
     0,
     {-0.0059889, -0.0135, -0.0059986},
     {0.0088834, 0.0135, 0.053421}},
    {"ur5/meshes/robotiq/outer_knuckle_fine.STL",
     1244,
     1244,
     0,
     1,
     0,
     0,
     {-0.0074992, -0.012, -0.0079326},
     {0.038289, 0.012, 0.014524}},
    {"ur5/meshes/robotiq/robotiq_85_base_link_fine.STL",
     40112,
     40112,
     0,
     79,
     72,
     30,
     {-0.042443, -0.0375, -0.003},
     {0.042443, 0.0375, 0.097888}},
    {"ur5/meshes/robotiq_fts300.stl",
     43473,
     43473,
     0,
     90,
     129,
     0,
     {-0.037499, -0.0415, -0.037499},
     {0.037826, 1.3332e-09, 0.037499}},
    {"ur5/meshes/ur5/collision/base.stl",
     578,
     578,
     0,
     0,
     0,
     0,
     {-0.073579, -0.11, -0.0030024},
     {0.073633, 0.073551, 0.021}},
    {"ur5/meshes/ur5/collision/forearm.stl",
     1050,
     1050,
     0,
     0,
     0,
     0,
     {-0.057912, -0.057176, -0.057986},
     {0.058534, 0.054511, 0.43128}},
    {"ur5/meshes/ur5/collision/shoulder.stl",
     674,
     674,
     0,
     0,
     0,
     0,
     {-0.059404, -0.059746, -0.0652},
     {0.0595, 0.070501, 0.06846}},
    {"ur5/meshes/ur5/collision/upperarm.stl",
     1176,
     1176,
     0,
     0,
     0,
     0,
     {-0.059892, -0.0652, -0.059746},
     {0.05948, 0.068597, 0.4849}},
    {"ur5/meshes/ur5/collision/wrist1.stl",
     702,
     702,
     0,
     0,
     0,
     0,
     {-0.0386, 0.047499, -0.057176},
     {0.03889, 0.1325, 0.0475}},
    {"ur5/meshes/ur5/collision/wrist2.stl",
     702,
     702,
     0,
     0,
     0,
     0,
     {-0.03889, -0.057188, 0.04915},
     {0.038694, 0.0475, 0.13338}},
    {"ur5/meshes/ur5/collision/wrist3.stl",
     446,
     446,
     0,
     0,
     0,
     0,
     {-0.037516, 0.047325, -0.037516},
     {0.037516, 0.081825, 0.043}},
};

TEST(InspectMesh, RobotsOfTheSharedData) {
  const auto data = dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const Row& row : robotRows) {
    expectRow(inspectMesh(readMeshFile(*data / "robots" / row.file).mesh), row);
  }
}

constexpr Row omplAppRows[] = {
    {"2D/BugTrap_planar_env.dae",
     264,
     132,
     2,
     0,
     44,
     23,
     {-55, -55.01, -0.001485},
     {55, 55.011, 8.1695}},
    {"2D/Maze_planar_env.dae", 1892, 946, 0, 4, 8, 14, {-55, -55, 0}, {55, 55, 10.63}},
    {"2D/car1_planar_robot.dae", 28, 14, 0, 0, 0, 4, {-2.475, -1.25, 0}, {2.525, 1.25, 7.874}},
    {"2D/car2_planar_robot.dae", 40, 20, 0, 0, 3, 3, {-1.99, -2, 0}, {2.01, 2, 7.874}},
    {"3D/Abstract_env.dae",
     1400,
     700,
     0,
     0,
     0,
     0,
     {-233.12, -222.2, -3.9451},
     {239.92, 250.74, 468.98}},
    {"3D/Abstract_robot.dae",
     48,
     24,
     0,
     0,
     0,
     0,
     {-25.791, -9.4488, -34.962},
     {26.287, 9.4488, 35.827}},
    {"3D/Easy_env.dae", 176, 88, 2, 0, 7, 4, {14.46, -24.25, -504.86}, {457.96, 321.25, -72.855}},
    {"3D/Easy_robot.dae", 56, 28, 0, 0, 0, 0, {251.12, 142.75, -322.66}, {308.35, 196.75, -274.16}},
    {"3D/Home_env.dae", 696, 348, 0, 0, 0, 0, {-383.8, -371.47, -0.19685}, {325, 337.89, 142.33}},
    {"3D/Home_robot.dae",
     120,
     60,
     0,
     0,
     0,
     0,
     {-23.541, -35.433, -12.58},
     {23.703, 35.433, 27.781}},
    {"3D/Twistycool_env.dae",
     176,
     88,
     2,
     0,
     7,
     5,
     {14.46, -24.25, -504.86},
     {457.96, 321.25, -72.855}},
    {"3D/Twistycool_robot.dae",
     56,
     28,
     0,
     0,
     0,
     0,
     {251.12, 142.75, -322.66},
     {308.35, 196.75, -274.16}},
    {"3D/alpha_env-1.5.dae",
     2016,
     1008,
     0,
     0,
     612,
     0,
     {-131.87, -42.493, -91.763},
     {106.82, 125.33, -3.0743}},
    {"3D/alpha_robot.dae",
     2016,
     1008,
     0,
     0,
     612,
     0,
     {-73.176, -59.949, -102.64},
     {171.8, 43.713, 39.496}},
    {"3D/cubicles_env.dae",
     626,
     313,
     16,
     12,
     33,
     0,
     {-508.88, -230.13, -123.75},
     {319.62, 531.87, 101}},
    {"3D/cubicles_robot.dae",
     40,
     20,
     0,
     0,
     0,
     0,
     {-27.2, -87.356, 55.692},
     {19.482, -8.4615, 85.024}},
};

TEST(InspectMesh, OmplAppMeshes) {
  const auto folder = omplAppFolder();
  if (!folder) GTEST_SKIP() << "set CORRIDOR_OMPLAPP to OMPL.app's folder resources";
  for (const Row& row : omplAppRows) {
    expectRow(inspectMesh(readOmplAppMesh(*folder / row.file).mesh), row);
  }
}

}  // namespace
}  // namespace corridor::test
