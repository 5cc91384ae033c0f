#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "collision/core/text_encoding.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr std::size_t headerSize = 84;  // 80 bytes of any content, then the number of triangles
constexpr std::size_t kHeaderText = 80;
constexpr std::size_t facetSize = 50;  // normal and three vertices (4 × 3 floats), 2 unused bytes

std::uint32_t littleEndian32(const char* bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

ReadMesh readBinary(std::string_view bytes, MeshFaults& faults) {
  const std::size_t facets = (bytes.size() - headerSize) / facetSize;
  // A closed mesh has about half as many vertices as triangles.
  VertexWelder welder(facets / 2);
  TriangleMesh mesh;
  mesh.triangles.resize(facets);
  for (std::size_t f = 0; f < facets; ++f) {
    for (int corner = 0; corner < 3; ++corner) {
      const std::size_t place = headerSize + f * facetSize + 12 * (corner + 1);
      Vec3 vertex;
      for (int i = 0; i < 3; ++i) {
        vertex[i] = std::bit_cast<float>(littleEndian32(bytes.data() + place + 4 * i));
      }
      if (!vertex.allFinite()) {
        faults.add(0, "facet " + std::to_string(f + 1) + " (byte " + std::to_string(place) +
                          "): a coordinate is not finite");
        continue;
      }
      mesh.triangles[f][corner] = welder.addOrFind(vertex);
    }
  }
  faults.throwIfAny();
  mesh.vertices = welder.takePoints();
  ReadMesh read{std::move(mesh), "STL (binary)"};
  addStatedUnit(bytes.substr(0, kHeaderText), 0, read.statedUnits);
  return read;
}

/// Returns whether `a` is the keyword, ignoring case. Setting bit 5 turns capitals into lower-case
/// letters, and turns no other character into a letter. @pre `keyword` consists of lower-case
/// letters.
bool sameWord(std::string_view a, std::string_view keyword) {
  return a.size() == keyword.size() && std::equal(a.begin(), a.end(), keyword.begin(),
                                                  [](char x, char y) { return (x | 0x20) == y; });
}

class AsciiStl {
 public:
  AsciiStl(std::string_view text, MeshFaults& faults)
      : cursor_(text), welder_(text.size() / 400), faults_(faults) {}

  ReadMesh read() {
    for (std::string_view word = cursor_.word(); !word.empty(); word = cursor_.word()) {
      if (!sameWord(word, "solid")) unexpected(word, "solid");
      skipName();
      readSolid();
      skipName();
    }
    faults_.throwIfAny();
    mesh_.vertices = welder_.takePoints();
    return {std::move(mesh_), "STL (ASCII)", {}, std::move(statedUnits_)};
  }

 private:
  /// Skips the rest of the line of "solid" or "endsolid", which is a name of any words. Fails if it
  /// has a facet, which no name has: "outer loop vertex" and a number.
  void skipName() {
    TextCursor name = cursor_;
    std::array<std::string_view, 4> last;
    for (std::string_view w = name.wordInLine(); !w.empty(); w = name.wordInLine()) {
      std::rotate(last.begin(), last.begin() + 1, last.end());
      last.back() = w;
      double number = 0;
      if (sameWord(last[0], "outer") && sameWord(last[1], "loop") && sameWord(last[2], "vertex") &&
          !parseCoordinate(w, number))
        faults_.fail(cursor_.line(),
                     "a facet is on the line of solid or endsolid, whose rest is a name; begin a "
                     "new line before the facet");
    }
    addStatedUnit(cursor_.takeRestOfLine(), cursor_.line(), statedUnits_);
    cursor_.nextLine();
  }

  void readSolid() {
    while (true) {
      const std::string_view word = cursor_.word();
      if (word.empty()) cutShort("endsolid");
      if (sameWord(word, "endsolid")) return;
      if (!sameWord(word, "facet")) unexpected(word, "facet or endsolid");
      readFacet();
    }
  }

  void readFacet() {
    // Skips the normal, which may be anything; the corners define the triangle.
    for (std::string_view word = cursor_.word(); !sameWord(word, "outer"); word = cursor_.word()) {
      if (word.empty()) cutShort("outer loop");
      if (sameWord(word, "vertex") || sameWord(word, "endfacet") || sameWord(word, "endsolid")) {
        unexpected(word, "outer loop");
      }
    }
    expect("loop");
    std::array<std::uint32_t, 3> triangle{};
    for (std::uint32_t& corner : triangle) {
      expect("vertex");
      corner = readVertex();
    }
    const std::string_view word = cursor_.word();
    if (sameWord(word, "vertex"))
      faults_.fail(cursor_.line(), "a facet has exactly 3 vertices, found a fourth");
    if (word.empty()) cutShort("endloop");
    if (!sameWord(word, "endloop")) unexpected(word, "endloop");
    expect("endfacet");
    mesh_.triangles.push_back(triangle);
  }

  std::uint32_t readVertex() {
    Vec3 vertex = Vec3::Zero();
    for (int i = 0; i < 3; ++i) {
      const std::string_view word = cursor_.word();
      if (word.empty()) cutShort("a coordinate");
      if (const auto complaint = parseCoordinate(word, vertex[i])) {
        faults_.add(cursor_.line(), *complaint);
        vertex[i] = 0;
      }
    }
    return welder_.addOrFind(vertex);
  }

  void expect(std::string_view keyword) {
    const std::string_view word = cursor_.word();
    if (word.empty()) cutShort(keyword);
    if (!sameWord(word, keyword)) unexpected(word, keyword);
  }

  [[noreturn]] void unexpected(std::string_view word, std::string_view right) {
    faults_.fail(cursor_.line(), "expected " + std::string(right) + ", found " + inQuotes(word));
  }

  [[noreturn]] void cutShort(std::string_view right) {
    faults_.fail(cursor_.line(),
                 "the file ends where " + std::string(right) + " should come, after " +
                     std::to_string(mesh_.triangles.size()) + " whole facets: it is cut short");
  }

  TextCursor cursor_;
  VertexWelder welder_;
  MeshFaults& faults_;
  TriangleMesh mesh_;
  std::vector<StatedUnit> statedUnits_;
};

}  // namespace

