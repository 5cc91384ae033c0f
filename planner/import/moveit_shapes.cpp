#include "planner/import/moveit_shapes.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>

#include "collision/core/error.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/import/moveit_poses.h"
#include "planner/problem/cloud_yaml.h"
#include "planner/problem/yaml_ledger.h"

namespace corridor {
namespace {

// The fields of the messages.
const MapKeys kPose{{"position", "orientation"}, {}};
const MapKeys kPrimitive{{"type", "dimensions", "polygon"}, {}};
const MapKeys kMesh{{"triangles", "vertices"}, {}};
const MapKeys kTriangle{{"vertex_indices"}, {}};
const MapKeys kOctomap{{"header", "binary", "id", "resolution", "data"}, {}};

/// Reads a list of bytes. Each is a number from -128 to 255, because ROS writes bytes with or
/// without a sign.
std::optional<std::string> readBytes(const YamlMap& map, const char* key) {
  const auto items = itemsOf(map, key);
  std::string bytes;
  bytes.reserve(items.size());
  for (const YamlValue* const item : items) {
    int byte = 0;
    const std::string& text = item->text;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), byte);
    if (error != std::errc() || end != text.data() + text.size() || byte < -128 || byte > 255) {
      map.source().fault(item->line, map.pathOf(key) + "[" + std::to_string(bytes.size()) +
                                         "]: a whole number from -128 to 255 is needed, not " +
                                         described(*item));
      return std::nullopt;
    }
    bytes.push_back(static_cast<char>(byte));
  }
  return bytes;
}

}  // namespace

std::optional<Placement> readPose(const YamlValue& value, const std::string& path,
                                  YamlSource& source) {
  const YamlMap map(value, path, &kPose, source);
  Placement placement;
  if (map.find("position")) {
    const auto p = readNamed(map, "position", {"x", "y", "z"});
    if (!p) return std::nullopt;
    placement.pose.p = Vec3((*p)[0], (*p)[1], (*p)[2]);
  }
  Orientation orientation;
  if (map.find("orientation")) {
    const auto q = readQuaternion(map, "orientation");
    if (!q) return std::nullopt;
    orientation.q = *q;
    orientation.R = rotationMatrix(orientation.q);
  }
  placement.pose.q = orientation.q;
  placement.X = {orientation.R, placement.pose.p};
  return placement;
}

std::optional<Primitive> readPrimitive(const YamlValue& value, const std::string& path,
                                       YamlSource& source) {
  const YamlMap map(value, path, &kPrimitive, source);
  const std::map<std::string, std::string> numbered{
      {"1", "box"}, {"2", "sphere"}, {"3", "cylinder"}, {"4", "cone"}};
  auto type = map.text("type");
  if (!type) {
    if (!map.find("type")) map.fault("type", "is missing");
    return std::nullopt;
  }
  if (const auto number = numbered.find(*type); number != numbered.end()) type = number->second;
  *type = lowered(*type);
  const std::map<std::string, std::size_t> counts{{"box", 3}, {"sphere", 1}, {"cylinder", 2}};
  const auto count = counts.find(*type);
  if (count == counts.end()) {
    map.fault("type", notOneOf(*type, {"box", "sphere", "cylinder"}));
    return std::nullopt;
  }
  const auto d = map.numbers("dimensions", count->second);
  if (!d) {
    if (!map.find("dimensions")) map.fault("dimensions", "is missing");
    return std::nullopt;
  }
  const Primitive primitive = *type == "box"      ? Primitive(Box{Vec3((*d)[0], (*d)[1], (*d)[2])})
                              : *type == "sphere" ? Primitive(Sphere{(*d)[0]})
                                                  : Primitive(Cylinder{(*d)[1], (*d)[0]});
  if (const auto why = checkPrimitive(primitive)) {
    map.fault("dimensions", *why);
    return std::nullopt;
  }
  return primitive;
}

std::optional<TriangleMesh> readMesh(const YamlValue& value, const std::string& path,
                                     YamlSource& source) {
  const std::size_t before = source.faults.size();
  const YamlMap map(value, path, &kMesh, source);
  TriangleMesh mesh;
  const auto vertices = itemsOf(map, "vertices"), triangles = itemsOf(map, "triangles");
  for (std::size_t i = 0; i < vertices.size() && source.faults.size() == before; ++i) {
    // readNamed only reads the value of a key. So the vertex, {x: 1, y: 2, z: 3} or [1, 2, 3], is
    // put into a new map, as the value of a key.
    YamlValue holder;
    holder.kind = YamlValue::Kind::Map;
    holder.line = vertices[i]->line;
    markRead(*vertices[i]);
    holder.entries.push_back({"vertex", vertices[i]->line, *vertices[i]});
    const YamlMap one(holder, map.pathOf("vertices[" + std::to_string(i) + "]"), nullptr, source);
    if (const auto p = readNamed(one, "vertex", {"x", "y", "z"}))
      mesh.vertices.emplace_back((*p)[0], (*p)[1], (*p)[2]);
  }
  for (std::size_t i = 0; i < triangles.size() && source.faults.size() == before; ++i) {
    const YamlMap one(*triangles[i], map.pathOf("triangles[" + std::to_string(i) + "]"), &kTriangle,
                      source);
    const auto corners = one.numbers("vertex_indices", 3);
    if (!corners) {
      if (!one.find("vertex_indices")) one.fault("vertex_indices", "is missing");
      continue;
    }
    std::array<std::uint32_t, 3> triangle{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double corner = (*corners)[k];
      if (!(corner >= 0 && corner < static_cast<double>(mesh.vertices.size()) &&
            corner == std::floor(corner))) {
        one.fault("vertex_indices", "the mesh has no vertex " + shortest(corner));
        break;
      }
      triangle[k] = static_cast<std::uint32_t>(corner);
    }
    mesh.triangles.push_back(triangle);
  }
  if (source.faults.size() != before) return std::nullopt;
  if (mesh.triangles.empty()) {
    map.fault("triangles", "a mesh needs at least one triangle");
    return std::nullopt;
  }
  return mesh;
}

std::optional<PlacedShape> readOctomap(const YamlValue& value, const std::string& path,
                                       const Placement& at, YamlSource& source) {
  const YamlMap map(value, path, &kOctomap, source);
  map.ignore({"header"});  // the frame is that of the message around the map
  if (isEmpty(map, "data")) return std::nullopt;
  OccupancyMessage message;
  const auto resolution = map.number("resolution", Range::Positive);
  const auto data = readBytes(map, "data");
  map.require("resolution", "the edge length of a cell, metres");
  if (!resolution || !data) return std::nullopt;
  message.binary = map.flag("binary").value_or(false);
  message.id = map.text("id").value_or("OcTree");
  message.resolution = *resolution;
  message.data = *data;
  PlacedShape shape;
  shape.name = "<octomap>";
  shape.at = at.pose;
  try {
    shape.parts = cubesOf(parseOccupancyMessage(message, {}, path), at.X);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults())
      source.fault(value.line, fault.file + ": " + fault.text);
    return std::nullopt;
  }
  if (shape.parts.empty()) return std::nullopt;
  shape.notes.push_back(
      {source.file + ": " + path + ": cells without a measurement count as free, as in MoveIt",
       NoteWeight::coverage});
  return shape;
}

}  // namespace corridor
