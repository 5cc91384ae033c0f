#include "collision/geometry/ply_header.h"

#include <algorithm>
#include <array>
#include <utility>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

std::optional<PlyType> typeOf(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> names{{
      {"char", PlyType::Int8},
      {"int8", PlyType::Int8},
      {"uchar", PlyType::UInt8},
      {"uint8", PlyType::UInt8},
      {"short", PlyType::Int16},
      {"int16", PlyType::Int16},
      {"ushort", PlyType::UInt16},
      {"uint16", PlyType::UInt16},
      {"int", PlyType::Int32},
      {"int32", PlyType::Int32},
      {"uint", PlyType::UInt32},
      {"uint32", PlyType::UInt32},
      {"float", PlyType::Float32},
      {"float32", PlyType::Float32},
      {"double", PlyType::Float64},
      {"float64", PlyType::Float64},
  }};
  for (const auto& [name, type] : names) {
    if (word == name) return type;
  }
  return std::nullopt;
}

class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, bool isMesh, MeshFaults& faults)
      : cursor_(bytes), bytes_(bytes), isMesh_(isMesh), faults_(faults) {}

  PlyHeader read() {
    if (cursor_.wordInLine() != "ply") fail("a PLY file must begin with the line \"ply\"");
    bool hasFormat = false;
    while (cursor_.nextLine()) {
      const std::string_view keyword = cursor_.wordInLine();
      if (keyword == "format") {
        readFormat();
        hasFormat = true;
      } else if (keyword == "element") {
        readElement();
      } else if (keyword == "property") {
        readProperty();
      } else if (keyword == "end_header") {
        if (!hasFormat) fail("the header has no line \"format\"");
        // The body begins right after this line's end, even if its first bytes look like blanks.
        if (!cursor_.nextLine()) fail("the file ends after its header: it is cut short");
        header_.size = bytes_.size() - cursor_.bytesLeft();
        header_.lines = cursor_.line() - 1;
        check();
        return std::move(header_);
      } else if (keyword == "comment" || keyword == "obj_info") {
        addStatedUnit(cursor_.takeRestOfLine(), cursor_.line(), header_.statedUnits);
      } else if (!keyword.empty()) {
        fail("unknown keyword " + inQuotes(keyword) + "; expected element, property or end_header");
      }
    }
    fail("the file ends where end_header should come: it is cut short");
  }

 private:
  [[noreturn]] void fail(std::string text) { faults_.fail(cursor_.line(), std::move(text)); }

  void readFormat() {
    if (hasFormat_) fail("a second format; keep one of the two");
    hasFormat_ = true;
    const std::string_view word = cursor_.wordInLine();
    if (word == "ascii") {
      header_.encoding = PlyEncoding::Ascii;
    } else if (word == "binary_little_endian") {
      header_.encoding = PlyEncoding::LittleEndian;
    } else if (word == "binary_big_endian") {
      header_.encoding = PlyEncoding::BigEndian;
    } else {
      fail("unknown format " + inQuotes(word) +
           "; expected ascii, binary_little_endian or binary_big_endian");
    }
    if (const std::string_view version = cursor_.wordInLine(); version != "1.0") {
      fail("unknown version " + inQuotes(version) + "; expected 1.0");
    }
  }

  void readElement() {
    PlyElement element;
    element.name = cursor_.wordInLine();
    const std::string_view word = cursor_.wordInLine();
    std::int64_t count = 0;
    if (!parseInteger(word, count) || count < 0) {
      fail("element " + inQuotes(element.name) + ": its count " + inQuotes(word) +
           " must be an integer of at least 0");
    }
    element.count = static_cast<std::uint64_t>(count);
    if (header_.elements.size() == mostElements)
      fail("the header has more than " + std::to_string(mostElements) + " elements");
    for (const PlyElement& other : header_.elements) {
      if (other.name == element.name) fail("element " + inQuotes(element.name) + " appears twice");
    }
    header_.elements.push_back(std::move(element));
  }

  PlyType readType() {
    const std::string_view word = cursor_.wordInLine();
    const auto type = typeOf(word);
    if (!type) {
      fail("unknown type " + inQuotes(word) +
           "; expected char, uchar, short, ushort, int, uint, float, double, or int8 to float64");
    }
    return *type;
  }

  void readProperty() {
    if (header_.elements.empty()) fail("a property comes before the first element");
    PlyProperty property{};
    TextCursor ahead = cursor_;
    if (ahead.wordInLine() == "list") {
      cursor_ = ahead;
      property.countType = readType();
      if (!isInteger(*property.countType)) fail("the count of a list must have an integer type");
    }
    property.type = readType();
    property.name = cursor_.wordInLine();
    if (property.name.empty()) fail("a property needs a name");
    std::vector<PlyProperty>& properties = header_.elements.back().properties;
    if (properties.size() == mostProperties)
      fail("element " + inQuotes(header_.elements.back().name) + " has more than " +
           std::to_string(mostProperties) + " properties");
    properties.push_back(std::move(property));
  }

  /// Returns the element of that name. Throws if the header does not have it.
  const PlyElement& find(std::string_view name) {
    const auto found =
        std::find_if(header_.elements.begin(), header_.elements.end(),
                     [&](const PlyElement& element) { return element.name == name; });
    if (found == header_.elements.end()) {
      faults_.fail(0, "the header has no element \"" + std::string(name) + "\"");
    }
    return *found;
  }

  /// Returns whether an element other than `vertex` and `face` may hold triangles: it has a list of
  /// corners; or it is no common one, and has any list, or a name like "polygon" or "tristrips".
  static bool mayHoldTriangles(const PlyElement& element) {
    const auto has = [&](const auto& isMeant) {
      return std::any_of(element.properties.begin(), element.properties.end(), isMeant);
    };
    if (has(isCornerList)) return true;
    const std::string name = lowered(element.name);
    if (name == "edge" || name == "material" || name == "camera") return false;
    for (const char* const part : {"face", "poly", "tris", "triang", "quad", "strip", "mesh"})
      if (name.find(part) != name.npos) return true;
    return has([](const PlyProperty& p) { return p.countType.has_value(); });
  }

  void check() {
    const auto& vertex = find("vertex").properties;
    for (const std::string_view axis : {"x", "y", "z"}) {
      const auto same = [&](const PlyProperty& p) { return p.name == axis && !p.countType; };
      if (std::count_if(vertex.begin(), vertex.end(), same) != 1) {
        faults_.fail(0, "element \"vertex\" needs one property \"" + std::string(axis) + "\"");
      }
    }
    if (!isMesh_) return;
    const auto& face = find("face").properties;
    const auto corners = [](const PlyProperty& p) {
      return isCornerList(p) && p.countType && isInteger(p.type);
    };
    if (std::count_if(face.begin(), face.end(), corners) != 1 ||
        std::count_if(face.begin(), face.end(), isCornerList) != 1) {
      faults_.fail(0, "element \"face\" needs one list \"vertex_indices\" of an integer type");
    }
    for (const PlyElement& element : header_.elements)
      if (element.count > 0 && element.name != "vertex" && element.name != "face" &&
          mayHoldTriangles(element))
        faults_.fail(0,
                     "element " + inQuotes(element.name) +
                         " is not read, and may hold triangles; save the mesh with polygons only");
  }

  // Limits for damaged headers. The time to read a header is quadratic in its number of elements,
  // because the name of each element is compared with all others.
  static constexpr std::size_t mostElements = 1000, mostProperties = 1000;

  TextCursor cursor_;
  std::string_view bytes_;
  bool isMesh_;
  MeshFaults& faults_;
  PlyHeader header_;
  bool hasFormat_ = false;
};

}  // namespace

int plySize(PlyType type) {
  switch (type) {
    case PlyType::Int8:
    case PlyType::UInt8:
      return 1;
    case PlyType::Int16:
    case PlyType::UInt16:
      return 2;
    case PlyType::Int32:
    case PlyType::UInt32:
    case PlyType::Float32:
      return 4;
    case PlyType::Float64:
      return 8;
  }
  return 0;
}

PlyHeader readPlyHeader(std::string_view bytes, bool isMesh, MeshFaults& faults) {
  return HeaderReader(bytes, isMesh, faults).read();
}

}  // namespace corridor
