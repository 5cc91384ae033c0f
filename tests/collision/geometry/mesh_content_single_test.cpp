// What mesh files state twice, elsewhere, or in other words than assimp reads.
#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;

// --- Collada

/// Returns a Collada file. @param asset the content of the document's <asset>. @param places texts
/// for inner places: a geometry, its library, the node, the scene.
std::string colladaWith(const std::string& asset, const std::vector<std::string>& places = {},
                        const std::string& libraries = "") {
  const auto at = [&](std::size_t i) { return i < places.size() ? places[i] : ""; };
  return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1"><asset>)" +
         asset + "</asset>" + libraries + "<library_geometries>" + at(1) + R"(<geometry id="g">)" +
         at(0) +
         R"(<mesh><source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 2 0</float_array>
<technique_common><accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s">)" +
         at(3) + R"(<node id="n">)" + at(2) +
         R"(<instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)";
}

TEST_F(MeshContent, ColladaAssetsWithin) {
  const auto fault = [&](const std::string& outer, const std::string& inner, std::size_t place) {
    std::vector<std::string> places(4);
    places[place] = "<asset>" + inner + "</asset>";
    const std::string text = complaint("a.dae", colladaWith(outer, places));
    const auto colon = text.find(": ");
    return colon == text.npos ? text : text.substr(colon + 2);
  };
  const auto text = [](const std::string& name) {
    return "an <asset> within the document has another <" + name +
           "> than the document, which assimp does not apply" + instead;
  };
  const std::string mm = R"(<unit name="mm" meter="0.001"/>)", z = "<up_axis>Z_UP</up_axis>";
  for (std::size_t place = 0; place < 4; ++place) {
    EXPECT_EQ(fault("", mm, place), text("unit"));
    EXPECT_EQ(fault(mm, "<unit/>", place), text("unit")) << "1 m by the specification";
    EXPECT_EQ(fault("", z, place), text("up_axis"));
    EXPECT_EQ(fault(mm + z, "<unit meter=\"1e-3\"></unit><up_axis> Z_UP </up_axis>", place),
              "no complaint");
    EXPECT_EQ(fault(mm + z, "<created>2020</created>", place), "no complaint");
  }
}

TEST_F(MeshContent, ColladaGeometryThatIsNotInstanced) {
  const std::string unused = "geometries that are in no node of the scene are not read";
  EXPECT_THAT(notesOf("a.dae", colladaWith("")), IsEmpty());
  EXPECT_THAT(notesOf("a.dae", colladaWith("", {"", "<geometry id=\"h\"><mesh/></geometry>"})),
              ElementsAre(unused));
  EXPECT_THAT(
      notesOf("a.dae", colladaWith("", {},
                                   "<library_nodes><node id=\"m\"><instance_geometry url=\"#g\"/>"
                                   "</node></library_nodes>")),
      ElementsAre(unused));
  EXPECT_THAT(
      notesOf("a.dae", colladaWith("", {"", "", "<instance_node url=\"#m\"/>"},
                                   "<library_nodes><node id=\"m\"><instance_geometry url=\"#g\"/>"
                                   "</node></library_nodes>")),
      IsEmpty());
}

// --- glTF

TEST_F(MeshContent, GltfNamesWithBytesInHexadecimal) {
  std::string numbers;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) numbers += bytesOf(x);
  const auto gltf = [](const std::string& uri) {
    return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"buffers": [{"uri": ")" +
           uri + R"(", "byteLength": 36}], "bufferViews": [{"buffer": 0, "byteLength": 36}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}]})";
  };
  write("a b.bin", numbers);
  const MeshFile file = read("a.gltf", gltf("a%20b.b%69n"));
  EXPECT_EQ(file.mesh.vertices.at(2), Vec3(0, 2, 0));
  EXPECT_THAT(file.otherFiles, ElementsAre((folder_ / "a b.bin").string()));
  write("a%2b.bin", numbers);
  EXPECT_THAT(read("a.gltf", gltf("a%2b.bin")).otherFiles,
              ElementsAre((folder_ / "a%2b.bin").string()));
  // Where both names exist, the format's rule counts.
  write("a+.bin", numbers);
  EXPECT_THAT(read("a.gltf", gltf("a%2b.bin")).otherFiles,
              ElementsAre((folder_ / "a+.bin").string()));
  // Names of folders are not encoded.
  std::filesystem::create_directories(folder_ / "b%20c");
  std::filesystem::create_directories(folder_ / "b c");
  write("b%20c/a.bin", numbers);
  write("b c/a.bin", "");
  EXPECT_THAT(read("b%20c/a.gltf", gltf("a.bin")).otherFiles,
              ElementsAre((folder_ / "b%20c/a.bin").string()));
  EXPECT_THAT(complaint("a.gltf", gltf("%zz.bin")), HasSubstr("cannot be read by assimp"));
}

// --- Corridor's own readers

std::string ply(const std::string& element, const std::string& property, const std::string& list) {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\n" +
         list + (element.empty() ? "" : "element " + element + " 1\nproperty " + property + "\n") +
         "end_header\n0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n" + (list.empty() ? "" : "1 7\n") +
         (element.empty() ? "" : "1 7\n");
}

