#include <cmath>

#include <gmock/gmock.h>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/collada_fixture.h"
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
    EXPECT_TRUE(file.facesOnly);
    EXPECT_EQ(file.format, "Collada");
    EXPECT_EQ(file.unitRule, "0.0254 m per unit, by the file or its format");
    EXPECT_EQ(
        file.upRule,
        std::string("coordinates as stored, since no up-axis was requested; the file's own, ") +
            *file.fileUp + ", is not applied (ROS's rule)");
    EXPECT_EQ(file.mesh.vertices.size(), 5u);
  }
}

TEST_F(Collada, VerticesAreDoubles) {
  const MeshFile file = read("a.dae", collada("<up_axis>Z_UP</up_axis>"));
  double least = 100;
  for (const Vec3& v : file.mesh.vertices) {
    if (v.x() > 10) least = std::min(least, v.x());
  }
  EXPECT_EQ(least, 10 + 2 * 0.1);
}

TEST_F(Collada, UnitAndUpAxisAsRequested) {
  const MeshFile file =
      read("a.dae", collada("<unit meter=\"0.0254\"/><up_axis>Z_UP</up_axis>"), {0.5, 'y'});
  expectBounds(file.mesh, Vec3(4, -3, 2), Vec3(6, -3, 9));
  EXPECT_EQ(file.unitRule, "0.5 m per unit, as requested, instead of the file's own 0.0254 m");
  EXPECT_EQ(file.upRule,
            "y is up, as requested: rotated by (x, y, z) -> (x, -z, y); the file's own, z, is not "
            "applied");
}

TEST_F(Collada, InvalidUnitsAndUpAxes) {
  for (const char* const unit : {"0", "-1", "abc", "", "inf", "1 m"})
    EXPECT_EQ(
        complaint("a.dae", collada("\n<unit name=\"x\" meter=\"" + std::string(unit) + "\"/>")),
        "a.dae:4: <unit meter=\"" + std::string(unit) +
            "\">: the unit must be a number of metres above 0");
  EXPECT_EQ(complaint("a.dae", collada("<unit name=\"a>b\" meter=\"0\"/>")),
            "a.dae:3: <unit meter=\"0\">: the unit must be a number of metres above 0");
  EXPECT_THAT(complaint("a.dae", collada("<unit meter=\"1\"/><unit meter=\"0.5\"/>")),
              testing::HasSubstr("a second <unit> is in one <asset>"));
  EXPECT_THAT(complaint("a.dae", collada("<unit Meter=\"0.5\"/>")),
              testing::EndsWith("the attribute \"Meter\" of <unit> is not read; write \"meter\""));
  EXPECT_EQ(complaint("a.dae", collada("<up_axis> W_UP </up_axis>")),
            "a.dae:3: <up_axis> is \"W_UP\"; X_UP, Y_UP or Z_UP is needed");
  EXPECT_EQ(complaint("a.dae", collada("<up_axis\n>W_UP</up_axis>")),
            "a.dae:3: <up_axis> is \"W_UP\"; X_UP, Y_UP or Z_UP is needed");
  EXPECT_THROW(readOmplAppMesh(write("z.dae", collada("<unit meter=\"0\"/>"))), InputError);
}

