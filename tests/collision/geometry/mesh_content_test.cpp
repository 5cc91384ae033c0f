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

/// Returns a GLB file: its buffer holds the corners. @param type that of the first chunk
std::string glb(std::string json, std::uint32_t version = 2, const std::string& type = "JSON") {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const auto size = static_cast<std::uint32_t>(json.size());
  std::string corners;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) corners += bytesOf(x);
  return "glTF" + bytesOf(version) + bytesOf(size + 64) + bytesOf(size) + type + json +
         bytesOf(std::uint32_t{36}) + std::string("BIN\0", 4) + corners;
}

TEST_F(Gltf, ExtensionsOfBinaryFiles) {
  const auto binary = [](std::string json, bool hasUri = false) {
    if (!hasUri) json.erase(json.find("\"uri\": \"a.bin\", "), 16);
    return glb(json);
  };
  EXPECT_EQ(read("a.glb", binary(gltf())).mesh.triangles.size(), 1u);
  EXPECT_EQ(
      complaint("a.glb", binary(gltf(), true)),
      "a.glb: assimp does not read the uri of a GLB file's first buffer; put the data into the "
      "file");
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

TEST_F(Gltf, TransformsThatAssimpWouldDistort) {
  const std::string length =
      "the rotation of a node is not of length 1, and assimp would distort the mesh; write a "
      "quaternion with length 1, with six digits or more";
  for (const std::string turn : {"0, 0, 1, 1", "0, 0, 0, 0", "0, 0, 0.7072, 0.7072"})
    EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "rotation": [)" + turn + "]}")), length) << turn;
  const auto turned = gltf("", R"({"mesh": 0, "rotation": [0, 0, 0.707107, 0.707107]})");
  EXPECT_LT((read("a.gltf", turned).mesh.vertices.at(1) - Vec3(0, 1, 0)).norm(), 1e-6);
  const std::string matrix = R"("matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, )";
  EXPECT_EQ(complaint("a.gltf", gltf("", R"({"mesh": 0, )" + matrix + "1]}")), "no complaint");
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, )" + matrix + "2]}")),
            "the last row of a node's matrix is not 0 0 0 1; save the mesh with such transforms");
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "scale": [1, 1, 1], )" + matrix + "1]}")),
            "a node has a matrix and another transform, of which assimp reads one; keep one");
}

TEST_F(Gltf, VerticesThatMakeNoTriangle) {
  std::string text = gltf();
  text.replace(text.find("\"count\": 3"), 10, "\"count\": 2");
  EXPECT_EQ(fault(text), "assimp leaves out geometry: TRIANGLES mode. Some vertices were dropped.");
  const std::string alsoLines = R"(}, {"attributes": {"POSITION": 0}, "mode": 1)";
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"mesh": 0})", alsoLines)), ElementsAre(linesNote));
}

/// Returns the text with the first `from` in it replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Gltf, TrianglesAreCounted) {
  const auto strip = [&](const std::string& indices, const std::string& mode) {
    write("i.bin", indices);
    const std::string size = std::to_string(indices.size());
    std::string text = gltf("", R"({"mesh": 0, "children": [1, 1]}, {"mesh": 0})",
                            R"(, "indices": 1, "mode": )" + mode);
    text = with(text, "\"byteLength\": 36}]",
                "\"byteLength\": 36}, {\"uri\": \"i.bin\", \"byteLength\": " + size + "}]");
    text =
        with(text, "\"buffer\": 0, \"byteLength\": 36}",
             "\"buffer\": 0, \"byteLength\": 36}, {\"buffer\": 1, \"byteLength\": " + size + "}");
    return with(text, "\"VEC3\"}",
                R"("VEC3"}, {"bufferView": 1, "componentType": 5121, "count": )" + size +
                    R"(, "type": "SCALAR"})");
  };
  const std::string four("\0\1\2\0", 4), beyond("\0\1\2\7", 4);
  for (const std::string mode : {"5", "6"}) {
    EXPECT_EQ(read("a.gltf", strip(four, mode)).mesh.triangles.size(), 6u) << mode;
    EXPECT_EQ(fault(strip(beyond, mode)),
              "assimp reads 3 triangles of the file's 6; correct its indices and counts, or save "
              "the mesh as OBJ, STL, PLY or OFF")
        << mode;
  }
  EXPECT_EQ(read("a.gltf", strip(four.substr(0, 3), "4")).mesh.triangles.size(), 3u);
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0})", R"(}, {"attributes": {"POSITION": 0}, "mode": 7)")),
            "the mode of a primitive is 7; 0 to 6 is needed");
}

