// What mesh files hold beyond the triangles that are read: it is a fault or a note, and is never
// dropped in silence.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

const std::string instead = "; save the mesh as OBJ, STL, PLY or OFF";
const std::string linesNote = "lines and points have no volume, and are not read";

std::string notRight(const std::string& element) {
  return "<" + element + "> may be or move geometry, and assimp does not read it rightly" + instead;
}

class MeshContent : public MeshFileTest {
 protected:
  /// Returns the complaint on a file after its first `words`, which it must begin with.
  std::string after(const std::string& words, const std::string& name, const std::string& bytes) {
    const std::string text = complaint(name, bytes);
    EXPECT_THAT(text, StartsWith(words)) << bytes;
    return text.substr(std::min(words.size(), text.size()));
  }
  std::vector<std::string> notesOf(const std::string& name, const std::string& bytes) {
    return read(name, bytes).notes;
  }
};

// --- glTF: the buffer holds the corners (0, 0, 0), (1, 0, 0) and (0, 2, 0) as floats.

class Gltf : public MeshContent {
 protected:
  void SetUp() override {
    std::string numbers;
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) numbers += bytesOf(x);
    write("a.bin", numbers);
  }
  std::string fault(const std::string& text) { return after("a.gltf: ", "a.gltf", text); }
};

/// Returns a glTF file. @param more members of the root, each with a comma before it. @param nodes
/// the nodes, of which the first is in the scene. @param primitive members of the primitive.
std::string gltf(const std::string& more = "", const std::string& nodes = R"({"mesh": 0})",
                 const std::string& primitive = "", const std::string& type = "5126") {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}, {"nodes": [1]}],
"nodes": [)" +
         nodes + R"(], "meshes": [{"primitives": [{"attributes": {"POSITION": 0})" + primitive +
         R"(}]}], "buffers": [{"uri": "a.bin", "byteLength": 36}],
"bufferViews": [{"buffer": 0, "byteLength": 36}],
"accessors": [{"bufferView": 0, "componentType": )" +
         type + R"(, "count": 3, "type": "VEC3"}])" + more + "}";
}

TEST_F(Gltf, RequiredExtensions) {
  for (const std::string name :
       {"KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "EXT_meshopt_compression",
        "KHR_draco_mesh_compression", "FOO_bar"}) {
    const std::string list = "[\"KHR_materials_unlit\", \"" + name + "\"]";
    EXPECT_EQ(fault(gltf(", \"extensionsUsed\": " + list + ", \"extensionsRequired\": " + list)),
              "the required extension \"" + name + "\" is not supported; save the mesh without it");
  }
}

TEST_F(Gltf, OptionalExtensions) {
  const std::string instancing =
      "the extension \"EXT_mesh_gpu_instancing\" moves, copies or packs geometry, and is not "
      "supported; save the mesh without it";
  EXPECT_EQ(fault(gltf(R"(, "extensionsUsed": ["EXT_mesh_gpu_instancing"])")), instancing);
  EXPECT_THAT(fault(gltf(R"(, "extensionsUsed": ["CESIUM_RTC"])")),
              StartsWith("the extension \"CESIUM_RTC\" moves, copies or packs geometry"));
  // The list at the root is optional for the reader: the node counts.
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {}}})")),
            instancing);
  EXPECT_THAT(notesOf("a.gltf", gltf(R"(, "extensionsUsed": ["FOO_bar", "KHR_materials_unlit"])")),
              ElementsAre("the optional extension \"FOO_bar\" is not read"));
  const std::string looks =
      R"(["KHR_texture_transform", "KHR_lights_punctual", "EXT_texture_webp", "MSFT_lod"])";
  EXPECT_THAT(notesOf("a.gltf",
                      gltf(", \"extensionsUsed\": " + looks + ", \"extensionsRequired\": " + looks +
                           R"(, "extras": {"extensions": {"EXT_mesh_x": 1}})")),
              IsEmpty());
}

