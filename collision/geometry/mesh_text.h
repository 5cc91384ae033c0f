#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/error.h"
#include "collision/geometry/mesh_limits.h"
#include "collision/geometry/triangle_mesh.h"

/// What the mesh readers share: words and numbers in a text, and the faults found.
namespace corridor {

/// For messages: the word, shortened and with unprintable bytes shown as '?'.
std::string printable(std::string_view word);
/// The same in double quotes.
std::string inQuotes(std::string_view word);

/// Collects the faults of one mesh file; gives up at the tenth, since the rest rarely says anything
/// new.
class MeshFaults {
 public:
  explicit MeshFaults(std::string file) : file_(std::move(file)) {}

  void add(int line, std::string text);
  /// For faults that leave a reader without a place to go on from.
  [[noreturn]] void fail(int line, std::string text);
  void throwIfAny() const;
  /// Fails where there are more vertices or triangles (`what`) than are read.
  void requireFew(std::uint64_t count, std::string_view what, int line) {
    if (count > kMostOfAMesh) failCount(count, what, line);
  }
  void requireFew(const TriangleMesh& mesh, int line) {
    requireFew(mesh.vertices.size(), "vertices", line);
    requireFew(mesh.triangles.size(), "triangles", line);
  }

 private:
  [[noreturn]] void failCount(std::uint64_t count, std::string_view what, int line);

  std::string file_;
  std::vector<Fault> faults_;
};

/// Reads a whole word as a finite coordinate. @returns a complaint, or nullopt and `value` set.
/// Numbers too small for a double become 0, the nearest double.
std::optional<std::string> parseCoordinate(std::string_view word, double& value);

/// Reads a whole word as a decimal integer of 64 bits; false where it is none.
bool parseInteger(std::string_view word, std::int64_t& value);

/// Blanks within a line.
inline bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

/// Walks through a text by words, counting lines from 1.
class TextCursor {
 public:
  explicit TextCursor(std::string_view text, int line = 1) : rest_(text), line_(line) {}

  /// The next word of this line; empty at its end.
  std::string_view wordInLine();
  /// The next word of this or a later line; empty at the end of the text. `line()` is the line that
  /// it stands in.
  std::string_view word();
  /// Goes to the start of the next line; false at the end of the text.
  bool nextLine();

  int line() const { return line_; }
  std::size_t bytesLeft() const { return rest_.size(); }

 private:
  std::string_view rest_;
  int line_;
};

/// A vertex of three coordinates, of words that `next` gives until it gives an empty one; 0 from
/// the first that is missing or wrong on, with a fault of the line that `cursor` is in.
template <class Next>
Vec3 parseVertex(const Next& next, const TextCursor& cursor, MeshFaults& faults) {
  Vec3 vertex = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    const std::string_view word = next();
    if (word.empty()) {
      faults.add(cursor.line(), "a vertex has 3 coordinates, found " + std::to_string(i));
      break;
    }
    if (const auto complaint = parseCoordinate(word, vertex[i])) {
      faults.add(cursor.line(), *complaint);
      break;
    }
  }
  return vertex;
}

}  // namespace corridor