TEST_F(Collada, Units) {
  for (const auto& [asset, metres] : std::vector<std::pair<std::string, double>>{
           {"", 1},
           {"<unit meter = '0.01 ' name=\"meter\"/><up_axis>\nZ_UP\n</up_axis>", 0.01},
           {"<unit meter=\"\n0.5\"/>", 0.5},
           {"<unit name=\"a>b\" meter=\"1e-60\"/>", 1e-60},
           {"<unit name=\"meter\"/>", 1},
           {"<!-- <unit meter=\"0\"/> <up_axis>W</up_axis> --><unit meter=\"5e0\"/>", 5},
           {"<comments><![CDATA[<unit meter=\"0\"/>]]></comments><up_axis >Z_UP</up_axis>", 1}})
    EXPECT_EQ(inspectMesh(read("a.dae", collada(asset)).mesh).max.y(), 18 * metres) << asset;
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
  EXPECT_THAT(complaint("a.dae", "hello"), testing::StartsWith("a.dae:1: is no complete XML; "));
  EXPECT_EQ(complaint("a.dae", collada("", "1e251")),
            "a.dae:5: <float_array>: the number 1e+251 is not 0 or from 1e-250 to 1e250");
  EXPECT_EQ(complaint("a.dae", collada("", "-1e-400")),
            "a.dae:5: <float_array>: the number -1e-400 is not 0 or from 1e-250 to 1e250");
  EXPECT_EQ(complaint("a.dae", collada("", "-1e-251")),
            "a.dae:5: <float_array>: the number -1e-251 is not 0 or from 1e-250 to 1e250");
  std::string noMesh = collada("");
  const auto at = noMesh.find("<polylist");
  noMesh.erase(at, noMesh.find("<lines") - at);
  EXPECT_EQ(complaint("a.dae", noMesh),
            "a.dae: the mesh has no faces; triangles or polygons are needed, lines and points are "
            "not read");
}

// --- Geometry: what the specification says of the triangle of colladaOf().

/// Returns the area of triangles in the plane z = 0, which must all face upwards.
double areaFromAbove(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vec3 across =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);
    EXPECT_GT(across.z(), 0);
    area += across.z() / 2;
  }
  return area;
}

class ColladaGeometry : public MeshFileTest {
 protected:
  TriangleMesh meshOf(const ColladaParts& parts) const {
    return read("a.dae", colladaOf(parts)).mesh;
  }
  /// Returns where a node moves the corners (0, 0, 0), (1, 0, 0) and (0, 2, 0).
  std::vector<Vec3> moved(const std::string& node) const {
    ColladaParts parts;
    parts.node = node;
    return meshOf(parts).vertices;
  }
  void expectMoved(const std::string& node, const Vec3& a, const Vec3& b, const Vec3& c) const {
    const std::vector<Vec3> corners = moved(node);
    ASSERT_EQ(corners.size(), 3u) << node;
    EXPECT_LT((corners[0] - a).norm() + (corners[1] - b).norm() + (corners[2] - c).norm(), 1e-8)
        << node;
  }
};

TEST_F(ColladaGeometry, InstancesThatBindOtherMaterials) {
  ColladaParts parts;
  parts.array = "count=\"18\">0 0 0 1 0 0 0 1 0 0 0 10 1 0 10 0 1 10";
  parts.accessor = R"(count="6" stride="3")";
  parts.faces =
      R"(<triangles count="1" material="m"><input semantic="VERTEX" source="#v" offset="0"/>
<p>0 1 2</p></triangles><triangles count="1" material="n"><input semantic="VERTEX" source="#v" offset="0"/>
<p>3 4 5</p></triangles>)";
  const auto bound = [](const std::string& x, const std::string& material) {
    return "<node><translate>" + x +
           " 0 0</translate><instance_geometry url=\"#g\"><bind_material>"
           "<technique_common><instance_material symbol=\"m\" target=\"#A\"/><instance_material "
           "symbol=\"n\" target=\"#" +
           material + "\"/></technique_common></bind_material></instance_geometry></node>";
  };
  parts.inScene = bound("3", "B") + bound("6", "C");
  const TriangleMesh mesh = meshOf(parts);
  EXPECT_EQ(mesh.triangles.size(), 6u);
  for (const double x : {0, 3, 6})
    for (const double z : {0, 10})
      for (const Vec3& corner : {Vec3(x, 0, z), Vec3(x + 1, 0, z), Vec3(x, 1, z)})
        EXPECT_THAT(mesh.vertices, testing::Contains(corner));
}

