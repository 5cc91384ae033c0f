#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

static_assert(std::endian::native == std::endian::little, "PCD stores little-endian numbers");

struct Field {
  std::string name;
  std::uint64_t size = 4, count = 1;  ///< bytes of one number; how many numbers a point has
  char type = 'F';                    ///< F (floating point), I (signed), U (unsigned)
  std::uint64_t offset = 0;           ///< bytes before the field in a point
  std::uint64_t bytes() const { return size * count; }
};

struct Header {
  std::vector<Field> fields;
  std::uint64_t points = 0;
  std::uint64_t pointBytes = 0;
  std::string data;      ///< ascii, binary, binary_compressed
  std::size_t size = 0;  ///< bytes before the data
  int lines = 0;
  std::array<std::size_t, 3> xyz{};  ///< indices of the fields x, y and z
  bool hasViewpoint = false;
  std::vector<StatedUnit> statedUnits;  ///< in comments
};

/// Returns whether a viewpoint, tx ty tz qw qx qy qz, is the identity. The quaternions 1 and -1
/// both stand for no rotation.
bool isIdentity(const std::vector<std::string>& viewpoint) {
  for (std::size_t i = 0; i < viewpoint.size(); ++i) {
    double value = 0;
    if (parseCoordinate(viewpoint[i], value)) return false;
    if ((i == 3 ? std::abs(value) : value) != (i == 3 ? 1 : 0)) return false;
  }
  return viewpoint.size() == 7;
}

/// Reads the header. Each line is a keyword followed by words; DATA is the last line.
class PcdHeaderReader {
 public:
  PcdHeaderReader(std::string_view bytes, MeshFaults& faults)
      : cursor_(bytes), bytes_(bytes), faults_(faults) {}

