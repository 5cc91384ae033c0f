#pragma once

#include <string>

#include "tests/collision/geometry/mesh_content_fixture.h"

namespace corridor::test::mesh_content {

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
inline std::string gltf(const std::string& more = "", const std::string& nodes = R"({"mesh": 0})",
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
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return at == text.npos ? text : text.replace(at, from.size(), to);
}

}  // namespace corridor::test::mesh_content
