#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "collision/core/text_encoding.h"
#include "collision/geometry/cut_polygons.h"
#include "collision/geometry/mesh_readers.h"
#include "collision/geometry/ply_header.h"
#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

/// Lists of faces that do not concern their shapes.
constexpr std::array<std::string_view, 11> kLooks{"texcoord", "texnumber", "flags",  "red",
                                                  "green",    "blue",      "alpha",  "color",
                                                  "colour",   "colors",    "quality"};

/// The element that is being read, and the index of its entry, for messages.
struct Place {
  const PlyElement* element = nullptr;
  std::uint64_t index = 0;

  std::string str() const {
    return printable(element->name) + ' ' + std::to_string(index + 1) + " of " +
           std::to_string(element->count);
  }
};

/// Reads values from an ASCII body, where each value is a word.
class AsciiBody {
 public:
  AsciiBody(std::string_view body, const PlyHeader& header, MeshFaults& faults)
      : cursor_(body, header.lines + 1), faults_(faults) {}

  /// Returns the least number of bytes that a value takes: two, for a digit and a blank.
  static std::uint64_t leastSize(PlyType) { return 2; }
  /// Returns the number of bytes left, plus one: the last word of a file needs no blank after it,
  /// so it may be one byte shorter than `leastSize`.
  std::uint64_t bytesLeft() const { return cursor_.bytesLeft() + 1; }

  double coordinate(PlyType) {
    double value = 0;
    const std::string_view text = word();
    if (const auto complaint = parseCoordinate(text, value, !isMesh)) add(*complaint);
    return value;
  }

  std::int64_t integer(PlyType) {
    std::int64_t value = 0;
    const std::string_view text = word();
    if (!parseInteger(text, value)) fail(inQuotes(text) + " is not an integer");
    return value;
  }

  void skip(PlyType, std::uint64_t times) {
    for (std::uint64_t i = 0; i < times; ++i) word();
  }

  void expectEnd() {
    const std::string_view text = cursor_.word();
    if (text.empty()) return;
    faults_.fail(cursor_.line(),
                 inQuotes(text) + " comes after the last element: the header's counts are wrong");
  }

  void add(const std::string& text) { faults_.add(cursor_.line(), place.str() + ": " + text); }
  [[noreturn]] void fail(const std::string& text) {
    faults_.fail(cursor_.line(), place.str() + ": " + text);
  }

  int line() const { return cursor_.line(); }

  Place place;
  bool isMesh = true;  // false: coordinates need not be finite

 private:
  std::string_view word() {
    const std::string_view text = cursor_.word();
    if (text.empty()) fail("the file ends here: it is cut short");
    return text;
  }

  TextCursor cursor_;
  MeshFaults& faults_;
};

/// Reads values from a binary body.
class BinaryBody {
 public:
  BinaryBody(std::string_view body, const PlyHeader& header, MeshFaults& faults)
      : rest_(body),
        size_(header.size + body.size()),
        swapped_((header.encoding == PlyEncoding::BigEndian) !=
                 (std::endian::native == std::endian::big)),
        faults_(faults) {}

  static std::uint64_t leastSize(PlyType type) { return static_cast<std::uint64_t>(plySize(type)); }
  std::uint64_t bytesLeft() const { return rest_.size(); }

  double coordinate(PlyType type) {
    if (isInteger(type)) return static_cast<double>(integer(type));
    const double value = type == PlyType::Float32 ? take<float>() : take<double>();
    if (isMesh && !std::isfinite(value)) add("a coordinate is not finite");
    return value;
  }

  std::int64_t integer(PlyType type) {
    switch (type) {
      case PlyType::Int8:
        return take<std::int8_t>();
      case PlyType::UInt8:
        return take<std::uint8_t>();
      case PlyType::Int16:
        return take<std::int16_t>();
      case PlyType::UInt16:
        return take<std::uint16_t>();
      case PlyType::Int32:
        return take<std::int32_t>();
      default:
        return take<std::uint32_t>();  // the header allows no other type here
    }
  }

  void skip(PlyType type, std::uint64_t times) {
    if (times > rest_.size() / leastSize(type)) cutShort();
    rest_.remove_prefix(times * leastSize(type));
  }