TEST_F(Gltf, ExtensionsOfBinaryFiles) {
  const auto binary = [](std::string json) {
    json.erase(json.find("\"uri\": \"a.bin\", "), 16);
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const auto size = static_cast<std::uint32_t>(json.size());
    std::string corners;
    for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) corners += bytesOf(x);
    return "glTF" + bytesOf(std::uint32_t{2}) + bytesOf(size + 64) + bytesOf(size) + "JSON" + json +
           bytesOf(std::uint32_t{36}) + std::string("BIN\0", 4) + corners;
  };
  EXPECT_EQ(read("a.glb", binary(gltf())).mesh.triangles.size(), 1u);
  EXPECT_EQ(complaint("a.glb", binary(gltf(R"(, "extensionsRequired": ["FOO_bar"])"))),
            "a.glb: the required extension \"FOO_bar\" is not supported; save the mesh without it");
}

TEST_F(Gltf, SkinsAndMorphTargets) {
  EXPECT_EQ(fault(gltf(R"(, "skins": [{"joints": [0]}])", R"({"mesh": 0, "skin": 0})")),
            "a node has a skin, whose joints move its vertices, which is not supported; save the "
            "mesh in its pose, without a skin");
  const std::string morph =
      "morph targets have weights other than 0, which is not supported; save the mesh in its "
      "shape, without morph targets";
  const std::string target = R"(, "targets": [{"POSITION": 0}])";
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "weights": [0.5]})", target)), morph);
  std::string ofMesh = gltf("", R"({"mesh": 0})", target);
  ofMesh.insert(ofMesh.find("\"primitives\""), "\"weights\": [1], ");
  EXPECT_EQ(fault(ofMesh), morph);
  EXPECT_EQ(complaint("a.gltf", gltf("", R"({"mesh": 0, "weights": [0.0]})", target)),
            "no complaint");
}

TEST_F(Gltf, PositionsThatAreNoFloats) {
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0})", "", "5122")),
            "positions are not stored as floats, which is not supported; save them as floats");
}

TEST_F(Gltf, VerticesThatMakeNoTriangle) {
  std::string text = gltf();
  text.replace(text.find("\"count\": 3"), 10, "\"count\": 2");
  EXPECT_EQ(fault(text), "assimp leaves out geometry: TRIANGLES mode. Some vertices were dropped.");
  const std::string alsoLines = R"(}, {"attributes": {"POSITION": 0}, "mode": 1)";
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"mesh": 0})", alsoLines)), ElementsAre(linesNote));
}

TEST_F(Gltf, MeshesOutsideTheSceneAreNoted) {
  const std::string outside = "meshes outside the file's default scene are not read";
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"mesh": 0}, {"mesh": 0})")), ElementsAre(outside));
  std::string without = gltf("", R"({"mesh": 0}, {"mesh": 0})");
  without.erase(without.find("\"scene\": 0, "), 12);
  EXPECT_THAT(notesOf("a.gltf", without), ElementsAre(outside));
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"children": [2]}, {"name": "camera"}, {"mesh": 0})")),
              IsEmpty());
}

TEST_F(Gltf, KeysThatParsersTakeDifferently) {
  EXPECT_EQ(fault(gltf(R"(, "extras": 1, "extras": 2)")), "an object has a key twice: \"extras\"");
  const std::string text = gltf();
  EXPECT_EQ(fault(text + "x"), "no valid JSON at byte " + std::to_string(text.size() + 1));
}

TEST_F(Gltf, OtherFilesAreListed) {
  EXPECT_THAT(read("a.gltf", gltf()).otherFiles, ElementsAre((folder_ / "a.bin").string()));
  EXPECT_THAT(readOmplAppMesh(folder_ / "a.gltf").otherFiles,
              ElementsAre((folder_ / "a.bin").string()));
}

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
    EXPECT_EQ(complaint("a.x3d", unit(category, "0.001")),
              "a.x3d:2: the file's unit of " + category +
                  " is not applied; store metres and radians, without <unit>");
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

