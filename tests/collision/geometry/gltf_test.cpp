// glTF 2.0: the scene, its nodes and extensions.
#include <gmock/gmock.h>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/gltf_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

TEST_F(Gltf, RequiredExtensions) {
  for (const std::string name :
       {"EXT_mesh_gpu_instancing", "EXT_meshopt_compression", "KHR_draco_mesh_compression",
        "FOO_bar", "ACME_materials_displacement"}) {
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

TEST_F(Gltf, ByteOrderMark) {
  EXPECT_EQ(complaint("a.gltf", "\xEF\xBB\xBF" + gltf()), "no complaint");
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
            "applied (ROS's rule)");
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

/// By the specification, a mirrored node turns its triangles around, so that the outside stays it.
TEST_F(Gltf, MirroredNodes) {
  const auto& shape = read("a.gltf", gltf("", R"({"mesh": 0, "scale": [-3, 1, 1]})")).mesh;
  EXPECT_EQ(shape.vertices.at(shape.triangles.at(0)[1]), Vec3(0, 2, 0));
  EXPECT_EQ(shape.vertices.at(shape.triangles.at(0)[2]), Vec3(-3, 0, 0));
  const auto& twice = read("a.gltf", gltf("", R"({"mesh": 0, "scale": [-3, -1, 1]})")).mesh;
  EXPECT_EQ(twice.vertices.at(twice.triangles.at(0)[1]), Vec3(-3, 0, 0));
}

TEST_F(Gltf, NumbersOutOfRange) {
  EXPECT_EQ(fault(gltf(R"(, "extras": 1e999)")),
            "no valid JSON: a number is beyond the range of doubles; correct it");
  // They would be 0.
  for (const std::string number : {"1e-400", "0.01E-330", "5e-324000"})
    EXPECT_EQ(
        fault(gltf("", R"({"name": "\"2e-400", "mesh": 0, "translation": [0, -)" + number + "]}")),
        "the number \"" + number + "\" is beyond the range of doubles; correct it");
  EXPECT_EQ(complaint("a.gltf", gltf("", R"({"mesh": 0, "translation": [0.0e-400, -0.0, 0]})")),
            "no complaint");
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
  const std::string outside = "node 1 has a mesh, but is not in the default scene, and not read";
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"mesh": 0}, {"mesh": 0})")), ElementsAre(outside));
  std::string without = gltf("", R"({"mesh": 0}, {"mesh": 0})");
  without.erase(without.find("\"scene\": 0, "), 12);
  EXPECT_THAT(notesOf("a.gltf", without), ElementsAre(outside));
  const std::string unplaced = gltf("", R"({"mesh": 1})");
  EXPECT_THAT(
      notesOf("a.gltf", with(unplaced, R"("meshes": [)", R"("meshes": [{"primitives": []}, )")),
      testing::Contains("mesh 0 is in no node, and not read"));
  EXPECT_THAT(notesOf("a.gltf", gltf("", R"({"children": [2]}, {"name": "camera"}, {"mesh": 0})")),
              IsEmpty());
}

TEST_F(Gltf, KeysThatParsersTakeDifferently) {
  EXPECT_EQ(fault(gltf(R"(, "extras": 1, "extras": 2)")), "an object has a key twice: \"extras\"");
  const std::string text = gltf();
  EXPECT_EQ(fault(text + "x"), "no valid JSON at byte " + std::to_string(text.size() + 1));
}

/// Lists of another type than the specification's are faults, not empty lists.
TEST_F(Gltf, ValuesOfOtherTypes) {
  for (const std::string key : {"extensionsRequired", "extensionsUsed"})
    for (const std::string value :
         {R"({"EXT_mesh_x": {}})", R"("EXT_mesh_x")", "[[\"EXT_mesh_x\"]]", "null"})
      EXPECT_EQ(fault(gltf(", \"" + key + "\": " + value)),
                '"' + key + "\" is not an array of texts")
          << value;
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "extensions": ["EXT_mesh_x"]})")),
            "\"extensions\" is no JSON object");
  EXPECT_EQ(fault(gltf("", R"({"mesh": 0, "weights": {"0": 1}})")), "\"weights\" is not an array");
  for (const std::string value : {"true", "\"true\"", "1", "[true]"})
    EXPECT_EQ(fault(with(gltf(), "\"VEC3\"", "\"VEC3\", \"normalized\": " + value)),
              "an accessor of POSITION may not be normalized");
  EXPECT_EQ(complaint("a.gltf", with(gltf(), "\"VEC3\"", "\"VEC3\", \"normalized\": false")),
            "no complaint");
  // The name of an extension begins with what it is about.
  EXPECT_THAT(fault(gltf(R"(, "extensionsUsed": ["FOO_mesh_materials_x"])")),
              StartsWith("the extension \"FOO_mesh_materials_x\" moves, copies or packs geometry"));
}

TEST_F(Gltf, ScenesWithoutMeshes) {
  EXPECT_EQ(fault(gltf("", R"({"name": "empty"}, {"mesh": 0})")),
            "no node of its scene places a mesh; node 1 has a mesh, but is not in the default "
            "scene, and not read");
}

}  // namespace
}  // namespace corridor::test::mesh_content
