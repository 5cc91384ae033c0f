#include "planner/problem/hull_yaml.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "collision/core/shortest.h"
#include "collision/queries/hull_deviation.h"

namespace corridor {
namespace {

/// The default of `deviation`, as a fraction of the longest side of the mesh's box. A mesh that is
/// convex except for the rounding of its coordinates (to floats, for example) is within this
/// deviation. A mesh with a visible hollow is not.
constexpr double kDefaultDeviation = 1e-4;

/// A `deviation` below this fraction of the largest coordinate may be impossible to prove.
/// `hullDeviation` adds 2^-38 times this coordinate to each distance, for the rounding of the
/// distance. The larger factor 2^-35 leaves room for the distances.
constexpr double kProvableShare = 0x1p-35;

/// Returns the length in metres with three significant digits, rounded up or down. A length that is
/// below a decimal of three digits by at most 1e-12 of the length counts as that decimal. If `up`
/// is true, the result is an upper bound in spite of the rounding in this function.
std::string metres(double length, bool up) {
  if (!(length >= 1e-300)) return up && length > 0 ? "1e-300 m" : "0 m";
  const double unit = std::pow(10.0, std::floor(std::log10(length)) - 2);
  const double digits = length / unit * (1 + 1e-12);
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", (up ? std::ceil(digits) : std::floor(digits)) * unit);
  return text;
}

}  // namespace

bool isBoolean(const YamlValue& value) {
  return value.kind == YamlValue::Kind::Scalar && value.isPlain &&
         (value.text == "true" || value.text == "false");
}

HullKey readHullKey(const YamlMap& map) {
  const YamlValue* convex = map.find("convex");
  HullKey key = HullKey::none;
  if (map.find("mesh") && convex) {
    if (!isBoolean(*convex)) {
      map.fault("convex", "beside mesh, true or false is needed, not " + described(*convex));
      return HullKey::faulty;
    }
    key = convex->text == "true" ? HullKey::hull : HullKey::mesh;
  }
  if (key == HullKey::hull && map.find("solid"))
    map.fault("solid", "is for meshes without convex: true; a convex hull is always solid");
  if (key != HullKey::hull && map.find("deviation"))
    map.fault("deviation", "is for meshes with convex: true, whose convex hull is the model");
  return key;
}

bool replaceByHull(const YamlMap& map, PlacedShape& shape) {
  const TriangleMesh& mesh = shape.mesh->mesh;
  std::vector<char> used(mesh.vertices.size());
  for (const auto& triangle : mesh.triangles)
    for (const std::uint32_t i : triangle) used[i] = 1;
  std::vector<Vec3> points;
  Vec3 lower = Vec3::Zero(), upper = Vec3::Zero();
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i]) continue;
    const Vec3& p = mesh.vertices[i];
    lower = points.empty() ? p : lower.cwiseMin(p);
    upper = points.empty() ? p : upper.cwiseMax(p);
    points.push_back(p);
  }
  double limit = kDefaultDeviation * (upper - lower).maxCoeff();
  std::string allowed = metres(limit, false);
  if (map.find("deviation")) {
    const auto given = map.number("deviation", Range::Positive);
    if (!given) return false;
    limit = *given;
    allowed = shortest(limit) + " m";
  }
  std::optional<Polytope> hull;
  try {
    hull.emplace(points);
  } catch (const std::invalid_argument&) {
    map.fault("convex", "needs a mesh whose vertices are not all in one plane; leave out convex");
    return false;
  }
  const HullDeviation deviation = hullDeviation(*hull, mesh, limit);
  if (!std::isfinite(limit) || !std::isfinite(deviation.found) ||
      (deviation.within && !std::isfinite(deviation.upper))) {
    map.fault("convex",
              "the mesh is too large to measure how far its convex hull is from it; leave it out");
    return false;
  }
  if (!deviation.within) {
    const double least = kProvableShare * std::max(-lower.minCoeff(), upper.maxCoeff());
    if (deviation.found > limit)
      map.fault("convex", "the convex hull is " + metres(deviation.found, false) +
                              " or more away from the mesh, and " + allowed +
                              " is allowed; leave out convex, or set deviation (metres)");
    else if (limit < least)
      map.fault("convex", "it can't be proved that the convex hull is within " + allowed +
                              " of the mesh, because of the rounding of the coordinates; set a "
                              "deviation of at least " +
                              metres(least, true));
    else
      map.fault("convex", "it takes too long to prove that the convex hull is within " + allowed +
                              " of the mesh; set a larger deviation (metres)");
    return false;
  }
  shape.notes.push_back(
      {shape.file.string() + ": the model is the solid convex hull of the mesh, with " +
           std::to_string(hull->vertices().size()) +
           " corners; everything inside it counts as occupied; its surface is at most " +
           metres(deviation.upper, true) + " away from the mesh",
       NoteWeight::coverage});
  const std::vector<Vec3> corners(hull->vertices().begin(), hull->vertices().end());
  shape.primitive = Convex{corners};
  shape.at = {};  // the corners are in their final place already
  shape.parts = {{corners, 0, false}};
  shape.mesh = nullptr;
  return true;
}

}  // namespace corridor
