#include "collision/geometry/mesh_health.h"

#include <cmath>
#include <limits>
#include <map>
#include <random>

#include <gtest/gtest.h>

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
  EXPECT_EQ(health.misorientedEdges, 0u);
  EXPECT_EQ(health.whyNotWatertight, "");
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
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(std::signbit(inspectMesh(soup).min[i]));
  for (Vec3& vertex : soup.vertices) vertex = -vertex;  // the upper bounds become -0
  const MeshHealth health = inspectMesh(soup);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(std::signbit(health.max[i]));
}

TEST(InspectMesh, OpenTurnedAndDoubledMeshes) {
  TriangleMesh open = tetrahedron();
  open.triangles.pop_back();
  EXPECT_EQ(inspectMesh(open).boundaryEdges, 3u);
  EXPECT_FALSE(inspectMesh(open).watertight);
  EXPECT_FALSE(inspectMesh(open).volume.has_value());
  EXPECT_EQ(inspectMesh(open).whyNotWatertight, "3 of its edges have a triangle on one side only");

  TriangleMesh turned = tetrahedron();
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_EQ(inspectMesh(turned).boundaryEdges, 0u);
  EXPECT_FALSE(inspectMesh(turned).watertight);
  EXPECT_EQ(inspectMesh(turned).misorientedEdges, 3u);
  EXPECT_EQ(inspectMesh(turned).whyNotWatertight,
            "its triangles do not face the same way at 3 of its edges");

  TriangleMesh inwards = tetrahedron();
  for (auto& t : inwards.triangles) std::swap(t[0], t[1]);
  EXPECT_DOUBLE_EQ(inspectMesh(inwards).volume.value_or(0), -1.0 / 6);

  TriangleMesh doubled = tetrahedron();  // both sides of each face, as SketchUp exports
  for (const auto& t : tetrahedron().triangles) doubled.triangles.push_back({t[1], t[0], t[2]});
  const MeshHealth health = inspectMesh(doubled);
  EXPECT_EQ(health.triangles, 8u);
  EXPECT_EQ(health.distinctTriangles, 4u);
  EXPECT_EQ(health.nonManifoldEdges, 0u);
  EXPECT_EQ(health.misorientedEdges, 0u);
  EXPECT_FALSE(health.watertight);
  EXPECT_EQ(health.whyNotWatertight,
            "6 of its edges have three triangles or more, repeated ones included");

  // Closed, with an additional collinear triangle at the edge 0-1.
  TriangleMesh finned = tetrahedron();
  finned.vertices.push_back({2, 0, 0});
  finned.triangles.push_back({0, 1, 4});
  EXPECT_EQ(inspectMesh(finned).whyNotWatertight,
            "2 of its edges have a triangle on one side only");
  TriangleMesh fan = tetrahedron();  // a third triangle at an edge
  fan.vertices.push_back({1, 1, 1});
  fan.triangles.push_back({0, 1, 4});
  EXPECT_EQ(inspectMesh(fan).whyNotWatertight, "2 of its edges have a triangle on one side only");
  // Three closed surfaces that share an edge: six triangles use it.
  TriangleMesh book;
  for (const double x : {1.0, 2.0, 3.0}) {
    TriangleMesh page = tetrahedron();
    for (const std::size_t v : {2, 3}) page.vertices[v] = Vec3(0, static_cast<double>(v), 10 * x);
    const auto first = static_cast<std::uint32_t>(book.vertices.size());
    for (const Vec3& p : page.vertices) book.vertices.push_back(p);
    for (const auto& t : page.triangles)
      book.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  }
  EXPECT_EQ(inspectMesh(book).whyNotWatertight, "1 of its edges have three triangles or more");
  // A collinear triangle closes an opening, so the reason must not be the opening.
  TriangleMesh filled = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 0, 0}},
                         {{0, 2, 4}, {4, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {0, 4, 1}}};
  EXPECT_TRUE(inspectMesh(filled).watertight);
  EXPECT_EQ(inspectMesh(filled).boundaryEdges, 3u);
  std::swap(filled.triangles[3][0], filled.triangles[3][1]);
  EXPECT_EQ(inspectMesh(filled).whyNotWatertight,
            "its triangles do not face the same way at 3 of its edges");
  const TriangleMesh point = {{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 0}, {0, 1, 0}}};
  EXPECT_EQ(inspectMesh(point).whyNotWatertight,
            "none of its triangles has three different corners");
  EXPECT_EQ(inspectMesh(TriangleMesh{}).whyNotWatertight, "there are no triangles");
}