/// Inputs that are not read have offsets, too. Strips and fans keep the side that faces outwards.
TEST_F(ColladaGeometry, InputsThatAreNotRead) {
  ColladaParts parts;
  parts.array = "count=\"12\">0 0 0 4 0 0 4 4 0 0 4 0";
  parts.accessor = R"(count="4" stride="3")";
  for (const std::string semantic : {"UV", "CONTINUITY", "TEXCOORD"})
    for (const auto& [kind, lists] : std::vector<std::pair<std::string, std::string>>{
             {"polygons count=\"1\"", "<p>0 9 1 9 2 9 3 9</p>"},
             {"trifans count=\"1\"", "<p>0 9 1 9 2 9 3 9</p>"},
             {"tristrips count=\"1\"", "<p>0 9 1 9 3 9 2 9</p>"},
             {"tristrips count=\"2\"", "<p>0 9 1 9 3 9</p><p>1 9 2 9 3 9</p>"},
             {"triangles count=\"2\"", "<p>0 9 1 9 2 9 0 9 2 9 3 9</p>"},
             {"polylist count=\"1\"", "<vcount>4</vcount><p>0 9 1 9 2 9 3 9</p>"}}) {
      const std::string name = kind.substr(0, kind.find(' '));
      parts.faces = "<" + kind + R"(><input semantic="VERTEX" source="#v" offset="0"/>)" +
                    "<input semantic=\"" + semantic + R"(" source="#u" offset="1"/>)" + lists +
                    "</" + name + ">";
      const TriangleMesh mesh = meshOf(parts);
      EXPECT_EQ(mesh.triangles.size(), 2u) << parts.faces;
      EXPECT_EQ(areaFromAbove(mesh), 16) << parts.faces;
    }
}

/// A strip around a tetrahedron: every second triangle is turned over.
TEST_F(ColladaGeometry, StripsFaceOutwards) {
  ColladaParts parts;
  parts.array = "count=\"12\">0 0 0 0 1 0 1 0 0 0 0 1";
  parts.accessor = R"(count="4" stride="3")";
  parts.faces = R"(<tristrips count="1"><input semantic="VERTEX" source="#v" offset="0"/>)"
                "<p>0 1 2 3 0 1</p></tristrips>";
  const MeshHealth health = inspectMesh(meshOf(parts));
  ASSERT_TRUE(health.volume);
  EXPECT_NEAR(*health.volume, 1. / 6, 1e-15);
}

TEST_F(ColladaGeometry, StridesAndOffsets) {
  ColladaParts parts;
  parts.array = "count=\"13\">9 9 0 0 0 7 1 0 0 7 0 2 0";
  parts.accessor = R"(count="3" stride="4" offset="2")";
  EXPECT_THAT(meshOf(parts).vertices,
              testing::ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0)));
}

TEST_F(ColladaGeometry, AccessorsOfOtherProgramsAreSkipped) {
  ColladaParts parts;
  parts.inSource = R"(<technique profile="X"><technique_common><accessor source="#pa" count="1" )"
                   R"(stride="1"/></technique_common></technique>)";
  EXPECT_EQ(meshOf(parts).vertices.at(2), Vec3(0, 2, 0));
}

/// The name of a node is not its id.
TEST_F(ColladaGeometry, IdsWithCharacterReferences) {
  for (const auto& [id, url] :
       {std::pair<std::string, std::string>{"A", "&#65;"}, {"&#65;", "A"}, {"A", "&#x41;"}}) {
    ColladaParts parts;
    parts.inScene = R"(<node id="B" name="A"><translate>100 0 0</translate></node><node id=")" +
                    id + R"("><translate>0 5 0</translate><instance_geometry url="#g"/></node>)" +
                    R"(<node><translate>0 0 7</translate><instance_node url="#)" + url +
                    R"("/></node>)";
    EXPECT_THAT(meshOf(parts).vertices, testing::Contains(Vec3(0, 7, 7))) << url;
    EXPECT_EQ(inspectMesh(meshOf(parts)).max, Vec3(1, 7, 7));
  }
}