TEST_F(Gltf, ByteOrderMark) {
  EXPECT_EQ(complaint("a.gltf", "\xEF\xBB\xBF" + gltf()),
            "a.gltf: begins with a byte-order mark, which glTF doesn't allow; remove it");
}

TEST_F(Gltf, VersionsOtherThan2) {
  const auto asset = [](const std::string& members) {
    return with(gltf(), R"({"version": "2.0"})", "{" + members + "}");
  };
  const auto version = [&](const std::string& text) { return asset("\"version\": " + text); };
  const std::string end = " is not supported; save the mesh as glTF 2.0";
  for (const std::string text : {"1.0", "1.1", "3.0", "20.0", " 2.0", "2,0"})
    EXPECT_EQ(fault(version('"' + text + '"')), "glTF " + text + end);
  for (const std::string text : {"2.0", "2.1", "2"})
    EXPECT_EQ(read("a.gltf", version('"' + text + '"')).mesh.triangles.size(), 1u) << text;
  const std::string none = "glTF without a version such as \"2.0\" in its asset" + end;
  for (const std::string text : {"2.0", "2", "null", "\"\"", "[\"2.0\"]"})
    EXPECT_EQ(fault(version(text)), none) << text;
  EXPECT_EQ(fault(asset("")), none);
  EXPECT_EQ(fault(with(gltf(), R"("asset": {"version": "2.0"}, )", "")), none);
  EXPECT_EQ(fault(with(gltf(), R"({"version": "2.0"})", "\"2.0\"")), none);
  // In version 1, lists are objects, whose keys are names.
  EXPECT_EQ(fault(R"({"asset": {"version": "1.0"}, "scene": "s", "scenes": {"s": {"nodes": []}}})"),
            "glTF 1.0" + end);
  for (const std::string list :
       {"accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes"})
    EXPECT_EQ(fault("{\"asset\": {\"version\": \"2.0\"}, \"" + list + "\": {\"a\": {}}}"),
              '"' + list + "\" is not an array");
}

TEST_F(Gltf, VersionsOfBinaryFiles) {
  const std::string json = with(gltf(), "\"uri\": \"a.bin\", ", "");
  const std::string end = " is not supported; save the mesh as glTF 2.0";
  EXPECT_EQ(complaint("a.glb", glb(json)), "no complaint");
  EXPECT_EQ(complaint("a.glb", glb(json, 1, std::string(4, '\0'))), "a.glb: binary glTF 1" + end);
  EXPECT_EQ(complaint("a.glb", glb(json, 3)), "a.glb: binary glTF 3" + end);
  EXPECT_EQ(complaint("a.glb", glb(with(json, "2.0", "1.0"))), "a.glb: glTF 1.0" + end);
  for (const std::string& type : {std::string("BIN\0", 4), std::string(4, '\0')})
    EXPECT_EQ(complaint("a.glb", glb(json, 2, type)),
              "a.glb: the first chunk of a GLB file must be JSON; save the file again");
}

TEST_F(Gltf, UpAxis) {
  const MeshFile file = read("a.gltf", gltf());
  EXPECT_EQ(file.fileUp, 'y');
  EXPECT_EQ(file.upRule,
            "coordinates as stored, since no up-axis was requested; the file's own, y, is not "
            "applied");
}

