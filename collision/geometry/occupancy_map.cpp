#include "collision/geometry/occupancy_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>
#include <set>
#include <string_view>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/geometry/mesh_text.h"

namespace corridor {
namespace {

static_assert(std::endian::native == std::endian::little, "OctoMap stores little-endian numbers");

constexpr int kDepth = 16;                      ///< levels below the root, as in OctoMap
constexpr std::size_t kMostCubes = 10'000'000;  ///< as an obstacle, a cube takes some 300 bytes
constexpr const char* kBinary = "# Octomap OcTree binary file";
constexpr const char* kFull = "# Octomap OcTree file";

enum class NodeKind { none, free, occupied, inner };

/// Reads nodes from the data of a file, depth first. Recursion is at most 17 deep.
class MapReader {
 public:
  MapReader(std::string_view bytes, const OccupancyRules& rules, const std::string& file)
      : cursor_(bytes),
        bytes_(bytes),
        rules_(rules),
        least_(static_cast<float>(std::log(rules.threshold / (1 - rules.threshold)))),
        faults_(file) {}

  OccupancyMap readFile() {
    requireThreshold();
    readHeader();
    return readNodes();
  }

  OccupancyMap readMessage(const OccupancyMessage& message) {
    requireThreshold();
    binary_ = message.binary;
    map_.format = "octomap_msgs/Octomap";
    map_.resolution = message.resolution;
    setTree(message.id);
    return readNodes();
  }

 private:
  using Cube = OccupancyMap::Cube;

  void requireThreshold() {
    if (!(rules_.threshold > 0 && rules_.threshold < 1))
      faults_.fail(0, "threshold: a probability above 0 and below 1 is needed, not " +
                          shortest(rules_.threshold));
  }

  OccupancyMap readNodes() {
    constexpr std::int32_t half = 1 << (kDepth - 1);
    const OccupancyMap::Cube root{{-half, -half, -half}, 1 << kDepth};
    if (promised_ ? *promised_ > 0 : !bytes_.empty()) {
      nodes_ = 1;
      if (binary_)
        readChildren(root, 0);
      else
        readNode(root, 0);
    }
    if (const std::size_t rest = bytes_.size() - at_)
      faults_.fail(0, (rest == 1 ? "1 byte comes" : std::to_string(rest) + " bytes come") +
                          " after the last node: the " + container() + " is damaged");
    if (promised_ && nodes_ != *promised_)
      faults_.fail(0, "the header promises " + std::to_string(*promised_) +
                          " nodes, but the data have " + std::to_string(nodes_) +
                          ": the file is damaged");
    if (nodes_ == 1 && binary_)
      faults_.fail(0,
                   "the tree has a root only, whose state this form of a map does not store; save "
                   "the full form");
    if (rules_.unknownIsOccupied) addUnknown();
    return std::move(map_);
  }

  /// Returns what contains the map, "file" or "message", for error messages.
  std::string container() const { return promised_ ? "file" : "message"; }

  /// Checks the type of the tree and the resolution.
  void setTree(const std::string& id) {
    map_.hasProbabilities = !binary_;
    if (id != "OcTree" && (binary_ || id != "ColorOcTree"))
      faults_.fail(0, "trees of type " + inQuotes(id) + " can't be read; save an OcTree" +
                          (binary_ ? "" : " or a ColorOcTree"));
    color_ = id == "ColorOcTree";
    // The largest coordinate, 2^15 times the resolution, must be finite.
    if (!(map_.resolution > 0 && map_.resolution < 1e100))
      faults_.fail(0, std::string(promised_ ? "res" : "resolution") +
                          ": the edge length of a cell, in metres, must be above 0 and below "
                          "1e100");
  }

