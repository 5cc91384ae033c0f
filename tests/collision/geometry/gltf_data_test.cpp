// glTF 2.0: buffers, accessors and indices.
#include <gmock/gmock.h>

#include "collision/geometry/mesh_health.h"
#include "tests/collision/geometry/gltf_fixture.h"

namespace corridor::test::mesh_content {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::StartsWith;

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

TEST_F(Gltf, DataThatAreNotBase64) {
  // 36 bytes of zeros, except the floats 1 and 2.
  const std::string good = "AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAAEAAAAAA";
  const auto of = [&](const std::string& data, const std::string& type = ";base64,") {
    return with(gltf(), "\"a.bin\"", "\"data:application/octet-stream" + type + data + '"');
  };
  EXPECT_EQ(read("a.gltf", of(good)).mesh.vertices.at(2), Vec3(0, 2, 0));
  EXPECT_EQ(complaint("a.gltf", with(of(good), "data:", "DATA:")), "no complaint");
  const std::string text =
      "the data of a buffer are no Base64: A to Z, a to z, 0 to 9, + and /, four characters for "
      "three bytes, with = at the end";
  for (const std::string& data :
       {with(good, "CAPw", "CA_w"), with(good, "CAPw", "CA-w"), with(good, "CAPw", "CA w"),
        with(good, "CAPw", "CA=w"), good + "AA", good + "A===", good + "A"})
    EXPECT_EQ(fault(of(data)), text) << data;
  EXPECT_EQ(fault(of(good, ",")), "the data of a buffer are not in Base64");
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
