#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "collision/core/text_encoding.h"
#include "collision/geometry/cut_polygons.h"
#include "collision/geometry/mesh_readers.h"

namespace corridor {
namespace {

/// Returns whether a keyword cannot matter: it is about normals, textures, names, the looks, or the
/// parameters of free-form curves and surfaces, which other keywords begin.
bool isHarmless(std::string_view keyword) {
  static constexpr std::array<std::string_view, 22> harmless{
      "vn",        "vt",     "vp",     "g",      "o",        "s",        "mg",  "mtllib",
      "usemtl",    "usemap", "maplib", "bevel",  "c_interp", "d_interp", "lod", "shadow_obj",
      "trace_obj", "ctech",  "stech",  "cstype", "deg",      "step"};
  return std::find(harmless.begin(), harmless.end(), keyword) != harmless.end();
}

/// Adds a fault if a keyword is not one of those that are read, noted or harmless.
void checkKeyword(std::string_view keyword, int line, MeshFaults& faults) {
  constexpr std::array<std::string_view, 4> read{"v", "f", "l", "p"};
  if (std::find(read.begin(), read.end(), keyword) != read.end() || isHarmless(keyword)) return;
  faults.add(line, "the keyword " + inQuotes(keyword) +
                       " is not supported, and may be or move geometry; write faces with v and f");
}

class ObjReader {
 public:
  ObjReader(std::string_view text, MeshFaults& faults)
      : cursor_(text), mayContinue_(text.find('\\') != text.npos), faults_(faults) {}

  ReadMesh read() {
    do {
      continued_ = false;
      const std::string_view keyword = nextWord();
      if (keyword == "v") {
        readVertex();
      } else if (keyword == "f") {
        readFace();
      } else if (keyword == "l" || keyword == "p") {
        addNote(notes_, kNoteOnLines);
      } else if (!keyword.empty()) {
        checkKeyword(keyword, cursor_.line(), faults_);
      }
      if (mayContinue_ && !keyword.empty() && keyword != "f") skipWords();
      faults_.requireFew(mesh_, cursor_.line());
    } while (cursor_.nextLine());
    for (const LateCorner& late : lateCorners_) {
      if (late.number > count()) outOfRange(late.line, late.number);
    }
    faults_.throwIfAny();
    cutPolygons(mesh_, polygons_, faults_, notes_);
    return {std::move(mesh_), "OBJ", std::move(notes_), std::move(statedUnits_)};
  }

 private:
  struct LateCorner {  ///< a corner whose vertex comes later in the file
    std::int64_t number;
    int line;
  };

  std::int64_t count() const { return static_cast<std::int64_t>(mesh_.vertices.size()); }

  /// Returns the next word of the logical line; empty at the end of this line, and at a word that
  /// begins with '#'. A backslash at the end of a line continues the logical line on the next line.
  std::string_view nextWord() {
    std::string_view word = cursor_.wordInLine();
    if (continued_ && !word.empty()) faultBackslash();
    while (word == "\\" || (word.empty() && continued_)) {
      if (!continued_ && !cursor_.wordInLine().empty()) faultBackslash();
      continued_ = false;
      if (!cursor_.nextLine()) return {};
      word = cursor_.wordInLine();
      if (word == "f" || word == "v") noteContinued(word);
    }
    continued_ = !word.empty() && word.back() == '\\';
    if (continued_) word.remove_suffix(1);
    if (!word.starts_with('#')) return word;
    continued_ = false;
    addStatedUnit(cursor_.takeLineFrom(word), cursor_.line(), statedUnits_);
    return {};
  }

  void faultBackslash() {
    faults_.add(cursor_.line(),
                "a backslash continues a line only at its end; something follows it");
  }
  void noteContinued(std::string_view word) {
    addNote(notes_, "line " + std::to_string(cursor_.line()) + ", which begins with " +
                        std::string(word) +
                        ", continues the line above, which ends in a backslash");
  }

  void skipWords() {  // of the logical line, which may go on for several lines
    while (!nextWord().empty()) {
    }
  }

  void readVertex() {  // also keeps a faulty vertex, so that later vertices keep their numbers
    int words = 0;
    const auto next = [&] { return ++words, nextWord(); };
    mesh_.vertices.push_back(parseVertex(next, cursor_, faults_));
    if (words != 3) return;
    int more = 0;
    double weight = 1;
    const auto nextOfMore = [&] {
      const std::string_view word = nextWord();
      double number = 0;
      if (!word.empty() && ++more == 1 && !parseCoordinate(word, number, true)) weight = number;
      return word;
    };
    requireNumbers(nextOfMore, "a weight or a colour", cursor_, faults_);
    if (more == 1 && weight != 1)
      addNote(notes_, "vertices have weights (the fourth number), which are not used");
  }

  void readFace() {
    std::array<std::uint32_t, 3> triangle{};
    const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
    std::uint32_t corners = 0;
    ++faces_;
    for (std::string_view word = nextWord(); !word.empty(); word = nextWord()) {
      triangle[corners < 2 ? corners : 2] = corner(word);
      if (++corners < 3) continue;
      mesh_.triangles.push_back(triangle);
      faults_.requireFew(mesh_, cursor_.line());
      triangle[1] = triangle[2];
    }
    if (corners < 3) {
      faults_.add(cursor_.line(),
                  "a face has at least 3 corners, found " + std::to_string(corners));
    } else if (corners > 3) {
      polygons_.push_back({first, corners - 2, faces_, cursor_.line()});
    }
  }

  std::uint32_t corner(std::string_view word) {
    const std::size_t slash = word.find('/');
    std::int64_t number = 0;
    if (!parseInteger(word.substr(0, slash), number) ||
        (slash != word.npos && word.find_first_not_of("0123456789/+-", slash) != word.npos)) {
      faults_.add(cursor_.line(),
                  "face corner " + inQuotes(word) + " is not of the form 1, 1/2, 1/2/3 or 1//3");
      return 0;
    }
    if (number == 0) {
      faults_.add(cursor_.line(),
                  "face corner 0 is out of range: vertices count from 1, or backwards from -1");
      return 0;
    }
    if (number < -count()) {
      faults_.add(cursor_.line(), "face corner " + std::to_string(number) + " is out of range: " +
                                      std::to_string(count()) + " vertices come before it");
      return 0;
    }
    if (number < 0) return static_cast<std::uint32_t>(count() + number);
    if (number > UINT32_MAX) {
      outOfRange(cursor_.line(), number);
      return 0;
    }
    if (number > count()) lateCorners_.push_back({number, cursor_.line()});
    return static_cast<std::uint32_t>(number - 1);
  }

  void outOfRange(int line, std::int64_t number) {
    faults_.add(line, "face corner " + std::to_string(number) + " is out of range: the file has " +
                          std::to_string(count()) + " vertices");
  }

  TextCursor cursor_;
  const bool mayContinue_;  // there is a backslash in the file; skipping words takes time
  MeshFaults& faults_;
  bool continued_ = false;
  TriangleMesh mesh_;
  std::uint32_t faces_ = 0;
  std::vector<PolygonFan> polygons_;
  std::vector<LateCorner> lateCorners_;
  std::vector<std::string> notes_;
  std::vector<StatedUnit> statedUnits_;
};

}  // namespace

ReadMesh readObj(std::string_view text, MeshFaults& faults) {
  // A byte-order mark would hide the first keyword. If the hidden keyword is `v`, all vertex
  // numbers would be off by one.
  return ObjReader(withoutByteOrderMark(text), faults).read();
}

}  // namespace corridor
