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

/// Returns the complaint on an element that is not known in another one.
inline std::string notIn(const std::string& parent, const std::string& element) {
  return "<" + element + "> is not supported in <" + parent +
         ">, and may be or move geometry; remove it, or save the mesh as OBJ, STL, PLY or OFF";
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