/// assimp reads other values as 0, or skips what they belong to.
TEST_F(Gltf, WholeNumbersAndIndices) {
  const std::string second = R"({"mesh": 0}, {"mesh": 0, "children": []})";
  const auto changed = [&](const std::string& from, const std::string& to) {
    return fault(with(gltf("", second, R"(, "mode": 4)"), from, to));
  };
  const std::string whole = "; a whole number of at least 0 is needed, without a point";
  EXPECT_EQ(changed("\"count\": 3", "\"count\": 3.0"), "\"count\" is 3.0" + whole);
  EXPECT_EQ(changed("\"mode\": 4", "\"mode\": \"5\""), "\"mode\" is \"5\"" + whole);
  EXPECT_EQ(changed("\"buffer\": 0,", "\"buffer\": 0, \"byteOffset\": -0.0,"),
            "\"byteOffset\" is -0.0" + whole);
  EXPECT_EQ(changed("\"byteLength\": 36}],\n\"acc", "\"byteLength\": null}],\n\"acc"),
            "\"byteLength\" is null" + whole);
  EXPECT_EQ(changed("\"byteLength\": 36}],\n\"acc", "\"byteLength\": 4294967332}],\n\"acc"),
            "\"byteLength\" is 4294967332" + whole);
  for (const std::string index : {"0.0", "\"0\"", "-1", "null", "[0]"}) {
    EXPECT_EQ(changed("{\"mesh\": 0}", "{\"mesh\": " + index + "}"),
              "\"mesh\" is " + index + whole);
    EXPECT_EQ(changed("\"scene\": 0", "\"scene\": " + index), "\"scene\" is " + index + whole);
    EXPECT_EQ(changed("\"nodes\": [0]", "\"nodes\": [0, " + index + "]"),
              "\"nodes\" is " + index + whole);
    EXPECT_EQ(changed("\"children\": []", "\"children\": [" + index + "]"),
              "\"children\" is " + index + whole);
  }
  EXPECT_EQ(changed("\"children\": []", "\"children\": 1"), "\"children\" is not an array");
  EXPECT_EQ(changed("{\"mesh\": 0}", "{\"Mesh\": 0}"),
            "the key \"Mesh\" is not read; write \"mesh\"");
}

/// assimp reads sparse accessors as if there were no gaps, and other ones with overlaps.
TEST_F(Gltf, BytesBetweenElements) {
  write("a.bin", std::string(48, '\0'));  // for gaps of four bytes
  // The positions are in the first view, and what a sparse accessor replaces is in the second.
  const auto strided = [&](const std::string& first, const std::string& second, bool isSparse) {
    const auto stride = [](const std::string& bytes) {
      return bytes.empty() ? "" : ", \"byteStride\": " + bytes;
    };
    const std::string text =
        with(with(gltf(), "\"byteLength\": 36}],\n\"buf", "\"byteLength\": 48}],\n\"buf"),
             "\"byteLength\": 36}],\n\"acc",
             "\"byteLength\": 48" + stride(first) + "}, {\"buffer\": 0, \"byteLength\": 36" +
                 stride(second) + "}],\n\"acc");
    return complaint(
        "a.gltf", isSparse ? with(text, "\"VEC3\"",
                                  R"("VEC3", "sparse": {"count": 1, "indices": {"bufferView": 1, )"
                                  R"("componentType": 5121}, "values": {"bufferView": 1}})")
                           : text);
  };
  const std::string gaps =
      "a.gltf: a sparse accessor of POSITION has a byteStride, which assimp does not apply; save "
      "the mesh without sparse accessors";
  EXPECT_EQ(strided("16", "", true), gaps);
  EXPECT_EQ(strided("", "16", true), gaps);
  EXPECT_EQ(strided("12", "", true), "no complaint");
  EXPECT_EQ(strided("12", "16", false), "no complaint");
  for (const std::string bytes : {"4", "8", "11"})
    EXPECT_EQ(strided(bytes, "", false),
              "a.gltf: the byteStride of POSITION is " + bytes + "; at least 12 is needed");
}

