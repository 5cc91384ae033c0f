#include "planner/problem/cloud_yaml.h"

#include "collision/core/read_file.h"
#include "collision/geometry/point_cloud.h"
#include "planner/problem/keys.h"

namespace corridor {
namespace {

bool readPoints(const YamlMap& inner, const MeshFileOptions& options, const Transform& X,
                PlacedShape& shape) {
  inner.require("radius", "metres, such as 0.01: each point becomes a ball");
  const auto radius = inner.number("radius", Range::Positive);
  if (!radius) return false;
  const PointCloud cloud = readPointCloud(shape.file, options);
  shape.parts.reserve(cloud.points.size());
  for (const Vec3& point : cloud.points) shape.parts.push_back({{X * point}, *radius, false});
  if (cloud.notFinite > 0)
    shape.notes.push_back({shape.file.string() + ": " + std::to_string(cloud.notFinite) + " of " +
                               std::to_string(cloud.points.size() + cloud.notFinite) +
                               " points are not finite, and are left out",
                           NoteWeight::coverage});
  if (cloud.unnamedColumns > 0)
    shape.notes.push_back({shape.file.string() + ": no header names its columns; the first three " +
                               "are x, y, z, and " + std::to_string(cloud.unnamedColumns) +
                               (cloud.unnamedColumns == 1 ? " more is" : " more are") + " not read",
                           NoteWeight::coverage});
  if (cloud.comment > 0)
    shape.notes.push_back(
        {shape.file.string() + ": line " + std::to_string(cloud.comment) +
             " is a comment, which is not read; the first three columns are x, y, z" +
             (options.metresPerUnit ? "" : " in metres"),
         NoteWeight::coverage});
  if (const auto note = noteOnUnits(cloud.statedUnits, options.metresPerUnit.value_or(1)))
    shape.notes.push_back({shape.file.string() + ": " + *note, NoteWeight::coverage});
  for (const std::string& element : cloud.unreadElements)
    shape.notes.push_back({shape.file.string() + ": the element " + quotedWord(element) +
                               " is not read, only its points" +
                               (element == "face" ? " (the key mesh reads faces)" : ""),
                           NoteWeight::coverage});
  if (cloud.hasViewpoint)
    shape.notes.push_back({shape.file.string() +
                               ": its viewpoint (the sensor's pose) is not applied; at and a "
                               "rotation place the points",
                           NoteWeight::coverage});
  return true;
}

bool readMap(const YamlMap& inner, const Transform& X, PlacedShape& shape) {
  OccupancyRules rules;
  if (const auto cells = inner.choice("unknown", problemChoices().at("world.*.octomap.unknown")))
    rules.unknownIsOccupied = *cells == "occupied";
  if (const auto threshold = inner.number("threshold", Range::Positive)) {
    rules.threshold = *threshold;
    if (!(*threshold < 1)) {
      inner.fault("threshold", "a probability above 0 and below 1 is needed");
      return false;
    }
  }
  const OccupancyMap octree = readOccupancyMap(shape.file, rules);
  if (!inner.find("unknown"))
    shape.notes.push_back({shape.file.string() +
                               ": cells without a measurement count as free (unknown: occupied "
                               "makes obstacles of them)",
                           NoteWeight::coverage});
  if (inner.find("threshold") && !octree.hasProbabilities)
    shape.notes.push_back(
        {shape.file.string() + ": threshold has no effect, since a .bt file has no probabilities",
         NoteWeight::detail});
  if (octree.cubes.empty()) {
    inner.fault("file", shape.file.string() + ": the map has no occupied cell");
    return false;
  }
  shape.parts = cubesOf(octree, X);
  return true;
}

}  // namespace

std::vector<ConvexPart> cubesOf(const OccupancyMap& map, const Transform& X) {
  std::vector<ConvexPart> parts;
  parts.reserve(map.cubes.size());
  for (const OccupancyMap::Cube& cube : map.cubes)
    parts.push_back(placed(Box{Vec3::Constant(map.sizeOf(cube))},
                           X * Transform{Mat3::Identity(), map.centerOf(cube)}));
  return parts;
}

bool readCloud(const YamlMap& map, const std::string& kind, const MapKeys& keys,
               const std::filesystem::path& folder, const MeshFileOptions& options,
               const Transform& X, PlacedShape& shape, std::vector<std::filesystem::path>& files) {
  const YamlValue& value = *map.find(kind);
  if (value.kind != YamlValue::Kind::Map) {
    map.fault(kind, kind == "points" ? "write points: {file: cloud.ply, radius: 0.01}"
                                     : "write octomap: {file: map.bt}");
    return false;
  }
  const YamlMap inner(value, map.pathOf(kind), &keys, map.source());
  inner.require("file", kind == "points" ? "the file of the points: .ply, .pcd or .xyz"
                                         : "the map: .bt or .ot");
  const auto name = inner.text("file");
  if (!name) return false;
  shape.file = folder / *name;
  if (const std::string why = whyNotOrdinaryFile(shape.file); !why.empty()) {
    inner.fault("file", shape.file.string() + ": " + why);
    return false;
  }
  addFile(files, shape.file);
  try {
    return kind == "points" ? readPoints(inner, options, X, shape) : readMap(inner, X, shape);
  } catch (const InputError& error) {
    map.source().faults.add(error);
    return false;
  }
}

}  // namespace corridor