TEST_F(ColladaGeometry, NumbersAreTheNearestDoubles) {
  for (const std::string word :
       {"340282346638528859811704183484516925440.000000", "200000000000000000000e-20",
        "0.00000000000000002e17", "0.0000000000000001234e20", "-123.456789",
        "1.2246467991473532e-16", "1e-45", "0.10000000000000000555", "123456789012345678",
        "1.1754943508222875e-38", "0.70710678118654752440", "+2.0", "2.", ".2E1", "\n20e-1\t",
        "&#50;", "2<!-- 9 -->", "<![CDATA[2]]>"}) {
    double number = 2;
    if (word.find_first_of("&<") == word.npos) number = std::stod(word);
    ColladaParts parts;
    parts.array = "count=\"9\">0 0 0 1 0 0 0 " + word + " 0";
    EXPECT_EQ(meshOf(parts).vertices.at(2), Vec3(0, number, 0)) << word;
    const std::size_t third = number < 0 ? 1 : 2;  // mirrored triangles are turned around
    EXPECT_EQ(moved("<scale>1 " + word + " 1</scale>").at(third), Vec3(0, 2 * number, 0)) << word;
  }
}

TEST_F(ColladaGeometry, CommentsDoNotEndNumbers) {
  ColladaParts parts;
  parts.array = "count=\"9\">0 0 0 1 <!-- 7 --> 0 0 <![CDATA[0]]> 2 0";
  EXPECT_EQ(meshOf(parts).vertices.at(2), Vec3(0, 2, 0));
  parts.array = "count=\"9\">0 0 0 1<!-- 7 -->0 0 0 2 0";
  EXPECT_NE(complaint("a.dae", colladaOf(parts)), "no complaint") << "the numbers are joined";
}

TEST_F(ColladaGeometry, RotationsByAxesOfAnyLength) {
  expectMoved("<rotate>0 0 10 90</rotate>", {0, 0, 0}, {0, 1, 0}, {-2, 0, 0});
  expectMoved("<rotate>0 0 1e-200 90</rotate>", {0, 0, 0}, {0, 1, 0}, {-2, 0, 0});
  expectMoved("<rotate>0.7071 0.7071 0 180</rotate>", {0, 0, 0}, {0, 1, 0}, {2, 0, 0});
  expectMoved("<rotate>0.57735 0.57735 0.57735 120</rotate>", {0, 0, 0}, {0, 1, 0}, {0, 0, 2});
  expectMoved("<rotate>0 0 1 360180</rotate>", {0, 0, 0}, {-1, 0, 0}, {0, -2, 0});
  for (const std::string axis : {"0 0 10", "0 0 0"})
    EXPECT_EQ(moved("<rotate>" + axis + " 0</rotate>").at(2), Vec3(0, 2, 0)) << axis;
}

TEST_F(ColladaGeometry, TransformsApplyFromTheLastToTheFirst) {
  expectMoved("<scale>1e6 1 1</scale><rotate>0 0 1 90</rotate><scale>1 1e-6 1</scale>", {0, 0, 0},
              {0, 1, 0}, {-2, 0, 0});
  expectMoved(
      "<translate>1 2 3</translate><rotate>0 0 1 90</rotate><translate>-1 -2 -3</translate>",
      {3, 1, 0}, {3, 2, 0}, {1, 1, 0});
  // Rows: x' = 5 - y, y' = 6 + x.
  const std::string matrix = "<matrix>0 -1 0 5 1 0 0 6 0 0 1 7 0 0 0 1</matrix>";
  EXPECT_THAT(moved(matrix), testing::ElementsAre(Vec3(5, 6, 7), Vec3(5, 7, 7), Vec3(3, 6, 7)));
  EXPECT_THAT(moved(matrix + matrix),
              testing::ElementsAre(Vec3(-1, 11, 14), Vec3(-2, 11, 14), Vec3(-1, 9, 14)));
  // A child is in the frame of its parent.
  EXPECT_EQ(moved("<translate>10 0 0</translate><node><scale>2 2 2</scale><translate>0 0 4"
                  "</translate><instance_geometry url=\"#g\"/></node>")
                .at(2),
            Vec3(10, 4, 8))
      << "the inner node comes first";
}

