#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <utility>

#include "collision/core/text_encoding.h"
#include "collision/geometry/cut_polygons.h"
#include "collision/geometry/mesh_limits.h"
#include "collision/geometry/mesh_readers.h"

namespace corridor {
namespace {

/// A reader of OFF as text. The file begins with the word "OFF", or with a variant such as "COFF"
/// if its vertices have more than three numbers. The counts follow, then one vertex or face per
/// line. Only coordinates and corners are read.
class OffReader {
 public:
  OffReader(std::string_view text, MeshFaults& faults) : cursor_(text), faults_(faults) {}

  ReadMesh read() {
    readKeyword();
    const std::int64_t vertices = count("vertices"), faces = count("faces");
    // The count of edges must end this line. If the count were missing, the first vertex would be
    // read as the count, or be skipped.
    if (wordInLine().empty())
      faults_.fail(cursor_.line(),
                   "the number of edges is missing; add a third number to the line, for example 0");
    if (const std::string_view more = wordInLine(); !more.empty())
      faults_.fail(cursor_.line(), "the numbers of vertices, faces and edges are followed by " +
                                       inQuotes(more) + "; a new line is needed");
    endLine();
    for (std::int64_t i = 0; i < vertices; ++i) readVertex(i, vertices);
    for (std::int64_t i = 0; i < faces; ++i) readFace(i, faces);
    if (const std::string_view more = nextWord(); !more.empty())
      faults_.add(cursor_.line(), inQuotes(more) + " comes after the last of the " +
                                      std::to_string(faces) + " faces: the counts are wrong");
    faults_.throwIfAny();
    ReadMesh read;
    cutPolygons(mesh_, polygons_, faults_, read.notes);
    read.mesh = std::move(mesh_);
    read.format = "OFF";
    if (hasLines_) read.notes.push_back(kNoteOnLines);
    read.statedUnits = std::move(statedUnits_);
    return read;
  }

 private:
  /// Returns the next word of this or a later line, skipping comments.
  std::string_view nextWord() {
    std::string_view word = cursor_.word();
    while (isComment(word)) word = cursor_.nextLine() ? cursor_.word() : std::string_view();
    return word;
  }
  /// Returns the next word of this line; empty at the end of the line or at a comment.
  std::string_view wordInLine() {
    const std::string_view word = cursor_.wordInLine();
    return word.substr(0, isComment(word) ? 0 : word.npos);
  }
  /// Goes to the next line. The rest of this line is skipped: a face's colour, or a comment.
  void endLine() {
    const std::string_view rest = cursor_.takeRestOfLine();
    if (const std::size_t mark = rest.find('#'); mark != rest.npos) noteUnit(rest.substr(mark));
    cursor_.nextLine();
  }
  /// Returns whether the word begins a comment, which may state a unit.
  bool isComment(std::string_view word) {
    if (!word.starts_with('#')) return false;
    noteUnit(cursor_.takeLineFrom(word));
    return true;
  }
  void noteUnit(std::string_view comment) { addStatedUnit(comment, cursor_.line(), statedUnits_); }

  void readKeyword() {
    std::string_view word = nextWord();
    const std::string_view keyword = word;
    for (const std::string_view kind : {"ST", "C", "N"})
      if (word.starts_with(kind)) word.remove_prefix(kind.size());
    if (word != "OFF")
      faults_.fail(cursor_.line(), "begins with " + inQuotes(keyword) +
                                       "; \"OFF\", \"COFF\", \"NOFF\" or \"STOFF\" is needed");
  }

  std::int64_t count(const std::string& what) {
    const std::string_view word = nextWord();
    std::int64_t number = 0;
    if (word == "BINARY")
      faults_.fail(cursor_.line(), "is binary, which is not supported; save it as text");
    if (!parseInteger(word, number) || number < 0)
      faults_.fail(cursor_.line(), "the number of " + what + " is " + inQuotes(word) +
                                       "; a whole number is needed");
    faults_.requireFew(static_cast<std::uint64_t>(number), what, cursor_.line());
    if (number > static_cast<std::int64_t>(cursor_.bytesLeft()))
      faults_.fail(cursor_.line(),
                   std::to_string(number) + " " + what + " are more than the file has bytes for");
    return number;
  }

  void requireMore(const char* what, std::int64_t i, std::int64_t all, std::string_view word) {
    if (word.empty())
      faults_.fail(cursor_.line(),
                   "ends after " + std::to_string(i) + " of " + std::to_string(all) + " " + what);
  }

  void readVertex(std::int64_t i, std::int64_t all) {
    std::string_view first = nextWord();
    requireMore("vertices", i, all, first);
    int words = 0;
    const auto next = [&] {
      return ++words, first.empty() ? wordInLine() : std::exchange(first, {});
    };
    mesh_.vertices.push_back(parseVertex(next, cursor_, faults_));
    if (words == 3)  // a fault in the coordinates is enough
      requireNumbers([&] { return wordInLine(); }, "a colour or a normal", cursor_, faults_);
    endLine();
  }

  void readFace(std::int64_t i, std::int64_t all) {
    const std::string_view word = nextWord();
    requireMore("faces", i, all, word);
    std::int64_t corners = 0;
    if (!parseInteger(word, corners) || corners < 1) {
      faults_.add(cursor_.line(),
                  "a face begins with the number of its corners, not " + inQuotes(word));
      corners = 0;
    }
    hasLines_ |= corners == 1 || corners == 2;
    std::array<std::uint32_t, 3> triangle{};
    const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
    for (std::int64_t k = 0; k < corners; ++k) {
      const auto corner = readCorner(k, corners);
      if (!corner) break;
      triangle[static_cast<std::size_t>(std::min<std::int64_t>(k, 2))] = *corner;
      if (k < 2) continue;
      mesh_.triangles.push_back(triangle);
      faults_.requireFew(mesh_, cursor_.line());
      triangle[1] = triangle[2];
    }
    if (const auto triangles = static_cast<std::uint32_t>(mesh_.triangles.size()) - first;
        triangles > 1)
      polygons_.push_back({first, triangles, static_cast<std::uint32_t>(i + 1), cursor_.line()});
    endLine();
  }

  std::optional<std::uint32_t> readCorner(std::int64_t k, std::int64_t corners) {
    const std::string_view word = wordInLine();
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    std::int64_t number = 0;
    if (word.empty()) {
      faults_.add(cursor_.line(), "a face of " + std::to_string(corners) + " corners lists only " +
                                      std::to_string(k));
    } else if (!parseInteger(word, number)) {
      faults_.add(cursor_.line(), "face corner " + inQuotes(word) + " is not a whole number");
    } else if (number < 0 || number >= count) {
      faults_.add(cursor_.line(), "face corner " + std::to_string(number) +
                                      " is out of range: the file has " + std::to_string(count) +
                                      " vertices, from 0");
    } else {
      return static_cast<std::uint32_t>(number);
    }
    return std::nullopt;
  }

  TextCursor cursor_;
  MeshFaults& faults_;
  TriangleMesh mesh_;
  bool hasLines_ = false;
  std::vector<PolygonFan> polygons_;
  std::vector<StatedUnit> statedUnits_;
};

}  // namespace

ReadMesh readOff(std::string_view text, MeshFaults& faults) {
  return OffReader(withoutByteOrderMark(text), faults).read();
}

}  // namespace corridor
