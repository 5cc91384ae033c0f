#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/fault_list.h"
#include "collision/geometry/mesh_limits.h"
#include "collision/geometry/triangle_mesh.h"

/// Helpers of the readers of meshes, point clouds and maps: words and numbers in a text, and the
/// list of faults.
namespace corridor {

/// Returns the word for a message. Bytes that are not printable ASCII become '?'. A word of more
/// than 32 bytes is cut after 32 bytes, and "..." marks the cut.
std::string printable(std::string_view word);
/// Adds a note, if it is new. After a hundred, one note says that there are more.
void addNote(std::vector<std::string>& notes, const std::string& text);
/// Returns `printable(word)` in double quotes.
std::string inQuotes(std::string_view word);

/// Collects the faults of one file (a mesh, a point cloud or a map). `add` throws all faults at the
/// tenth fault, since further faults rarely add information.
class MeshFaults {
 public:
  explicit MeshFaults(std::string file) : file_(std::move(file)), faults_(file_, 10) {}

  void add(int line, std::string text) { faults_.add(file_, line, std::move(text)); }
  /// Adds a fault after which the reader cannot go on, and throws all faults.
  [[noreturn]] void fail(int line, std::string text);
  void throwIfAny() const { faults_.throwIfAny(); }
  /// Calls `fail` if `count` exceeds `kMaxMeshElements`. @param what the things that were counted:
  /// "vertices", "faces" or "triangles".
  void requireFew(std::uint64_t count, std::string_view what, int line) {
    if (count > kMaxMeshElements) failCount(count, what, line);
  }
  void requireFew(const TriangleMesh& mesh, int line) {
    requireFew(mesh.vertices.size(), "vertices", line);
    requireFew(mesh.triangles.size(), "triangles", line);
  }

 private:
  [[noreturn]] void failCount(std::uint64_t count, std::string_view what, int line);

  std::string file_;
  FaultList faults_;
};

/// Reads a whole word as a finite coordinate, and stores the coordinate in `value`. Numbers that
/// are too small for a double become 0, the nearest double. @returns what is wrong with the word,
/// or nullopt on success.
/// @param notFiniteToo true: also accepts "nan" and "inf", which sensors write for directions
/// without a measurement.
std::optional<std::string> parseCoordinate(std::string_view word, double& value,
                                           bool notFiniteToo = false);

/// Reads a whole word as a decimal integer of 64 bits. @returns false if the word is not such an
/// integer.
bool parseInteger(std::string_view word, std::int64_t& value);

/// Returns whether `c` is a blank within a line (not a line end).
inline bool isBlank(char c) {
  return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
inline bool isLineEnd(char c) {
  return c == '\n' || c == '\r';
}

/// Walks through a text word by word, and counts its lines, from 1 unless the constructor gets
/// another number. All text readers use this class, so they agree on where lines end: at LF, at
/// CR LF, and at a CR alone. (If the first line ends with a CR alone, so do all others: an LF after
/// a later CR is an empty line, or the first byte of binary data.)
class TextCursor {
 public:
  explicit TextCursor(std::string_view text, int line = 1) : rest_(text), line_(line) {}

  /// Returns the next word of this line; empty at the end of the line.
  std::string_view wordInLine();
  /// Returns the next word of this or a later line; empty at the end of the text. After the call,
  /// `line()` is the line of that word.
  std::string_view word();
  /// Returns the rest of this line without its end, and moves to this end.
  std::string_view takeRestOfLine();
  /// Returns this line from `word` on, the last word that was read; moves to the line's end.
  std::string_view takeLineFrom(std::string_view word);
  /// Goes to the start of the next line. @returns false at the end of the text.
  bool nextLine();

  int line() const { return line_; }
  std::size_t bytesLeft() const { return rest_.size(); }

 private:
  enum class LineEnds { unknown, lfOrCrLf, cr };
  /// Returns the end of this line: of its first LF or CR, or of the text.
  const char* lineEnd();

  std::string_view rest_;
  int line_;
  LineEnds ends_ = LineEnds::unknown;
  // The next LF and CR that were found. They are sought again when the cursor is behind them, so
  // that a text without one of them is searched once.
  const char *lf_ = nullptr, *cr_ = nullptr;
};

/// Reads a vertex of three coordinates from the words that `next` returns; an empty word means that
/// no more words follow. If a coordinate is missing or wrong, adds a fault at the cursor's line;
/// that coordinate and all later ones stay 0.
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

/// Adds a fault for the first of the words that `next` returns after the coordinates of a vertex
/// that is no number. @param what the numbers that may follow: "a weight or a colour".
template <class Next>
void requireNumbers(const Next& next, const char* what, const TextCursor& cursor,
                    MeshFaults& faults) {
  double number = 0;
  for (std::string_view word = next(); !word.empty(); word = next())
    if (parseCoordinate(word, number, true))
      return faults.add(cursor.line(), inQuotes(word) +
                                           " comes after the coordinates of a vertex; only numbers "
                                           "(" +
                                           what + ") may follow");
}

}  // namespace corridor
