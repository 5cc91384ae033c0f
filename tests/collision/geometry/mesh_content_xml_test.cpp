// What Collada, X3D and AMF files hold beyond the triangles that are read.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using testing::StartsWith;

// --- Collada

/// Returns a Collada file of the triangle (0, 0, 0), (1, 0, 0), (0, 2, 0). The places: the content
/// of the node, the primitives, and further libraries, which begin in line 3.
std::string collada(const std::string& node = "", const std::string& primitives = "",
                    const std::string& libraries = "") {
  return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset/>
)" + libraries +
         R"(
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)" +
         primitives +
         R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node id="n"><instance_geometry url="#g"/>)" +
         node + R"(</node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshContent, ColladaElements) {
  EXPECT_EQ(complaint("a.dae", collada()), "no complaint");
  EXPECT_EQ(complaint("a.dae", collada("<instance_controller url=\"#c\"/>")),
            "a.dae:8: " + notRight("instance_controller"));
  EXPECT_EQ(complaint("a.dae", collada("<node><skew>45 0 1 0 1 0 0</skew></node>")),
            "a.dae:8: " + notRight("skew"));
  EXPECT_EQ(complaint("a.dae", collada("<!-- <skew> -->")), "no complaint");
  EXPECT_EQ(
      complaint("a.dae", collada("", "<polygons count=\"1\"><ph><p>0 1 2</p></ph></polygons>")),
      "a.dae:6: " + notRight("ph"));
  for (const std::string name : {"convex_mesh", "brep"})
    EXPECT_EQ(complaint("a.dae", collada("", "",
                                         "<library_geometries><geometry id=\"h\"><" + name +
                                             "/></geometry></library_geometries>")),
              "a.dae:2: " + notRight(name));
}

TEST_F(MeshContent, ColladaReferences) {
  EXPECT_EQ(complaint("a.dae", collada("<instance_node url=\"other.dae#x\"/>")),
            "a.dae: assimp leaves out geometry: Unresolved reference format of node");
  EXPECT_EQ(complaint("a.dae", collada("<instance_node url=\"#x\"/>")),
            "a.dae: assimp leaves out geometry: Unable to resolve reference to instanced node x");
  EXPECT_EQ(complaint("a.dae", collada("<instance_node url=\"#" + std::string(2000, 'x') + "\"/>")),
            "a.dae: assimp leaves out geometry: long message discarded>");
  EXPECT_THAT(
      complaint("a.dae", collada("<instance_geometry url=\"#x\"/>")),
      StartsWith("a.dae: assimp leaves out geometry: Unable to find geometry for ID \"x\""));
  EXPECT_THAT(complaint("a.dae", collada("<instance_geometry url=\"other.dae#g\"/>")),
              StartsWith("a.dae: cannot be read by assimp: "));
  EXPECT_EQ(complaint("a.dae", collada("", "",
                                       "<library_geometries><geometry id=\"g\"/>"
                                       "</library_geometries>")),
            "a.dae:3: two elements <geometry> have the id \"g\", so assimp drops one; give each an "
            "id of its own");
}

/// assimp takes the last of two nodes with one id, and a node's name before another one's id.
TEST_F(MeshContent, ColladaIdsAndNamesOfNodes) {
  EXPECT_EQ(
      complaint("a.dae", collada("<node id=\"a\"/><node id=\"a\"/>")),
      "a.dae:8: two elements <node> have the id \"a\", so assimp drops one; give each an id of "
      "its own");
  const std::string instance = "<instance_node url=\"#a\"/>";
  EXPECT_EQ(complaint("a.dae", collada("<node id=\"a\" name=\"a\"/><node>" + instance + "</node>")),
            "no complaint");
  EXPECT_EQ(complaint("a.dae", collada("<node id=\"b\" name=\"a\"/><node id=\"a\"/><node>" +
                                       instance + "</node>")),
            "a.dae:8: the name of this <node> is the id that an <instance_node> asks for; give the "
            "node another name");
}

TEST_F(MeshContent, LinesAreNoted) {
  EXPECT_THAT(notesOf("a.dae", collada()), IsEmpty());
  EXPECT_THAT(notesOf("a.dae", collada("",
                                       "<lines count=\"1\"><input semantic=\"VERTEX\" "
                                       "source=\"#v\" offset=\"0\"/><p>0 1</p></lines>")),
              ElementsAre(linesNote));
}

// --- X3D

std::string x3d(const std::string& scene, const std::string& head = "") {
  return "<?xml version=\"1.0\"?>\n<X3D profile='Interchange' version='3.3'>" + head + "<Scene>\n" +
         scene + "</Scene></X3D>";
}
const std::string oneShape =
    "<Shape><Appearance><Material/></Appearance><IndexedFaceSet coordIndex='0 1 2 -1'>"
    "<Coordinate point='0 0 0 1 0 0 0 2 0'/></IndexedFaceSet></Shape>";