  void readHeader() {
    const std::size_t end = std::min(bytes_.find('\n'), bytes_.size());
    std::string_view first = bytes_.substr(0, end);
    if (first.ends_with('\r')) first.remove_suffix(1);
    binary_ = first.starts_with(kBinary);
    if (!binary_ && !first.starts_with(kFull))
      faults_.fail(1, "a map of OctoMap begins with \"" + std::string(kBinary) + "\" or \"" +
                          std::string(kFull) + "\"");
    map_.format = binary_ ? "OctoMap (.bt)" : "OctoMap (.ot)";
    std::string id;
    std::optional<std::int64_t> size;
    std::set<std::string> known;
    for (;;) {
      if (!cursor_.nextLine()) faults_.fail(cursor_.line(), "the header has no line \"data\"");
      const std::string_view word = cursor_.wordInLine();
      if (word.empty() || word.front() == '#') continue;
      if (word == "data") break;
      const std::string_view value = cursor_.wordInLine();
      if (const std::string_view more = cursor_.wordInLine(); !more.empty())
        faults_.fail(cursor_.line(), inQuotes(more) + " comes after the value of " +
                                         inQuotes(word) + "; one value is needed");
      if (!known.insert(std::string(word)).second)
        faults_.fail(cursor_.line(), "the header has a second line " + inQuotes(word));
      std::int64_t number = 0;
      if (word == "id") {
        id = value;
      } else if (word == "size") {
        if (!parseInteger(value, number) || number < 0)
          faults_.fail(cursor_.line(), "size: a number of nodes is needed, not " + inQuotes(value));
        size = number;
      } else if (word == "res") {
        if (const auto why = parseCoordinate(value, map_.resolution))
          faults_.fail(cursor_.line(), "res: " + *why);
      } else {
        faults_.fail(cursor_.line(), inQuotes(word) + " is no line of OctoMap's header");
      }
    }
    if (!size) faults_.fail(0, "the header has no line \"size\"");
    promised_ = size;
    setTree(id);
    at_ = bytes_.size() - cursor_.bytesLeft();
    // The line `data` ends with a line feed. All bytes after this line feed are data.
    const std::size_t feed = bytes_.find('\n', at_);
    at_ = feed == bytes_.npos ? bytes_.size() : feed + 1;
  }

  template <class T>
  T take() {
    if (bytes_.size() - at_ < sizeof(T))
      faults_.fail(0, "the " + container() + " ends within its nodes: it is cut short");
    T value;
    std::memcpy(&value, bytes_.data() + at_, sizeof(T));
    at_ += sizeof(T);
    return value;
  }

  static Cube childOf(const Cube& cube, int child) {
    Cube own = cube;
    own.size /= 2;
    for (int axis = 0; axis < 3; ++axis)
      if (child >> axis & 1) own.corner[static_cast<std::size_t>(axis)] += own.size;
    return own;
  }

  void requireDepth(int depth) {
    if (depth == kDepth)
      faults_.fail(0, "the tree is deeper than 16 levels: the " + container() + " is damaged");
  }

  /// Reads an inner node of a .bt file: two bits for each child, and then the inner children.
  /// @returns whether the whole cube is occupied. If it is, `map_.cubes` has it as one cube.
  bool readChildren(const Cube& cube, int depth) {
    requireDepth(depth);
    const auto bits = take<std::uint16_t>();
    const std::size_t before = map_.cubes.size();
    int full = 0;
    for (int child = 0; child < 8; ++child) {
      const Cube own = childOf(cube, child);
      const NodeKind kind = kindOf(bits, child);
      nodes_ += kind != NodeKind::none;
      if (kind == NodeKind::occupied) {
        addOccupied(own);
        ++full;
      } else if (kind == NodeKind::free) {
        addFree(own);
      } else if (kind == NodeKind::none) {
        addMissing(own);
      } else if (readChildren(own, depth + 1)) {
        ++full;
      }
    }
    return joinIfFull(cube, full, before);
  }

  static NodeKind kindOf(std::uint16_t bits, int child) {
    switch (bits >> 2 * child & 3) {
      case 1:
        return NodeKind::free;
      case 2:
        return NodeKind::occupied;
      case 3:
        return NodeKind::inner;
      default:
        return NodeKind::none;
    }
  }

  /// Reads a node of a .ot file: its log-odds, its colour in a ColorOcTree, a bit for each child,
  /// and then the children.
  /// @returns whether the whole cube is occupied. If it is, `map_.cubes` has it as one cube.
  bool readNode(const Cube& cube, int depth) {
    const auto logOdds = take<float>();
    if (color_)
      for (int i = 0; i < 3; ++i) take<std::uint8_t>();
    const auto children = take<std::uint8_t>();
    if (children == 0) {
      // NaN counts as occupied.
      const bool isFree = logOdds < least_;
      if (isFree)
        addFree(cube);
      else
        addOccupied(cube);
      return !isFree;
    }
    requireDepth(depth);
    const std::size_t before = map_.cubes.size();
    int full = 0;
    nodes_ += std::popcount(children);
    for (int child = 0; child < 8; ++child) {
      if (children >> child & 1)
        full += readNode(childOf(cube, child), depth + 1);
      else
        addMissing(childOf(cube, child));
    }
    return joinIfFull(cube, full, before);
  }

