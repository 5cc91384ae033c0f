#include <cmath>

#include <gmock/gmock.h>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test {
namespace {

/// Returns a Collada file with a triangle and a quad, which the nodes scale by 2 and translate, and
/// a line, which is not read.
std::string collada(const std::string& asset, const std::string& first = "0.1") {
  return R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset>)" +
         asset + R"(</asset>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="15">)" +
         first + R"( 2 3  1 2 3  1 5 3  0 5 3  -1 9 3</float_array>
<technique_common><accessor source="#pa" count="5" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<polylist count="2"><input semantic="VERTEX" source="#v" offset="0"/><vcount>4 3</vcount><p>0 1 2 3 3 2 4</p></polylist>
<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 4</p></lines>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">
<node id="a"><translate>10 0 0</translate><node id="b"><scale>2 2 2</scale><instance_geometry url="#g"/></node></node>
</visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene>
</COLLADA>
)";
}

class Collada : public MeshFileTest {
 protected:
  static void expectBounds(const TriangleMesh& mesh, const Vec3& min, const Vec3& max) {
    const MeshHealth health = inspectMesh(mesh);
    EXPECT_EQ(health.triangles, 3u);
    EXPECT_LT((health.min - min).norm(), 1e-14);
    EXPECT_LT((health.max - max).norm(), 1e-14);
  }
};

TEST_F(Collada, NodesAndUnitApplyButNotTheUpAxis) {
  for (const char* const up : {"X_UP", "Y_UP", "Z_UP"}) {
    SCOPED_TRACE(up);
    const MeshFile file = read(
        "a.dae", collada("<unit meter=\"0.0254\"/><up_axis>" + std::string(up) + "</up_axis>"));
    expectBounds(file.mesh, 0.0254 * Vec3(8, 4, 6), 0.0254 * Vec3(12, 18, 6));
    EXPECT_TRUE(file.floatVertices);
    EXPECT_EQ(file.format, "Collada");
    EXPECT_EQ(file.unitRule, "0.0254 m per unit, by the file or its format");
    EXPECT_EQ(file.upRule,
              "coordinates as stored, since no up-axis was requested; the file's own <up_axis> is "
              "not applied "
              "(ROS's rule)");
    EXPECT_EQ(file.mesh.vertices.size(), 5u);
  }
}

TEST_F(Collada, VerticesAreRoundedToFloat) {
  const MeshFile file = read("a.dae", collada("<up_axis>Z_UP</up_axis>"));
  double least = 100;
  for (const Vec3& v : file.mesh.vertices) {
    if (v.x() > 10) least = std::min(least, v.x());
  }
  EXPECT_EQ(least, 10 + 2 * static_cast<double>(0.1f));
}

TEST_F(Collada, UnitAndUpAxisAsRequested) {
  const MeshFile file =
      read("a.dae", collada("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"), {0.5, 'y'});
  expectBounds(file.mesh, Vec3(4, -3, 2), Vec3(6, -3, 9));
  EXPECT_EQ(file.unitRule, "0.5 m per unit, as requested, instead of the file's own 0.0254 m");
  EXPECT_EQ(
      file.upRule,
      "y is up, as requested: rotated by (x, y, z) -> (x, -z, y); the file's own <up_axis> is not "
      "applied "
      "(ROS's rule)");
}