TEST_F(MeshContent, X3dNodes) {
  EXPECT_EQ(complaint("a.x3d", x3d(oneShape)), "no complaint");
  for (const std::string name :
       {"LOD", "Collision", "Anchor", "Billboard", "CADPart", "CADAssembly", "CADLayer", "CADFace",
        "Switch", "ProtoInstance", "ProtoDeclare", "GeoTransform", "HAnimHumanoid"})
    EXPECT_EQ(complaint("a.x3d", x3d(oneShape + "\n<" + name + ">" + oneShape + "</" + name + ">")),
              "a.x3d:4: " + notRight(name));
  for (const std::string name : {"NurbsPatchSurface", "Sphere", "Cylinder", "Cone", "Disk2D",
                                 "Text", "Extrusion", "QuadSet"})
    EXPECT_EQ(complaint("a.x3d", x3d(oneShape + "<Shape>\n<" + name + "/></Shape>")),
              "a.x3d:4: " + notRight(name));
  EXPECT_EQ(complaint("a.x3d", x3d("<Viewpoint/><NavigationInfo/><Background/><WorldInfo/>"
                                   "<DirectionalLight/><!-- <LOD> -->" +
                                   oneShape)),
            "no complaint");
  EXPECT_THAT(complaint("a.x3d", "<!DOCTYPE X3D [<!ENTITY a \"<!--\">]>" + x3d(oneShape)),
              HasSubstr("a DOCTYPE with declarations is not read; save the file without it"));
}

TEST_F(MeshContent, X3dUnits) {
  const auto unit = [](const std::string& category, const std::string& factor) {
    return x3d(oneShape, "<head><unit category='" + category + "' name='u' conversionFactor='" +
                             factor + "'/></head>");
  };
  for (const std::string category : {"length", "angle"}) {
    for (const std::string factor : {"0.001", "1,5", "1 000"})
      EXPECT_EQ(complaint("a.x3d", unit(category, factor)),
                "a.x3d:2: the file's unit of " + category +
                    " is not applied; store metres and radians, without <unit>")
          << factor;
    EXPECT_EQ(complaint("a.x3d", unit(category, "1.0")), "no complaint");
  }
  EXPECT_EQ(complaint("a.x3d", unit("mass", "0.001")), "no complaint");
}

TEST_F(MeshContent, X3dGroupsThatMisplaceWhatFollows) {
  for (const std::string name : {"Group", "StaticGroup", "Transform"}) {
    const std::string text = "a.x3d:3: assimp misplaces what comes after a <" + name +
                             "> that is empty or has USE" + instead;
    const auto moved = [&](const std::string& group) {
      return x3d("<Transform translation='5 0 0'>" + group + oneShape + "</Transform>");
    };
    EXPECT_EQ(complaint("a.x3d", moved("<" + name + "/>")), text);
    EXPECT_EQ(complaint("a.x3d", moved("<" + name + "></" + name + ">")), text);
    EXPECT_EQ(complaint("a.x3d", moved("<" + name + " DEF='a'>" + oneShape + "</" + name + "><" +
                                       name + " USE='a'/>")),
              text);
    const MeshFile file = read("a.x3d", moved("<" + name + " DEF = \"U\" bboxSize='1 1 1'>" +
                                              oneShape + "</" + name + ">"));
    EXPECT_EQ(file.mesh.triangles.size(), 2u);
    for (const Vec3& p : file.mesh.vertices) EXPECT_GE(p.x(), 5) << name;
  }
}

/// Each kind of shape that is accepted gives the triangles that its coordinates say.
TEST_F(MeshContent, X3dShapesThatAreRead) {
  const std::string points = "<Coordinate point='0 0 0 1 0 0 0 2 0 0 0 3'/>";
  const auto corners = [&](const std::string& geometry) {
    const TriangleMesh mesh = read("a.x3d", x3d("<Shape>" + geometry + "</Shape>")).mesh;
    std::vector<std::vector<double>> all;
    for (const auto& triangle : mesh.triangles)
      for (const std::uint32_t i : triangle)
        all.push_back({mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z()});
    return all;
  };
  const std::vector<double> o{0, 0, 0}, x{1, 0, 0}, y{0, 2, 0}, z{0, 0, 3};
  EXPECT_THAT(
      corners("<IndexedTriangleSet index='0 1 2 3 2 1'>" + points + "</IndexedTriangleSet>"),
      testing::UnorderedElementsAre(o, x, y, z, y, x));
  EXPECT_THAT(
      corners("<IndexedTriangleFanSet index='0 1 2 3 -1'>" + points + "</IndexedTriangleFanSet>"),
      testing::UnorderedElementsAre(o, x, y, o, y, z));
  EXPECT_THAT(corners("<TriangleSet><Coordinate point='0 0 0 1 0 0 0 2 0'/></TriangleSet>"),
              testing::UnorderedElementsAre(o, x, y));
  EXPECT_THAT(
      corners("<IndexedFaceSet coordIndex='0 1 2 -1 1 3 2'>" + points + "</IndexedFaceSet>"),
      testing::UnorderedElementsAre(o, x, y, x, z, y));
  const auto grid = corners(
      "<ElevationGrid xDimension='2' zDimension='2' xSpacing='1' "
      "zSpacing='3' height='0 0 0 7'/>");
  EXPECT_EQ(grid.size(), 6u);
  for (const std::vector<double>& corner :
       std::vector<std::vector<double>>{{0, 0, 0}, {1, 0, 0}, {0, 0, 3}, {1, 7, 3}})
    EXPECT_THAT(grid, testing::Contains(corner));
  // Looks beside the coordinates change nothing.
  for (const std::string looks :
       {"<TextureCoordinateGenerator mode='SPHERE'/>", "<FogCoordinate depth='0 1 2'/>"}) {
    EXPECT_THAT(corners("<IndexedFaceSet coordIndex='0 1 2 -1 1 3 2'>" + looks + points +
                        "</IndexedFaceSet>"),
                testing::UnorderedElementsAre(o, x, y, x, z, y));
    EXPECT_THAT(corners("<IndexedTriangleSet index='0 1 2 3 2 1'>" + points + looks +
                        "</IndexedTriangleSet>"),
                testing::UnorderedElementsAre(o, x, y, z, y, x));
  }
  const auto box = corners("<Box size='2 4 6'/>");
  EXPECT_EQ(box.size(), 36u);
  for (const double sx : {-1., 1.})
    for (const double sy : {-2., 2.})
      for (const double sz : {-3., 3.})
        EXPECT_THAT(box, testing::Contains(std::vector<double>{sx, sy, sz}));
  EXPECT_THAT(notesOf("a.x3d", x3d(oneShape + "<Shape><IndexedLineSet coordIndex='0 1 -1'>" +
                                   points + "</IndexedLineSet></Shape>")),
              ElementsAre(linesNote));
}

