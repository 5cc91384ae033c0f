#include "collision/geometry/cut_polygons.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

using Polygon = std::vector<Vec2>;

/// Returns how often a polygon of small numbers winds about a point that is on no edge.
int winding(const Polygon& p, const Vec2& at) {
  int sum = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 a = p[i] - at, b = p[(i + 1) % p.size()] - at;
    const double side = a.x() * b.y() - a.y() * b.x();
    sum += a.y() <= 0 && b.y() > 0 && side > 0;
    sum -= a.y() > 0 && b.y() <= 0 && side < 0;
  }
  return sum;
}

/// Returns whether the triangles cover a point as often as the polygon winds about it.
bool isCovered(const Polygon& p, const std::vector<std::array<std::uint32_t, 3>>& triangles,
               const Vec2& at) {
  int sum = 0;
  for (const auto& t : triangles) sum += winding({p[t[0]], p[t[1]], p[t[2]]}, at);
  return sum == winding(p, at);
}

/// Loops along the lines of a small grid: they touch, repeat and cross themselves in all ways, and
/// wind about the points of a cell equally often.
TEST(CutPolygons, LoopsOnAGrid) {
  std::mt19937_64 random(testSeed(7));
  int valid = 0, refused = 0;
  for (int i = 0, n = casesOf(30'000, 3'000'000); i < n; ++i) {
    const int size = 2 + static_cast<int>(random() % 4);
    const auto any = [&] { return static_cast<double>(random() % size); };
    Polygon p{{any(), any()}};
    for (std::size_t corners = 4 + random() % 14; p.size() < corners;) {
      Vec2 next = p.back();
      next[static_cast<int>(p.size() % 2)] = any();
      p.push_back(next);
    }
    p.emplace_back(p.size() % 2 == 0 ? Vec2(p.back().x(), p[0].y()) : Vec2(p[0].x(), p.back().y()));
    bool isValid = true;
    for (int x = 0; x < size; ++x)
      for (int y = 0; y < size; ++y) {
        const int w = winding(p, {x + 0.5, y + 0.5});
        isValid &= w == 0 || w == 1;
      }
    const auto triangles = trianglesOfPolygon(p);
    valid += isValid;
    refused += isValid && triangles.empty();
    if (triangles.empty()) continue;
    ASSERT_TRUE(isValid) << "case " << i;
    ASSERT_EQ(triangles.size(), p.size() - 2);
    for (int x = 0; x < size; ++x)
      for (int y = 0; y < size; ++y)
        for (const Vec2& at : {Vec2(x + 0.3, y + 0.37), Vec2(x + 0.72, y + 0.59)})
          ASSERT_TRUE(isCovered(p, triangles, at)) << "case " << i;
  }
  EXPECT_GT(valid, casesOf(30'000, 3'000'000) / 4);
  // Loops that run along an edge three times may have no ear.
  EXPECT_LT(refused, valid / 100);
}

TEST(CutPolygons, RandomPolygons) {
  std::mt19937_64 random(testSeed(8));
  int accepted = 0;
  for (int i = 0, n = casesOf(4'000, 400'000); i < n; ++i) {
    const int size = 3 + static_cast<int>(random() % 4);
    Polygon p;
    for (std::size_t corners = 4 + random() % 7; p.size() < corners;)
      p.emplace_back(random() % size, random() % size);
    const auto triangles = trianglesOfPolygon(p);
    accepted += !triangles.empty();
    std::uniform_real_distribution<double> within(0, size);
    for (int k = 0; k < 100 && !triangles.empty(); ++k) {
      const Vec2 at(within(random), within(random));
      ASSERT_THAT(winding(p, at), testing::AnyOf(0, 1)) << "case " << i;
      ASSERT_TRUE(isCovered(p, triangles, at)) << "case " << i;
    }
  }
  EXPECT_GT(accepted, casesOf(4'000, 400'000) / 100);
}

TEST(CutPolygons, WhatIsNoPolygonIsRefused) {
  EXPECT_THAT(trianglesOfPolygon(Polygon{{0, 0}, {1, 1}, {1, 0}, {0, 1}}), IsEmpty());
  EXPECT_THAT(trianglesOfPolygon(Polygon{{0, 0}, {0, 1}, {1, 1}, {1, 0}}), IsEmpty());  // clockwise
  EXPECT_THAT(
      trianglesOfPolygon(Polygon{{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {0, 1}}),
      IsEmpty());  // twice around
}

/// Corners that are left or right of a line by less than the rounding of a determinant in doubles.
TEST(CutPolygons, CornersOffALineByARounding) {
  const double u = 0x1p-53;
  int wrong = 0, dents = 0;
  for (int k = 0; k < 40; ++k)
    for (int m = 0; m < 40; ++m) {
      const double x = 0.5 + k * u, y = 0.5 + m * u;          // the line: y = x
      const Polygon p{{24, 24}, {12, 24}, {x, y}, {12, 12}};  // (12, 12) is between, if x = y
      const double naive = (x - 24) * (12 - 24) - (y - 24) * (12 - 24);
      wrong += (naive > 0) != (x > y) || (naive < 0) != (x < y);
      const auto triangles = trianglesOfPolygon(p);
      // For x < y the corner (12, 12) turns left, and else right, or not at all: then the diagonal
      // from it is the only one.
      ASSERT_EQ(triangles.size(), 2u) << k << ' ' << m;
      if (y < x) ++dents;
      if (y < x)
        for (const auto& t : triangles) {
          EXPECT_NE(std::find(t.begin(), t.end(), 3u), t.end()) << k << ' ' << m;
          EXPECT_NE(std::find(t.begin(), t.end(), 1u), t.end()) << k << ' ' << m;
        }
    }
  EXPECT_GT(wrong, 0);
  EXPECT_GT(dents, 0);
}

// --- Files

class PolygonFiles : public MeshFileTest {
 protected:
  /// Returns the number of triangles that cover a point of the plane z = 0.
  static int covering(const TriangleMesh& mesh, const Vec2& at) {
    int sum = 0;
    for (const auto& t : mesh.triangles) {
      Polygon corners;
      for (const std::uint32_t v : t) corners.emplace_back(mesh.vertices[v].head<2>());
      sum += winding(corners, at) != 0;
    }
    return sum;
  }
  static std::string joined(const std::vector<int>& numbers, int add) {
    std::string text;
    for (const int n : numbers) text += ' ' + std::to_string(n + add);
    return text;
  }
  /// Returns the mesh of one face in each format that has polygons. @param points "x y z\n" …
  std::vector<MeshFile> inAllFormats(const std::vector<std::string>& points,
                                     const std::vector<int>& corners) const {
    const std::string count = std::to_string(points.size()), n = std::to_string(corners.size());
    std::string obj, lines;
    for (const std::string& p : points) {
      obj += "v " + p + '\n';
      lines += p + '\n';
    }
    const std::string dae =
        R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count=")" +
        std::to_string(3 * points.size()) + "\">" + lines +
        R"(</float_array><technique_common><accessor source="#a" count=")" + count +
        R"(" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/><vcount>)" +
        n + "</vcount><p>" + joined(corners, 0) +
        R"(</p></polylist></mesh></geometry></library_geometries><library_visual_scenes>
<visual_scene id="w"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>)";
    const std::string ply =
        "element vertex " + count +
        "\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list "
        "uint uint vertex_indices\nend_header\n" +
        lines + n + joined(corners, 0) + '\n';
    return {read("a.obj", obj + 'f' + joined(corners, 1) + '\n'),
            read("a.off", "OFF\n" + count + " 1 0\n" + lines + n + joined(corners, 0) + '\n'),
            read("a.ply", "ply\nformat ascii 1.0\n" + ply), read("a.dae", dae)};
  }
};

/// A wall with a door, from each first corner and in both directions.
TEST_F(PolygonFiles, TheDoorOfAWallStaysOpen) {
  const std::vector<std::string> points{"0 0 0", "1 0 0", "1 2 0", "2 2 0",
                                        "2 0 0", "4 0 0", "4 3 0", "0 3 0"};
  for (int first = 0; first < 8; ++first)
    for (const int step : {1, 7}) {
      std::vector<int> corners;
      for (int i = 0; i < 8; ++i) corners.push_back((first + i * step) % 8);
      for (const MeshFile& file : inAllFormats(points, corners)) {
        SCOPED_TRACE(file.format + joined(corners, 0));
        EXPECT_EQ(file.mesh.triangles.size(), 6u);
        EXPECT_EQ(covering(file.mesh, {1.5, 0.9}), 0);
        for (const Vec2& inside : {Vec2(0.4, 1), Vec2(3, 1.1), Vec2(1.5, 2.6)})
          EXPECT_EQ(covering(file.mesh, inside), 1);
        EXPECT_THAT(file.notes, IsEmpty());
      }
    }
}

/// Straight corners, for which assimp makes triangles outside the polygon; and a wall with a
/// window, whose boundary is one loop.
TEST_F(PolygonFiles, StraightCornersAndHoles) {
  for (const MeshFile& file :
       inAllFormats({"0 0 0", "0 2 0", "2 1 0", "1 1 0", "1 2 0", "2 0 0"}, {0, 5, 2, 3, 4, 1})) {
    SCOPED_TRACE(file.format);
    EXPECT_EQ(covering(file.mesh, {1.6, 1.5}), 0);
    EXPECT_EQ(covering(file.mesh, {1.6, 0.6}), 1);
    EXPECT_EQ(covering(file.mesh, {0.5, 1.6}), 1);
  }
  for (const MeshFile& file :
       inAllFormats({"0 0 0", "3 0 0", "3 3 0", "0 3 0", "1 1 0", "1 2 0", "2 2 0", "2 1 0"},
                    {0, 1, 2, 3, 0, 4, 5, 6, 7, 4})) {
    SCOPED_TRACE(file.format);
    EXPECT_EQ(covering(file.mesh, {1.6, 1.5}), 0);
    for (const Vec2& inside : {Vec2(0.5, 0.6), Vec2(2.5, 1.6), Vec2(1.6, 2.5), Vec2(1.4, 0.3)})
      EXPECT_EQ(covering(file.mesh, inside), 1);
  }
}

TEST_F(PolygonFiles, PolygonsThatCrossThemselves) {
  const std::string points = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\n";
  EXPECT_EQ(complaint("a.obj", points + "f 1 2 3\nf 1 2 3 4\n"),
            "a.obj:7: face 2, a polygon of 4 corners, crosses or overlaps itself (the edges behind "
            "its corners 1 and 3); split it into simple polygons, or into triangles");
  EXPECT_THAT(complaint("a.off", "OFF\n4 1 0\n0 0 0\n1 1 0\n1 0 0\n0 1 0\n4 0 1 2 3\n"),
              StartsWith("a.off:7: face 1, a polygon of 4 corners, crosses"));
  EXPECT_THAT(complaint("a.ply",
                        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float "
                        "y\nproperty float z\nelement face 1\nproperty list uchar int "
                        "vertex_index\nend_header\n0 0 0\n1 1 0\n1 0 0\n0 1 0\n4 0 1 2 3\n"),
              StartsWith("a.ply:14: face 1, a polygon of 4 corners, crosses"));
}

/// A small polygon far from the origin is not taken for a thin one.
TEST_F(PolygonFiles, CrossingPolygonsFarFromTheOrigin) {
  const auto bowTie = [&](const std::string& x, const std::string& next) {
    return complaint("a.obj", "v " + x + " 0 0\nv " + next + " 0.01 0\nv " + next + " 0 0\nv " + x +
                                  " 0.01 0\nf 1 2 3 4\n");
  };
  EXPECT_THAT(bowTie("1000", "1000.01"), HasSubstr("crosses or overlaps itself"));
  EXPECT_THAT(bowTie("450000", "450000.01"), HasSubstr("crosses or overlaps itself"));
  // Its area is small, so rounding turns Newell's normal.
  EXPECT_THAT(complaint("a.obj",
                        "v 0 0 0.000005\nv 1 1 0.000005\nv 1 0 -0.000005\nv 0 0.997 -0.000005\n"
                        "f 1 2 3 4\n"),
              HasSubstr("crosses or overlaps itself"));
}

/// A polygon that is tiny beside its distance from the origin is judged by its own size.
TEST_F(PolygonFiles, TinyPolygonsFarFromTheOrigin) {
  const std::string wall[] = {"0 1 0",     "1e-80 1 0", "1e-80 1 2e-80", "2e-80 1 2e-80",
                              "2e-80 1 0", "4e-80 1 0", "4e-80 1 3e-80", "0 1 3e-80"};
  std::string obj;
  for (const std::string& p : wall) obj += "v " + p + '\n';
  TriangleMesh mesh = read("a.obj", obj + "f 1 2 3 4 5 6 7 8\n").mesh;
  for (Vec3& p : mesh.vertices) p = {p.x() * 1e80, p.z() * 1e80, 0};
  EXPECT_EQ(covering(mesh, {1.5, 0.9}), 0);
  for (const Vec2& inside : {Vec2(0.4, 1), Vec2(3, 1.1), Vec2(1.5, 2.6)})
    EXPECT_EQ(covering(mesh, inside), 1);
}

/// Corners that are not in a plane determine no surface, so a note says so.
TEST_F(PolygonFiles, PolygonsThatAreNotFlat) {
  const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 ", face = "\nv 0 1 0\nf 1 2 3 4\n";
  EXPECT_THAT(read("a.obj", square + "0.000001" + face).notes, IsEmpty());
  const std::string flat = "v 0 0 7\nv 1 0 7\nv 1 1 7\nv 0 1 7\nf 5 6 7 8\n";
  EXPECT_THAT(read("a.obj", square + "0.4" + face + flat).notes,
              ElementsAre("1 polygon is not flat, so the triangles into which a polygon is cut "
                          "determine its surface; the largest deviation from a plane is 0.0962 "
                          "units of the file, at line 5"));
  EXPECT_THAT(read("a.obj", square + "0.4" + face + "f 4 3 2 1\n").notes,
              ElementsAre(StartsWith("2 polygons are not flat, so")));
}

/// Polygons for which no surface is right, or whose area is nothing, stay fans.
TEST_F(PolygonFiles, CrossingPolygonsThatStayFans) {
  const auto fanWith = [&](const std::string& points, const std::string& note) {
    const MeshFile file = read("a.obj", points + "f 1 2 3 4\n");
    EXPECT_EQ(file.mesh.triangles,
              (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
    EXPECT_THAT(file.notes, testing::Contains(note)) << points;
  };
  const std::string note =
      "1 polygon that crosses itself is so thin, or so far from flat, that a fan of triangles is "
      "used instead, which may overlap; the first is at line 5";
  fanWith("v 0 0 0\nv 2 0 0\nv 0.5 0.000001 0\nv 1.5 0.000001 0\n", note);  // thin
  fanWith("v 0 0 0\nv 1 1 0.1\nv 1 0 -0.1\nv 0 0.8 0.1\n", note);           // bent
  EXPECT_THAT(complaint("a.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.001 0\nv 1.5 0.001 0\nf 1 2 3 4\n"),
              HasSubstr("crosses or overlaps itself"));
  EXPECT_THAT(complaint("a.obj", "v 0 0 0\nv 1 1 0.001\nv 1 0 -0.001\nv 0 0.8 0.001\nf 1 2 3 4\n"),
              HasSubstr("crosses or overlaps itself"));
  EXPECT_THAT(
      read("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 1 3\nf 1 1 1 1 1\nf 1 2 4\n").notes,
      IsEmpty());
}

/// The door of a wall in other planes: along each axis, and oblique.
TEST_F(PolygonFiles, OtherPlanes) {
  const double wall[][2] = {{0, 0}, {1, 0}, {1, 2}, {2, 2}, {2, 0}, {4, 0}, {4, 3}, {0, 3}};
  const Vec3 oblique = Vec3(2, -3, 6) / 7, across = Vec3(6, -2, -3) / 7;  // an exact frame in 1/7
  const std::pair<Vec3, Vec3> planes[] = {{{1, 0, 0}, {0, 1, 0}},  {{0, 1, 0}, {0, 0, 1}},
                                          {{0, 0, 1}, {1, 0, 0}},  {{0, 1, 0}, {1, 0, 0}},
                                          {{-1, 0, 0}, {0, 0, 1}}, {oblique, across}};
  for (const auto& [u, v] : planes) {
    std::string obj;
    for (const auto& [x, y] : wall) {
      const Vec3 p = x * u + y * v;
      char line[100];
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", p.x(), p.y(), p.z());
      obj += line;
    }
    for (int first = 0; first < 8; ++first) {
      std::string face = "f";
      for (int i = 0; i < 8; ++i) face += ' ' + std::to_string((first + i) % 8 + 1);
      TriangleMesh mesh = read("a.obj", obj + face).mesh;
      const Vec3 normal = u.cross(v);
      double area = 0;
      for (const auto& t : mesh.triangles) {  // all have the polygon's orientation
        const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
        const double twice = (b - a).cross(c - a).dot(normal);
        EXPECT_GE(twice, -1e-15);
        area += std::abs(twice) / 2;
      }
      EXPECT_NEAR(area, 10, 1e-13);
      for (Vec3& p : mesh.vertices) p = {p.dot(u), p.dot(v), 0};
      EXPECT_EQ(covering(mesh, {1.5, 0.9}), 0);
      EXPECT_EQ(covering(mesh, {3, 1.1}), 1);
    }
  }
}

/// Under OMPL.app's rules, too: assimp gives the frame, not the triangles.
TEST_F(PolygonFiles, OmplAppsRules) {
  inAllFormats({"0 0 0", "0 2 0", "2 1 0", "1 1 0", "1 2 0", "2 0 0"}, {0, 5, 2, 3, 4, 1});
  const OmplAppMesh read = readOmplAppMesh(folder_ / "a.dae");
  EXPECT_EQ(read.importedVertices, 6);
  EXPECT_EQ(read.mesh.triangles.size(), 4u);
  // The frame is turned to y-up: (x, y, z) -> (x, z, -y).
  TriangleMesh mesh = read.mesh;
  for (Vec3& p : mesh.vertices) {
    EXPECT_NEAR(p.y(), 0, 1e-6);
    p = {p.x(), -p.z(), 0};
  }
  EXPECT_EQ(covering(mesh, {1.6, 1.5}), 0);
  EXPECT_EQ(covering(mesh, {1.6, 0.6}), 1);
  EXPECT_EQ(covering(mesh, {0.5, 1.6}), 1);
}

TEST_F(PolygonFiles, ColladaPolygonsThatCrossThemselves) {
  EXPECT_EQ(
      complaintOf([&] {
        inAllFormats({"0 0 0", "1 1 0", "1 0 0", "0 1 0"}, {0, 1, 2});  // writes the files
        std::string dae = contents(folder_ / "a.dae");
        dae.replace(dae.find("<vcount>3"), 9, "<vcount>4");
        dae.replace(dae.find("<p> 0 1 2"), 9, "<p> 0 1 2 3");
        read("a.dae", dae);
      }),
      "a.dae:10: a polygon of 4 corners with a corner at (0, 0, 0) crosses or overlaps itself "
      "(the edges behind its corners 1 and 3); split it into simple polygons, or into "
      "triangles");
}

TEST_F(PolygonFiles, TooManyCornersThatAreNotConvex) {
  std::string obj, face = "f";
  const int n = 10'002;
  for (int i = 0; i < n; ++i) {
    const double turn = 6.283185307179586 * i / n, radius = i % 2 == 0 ? 1 : 2;
    obj += "v " + std::to_string(radius * std::cos(turn)) + ' ' +
           std::to_string(radius * std::sin(turn)) + " 0\n";
    face += ' ' + std::to_string(i + 1);
  }
  EXPECT_EQ(
      complaint("a.obj", obj + face),
      "a.obj:10003: the polygons that are not convex have too many corners (face 1, a polygon "
      "of 10002 corners, is the first that is not cut); save the mesh as triangles");
}

}  // namespace
}  // namespace corridor::test
