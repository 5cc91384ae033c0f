// What mesh files of other formats than XML hold beyond the triangles that are read.
#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

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

TEST_F(Gltf, PositionsThatAreNoPoints) {
  for (const std::string type : {"VEC2", "VEC4", "SCALAR"}) {
    std::string text = gltf();
    text.replace(text.find("VEC3"), 4, type);
    EXPECT_EQ(fault(text), "positions are not of type VEC3; save three coordinates for each");
  }
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

// --- FBX, 3MF

TEST_F(MeshContent, FbxSurfacesThatAreNoPolygons) {
  const auto withSecond = [](const std::string& geometry) {
    return fbx("", R"( Geometry: 2, "Geometry::b", "NurbsSurface" {
  Version: 100
 }
 Model: 4, "Model::b", "Mesh" {
  Version: 232
 }
)",
               " C: \"OO\",4,0\n C: \"OO\"," + geometry + ",4\n");
  };
  EXPECT_THAT(notesOf("a.fbx", withSecond("2")),
              ElementsAre("parts that are no polygons, such as NURBS surfaces, are not read"));
  EXPECT_THAT(notesOf("a.fbx", withSecond("1")), IsEmpty());
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

/// Returns a ZIP archive of files, which are not packed. @param files pairs of name and content
std::string archive(const std::vector<std::pair<std::string, std::string>>& files) {
  const auto half = [](std::size_t n) { return bytesOf(static_cast<std::uint16_t>(n)); };
  const auto word = [](std::size_t n) { return bytesOf(static_cast<std::uint32_t>(n)); };
  std::string bytes, directory;
  for (const auto& [name, content] : files) {
    std::uint32_t crc = ~0u;
    for (const char c : content) {
      crc ^= static_cast<unsigned char>(c);
      for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xEDB88320u : 0u);
    }
    const std::string entry = half(20) + word(0) + word(0) + word(~crc) + word(content.size()) +
                              word(content.size()) + half(name.size()) + half(0);
    directory += "PK\x01\x02" + half(20) + entry + half(0) + half(0) + half(0) + word(0) +
                 word(bytes.size()) + name;
    bytes += "PK\x03\x04" + entry + name + content;
  }
  return bytes + directory + "PK\x05\x06" + word(0) + half(files.size()) + half(files.size()) +
         word(directory.size()) + word(bytes.size()) + half(0);
}

TEST_F(MeshContent, ThreeMfIsNotSearched) {
  const std::string relations =
      R"(<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships">
<Relationship Target="/3D/3dmodel.model" Id="r" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>)";
  const std::string model =
      R"(<?xml version="1.0"?><model unit="meter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1" type="model"><mesh><vertices><vertex x="0" y="0" z="0"/><vertex x="1" y="0" z="0"/>
<vertex x="0" y="2" z="0"/></vertices><triangles><triangle v1="0" v2="1" v3="2"/></triangles></mesh></object></resources>
<build><item objectid="1"/></build></model>)";
  const MeshFile file =
      read("a.3mf", archive({{"_rels/.rels", relations}, {"3D/3dmodel.model", model}}), {1, {}});
  EXPECT_EQ(file.mesh.triangles.size(), 1u);
  EXPECT_THAT(file.notes,
              ElementsAre("the model in the archive is not searched for beam lattices, slices and "
                          "other extensions, which would not be read"));
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

TEST_F(MeshContent, ObjLinesThatGoOn) {
  const std::string text =
      "# c \\\nv 0 0 0 \\\n1.0\nv 1 0 0\nv 0 2 0\nvn 0 0 \\\n1\ng a \\\n b\nl 1 \\\n2\nf 1 2 "
      "\\\n3\n";
  EXPECT_EQ(read("a.obj", text).mesh.triangles.size(), 1u);
}

/// Problems of OMPL.app have their OBJ files read by assimp, which drops more than keywords.
TEST_F(MeshContent, ObjReadByAssimp) {
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
  const auto refused = [&](const std::string& line) {
    const std::string face = triangle + line + "\nf 3 2 1\n";
    return complaintOf([&] { readOmplAppMesh(write("a.obj", face)); });
  };
  for (const std::string keyword : {"fo", "F", "surf", "curv", "call", "bzp", "csh", "hello"})
    EXPECT_EQ(refused(keyword + " 1 2 3"),
              "a.obj:5: the keyword \"" + keyword +
                  "\" is not supported, and may be or move geometry; write faces with v and f");
  EXPECT_EQ(refused("cstype bezier"),
            "a.obj:5: assimp drops the lines from cstype on; write faces with v and f");
  for (const std::string line : {" f 1 2 3", "\tv 1 2 3"})
    EXPECT_EQ(refused(line),
              "a.obj:5: assimp drops a line that begins with a blank; remove the blank");
  for (const std::string line : {"# C:\\", "#\\\r"})
    EXPECT_EQ(refused(line),
              "a.obj:5: the comment ends with a backslash, so assimp drops the next line; remove "
              "it");
  // What is accepted loses no face.
  for (const std::string line :
       {"vn 0 0 1", "vn 0 0 \\\n1", "vt 0 0", "vp 0", "g a", "o b\\c", "s 1", "mg 0", "usemtl m",
        "deg 1", " # f 9", "# C:\\x y", "g a \\\r\nfo\r", ""})
    EXPECT_EQ(
        readOmplAppMesh(write("a.obj", triangle + line + "\nf 3 2 1\n")).mesh.triangles.size(), 2u)
        << line;
  EXPECT_EQ(readOmplAppMesh(write("a.obj", "\xEF\xBB\xBF# c\n" + triangle)).mesh.triangles.size(),
            1u);
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
