#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "tests/collision/geometry/mesh_fixture.h"

/// What mesh files hold beyond the triangles that are read: it is a fault or a note, and is never
/// dropped in silence.
namespace corridor::test::mesh_content {

inline const std::string instead = "; save the mesh as OBJ, STL, PLY or OFF";
inline const std::string linesNote = "lines and points have no volume, and are not read";

inline std::string notRight(const std::string& element) {
  return "<" + element + "> may be or move geometry, and assimp does not read it rightly" + instead;
}

/// Returns an FBX file of one triangle, the geometry 1 of the model 3. The places: further parts of
/// the file, objects and connections.
inline std::string fbx(const std::string& parts, const std::string& objects = "",
                       const std::string& connections = "") {
  return R"(; FBX 7.3.0 project file
FBXHeaderExtension: {
 FBXVersion: 7300
}
)" + parts +
         R"(Definitions: {
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
 Model: 3, "Model::a", "Mesh" {
  Version: 232
 }
)" + objects +
         R"(}
Connections: {
 C: "OO",3,0
 C: "OO",1,3
)" + connections +
         "}\n";
}

class MeshContent : public MeshFileTest {
 protected:
  /// Returns the complaint on a file after its first `words`, which it must begin with.
  std::string after(const std::string& words, const std::string& name, const std::string& bytes) {
    const std::string text = complaint(name, bytes);
    EXPECT_THAT(text, testing::StartsWith(words)) << bytes;
    return text.substr(std::min(words.size(), text.size()));
  }
  std::vector<std::string> notesOf(const std::string& name, const std::string& bytes) {
    return read(name, bytes).notes;
  }
};

}  // namespace corridor::test::mesh_content