TEST_F(Collada, InvalidUnitsAndUpAxes) {
  for (const char* const unit : {"0", "-1", "abc", "", "inf", "1 m"})
    EXPECT_EQ(
        complaint("a.dae", collada("\n<unit name=\"x\" meter=\"" + std::string(unit) + "\"/>")),
        "a.dae:4: <unit meter=\"" + std::string(unit) +
            "\">: the unit must be a number of metres above 0");
  for (const std::string blank : {" ", "\n"})
    EXPECT_THAT(complaint("a.dae", collada("<unit meter=\"" + blank + "0.5\"/>")),
                testing::EndsWith(">: assimp reads no number after a blank; remove it"));
  EXPECT_THAT(complaint("a.dae", collada("<unit meter=\"1\"/><unit meter=\"0.5\"/>")),
              testing::HasSubstr("a second <unit> is in one <asset>"));
  EXPECT_THAT(complaint("a.dae", collada("<unit Meter=\"0.5\"/>")),
              testing::EndsWith("the attribute \"Meter\" of <unit> is not read; write \"meter\""));
  EXPECT_EQ(complaint("a.dae", collada("<up_axis> W_UP </up_axis>")),
            "a.dae:3: <up_axis> is \"W_UP\"; X_UP, Y_UP or Z_UP is needed");
  EXPECT_EQ(complaint("a.dae", collada("<up_axis\n>W_UP</up_axis>")),
            "a.dae:3: <up_axis> is \"W_UP\"; X_UP, Y_UP or Z_UP is needed");
  for (const char* const sound :
       {"<unit meter = '0.01 ' name=\"meter\"/><up_axis>\nZ_UP\n</up_axis>",
        "<unit name=\"meter\"/>",
        "<!-- <unit meter=\"0\"/> <up_axis>W</up_axis> --><unit meter=\"1e0\"/>",
        "<comments><![CDATA[<unit meter=\"0\"/>]]></comments><up_axis >Z_UP</up_axis>"})
    EXPECT_EQ(complaint("a.dae", collada(sound)), "no complaint") << sound;
  EXPECT_THROW(readOmplAppMesh(write("z.dae", collada("<unit meter=\"0\"/>"))), InputError);
  // The check of the file's text does not detect these wrong units; the check of the imported mesh
  // does.
  const std::string message = ": its <unit> is not above 0, or too small";
  for (const char* const hidden : {"<unit name=\"a>b\" meter=\"0\"/>", "<unit meter=\"1e-60\"/>"}) {
    EXPECT_THAT(complaint("a.dae", collada(hidden)), testing::EndsWith(message)) << hidden;
    EXPECT_THROW(readOmplAppMesh(write("z.dae", collada(hidden))), InputError) << hidden;
  }
  EXPECT_THAT(complaint("a.dae", collada("<unit name=\"a>b\" meter=\"-1\"/>")),
              testing::EndsWith(message));
}

TEST_F(Collada, OmplAppTurnsToYUp) {
  OmplAppMesh read = readOmplAppMesh(write("z.dae", collada("<up_axis>Z_UP</up_axis>")));
  expectBounds(read.mesh, Vec3(8, 6, -18), Vec3(12, 6, -4));
  read = readOmplAppMesh(write("y.dae", collada("<up_axis>Y_UP</up_axis>")));
  expectBounds(read.mesh, Vec3(8, 4, 6), Vec3(12, 18, 6));
  read = readOmplAppMesh(write("x.dae", collada("<up_axis>X_UP</up_axis>")));
  expectBounds(read.mesh, Vec3(-18, 8, 6), Vec3(-4, 12, 6));
}

TEST_F(Collada, OmplAppAveragesAllVerticesThoseOfLinesToo) {
  const OmplAppMesh read = readOmplAppMesh(write("y.dae", collada("<up_axis>Y_UP</up_axis>", "0")));
  // All faces are in one plane and have equal normals, so assimp keeps each of the five different
  // vertices of the faces once. In addition, assimp keeps the two vertices of the line.
  EXPECT_EQ(read.importedVertices, 7);
  EXPECT_LT((read.vertexAverage - Vec3(10, 2 * 34.0 / 7, 6)).norm(), 1e-5)
      << read.vertexAverage.transpose();
}

TEST_F(Collada, Complaints) {
  EXPECT_EQ(complaint("a.dae", "hello"),
            "a.dae: cannot be read by assimp: Unable to read file, malformed XML");
  EXPECT_EQ(complaint("a.dae", collada("", "1e39")),
            "a.dae: vertex 0 (counted from 0) is not finite (this format is read in float, which "
            "ends at 3.4e38)");
  EXPECT_EQ(complaint("a.dae", collada("", "1e39")),
            "a.dae: vertex 0 (counted from 0) is not finite (this format is read in float, which "
            "ends at 3.4e38)");
  std::string noMesh = collada("");
  const auto at = noMesh.find("<polylist");
  noMesh.erase(at, noMesh.find("<lines") - at);
  EXPECT_EQ(complaint("a.dae", noMesh),
            "a.dae: the mesh has no faces; triangles or polygons are needed, lines and points are "
            "not read");
}

}  // namespace
}  // namespace corridor::test
