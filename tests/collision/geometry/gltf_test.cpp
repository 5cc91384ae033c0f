// glTF 2.0: what is read, refused and noted.
#include <gmock/gmock.h>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

/// The buffer holds the corners (0, 0, 0), (1, 0, 0) and (0, 2, 0) as floats.
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

/// Returns the text with the first `from` in it replaced.
std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

TEST_F(Gltf, RequiredExtensions) {
  for (const std::string name : {"EXT_mesh_gpu_instancing", "EXT_meshopt_compression",
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

TEST_F(Gltf, BinaryFiles) {
  const std::string json = with(gltf(), "\"uri\": \"a.bin\", ", ""), file = glb(json);
  EXPECT_EQ(read("a.glb", file).mesh.vertices.at(2), Vec3(0, 2, 0));
  // The first buffer may be in another file, nevertheless.
  EXPECT_THAT(read("a.glb", glb(gltf())).otherFiles, ElementsAre((folder_ / "a.bin").string()));
  EXPECT_EQ(
      complaint("a.glb", glb(with(json, "}]}]", "}], \"extensions\": {\"EXT_mesh_x\": 1}}]"))),
      "a.glb: the extension \"EXT_mesh_x\" moves, copies or packs geometry, and is not "
      "supported; save the mesh without it");
  const auto withSize = [](std::string bytes) {
    return bytes.replace(8, 4, bytesOf(static_cast<std::uint32_t>(bytes.size())));
  };
  const std::string size = std::to_string(file.size());
  for (const std::string more : {"x", "1234"})
    EXPECT_EQ(complaint("a.glb", file + more), "a.glb: the GLB file has " +
                                                   std::to_string(file.size() + more.size()) +
                                                   " bytes, and its header says " + size +
                                                   "; it is truncated, or something follows it");
  const std::string cut = "a.glb: a chunk of the GLB file is truncated";
  EXPECT_EQ(complaint("a.glb", withSize(file + "x")), cut);
  EXPECT_EQ(complaint("a.glb", withSize(file.substr(0, file.size() - 4))), cut);
  EXPECT_EQ(complaint("a.glb", file.substr(0, 16)),
            "a.glb: the GLB file is truncated: it ends within its header");
  const std::string four = bytesOf(std::uint32_t{4});
  EXPECT_EQ(complaint("a.glb", withSize(file + four + std::string("BIN\0abcd", 8))),
            "a.glb: a GLB file has two chunks of one kind");
  EXPECT_EQ(complaint("a.glb", withSize(file + four + "JSON{}  ")),
            "a.glb: a GLB file has two chunks of one kind");
  EXPECT_EQ(complaint("a.glb", withSize(file + four + "LATEabcd")), "no complaint");
  EXPECT_EQ(complaint("a.glb", "hello"),
            "a.glb: a GLB file begins with the word glTF; save the file again");
  EXPECT_EQ(complaint("a.glb", glb(with(json, "\"byteLength\": 36", "\"byteLength\": 40"))),
            "a.glb: buffer 0 has 36 bytes, and its byteLength is 40");
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
    EXPECT_EQ(fault(text),
              "an accessor of POSITION is of type \"" + type + "\", and VEC3 is needed");
  }
}

/// Returns the members of a node with a mesh and a transform.
std::string node(const std::string& transform) {
  return "{\"mesh\": 0, " + transform + "}";
}

TEST_F(Gltf, Rotations) {
  for (const std::string turn : {"0, 0, 1, 1", "0, 0, 0, 0", "0, 0, 0.71, 0.71"})
    EXPECT_EQ(fault(gltf("", node("\"rotation\": [" + turn + "]"))),
              "the rotation of node 0 is not of length 1; write a unit quaternion")
        << turn;
  // x, y, z, w; four digits are normalised.
  for (const std::string turn :
       {"0, 0, 0.7071067811865476, 0.7071067811865476", "0, 0, 0.7072, 0.7072"})
    EXPECT_LT((read("a.gltf", gltf("", node("\"rotation\": [" + turn + "]"))).mesh.vertices.at(2) -
               Vec3(-2, 0, 0))
                  .norm(),
              1e-15);
  // A scale comes before a rotation, and a translation after it.
  const MeshFile all = read(
      "a.gltf", gltf("", node("\"translation\": [5, 6, 7], \"scale\": [3, 4, 5], \"rotation\": "
                              "[0, 0, 0.7071067811865476, 0.7071067811865476]")));
  EXPECT_LT((all.mesh.vertices.at(1) - Vec3(5, 9, 7)).norm(), 1e-14);
  EXPECT_LT((all.mesh.vertices.at(2) - Vec3(-3, 6, 7)).norm(), 1e-14);
}

TEST_F(Gltf, MatricesAreColumnByColumn) {
  const std::string matrix = R"("matrix": [0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, )";
  EXPECT_THAT(read("a.gltf", gltf("", node(matrix + "1]"))).mesh.vertices,
              ElementsAre(Vec3(5, 6, 7), Vec3(5, 7, 7), Vec3(3, 6, 7)));
  EXPECT_EQ(fault(gltf("", node(matrix + "2]"))),
            "the last row of the matrix of node 0 is not 0 0 0 1, which is not supported");
  EXPECT_EQ(fault(gltf("", node("\"scale\": [1, 1, 1], " + matrix + "1]"))),
            "node 0 has a matrix and another transform; keep one");
}

/// Returns nodes, each the parent of the next; the last one has the mesh.
std::string chain(const std::vector<std::string>& transforms) {
  std::string nodes;
  for (std::size_t i = 0; i < transforms.size(); ++i)
    nodes += (i == 0 ? "{" : ", {") + transforms[i] +
             (i + 1 < transforms.size() ? ", \"children\": [" + std::to_string(i + 1) + "]}"
                                        : ", \"mesh\": 0}");
  return nodes;
}
std::string scale(const std::string& s) {
  return "\"scale\": [" + s + ", " + s + ", " + s + "]";
}
std::string along(const std::string& x) {
  return "\"translation\": [" + x + ", 0, 0]";
}

TEST_F(Gltf, LargeAndSmallTransforms) {
  const auto corners = [&](const std::vector<std::string>& transforms) {
    return read("a.gltf", gltf("", chain(transforms))).mesh.vertices;
  };
  const Vec3 flat = corners({scale("1e-46"), scale("1e38"), scale("1e8")}).at(2);
  EXPECT_NEAR(flat.y(), 2, 1e-14);
  const auto far = corners({scale("1e38"), scale("1e38"), scale("1e38"), scale("1e38"),
                            scale("1000"), along("100000003"), along("-100000000")});
  EXPECT_NEAR(far.at(0).x() / 1e155, 3, 1e-5);
  EXPECT_NEAR(far.at(1).x() / 1e155, 4, 1e-5);
  for (const std::string number : {"1e251", "-1e-251"})
    EXPECT_THAT(fault(gltf("", chain({scale(number)}))),
                StartsWith("the scale of node 0: the number "));
  const std::string moves = "the transforms of its nodes may round a mesh by ";
  EXPECT_THAT(fault(gltf("", chain({along("1e17"), along("-1e17")}))), StartsWith(moves));
  for (const auto& transforms :
       {std::vector<std::string>{scale("1e200"), scale("1e-100"), scale("1e150")},
        {scale("1e-200"), scale("1e-100")}})
    EXPECT_THAT(fault(gltf("", chain(transforms))),
                StartsWith("the transforms of its nodes shrink "));
  // The product of the first two is subnormal, and loses most of its digits.
  EXPECT_THAT(fault(gltf("", chain({scale("1e-160"), scale("1.3e-163"), scale("1e160"),
                                    scale("1e160"), scale("1000")}))),
              StartsWith("the transforms of its nodes "));
  EXPECT_THAT(notesOf("a.gltf", gltf("", chain({along("1e11"), along("-1e11")}))),
              ElementsAre(StartsWith(moves)));
}

TEST_F(Gltf, VerticesThatMakeNoTriangle) {
  EXPECT_EQ(fault(with(gltf(), "\"count\": 3", "\"count\": 2")),
            "a primitive of triangles in mesh 0 has 2 corners, which is no multiple of 3");
  const std::string alsoLines = R"(}, {"attributes": {"POSITION": 0}, "mode": 1)";
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"mesh": 0})", alsoLines)), ElementsAre(linesNote));
}