TEST_F(MeshContent, X3dInlines) {
  const std::string outer = x3d(oneShape + "<Inline url='o.x3d'/>");
  write("o.x3d", x3d("<Transform translation='5 0 0'>" + oneShape + "</Transform>"));
  const MeshFile file = read("a.x3d", outer);
  EXPECT_EQ(file.mesh.triangles.size(), 2u);
  EXPECT_THAT(file.otherFiles, ElementsAre((folder_ / "o.x3d").string()));
  write("o.x3d", x3d("<LOD>" + oneShape + "</LOD>"));
  EXPECT_EQ(complaint("a.x3d", outer), "o.x3d:3: " + notRight("LOD"));
  // assimp reads such a file as an empty one.
  for (const std::string& broken : {x3d(oneShape + "<Group>"), std::string("#VRML V2.0 utf8\n")}) {
    write("o.x3d", broken);
    EXPECT_EQ(complaint("a.x3d", outer), "o.x3d: no complete XML file whose root is <X3D>");
  }
}

// --- AMF

std::string amf(const std::string& id, const std::string& more = "") {
  return "<?xml version=\"1.0\"?>\n<amf unit=\"meter\"><object id=\"" + id +
         "\"><mesh><vertices>"
         "<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>"
         "<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>"
         "<vertex><coordinates><x>0</x><y>2</y><z>0</z></coordinates></vertex></vertices>"
         "<volume><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume></mesh></object>\n" +
         more + "</amf>";
}

TEST_F(MeshContent, Amf) {
  const MeshFileOptions metres{1, {}};
  EXPECT_EQ(read("a.amf", amf("0"), metres).mesh.triangles.size(), 1u);
  EXPECT_EQ(complaint("a.amf",
                      amf("0",
                          "<constellation id=\"1\"><instance objectid=\"0\">"
                          "<deltax>4</deltax></instance></constellation>"),
                      metres),
            "a.amf:3: " + notRight("constellation"));
  std::string other = amf("0");
  other = other.substr(other.find("<object"));
  EXPECT_EQ(complaint("a.amf", amf("0", other.substr(0, other.find("</amf>"))), metres),
            "a.amf:3: two elements <object> have the id \"0\", so assimp drops one; give each an "
            "id of its own");
}

TEST_F(MeshContent, UnitOfAmf) {
  const auto notes = [&](double given, const std::string& unit) {
    std::string text = amf("0");
    text.replace(text.find("unit=\"meter\""), 12, unit);
    return read("a.amf", text, {given, {}}).notes;
  };
  const std::vector<std::pair<std::string, double>> units{
      {"millimeter", 0.001}, {"inch", 0.0254}, {"feet", 0.3048}, {"meter", 1}, {"micron", 1e-6}};
  for (const auto& [name, metres] : units) {
    EXPECT_THAT(notes(metres, "unit=\"" + name + "\""), IsEmpty());
    EXPECT_THAT(notes(2, "unit=\"" + name + "\""), SizeIs(1)) << name;
  }
  EXPECT_THAT(notes(1, "unit=\"millimeter\""),
              ElementsAre("the file's own unit, 0.001 m, is not the stated one, 1 m, which is "
                          "used"));
  // Without a unit, it is the millimetre; assimp ignores the case of letters.
  for (const std::string unit : {"", "unit=\"Millimeter\"", "unit=\"millimeters\""}) {
    EXPECT_THAT(notes(1, unit), SizeIs(1)) << unit;
    EXPECT_THAT(notes(0.001, unit), IsEmpty()) << unit;
  }
}

}  // namespace
}  // namespace corridor::test::mesh_content