TEST_F(MeshContent, PlyElementsThatMayHoldTriangles) {
  const std::string list = "list uchar int numbers";
  for (const auto& [element, property] : {std::pair<std::string, std::string>{"polygon", list},
                                          {"Triangles", list},
                                          {"faces", list},
                                          {"tristrips", list},
                                          {"patch", list},
                                          {"edge", "list uchar int vertex_index"}})
    EXPECT_EQ(complaint("a.ply", ply(element, property, "")),
              "a.ply: element \"" + element +
                  "\" is not read, and may hold triangles; save the mesh with polygons only");
  for (const auto& [element, property] : {std::pair<std::string, std::string>{"edge", list},
                                          {"material", list},
                                          {"camera", list},
                                          {"pose", "int a\nproperty int b"}})
    EXPECT_EQ(complaint("a.ply", ply(element, property, "")), "no complaint") << element;
  EXPECT_THAT(complaint("a.ply", ply("quads", "int a\nproperty int b", "")),
              HasSubstr("may hold triangles"));
}

TEST_F(MeshContent, PlyListsOfFaces) {
  EXPECT_THAT(notesOf("a.ply", ply("", "", "property list uchar int holes\n")),
              ElementsAre("the list \"holes\" of faces is not read"));
  for (const std::string name : {"texcoord", "flags", "red"})
    EXPECT_THAT(notesOf("a.ply", ply("", "", "property list uchar int " + name + "\n")), IsEmpty());
}

TEST_F(MeshContent, OffFacesOfTwoCorners) {
  const std::string points = "0 0 0\n1 0 0\n0 2 0\n3 0 1 2\n";
  EXPECT_THAT(notesOf("a.off", "OFF 3 1 0\n" + points), IsEmpty());
  EXPECT_THAT(notesOf("a.off", "OFF 3 2 0\n" + points + "2 0 1\n"), ElementsAre(linesNote));
  EXPECT_THAT(notesOf("a.off", "OFF 3 2 0\n" + points + "1 0\n"), ElementsAre(linesNote));
}

// --- XML

/// Parsers differ in which of two attributes they read.
TEST_F(MeshContent, AttributesThatAreThereTwice) {
  EXPECT_EQ(complaint("a.dae", colladaWith("<unit meter='0.001' meter='1'/>")),
            "a.dae:1: <unit> has the attribute \"meter\" twice; keep one");
}

TEST_F(MeshContent, ColladaArraysThatAreThereTwice) {
  const auto with = [&](const std::string& more) {
    std::string text = colladaWith("");
    const std::string end = "</float_array>";
    return text.insert(text.find(end) + end.size(), more);
  };
  const std::string second = "<float_array id='pb' count='9'>9 0 0 1 0 0 0 2 0</float_array>";
  EXPECT_EQ(complaint("a.dae", with(second)),
            "a.dae:1: a second <float_array> is in one <source>, and assimp drops one" + instead);
  EXPECT_THAT(complaint("a.dae", with("</source><source id='q'><float_array id='pa' count='0'/>")),
              HasSubstr("two arrays of one <mesh> have the id \"pa\"; give each an id of its own"));
}

TEST_F(MeshContent, ColladaArraysOutsideOfMeshes) {
  const std::string source = "<source id=\"i\"><float_array count=\"1\">0</float_array></source>",
                    other = "<source id=\"o\"><float_array count=\"1\">0</float_array></source>";
  std::string text = colladaWith("");
  const std::string library = "<library_geometries>";
  text.insert(text.find(library), "<library_animations><animation id=\"n\">" + source + other +
                                      "</animation></library_animations>");
  EXPECT_EQ(complaint("a.dae", text), "no complaint");
}

TEST_F(MeshContent, ColladaPhysicsIsNoted) {
  const std::string physics =
      "<library_physics_models><physics_model id='p'><rigid_body sid='r'><technique_common><shape>"
      "<box><half_extents>1 1 1</half_extents></box></shape></technique_common></rigid_body>"
      "</physics_model></library_physics_models>";
  EXPECT_THAT(notesOf("a.dae", colladaWith("", {}, physics)),
              ElementsAre("the shapes of physics models are not read"));
}

TEST_F(MeshContent, SecondRoots) {
  const std::string file = colladaWith("") + "\n";
  const std::string one = "; the file needs one root, <COLLADA>";
  EXPECT_EQ(complaint("a.dae", "<?xml version='1.0'?>" + file + "<!-- c -->"), "no complaint");
  EXPECT_THAT(complaint("a.dae", file + file), EndsWith("<COLLADA> is a second root" + one));
  EXPECT_THAT(complaint("a.dae", file + "<x/>"), EndsWith("<x> is a second root" + one));
  EXPECT_EQ(complaint("a.dae", "<x/>\n" + file), "a.dae:1: <x> is the root" + one);
}

/// assimp would find no ear of this polygon, and leave out two of its triangles.
TEST_F(MeshContent, ColladaPolygonsThatAssimpCutsWrongly) {
  const auto of = [](const std::string& order) {
    return R"(<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Z_UP</up_axis></asset><library_geometries><geometry id="g"><mesh>
<source id="s"><float_array id="a" count="30">.3 .9 0 .3 .3 0 0 0 0 1.5 0 0 1.4 .3 0 1.4 1 0 1.2 1 0
1.2 .3 0 .9 .3 0 .9 .9 0</float_array><technique_common><accessor source="#a" count="10" stride="3">
<param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#s"/></vertices>
<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/>)" +
           order + R"(</polylist></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="w"><node><instance_geometry url="#g"/></node></visual_scene>
</library_visual_scenes><scene><instance_visual_scene url="#w"/></scene></COLLADA>)";
  };
  EXPECT_EQ(
      read("a.dae", of("<vcount>10</vcount><p>0 1 2 3 4 5 6 7 8 9</p>")).mesh.triangles.size(), 8u);
  EXPECT_EQ(complaint("a.dae", of("<vcount>6</vcount><p>3 4 5 6 7 2</p>")), "no complaint");
}

}  // namespace
}  // namespace corridor::test::mesh_content