  /// If all eight children of the cube are occupied, replaces the children by the cube. Returns
  /// whether all eight are occupied.
  /// @param full the number of children that are occupied as a whole.
  /// @param before the size that `map_.cubes` had before the children were read.
  bool joinIfFull(const Cube& cube, int full, std::size_t before) {
    if (full < 8) return false;
    map_.cubes.resize(before);
    map_.cubes.push_back(cube);
    return true;
  }

  void addOccupied(const Cube& cube) {
    add(cube);
    extendMeasuredBox(cube);
  }
  void addMissing(const Cube& cube) {
    if (!rules_.unknownIsOccupied) return;
    if (missing_.size() == kMostCubes) failCount();
    missing_.push_back(cube);
  }
  void addFree(const Cube& cube) {
    ++map_.free;
    extendMeasuredBox(cube);
  }
  void add(const Cube& cube) {
    if (map_.cubes.size() == kMostCubes) failCount();
    map_.cubes.push_back(cube);
  }
  [[noreturn]] void failCount() {
    faults_.fail(0, "has more than " + std::to_string(kMostCubes) +
                        (rules_.unknownIsOccupied ? " unknown or occupied cubes; use unknown: free"
                                                  : " occupied cubes") +
                        (rules_.unknownIsOccupied ? ", or a coarser resolution"
                                                  : "; use a coarser resolution"));
  }
  void extendMeasuredBox(const Cube& cube) {
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], cube.corner[k]);
      high_[k] = std::max(high_[k], cube.corner[k] + cube.size);
    }
  }

  /// Adds to `map_.cubes` all unknown space that is inside the bounding box of the measured cells.
  /// Unknown cubes that cross the boundary of this box are divided.
  void addUnknown() {
    std::vector<Cube> open = std::move(missing_);
    while (!open.empty()) {
      const Cube cube = open.back();
      open.pop_back();
      bool inside = true, outside = false;
      for (std::size_t k = 0; k < 3; ++k) {
        inside = inside && low_[k] <= cube.corner[k] && cube.corner[k] + cube.size <= high_[k];
        outside = outside || high_[k] <= cube.corner[k] || cube.corner[k] + cube.size <= low_[k];
      }
      if (outside) continue;
      if (inside)
        add(cube);
      else  // a single cell cannot get here: the box consists of whole cells
        for (int child = 0; child < 8; ++child) open.push_back(childOf(cube, child));
    }
  }

  TextCursor cursor_;
  std::string_view bytes_;
  const OccupancyRules& rules_;
  float least_;  // log-odds of the threshold, in float, as OctoMap stores and compares them
  MeshFaults faults_;
  OccupancyMap map_;
  std::vector<Cube> missing_;  // cubes of the children that inner nodes do not have
  std::array<std::int32_t, 3> low_{INT32_MAX, INT32_MAX, INT32_MAX},
      high_{INT32_MIN, INT32_MIN, INT32_MIN};
  std::size_t at_ = 0;
  // The number of nodes that the header states. Not set for a message, which has no header.
  std::optional<std::int64_t> promised_;
  std::int64_t nodes_ = 0;
  bool binary_ = false, color_ = false;
};

}  // namespace

Vec3 OccupancyMap::centerOf(const Cube& cube) const {
  Vec3 center;
  for (int k = 0; k < 3; ++k)
    center[k] = (cube.corner[static_cast<std::size_t>(k)] + 0.5 * cube.size) * resolution;
  return center;
}

OccupancyMap parseOccupancyMap(std::string_view bytes, const OccupancyRules& rules,
                               const std::string& name) {
  return MapReader(bytes, rules, name).readFile();
}

OccupancyMap parseOccupancyMessage(const OccupancyMessage& message, const OccupancyRules& rules,
                                   const std::string& name) {
  return MapReader(message.data, rules, name).readMessage(message);
}

OccupancyMap readOccupancyMap(const std::filesystem::path& file, const OccupancyRules& rules) {
  return parseOccupancyMap(readFile(file, "a map of OctoMap"), rules, file.string());
}

}  // namespace corridor