/// Lengths that cancel in doubles to far below the mesh's size.
TEST_F(ColladaGeometry, LengthsThatCancel) {
  expectMoved("<translate>5000000.3 0 0</translate><translate>-5000000 0 0</translate>",
              {0.3, 0, 0}, {1.3, 0, 0}, {0.3, 2, 0});
  expectMoved("<translate>100000000 0 0</translate><translate>-99999998 0 0</translate>", {2, 0, 0},
              {3, 0, 0}, {2, 2, 0});
  expectMoved("<scale>.5 1 1</scale><translate>1e9 0 0</translate><translate>-1e9 0 0</translate>",
              {0, 0, 0}, {0.5, 0, 0}, {0, 2, 0});
  expectMoved(
      "<scale>1e-46 1e-46 1e-46</scale><scale>1e38 1e38 1e38</scale><scale>1e8 1e8 1e8</scale>",
      {0, 0, 0}, {1, 0, 0}, {0, 2, 0});
}

TEST_F(ColladaGeometry, LengthsWhoseRoundingIsLarge) {
  const auto parts = [](const std::string& length) {
    ColladaParts all;
    all.node =
        "<translate>" + length + " 0 0</translate><translate>-" + length + " 0 0</translate>";
    return colladaOf(all);
  };
  const std::string moves = "the transforms of its nodes may round a mesh by ";
  EXPECT_THAT(read("a.dae", parts("1e9")).notes, testing::IsEmpty());
  EXPECT_THAT(read("a.dae", parts("1e11")).notes,
              testing::ElementsAre(testing::AllOf(
                  testing::StartsWith(moves), testing::EndsWith("more than 1e-4 of its size"))));
  for (const std::string length : {"1e13", "1e17", "1e200"})
    EXPECT_THAT(complaint("a.dae", parts(length)),
                testing::AllOf(testing::StartsWith("a.dae: " + moves),
                               testing::EndsWith("more than a hundredth of its size; move it to "
                                                 "the origin of its file")));
}

TEST_F(ColladaGeometry, NodesThatContainThemselves) {
  const auto fault = [&](const std::string& nodes) {
    ColladaParts parts;
    parts.libraries = "<library_nodes>" + nodes + "</library_nodes>";
    parts.node = "<instance_node url=\"#a0\"/>";
    return complaint("a.dae", colladaOf(parts));
  };
  const auto twice = [](const std::string& id, const std::string& of) {
    return "<node id=\"" + id + "\"><instance_node url=\"#" + of + "\"/><instance_node url=\"#" +
           of + "\"/></node>";
  };
  const std::string deep = "a.dae: nodes nest deeper than 500, or a node contains itself";
  EXPECT_EQ(fault(twice("a0", "a0")), deep);
  EXPECT_EQ(fault(twice("a0", "b") + twice("b", "a0")), deep);
  std::string chain;  // 2^40 instances of a node
  for (int i = 0; i < 40; ++i) chain += twice("a" + std::to_string(i), "a" + std::to_string(i + 1));
  EXPECT_THAT(fault(chain + "<node id=\"a40\"/>"),
              testing::EndsWith("instances of nodes; save the mesh as one"));
  std::string children;
  for (int i = 0; i < 1000; ++i) children += "<translate>0 0 0</translate>";
  chain = "<node id=\"a11\">" + children + "</node>";
  for (int i = 0; i < 11; ++i) chain += twice("a" + std::to_string(i), "a" + std::to_string(i + 1));
  EXPECT_EQ(fault(chain),
            "a.dae: the instances of nodes have more than 2000000 children; save the mesh as one");
}

}  // namespace
}  // namespace corridor::test