/// Compares random triangles on few points with the definitions in mesh_health.h, edge by edge.
TEST(InspectMesh, EdgesByTheirDefinition) {
  const unsigned seed = std::random_device{}();
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  std::size_t closed = 0, turned = 0;
  for (int i = 0; i < 20000; ++i) {
    TriangleMesh mesh = tetrahedron();
    mesh.vertices.push_back({1, 1, 1});
    std::uniform_int_distribution<std::uint32_t> vertex(0, 4), count(0, 3), any(0, 1);
    for (auto& t : mesh.triangles)
      if (any(random) && any(random)) std::swap(t[0], t[1]);
    for (std::uint32_t k = count(random); k > 0; --k)
      mesh.triangles.push_back({vertex(random), vertex(random), vertex(random)});
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> uses;
    for (const auto& t : mesh.triangles)
      if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
        for (int k = 0; k < 3; ++k) ++uses[{t[k], t[(k + 1) % 3]}];
    bool watertight = true;
    std::size_t same = 0;
    for (const auto& [edge, n] : uses) {
      const auto back = uses.find({edge.second, edge.first});
      watertight = watertight && n == 1 && back != uses.end() && back->second == 1;
      same += n == 2 && back == uses.end();
    }
    const MeshHealth health = inspectMesh(mesh);
    ASSERT_EQ(health.watertight, watertight) << i;
    ASSERT_EQ(health.misorientedEdges, same) << i;
    ASSERT_EQ(health.whyNotWatertight.empty(), watertight) << i;
    closed += watertight;
    turned += same > 0;
  }
  EXPECT_GT(closed, 100u);
  EXPECT_GT(turned, 100u);
}

TEST(InspectMesh, DefectsAreCounted) {
  TriangleMesh mesh = tetrahedron();
  mesh.vertices.push_back({5, 0, 0});     // 4
  mesh.vertices.push_back({6, 0, 0});     // 5
  mesh.vertices.push_back({5, 1e-4, 0});  // 6: a sliver with 4, 5
  mesh.vertices.push_back({7, 0, 0});     // 7: collinear with 4, 5
  mesh.vertices.push_back({-1, -1, 0});   // 8: corner of a third triangle at the edge 0-1
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
  TriangleMesh largest = tetrahedron();
  for (Vec3& v : largest.vertices) v = (2 * v - Vec3::Ones()) * 1.7e308;
  EXPECT_EQ(inspectMesh(largest).degenerateTriangles, 0u);
  for (const double scale : {1e-200, 1e-90, 1.0, 1e90, 1e110, 1e300}) {
    TriangleMesh mesh = tetrahedron();
    for (Vec3& v : mesh.vertices) v *= scale;
    const MeshHealth health = inspectMesh(mesh);
    EXPECT_EQ(health.degenerateTriangles, 0u) << scale;
    EXPECT_TRUE(health.watertight) << scale;
    const double volume = scale * scale * scale / 6;
    EXPECT_EQ(health.volume.has_value(), std::isfinite(volume)) << scale;
    if (std::isfinite(volume)) {
      EXPECT_NEAR(health.volume.value_or(-1), volume, 1e-15 * volume) << scale;
    }
  }
  TriangleMesh smallest = tetrahedron();
  smallest.vertices.emplace_back(2, 0, 0);
  smallest.triangles.push_back({0, 1, 4});  // on a line
  for (Vec3& v : smallest.vertices) v *= std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(inspectMesh(smallest).degenerateTriangles, 1u);
  EXPECT_EQ(triangleQualities(smallest)[4], TriangleQuality::degenerate);
  EXPECT_EQ(inspectMesh({}).triangles, 0u);
  const TriangleMesh point{{{1, 1, 1}}, {{0, 0, 0}}};
  EXPECT_EQ(inspectMesh(point).degenerateTriangles, 1u);
  EXPECT_FALSE(inspectMesh(point).watertight);
}

TEST(CheckMesh, Complains) {
  EXPECT_EQ(checkMesh(tetrahedron()), std::nullopt);
  TriangleMesh mesh = tetrahedron();
  mesh.triangles[2][1] = 4;
  EXPECT_EQ(checkMesh(mesh),
            "face 2 (counted from 0): index 4 is out of range: there are 4 vertices");
  mesh.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(checkMesh(mesh), "vertex 3 (counted from 0) is not finite");
}

}  // namespace
}  // namespace corridor::test