/// Returns a file whose primitive has indices of one byte each.
class GltfIndices : public Gltf {
 protected:
  std::string file(const std::string& indices, const std::string& mode,
                   const std::string& nodes = R"({"mesh": 0})") {
    write("i.bin", indices);
    const std::string size = std::to_string(indices.size());
    std::string text = gltf("", nodes, R"(, "indices": 1, "mode": )" + mode);
    text = with(text, "\"byteLength\": 36}]",
                "\"byteLength\": 36}, {\"uri\": \"i.bin\", \"byteLength\": " + size + "}]");
    text =
        with(text, "\"buffer\": 0, \"byteLength\": 36}",
             "\"buffer\": 0, \"byteLength\": 36}, {\"buffer\": 1, \"byteLength\": " + size + "}");
    return with(text, "\"VEC3\"}",
                R"("VEC3"}, {"bufferView": 1, "componentType": 5121, "count": )" + size +
                    R"(, "type": "SCALAR"})");
  }
};

TEST_F(GltfIndices, StripsAndFans) {
  using Corners = std::vector<std::array<std::uint32_t, 3>>;
  const std::string five("\0\1\2\0\1", 5);
  const auto triangles = [&](const std::string& mode) {
    return read("a.gltf", file(five, mode)).mesh.triangles;
  };
  EXPECT_EQ(triangles("5"), (Corners{{0, 1, 2}, {2, 1, 0}, {2, 0, 1}}));
  EXPECT_EQ(triangles("6"), (Corners{{0, 1, 2}, {0, 2, 0}, {0, 0, 1}}));
  EXPECT_EQ(read("a.gltf", file(std::string("\0\2\1\1\2\0", 6), "4")).mesh.triangles,
            (Corners{{0, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(fault(file(five, "4")),
            "a primitive of triangles in mesh 0 has 5 corners, which is no multiple of 3");
  for (const std::string mode : {"4", "5", "6"})
    EXPECT_EQ(fault(file(std::string("\0\1\7", 3), mode)),
              "the indices of mesh 0 name vertex 7 (from 0), and there are 3");
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0})", R"(}, {"attributes": {"POSITION": 0}, "mode": 7)")),
            "the mode of a primitive is 7; 0 to 6 is needed");
}

/// The greatest index of a type would restart a strip in some programs.
TEST_F(GltfIndices, TheGreatestIndexIsForbidden) {
  EXPECT_EQ(fault(file(std::string("\0\1\xFF", 3), "5")),
            "an accessor of indices has the greatest index of its type, which glTF forbids");
}

/// Small files may not take much time or memory.
TEST_F(GltfIndices, NoDataAndDeepNesting) {
  const std::string indices = file(std::string("\0\1\2", 3), "4");
  EXPECT_EQ(
      fault(with(indices, "\"bufferView\": 1, \"componentType\": 5121", "\"componentType\": 5121")),
      "an accessor of indices has no bufferView");
  const std::string many = with(gltf(), "\"count\": 3", "\"count\": 90000000");
  EXPECT_EQ(fault(with(many, "\"bufferView\": 0, ", "")),
            "an accessor of POSITION brings the elements without a bufferView to more than 10^6");
  const std::string deep = std::string(200'000, '[') + std::string(200'000, ']');
  EXPECT_EQ(fault(with(gltf(), "\"version\": \"2.0\"", "\"minVersion\": " + deep)),
            "its JSON nests deeper than 500");
}

/// A strip around a tetrahedron: every second triangle is turned over.
TEST_F(GltfIndices, StripsFaceOutwards) {
  std::string text = file(std::string("\0\1\2\3\0\1", 6), "5"), corners;
  for (const float x : {0.f, 0.f, 0.f, 0.f, 1.f, 0.f, 1.f, 0.f, 0.f, 0.f, 0.f, 1.f})
    corners += bytesOf(x);
  write("a.bin", corners);
  for (int i = 0; i < 2; ++i) text = with(text, "\"byteLength\": 36", "\"byteLength\": 48");
  const MeshHealth health =
      inspectMesh(read("a.gltf", with(text, "\"count\": 3", "\"count\": 4")).mesh);
  ASSERT_TRUE(health.volume);
  EXPECT_NEAR(*health.volume, 1. / 6, 1e-15);
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

TEST_F(Gltf, WholeNumbersAndIndices) {
  const std::string second = R"({"mesh": 0}, {"mesh": 0, "children": []})";
  const auto changed = [&](const std::string& from, const std::string& to) {
    return fault(with(gltf("", second, R"(, "mode": 4)"), from, to));
  };
  const std::string whole = "; a whole number of at least 0 is needed, without a point";
  const std::string noLength = "\na.gltf: a bufferView has no buffer or no byteLength";
  EXPECT_EQ(changed("\"count\": 3", "\"count\": 3.0"),
            "\"count\" of an accessor of POSITION is 3.0" + whole +
                "\na.gltf: an accessor of POSITION has no count");
  EXPECT_EQ(changed("\"mode\": 4", "\"mode\": \"5\""), "\"mode\" of mesh 0 is \"5\"" + whole);
  EXPECT_EQ(changed("\"buffer\": 0,", "\"buffer\": 0, \"byteOffset\": -0.0,"),
            "\"byteOffset\" of a bufferView is -0.0" + whole);
  EXPECT_EQ(changed("\"byteLength\": 36}],\n\"acc", "\"byteLength\": null}],\n\"acc"),
            "\"byteLength\" of a bufferView is null" + whole + noLength);
  EXPECT_EQ(changed("\"byteLength\": 36}],\n\"acc", "\"byteLength\": 4294967332}],\n\"acc"),
            "\"byteLength\" of a bufferView is 4294967332" + whole + noLength);
  for (const std::string index : {"0.0", "\"0\"", "-1", "null", "[0]"}) {
    EXPECT_EQ(changed("{\"mesh\": 0}", "{\"mesh\": " + index + "}"),
              "\"mesh\" of node 0 is " + index + whole);
    EXPECT_EQ(changed("\"scene\": 0", "\"scene\": " + index),
              "\"scene\" of the file is " + index + whole);
    EXPECT_EQ(changed("\"nodes\": [0]", "\"nodes\": [0, " + index + "]"),
              "\"nodes\" of a scene is " + index + whole);
    EXPECT_EQ(changed("\"children\": []", "\"children\": [" + index + "]"),
              "\"children\" of a node is " + index + whole);
  }
  EXPECT_EQ(changed("\"children\": []", "\"children\": 1"), "\"children\" is not an array");
  EXPECT_EQ(changed("{\"mesh\": 0}", "{\"Mesh\": 0}"),
            "the key \"Mesh\" is not read; write \"mesh\"");
}

/// Strides of stored elements, and of the indices and values of sparse accessors.
TEST_F(Gltf, BytesBetweenElements) {
  std::string
      data;  // positions with gaps of 4 bytes; indices 0, 2 with gaps of 2 bytes; two values
  for (const float x : {0.f, 0.f, 0.f, 9.f, 1.f, 0.f, 0.f, 9.f, 0.f, 2.f, 0.f, 9.f})
    data += bytesOf(x);
  data += std::string("\0\7\7\2\7\7\7\7", 8);
  for (const float x : {0.f, 5.f, 0.f, 9.f, 0.f, 0.f, 7.f, 9.f}) data += bytesOf(x);
  write("a.bin", data);
  const auto strided = [&](const std::string& stride, const std::string& sparse) {
    std::string text = with(gltf(), "\"byteLength\": 36}],\n\"buf", "\"byteLength\": 88}],\n\"buf");
    text = with(text, "\"byteLength\": 36}],\n\"acc",
                "\"byteLength\": 48, \"byteStride\": " + stride +
                    R"(}, {"buffer": 0, "byteOffset": 48, "byteLength": 8, "byteStride": 3},)" +
                    R"({"buffer": 0, "byteOffset": 52, "byteLength": 36, "byteStride": 16}],)" +
                    "\n\"acc");
    return with(text, "\"VEC3\"", "\"VEC3\"" + sparse);
  };
  const std::string sparse =
      R"(, "sparse": {"count": 2, "indices": {"bufferView": 1, )"
      R"("componentType": 5121}, "values": {"bufferView": 2, "byteOffset": 4}})";
  EXPECT_THAT(read("a.gltf", strided("16", "")).mesh.vertices,
              ElementsAre(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 2, 0)));
  EXPECT_THAT(read("a.gltf", strided("16", sparse)).mesh.vertices,
              ElementsAre(Vec3(0, 5, 0), Vec3(1, 0, 0), Vec3(0, 0, 7)));
  // Without a view, the elements that are not replaced are 0.
  EXPECT_THAT(read("a.gltf", with(strided("16", sparse), "\"bufferView\": 0, ", "")).mesh.vertices,
              ElementsAre(Vec3(0, 5, 0), Vec3(0, 0, 0), Vec3(0, 0, 7)));
  for (const std::string bytes : {"4", "8", "11"})
    EXPECT_EQ(fault(strided(bytes, "")),
              "the byteStride of an accessor of POSITION is " + bytes + "; at least 12 is needed");
}

/// By the specification, a mirrored node turns its triangles around, so that the outside stays it.
TEST_F(Gltf, MirroredNodes) {
  const auto& shape = read("a.gltf", gltf("", R"({"mesh": 0, "scale": [-3, 1, 1]})")).mesh;
  EXPECT_EQ(shape.vertices.at(shape.triangles.at(0)[1]), Vec3(0, 2, 0));
  EXPECT_EQ(shape.vertices.at(shape.triangles.at(0)[2]), Vec3(-3, 0, 0));
  const auto& twice = read("a.gltf", gltf("", R"({"mesh": 0, "scale": [-3, -1, 1]})")).mesh;
  EXPECT_EQ(twice.vertices.at(twice.triangles.at(0)[1]), Vec3(-3, 0, 0));
}

TEST_F(Gltf, ElementsBeyondTheirData) {
  const auto beyond = [](const std::string& what) {
    return "the elements of " + what +
           "an accessor of POSITION lie beyond the byteLength of their bufferView; correct count, "
           "byteOffset or byteLength";
  };
  const std::string positions = beyond("");
  EXPECT_EQ(fault(with(gltf(), "\"count\": 3", "\"count\": 3, \"byteOffset\": 4")), positions);
  EXPECT_EQ(fault(with(gltf(), "\"count\": 3", "\"count\": 6")), positions);
  EXPECT_EQ(fault(with(gltf(), "\"byteLength\": 36}],\n\"acc", "\"byteLength\": 35}],\n\"acc")),
            positions);
  EXPECT_EQ(fault(with(gltf(), "\"byteLength\": 36}],\n\"acc",
                       "\"byteOffset\": 4, \"byteLength\": 36}],\n\"acc")),
            "the bufferView of an accessor of POSITION lies beyond the byteLength of its buffer; "
            "correct its byteOffset or byteLength");
  const auto sparse = [&](const std::string& count, const std::string& indices) {
    return complaint(
        "a.gltf", with(gltf(), "\"VEC3\"",
                       "\"VEC3\", \"sparse\": {\"count\": " + count + ", \"indices\": {" + indices +
                           R"("componentType": 5121}, "values": {"bufferView": 0}})"));
  };
  EXPECT_EQ(sparse("1", R"("bufferView": 0, )"), "no complaint");
  EXPECT_EQ(sparse("3", R"("bufferView": 0, )"),
            "a.gltf: the sparse indices of an accessor of POSITION do not increase");
  EXPECT_EQ(sparse("4", R"("bufferView": 0, )"), "a.gltf: " + beyond("the sparse values of "));
  EXPECT_EQ(sparse("1", R"("bufferView": 0, "byteOffset": 36, )"),
            "a.gltf: " + beyond("the sparse indices of "));
  EXPECT_EQ(
      sparse("1", ""),
      "a.gltf: \"sparse\" of an accessor of POSITION needs a count, indices of an unsigned type, "
      "and values");
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

TEST_F(Gltf, NodesWithTwoParents) {
  const std::string two = "a node is the child of two nodes";
  EXPECT_EQ(fault(gltf("", R"({"children": [1, 1]}, {"mesh": 0})")), two);
  EXPECT_EQ(fault(gltf("", R"({"children": [1, 2]}, {"children": [2]}, {"mesh": 0})")), two);
  const std::string root =
      "a node is in a scene and the child of a node; a scene may name root nodes only";
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "children": [0]})")), root);
  EXPECT_EQ(fault(gltf("", R"({"children": [1]}, {"mesh": 0, "children": [0]})")), root);
  EXPECT_EQ(fault(with(gltf(), "\"nodes\": [0]", "\"nodes\": [0, 0]")),
            "node 0 is in the scene twice");
}

TEST_F(Gltf, NumbersOfTransforms) {
  const auto of = [&](const std::string& key, const std::string& value) {
    return fault(gltf("", "{\"mesh\": 0, \"" + key + "\": " + value + "}"));
  };
  for (const auto& [key, size] : std::vector<std::pair<std::string, std::string>>{
           {"translation", "3"}, {"rotation", "4"}, {"scale", "3"}, {"matrix", "16"}})
    for (const std::string value : {"2", "[]", "[1, 1]", "\"5 5 5\"", "null", "{\"x\": 5}",
                                    "[\"1\", 0, 0]", "[\"1\", 0, 0, 0]", "[0, 0, 0, 0, 1]"})
      EXPECT_EQ(of(key, value), "the " + key + " of node 0 needs " + size + " numbers") << value;
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

TEST_F(Gltf, NamesWithBytesInHexadecimal) {
  std::string numbers;
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) numbers += bytesOf(x);
  const auto of = [](const std::string& uri) { return with(gltf(), "a.bin", uri); };
  write("a b.bin", numbers);
  const MeshFile file = read("a.gltf", of("a%20b.b%69n"));
  EXPECT_EQ(file.mesh.vertices.at(2), Vec3(0, 2, 0));
  EXPECT_THAT(file.otherFiles, ElementsAre((folder_ / "a b.bin").string()));
  write("a%2b.bin", numbers);
  EXPECT_THAT(read("a.gltf", of("a%2b.bin")).otherFiles,
              ElementsAre((folder_ / "a%2b.bin").string()));
  // Where both names exist, the format's rule counts.
  write("a+.bin", numbers);
  EXPECT_THAT(read("a.gltf", of("a%2b.bin")).otherFiles,
              ElementsAre((folder_ / "a+.bin").string()));
  // Names of folders are not encoded.
  std::filesystem::create_directories(folder_ / "b%20c");
  std::filesystem::create_directories(folder_ / "b c");
  write("b%20c/a.bin", numbers);
  write("b c/a.bin", "");
  EXPECT_THAT(read("b%20c/a.gltf", gltf()).otherFiles,
              ElementsAre((folder_ / "b%20c/a.bin").string()));
  EXPECT_THAT(fault(of("%zz.bin")), StartsWith("the file \"%zz.bin\" of buffer 0: "));
}

}  // namespace
}  // namespace corridor::test::mesh_content