ReadMesh readStl(std::string_view bytes, MeshFaults& faults) {
  // The size of the file is tested first, because many binary files also begin with "solid".
  const bool hasHeader = bytes.size() >= headerSize;
  const std::uint64_t promised =
      hasHeader ? headerSize + std::uint64_t{facetSize} * littleEndian32(&bytes[80]) : 0;
  if (hasHeader && promised == bytes.size()) return readBinary(bytes, faults);
  if (const std::string_view text = withoutByteOrderMark(bytes);
      sameWord(TextCursor(text.substr(0, headerSize)).word(), "solid"))
    bytes = text;
  // Text has no zero byte. A binary file has a zero byte in its number of triangles, unless that
  // number is 2^24 or more.
  const std::string_view start = bytes.substr(0, headerSize);
  if (sameWord(TextCursor(start).word(), "solid") && start.find('\0') == start.npos) {
    return AsciiStl(bytes, faults).read();
  }
  if (!hasHeader) {
    faults.fail(0,
                "is not an STL file: ASCII begins with \"solid\", binary has at least 84 "
                "bytes, found " +
                    std::to_string(bytes.size()));
  }
  if (std::ranges::all_of(start,
                          [](char c) { return c == '\n' || c == '\r' || c == '\t' || c >= ' '; }))
    faults.fail(0, "is no STL file: it begins with the text " +
                       inQuotes(start.substr(0, start.find_first_of("\r\n"))));
  faults.fail(
      0,
      "binary STL of " + std::to_string(littleEndian32(&bytes[80])) + " triangles: expected " +
          std::to_string(promised) + " bytes, found " + std::to_string(bytes.size()) +
          (bytes.size() < promised ? ": it is cut short" : ": its header or its end is damaged"));
}

}  // namespace corridor