TEST_F(Gltf, ElementsBeyondTheirData) {
  const auto beyond = [](const std::string& what) {
    return "the elements of " + what + "POSITION (accessor 0) lie beyond the byteLength of their " +
           "bufferView; correct count, byteOffset or byteLength";
  };
  const std::string positions = beyond("");
  EXPECT_EQ(fault(with(gltf(), "\"count\": 3", "\"count\": 3, \"byteOffset\": 4")), positions);
  EXPECT_EQ(fault(with(gltf(), "\"count\": 3", "\"count\": 6")), positions);
  EXPECT_EQ(fault(with(gltf(), "\"byteLength\": 36}],\n\"acc", "\"byteLength\": 35}],\n\"acc")),
            positions);
  EXPECT_EQ(fault(with(gltf(), "\"byteLength\": 36}],\n\"acc",
                       "\"byteOffset\": 4, \"byteLength\": 36}],\n\"acc")),
            "the bufferView of POSITION (accessor 0) lies beyond the byteLength of its buffer; "
            "correct its "
            "byteOffset or byteLength");
  const auto sparse = [&](const std::string& count, const std::string& indices) {
    return complaint(
        "a.gltf", with(gltf(), "\"VEC3\"",
                       "\"VEC3\", \"sparse\": {\"count\": " + count + ", \"indices\": {" + indices +
                           R"("componentType": 5121}, "values": {"bufferView": 0}})"));
  };
  EXPECT_EQ(sparse("3", R"("bufferView": 0, )"), "no complaint");
  EXPECT_EQ(sparse("4", R"("bufferView": 0, )"), "a.gltf: " + beyond("the sparse values of "));
  EXPECT_EQ(sparse("1", R"("bufferView": 0, "byteOffset": 36, )"),
            "a.gltf: " + beyond("the sparse indices of "));
  EXPECT_EQ(
      sparse("1", ""),
      "a.gltf: a sparse accessor of POSITION needs indices and values, each with a bufferView");
}

TEST_F(Gltf, NumbersOutOfRange) {
  EXPECT_EQ(fault(gltf(R"(, "extras": 1e999)")),
            "no valid JSON: a number is beyond the range of doubles; correct it");
}

TEST_F(Gltf, DataThatAreNotBase64) {
  // 36 bytes of zeros, except the floats 1 and 2.
  const std::string good = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA";
  const auto of = [&](const std::string& data, const std::string& type = ";base64,") {
    return with(gltf(), "\"a.bin\"", "\"data:application/octet-stream" + type + data + '"');
  };
  EXPECT_EQ(read("a.gltf", of(good)).mesh.vertices.at(2), Vec3(0, 2, 0));
  const std::string text =
      "the data of a buffer are no Base64: A to Z, a to z, 0 to 9, + and /, four characters for "
      "three bytes, with = at the end";
  for (const std::string& data :
       {with(good, "CAPw", "CA_w"), with(good, "CAPw", "CA-w"), with(good, "CAPw", "CA w"),
        with(good, "CAPw", "CA=w"), good + "AA", good + "A===", good + "A"})
    EXPECT_EQ(fault(of(data)), text) << data;
  EXPECT_EQ(fault(of(good, ",")), "the data of a buffer are not in Base64");
}

TEST_F(Gltf, RootNodesThatAreChildren) {
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0}, {"children": [0]})")),
            "a node is in a scene and the child of a node; a scene may name root nodes only");
}

TEST_F(Gltf, NumbersOfTransforms) {
  const auto of = [&](const std::string& key, const std::string& value) {
    return fault(gltf("", "{\"mesh\": 0, \"" + key + "\": " + value + "}"));
  };
  for (const auto& [key, size] : std::vector<std::pair<std::string, std::string>>{
           {"translation", "3"}, {"rotation", "4"}, {"scale", "3"}, {"matrix", "16"}})
    for (const std::string value : {"2", "[]", "[1, 1]", "\"5 5 5\"", "null", "{\"x\": 5}",
                                    "[\"1\", 0, 0]", "[\"1\", 0, 0, 0]", "[0, 0, 0, 0, 1]"})
      EXPECT_EQ(of(key, value), "the " + key + " of a node needs " + size + " numbers") << value;
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