  void expectEnd() {
    if (rest_.find_first_not_of(" \t\r\n") == rest_.npos) return;
    faults_.fail(0, std::to_string(rest_.size()) +
                        " bytes come after the last element: the header's counts are wrong");
  }

  void add(const std::string& text) { faults_.add(0, where() + text); }
  [[noreturn]] void fail(const std::string& text) { faults_.fail(0, where() + text); }

  static int line() { return 0; }

  Place place;
  bool isMesh = true;  // false: coordinates need not be finite

 private:
  std::string where() const {
    return place.str() + " (byte " + std::to_string(size_ - rest_.size()) + "): ";
  }
  [[noreturn]] void cutShort() { fail("the file ends here: it is cut short"); }

  template <class T>
  T take() {
    if (rest_.size() < sizeof(T)) cutShort();
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    if (swapped_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  std::string_view rest_;
  std::size_t size_;
  bool swapped_;
  MeshFaults& faults_;
};

template <class Body>
class BodyReader {
 public:
  BodyReader(const PlyHeader& header, bool isMesh, Body body, MeshFaults& faults)
      : header_(header), isMesh_(isMesh), body_(std::move(body)), faults_(faults) {
    body_.isMesh = isMesh;
  }

  /// Appends notes to `notes`.
  TriangleMesh read(std::vector<std::string>& notes) {
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex" && isMesh_) faults_.requireFew(element.count, "vertices", 0);
      if (element.name == "vertex" && !isMesh_) limitPoints(element.count, 0, faults_);
      if (element.name == "face") faults_.requireFew(element.count, "faces", 0);
      if (element.name == "vertex") vertexCount_ = element.count;
    }
    for (const PlyElement& element : header_.elements) {
      if (!hasRoom(element)) continue;
      if (element.name == "vertex") mesh_.vertices.reserve(element.count);
      if (isMesh_ && element.name == "face") mesh_.triangles.reserve(element.count);
      for (std::uint64_t i = 0; i < element.count; ++i) {
        body_.place = {&element, i};
        readElement(element);
      }
    }
    body_.expectEnd();
    faults_.throwIfAny();
    cutPolygons(mesh_, polygons_, faults_, notes);
    return std::move(mesh_);
  }

 private:
  /// Fails unless the file has enough bytes left for the count of an element. Called before memory
  /// is allocated for the element. Returns true for elements that must be read. Returns false for
  /// elements without properties, which take no bytes and are skipped.
  bool hasRoom(const PlyElement& element) {
    std::uint64_t size = 0;
    for (const PlyProperty& p : element.properties)
      size += Body::leastSize(p.countType.value_or(p.type));
    if (size == 0) return false;
    if (element.count <= body_.bytesLeft() / size) return true;
    faults_.fail(0, "the header promises " + std::to_string(element.count) + " of element " +
                        inQuotes(element.name) + ", at least " + std::to_string(size) +
                        " bytes each, but " + std::to_string(body_.bytesLeft()) +
                        " bytes are left: the file is cut short");
  }

  void readElement(const PlyElement& element) {
    const bool isVertex = element.name == "vertex";
    const bool isFace = isMesh_ && element.name == "face";
    Vec3 vertex = Vec3::Zero();
    for (const PlyProperty& p : element.properties) {
      if (p.countType) {
        const std::int64_t count = body_.integer(*p.countType);
        if (count < 0)
          body_.fail("a list of " + std::to_string(count) + " values; a count must be at least 0");
        if (isFace && isCornerList(p)) {
          readCorners(p.type, count);
        } else {
          body_.skip(p.type, static_cast<std::uint64_t>(count));
        }
      } else if (isVertex && (p.name == "x" || p.name == "y" || p.name == "z")) {
        vertex[p.name[0] - 'x'] = body_.coordinate(p.type);
      } else {
        body_.skip(p.type, 1);
      }
    }
    if (isVertex) mesh_.vertices.push_back(vertex);
  }

  void readCorners(PlyType type, std::int64_t count) {
    if (count < 3) body_.add("a face has at least 3 corners, found " + std::to_string(count));
    std::array<std::uint32_t, 3> triangle{};
    const auto first = static_cast<std::uint32_t>(mesh_.triangles.size());
    for (std::int64_t i = 0; i < count; ++i) {
      const std::int64_t corner = body_.integer(type);
      if (corner < 0 || static_cast<std::uint64_t>(corner) >= vertexCount_) {
        body_.add("corner " + std::to_string(corner) + " is out of range: the file has " +
                  std::to_string(vertexCount_) + " vertices, counted from 0");
      }
      triangle[i < 2 ? i : 2] = static_cast<std::uint32_t>(corner);
      if (i < 2) continue;
      mesh_.triangles.push_back(triangle);
      faults_.requireFew(mesh_, 0);
      triangle[1] = triangle[2];
    }
    if (count > 3)
      polygons_.push_back({first, static_cast<std::uint32_t>(count - 2),
                           static_cast<std::uint32_t>(body_.place.index + 1), body_.line()});
  }

  const PlyHeader& header_;
  bool isMesh_;
  Body body_;
  MeshFaults& faults_;
  std::uint64_t vertexCount_ = 0;
  TriangleMesh mesh_;
  std::vector<PolygonFan> polygons_;
};

template <class Body>
ReadMesh readBody(std::string_view body, const PlyHeader& header, bool isMesh, const char* format,
                  MeshFaults& faults) {
  ReadMesh read;
  read.mesh = BodyReader<Body>(header, isMesh, Body(body, header, faults), faults).read(read.notes);
  read.format = format;
  return read;
}

/// Returns notes on elements that are not read, and on lists of faces that are not read and are
/// none of those that do not concern their shapes.
std::vector<std::string> notesOnLists(const PlyHeader& header) {
  std::vector<std::string> notes;
  static constexpr std::array<std::string_view, 5> known{"vertex", "face", "edge", "material",
                                                         "camera"};
  for (const PlyElement& element : header.elements)
    if (std::ranges::find(known, element.name) == known.end() && element.count > 0)
      notes.push_back("the element " + inQuotes(element.name) + " is not read");
  for (const PlyElement& element : header.elements)
    for (const PlyProperty& p : element.properties)
      if (element.name == "face" && element.count > 0 && p.countType && !isCornerList(p) &&
          std::none_of(kLooks.begin(), kLooks.end(), [&](auto name) { return p.name == name; }))
        notes.push_back("the list " + inQuotes(p.name) + " of faces is not read");
  return notes;
}

ReadMesh readPlyElements(std::string_view bytes, const PlyHeader& header, bool isMesh,
                         MeshFaults& faults) {
  const std::string_view body = bytes.substr(header.size);
  switch (header.encoding) {
    case PlyEncoding::Ascii:
      return readBody<AsciiBody>(body, header, isMesh, "PLY (ASCII)", faults);
    case PlyEncoding::LittleEndian:
      return readBody<BinaryBody>(body, header, isMesh, "PLY (binary, little endian)", faults);
    case PlyEncoding::BigEndian:
      break;
  }
  return readBody<BinaryBody>(body, header, isMesh, "PLY (binary, big endian)", faults);
}

}  // namespace

ReadMesh readPly(std::string_view bytes, MeshFaults& faults) {
  bytes = withoutByteOrderMark(bytes);
  const PlyHeader header = readPlyHeader(bytes, true, faults);
  ReadMesh read = readPlyElements(bytes, header, true, faults);
  for (std::string& note : notesOnLists(header)) read.notes.push_back(std::move(note));
  read.statedUnits = header.statedUnits;
  return read;
}

PointCloud readPlyPoints(std::string_view bytes, MeshFaults& faults) {
  const PlyHeader header = readPlyHeader(bytes, false, faults);
  ReadMesh read = readPlyElements(bytes, header, false, faults);
  PointCloud cloud{
      std::move(read.mesh.vertices), std::move(read.format), 0, false, 0, 0, header.statedUnits};
  for (const PlyElement& element : header.elements)
    if (element.name != "vertex" && element.count > 0) cloud.unreadElements.push_back(element.name);
  return cloud;
}

}  // namespace corridor