TEST_F(MeshContent, FbxSurfacesThatAreNoPolygons) {
  const auto fbx = [](const std::string& ofSecond) {
    return R"(; FBX 7.3.0 project file
FBXHeaderExtension: {
 FBXVersion: 7300
}
Definitions: {
 Version: 100
}
Objects: {
 Geometry: 1, "Geometry::a", "Mesh" {
  Vertices: *9 {
   a: 0,0,0,1,0,0,0,2,0
  }
  PolygonVertexIndex: *3 {
   a: 0,1,-3
  }
 }
 Geometry: 2, "Geometry::b", "NurbsSurface" {
  Version: 100
 }
 Model: 3, "Model::a", "Mesh" {
  Version: 232
 }
 Model: 4, "Model::b", "Mesh" {
  Version: 232
 }
}
Connections: {
 C: "OO",3,0
 C: "OO",4,0
 C: "OO",1,3
 C: "OO",)" +
           ofSecond + ",4\n}\n";
  };
  EXPECT_THAT(notesOf("a.fbx", fbx("2")),
              ElementsAre("parts that are no polygons, such as NURBS surfaces, are not read"));
  EXPECT_THAT(notesOf("a.fbx", fbx("1")), IsEmpty());
}

/// assimp reads the first model only, and drops objects that it takes from others by `p:path`.
TEST_F(MeshContent, ThreeMfOfSeveralModels) {
  const auto entry = [](const std::string& name) {
    std::string bytes = "PK\x01\x02" + std::string(42, '\0') + name;
    bytes[28] = static_cast<char>(name.size());
    return bytes;
  };
  const std::string one = entry("[Content_Types].xml") + entry("3D/3dmodel.model");
  EXPECT_EQ(complaint("a.3mf", one + entry("3D/Objects/o.MODEL"), {1, {}}),
            "a.3mf: the archive has 2 models, of which assimp reads one" + instead);
  EXPECT_THAT(complaint("a.3mf", one, {1, {}}), StartsWith("a.3mf: cannot be read by assimp"));
}

// --- Corridor's own readers

TEST_F(MeshContent, ObjKeywords) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  for (const std::string line :
       {"fo 1 2 3", "F 1 2 3", "V 1 2 3", "surf 0 1 0 1 1 2 3", "curv 0 1 1 2", "call other.obj",
        "bzp 1 2 3 4", "csh -x", "hello"}) {
    const std::string keyword = line.substr(0, line.find(' '));
    EXPECT_EQ(complaint("a.obj", triangle + line + "\n"),
              "a.obj:5: the keyword \"" + keyword +
                  "\" is not supported, and may be or move geometry; write faces with v and f");
  }
  EXPECT_THAT(notesOf("a.obj", triangle + "vn 0 0 1\nvt 0 0\nvp 0\ng a\no b\ns 1\nmg 0\nusemtl m\n"
                                          "mtllib none.mtl\nlod 1\ntrace_obj x\n # f 9\n\n"),
              IsEmpty());
  EXPECT_THAT(notesOf("a.obj", triangle + "l 1 2\nl 2 3\n"), ElementsAre(linesNote));
  EXPECT_THAT(notesOf("a.obj", triangle + "p 1\n"), ElementsAre(linesNote));
}

TEST_F(MeshContent, PlyStrips) {
  const auto ply = [](const std::string& count) {
    return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
           "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
           "element tristrips " +
           count +
           "\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n" +
           (count == "0" ? "" : "3 0 1 2\n");
  };
  EXPECT_EQ(complaint("a.ply", ply("1")),
            "a.ply: element \"tristrips\" is not read, and may hold triangles; save the mesh with "
            "polygons only");
  EXPECT_EQ(complaint("a.ply", ply("0")), "no complaint");
}

}  // namespace
}  // namespace corridor::test::mesh_content