  Header read() {
    std::optional<std::uint64_t> width, height, points;
    do {
      const std::string_view keyword = cursor_.wordInLine();
      if (keyword.empty()) continue;
      if (keyword.front() == '#') {
        addStatedUnit(cursor_.takeLineFrom(keyword), cursor_.line(), header_.statedUnits);
        continue;
      }
      if (!seen_.insert(keyword == "COLUMNS" ? "FIELDS" : keyword).second)
        fail("the header has a second line " + inQuotes(keyword) + "; delete one of them");
      if (keyword == "FIELDS" || keyword == "COLUMNS") {
        for (const std::string& name : words()) header_.fields.push_back({.name = name});
      } else if (keyword == "SIZE") {
        forEachField(keyword, [&](Field& f, const std::string& w) { f.size = size(w); });
      } else if (keyword == "TYPE") {
        forEachField(keyword, [&](Field& f, const std::string& w) {
          if (w != "F" && w != "I" && w != "U") fail("TYPE " + inQuotes(w) + " is not F, I or U");
          f.type = w[0];
        });
      } else if (keyword == "COUNT") {
        forEachField(keyword,
                     [&](Field& f, const std::string& w) { f.count = number(w, 100'000); });
      } else if (keyword == "WIDTH") {
        width = number(one(keyword), 1'000'000'000);
      } else if (keyword == "HEIGHT") {
        height = number(one(keyword), 1'000'000'000);
      } else if (keyword == "POINTS") {
        points = number(one(keyword), 1'000'000'000);
      } else if (keyword == "DATA") {
        header_.data = one(keyword);
      } else if (keyword == "VIEWPOINT") {
        header_.hasViewpoint = !isIdentity(words());
      } else if (keyword != "VERSION") {
        fail(inQuotes(keyword) + " is no line of a PCD header");
      }
    } while (header_.data.empty() && cursor_.nextLine());
    if (header_.data.empty()) fail("the header has no line DATA; a PCD file needs one");
    const std::uint64_t product = width.value_or(0) * height.value_or(1);
    if (points && width && *points != product)
      faults_.fail(0, "POINTS is " + std::to_string(*points) + ", but WIDTH times HEIGHT is " +
                          std::to_string(product));
    finish(points.value_or(product));
    return std::move(header_);
  }

 private:
  std::vector<std::string> words() {
    std::vector<std::string> all;
    for (std::string_view w = cursor_.wordInLine(); !w.empty(); w = cursor_.wordInLine()) {
      if (all.size() == 1000) fail("a line has more than 1000 words");
      all.emplace_back(w);
    }
    return all;
  }
  std::string one(std::string_view keyword) {
    const std::vector<std::string> all = words();
    if (all.size() != 1) fail(std::string(keyword) + " needs one value");
    return all[0];
  }
  template <class Set>
  void forEachField(std::string_view keyword, const Set& set) {
    const std::vector<std::string> all = words();
    if (all.size() != header_.fields.size())
      fail(std::string(keyword) + " has " + std::to_string(all.size()) + " values for " +
           std::to_string(header_.fields.size()) + " FIELDS");
    for (std::size_t i = 0; i < all.size(); ++i) set(header_.fields[i], all[i]);
  }
  std::uint64_t number(const std::string& word, std::uint64_t most) {
    std::int64_t value = 0;
    if (!parseInteger(word, value) || value < 0 || static_cast<std::uint64_t>(value) > most)
      fail(inQuotes(word) + " is not an integer from 0 to " + std::to_string(most));
    return static_cast<std::uint64_t>(value);
  }
  std::uint64_t size(const std::string& word) {
    const std::uint64_t bytes = number(word, 8);
    if (bytes != 1 && bytes != 2 && bytes != 4 && bytes != 8)
      fail("SIZE " + inQuotes(word) + " is not 1, 2, 4 or 8");
    return bytes;
  }

  void finish(std::uint64_t points) {
    limitPoints(points, 0, faults_);
    header_.points = points;
    for (Field& field : header_.fields) {
      if (field.type == 'F' && field.size < 4)
        faults_.fail(0, "field " + inQuotes(field.name) + ": a number of TYPE F has SIZE 4 or 8");
      field.offset = header_.pointBytes;
      header_.pointBytes += field.bytes();
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string name(1, "xyz"[axis]);
      const auto isNamed = [&](const Field& field) { return field.name == name; };
      const auto first = std::find_if(header_.fields.begin(), header_.fields.end(), isNamed);
      if (std::count_if(first, header_.fields.end(), isNamed) != 1 || first->count != 1)
        faults_.fail(0, "FIELDS needs one field \"" + name + "\" of COUNT 1");
      header_.xyz[axis] = static_cast<std::size_t>(first - header_.fields.begin());
    }
    header_.lines = cursor_.line();
    cursor_.nextLine();
    header_.size = bytes_.size() - cursor_.bytesLeft();
  }

  [[noreturn]] void fail(const std::string& text) { faults_.fail(cursor_.line(), text); }

  TextCursor cursor_;
  std::string_view bytes_;
  MeshFaults& faults_;
  std::set<std::string_view> seen_;  // keywords
  Header header_;
};

template <class T>
double loaded(const char* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return static_cast<double>(value);
}

double valueAt(const char* from, const Field& field) {
  switch (field.type) {
    case 'F':
      return field.size == 4 ? loaded<float>(from) : loaded<double>(from);
    case 'I':
      return field.size == 1   ? loaded<std::int8_t>(from)
             : field.size == 2 ? loaded<std::int16_t>(from)
             : field.size == 4 ? loaded<std::int32_t>(from)
                               : loaded<std::int64_t>(from);
    default:
      return field.size == 1   ? loaded<std::uint8_t>(from)
             : field.size == 2 ? loaded<std::uint16_t>(from)
             : field.size == 4 ? loaded<std::uint32_t>(from)
                               : loaded<std::uint64_t>(from);
  }
}

/// Adds a fault and throws if `available` bytes are too few for all points.
void requireBytes(const Header& header, std::uint64_t available, MeshFaults& faults) {
  if (header.pointBytes > 0 && header.points <= available / header.pointBytes) return;
  faults.fail(0, "the header promises " + std::to_string(header.points) + " points of " +
                     std::to_string(header.pointBytes) + " bytes, but " +
                     std::to_string(available) + " bytes are left: the file is cut short");
}

/// Reads ASCII data: one point per line; blank lines are skipped.
std::vector<Vec3> readAscii(std::string_view body, const Header& header, MeshFaults& faults) {
  std::uint64_t words = 0;
  for (const Field& field : header.fields) words += field.count;
  std::array<std::uint64_t, 3> places{};  // indices of x, y and z among the words of a line
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t f = 0; f < header.xyz[axis]; ++f) places[axis] += header.fields[f].count;
  // Each number takes at least two bytes, a digit and a blank; the last one needs no blank.
  if (header.points > (body.size() + 1) / (2 * words))
    faults.fail(0, "the header promises " + std::to_string(header.points) + " points of " +
                       std::to_string(words) + " numbers; the file is cut short");
  std::vector<Vec3> points;
  points.reserve(header.points);
  TextCursor cursor(body, header.lines + 1);
  do {
    std::uint64_t count = 0;
    Vec3 point = Vec3::Zero();
    for (std::string_view word = cursor.wordInLine(); !word.empty(); word = cursor.wordInLine()) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (places[axis] == count)
          if (const auto why = parseCoordinate(word, point[static_cast<Eigen::Index>(axis)], true))
            faults.add(cursor.line(), *why);
      ++count;
    }
    if (count == 0) continue;
    if (count != words)
      faults.fail(cursor.line(), "a line has " + std::to_string(count) +
                                     " numbers; by FIELDS and COUNT a point has " +
                                     std::to_string(words));
    if (points.size() == header.points)
      faults.fail(cursor.line(), "more points than the " + std::to_string(header.points) +
                                     " that the header promises");
    points.push_back(point);
  } while (cursor.nextLine());
  if (points.size() < header.points)
    faults.fail(0, "the header promises " + std::to_string(header.points) +
                       " points, but the file has " + std::to_string(points.size()) +
                       ": it is cut short");
  return points;
}

/// Reads binary data, which are the points one after another, each with all of its fields.
std::vector<Vec3> readBinary(std::string_view body, const Header& header, MeshFaults& faults) {
  requireBytes(header, body.size(), faults);
  const std::string_view rest = body.substr(header.points * header.pointBytes);
  // Some writers fill the file up with zeros or line ends.
  if (rest.find_first_not_of(std::string_view("\0 \t\r\n", 5)) != rest.npos)
    faults.fail(0, std::to_string(rest.size()) +
                       " bytes come after the last point: the header's counts are wrong");
  std::vector<Vec3> points(header.points);
  for (std::uint64_t i = 0; i < header.points; ++i)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Field& field = header.fields[header.xyz[axis]];
      points[i][static_cast<Eigen::Index>(axis)] =
          valueAt(body.data() + i * header.pointBytes + field.offset, field);
    }
  return points;
}

/// Expands LZF (liblzf's format). A control byte c below 32 is followed by c + 1 literal bytes. Any
/// other c stands for a copy of (c >> 5) + 2 bytes of the output written so far. The copy starts (d
/// + 1) bytes before the output's end, where the low 5 bits of c and the next byte give d. If c >>
/// 5 is 7, one more byte comes before the byte of d. The value of this additional byte is added to
/// the length of the copy.
/// @returns nullopt if the data are damaged, or do not expand to `size` bytes.
std::optional<std::string> expanded(std::string_view in, std::uint64_t size) {
  std::string out;
  out.reserve(size);
  for (std::size_t at = 0; at < in.size();) {
    const auto byte = [&] { return static_cast<unsigned char>(in[at++]); };
    const std::size_t control = byte();
    if (control < 32) {
      if (in.size() - at < control + 1 || size - out.size() < control + 1) return std::nullopt;
      out.append(in.substr(at, control + 1));
      at += control + 1;
      continue;
    }
    std::size_t length = control >> 5;
    if (length == 7) {
      if (at == in.size()) return std::nullopt;
      length += byte();
    }
    length += 2;
    if (at == in.size()) return std::nullopt;
    const std::size_t back = ((control & 31) << 8 | byte()) + 1;
    if (back > out.size() || size - out.size() < length) return std::nullopt;
    for (std::size_t k = 0; k < length; ++k) out.push_back(out[out.size() - back]);
  }
  return out.size() == size ? std::optional(std::move(out)) : std::nullopt;
}

/// Reads compressed data. They begin with the compressed and the expanded size in bytes; the
/// compressed values follow. The expanded data are all values of the first field, then all values
/// of the second field, and so on.
std::vector<Vec3> readCompressed(std::string_view body, const Header& header, MeshFaults& faults) {
  if (body.size() < 8) faults.fail(0, "the file ends before its data: it is cut short");
  std::uint32_t packed = 0, size = 0;
  std::memcpy(&packed, body.data(), 4);
  std::memcpy(&size, body.data() + 4, 4);
  body.remove_prefix(8);
  requireBytes(header, size, faults);
  // Three packed bytes expand to at most 264 bytes.
  if (packed > body.size() || size / 264 > packed)
    faults.fail(0, "the data's sizes do not fit the file: it is cut short");
  const auto data = expanded(body.substr(0, packed), size);
  if (!data) faults.fail(0, "the compressed data are damaged");
  std::vector<Vec3> points(header.points);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Field& field = header.fields[header.xyz[axis]];
    const char* column = data->data() + field.offset * header.points;
    for (std::uint64_t i = 0; i < header.points; ++i)
      points[i][static_cast<Eigen::Index>(axis)] = valueAt(column + i * field.size, field);
  }
  return points;
}

}  // namespace

PointCloud readPcd(std::string_view bytes, MeshFaults& faults) {
  const Header header = PcdHeaderReader(bytes, faults).read();
  const std::string_view body = bytes.substr(header.size);
  const auto cloud = [&](std::vector<Vec3> points, const char* format) {
    return PointCloud{.points = std::move(points),
                      .format = format,
                      .hasViewpoint = header.hasViewpoint,
                      .statedUnits = header.statedUnits};
  };
  if (header.data == "ascii") return cloud(readAscii(body, header, faults), "PCD (ASCII)");
  if (header.data == "binary") return cloud(readBinary(body, header, faults), "PCD (binary)");
  if (header.data == "binary_compressed")
    return cloud(readCompressed(body, header, faults), "PCD (compressed)");
  faults.fail(header.lines,
              "DATA " + inQuotes(header.data) + " is not ascii, binary or binary_compressed");
}

}  // namespace corridor
