#include "planner/problem/hull_yaml.h"

#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>

#include "collision/queries/hull_deviation.h"

namespace corridor {
namespace {

/// The default of `deviation`, as a share of the longest side of the mesh's box. Meshes of convex
/// parts in float, and of rounded coordinates, are within it; no visible hollow is.
constexpr double kDefaultDeviation = 1e-4;

/// Returns the length in metres with three digits, rounded up or down.
std::string metres(double length, bool up) {
  if (!(length > 0)) return "0 m";
  const double unit = std::pow(10.0, std::floor(std::log10(length)) - 2);
  const double digits = length / unit;
  char text[32];
  std::snprintf(text, sizeof text, "%.3g m", (up ? std::ceil(digits) : std::floor(digits)) * unit);
  return text;
}

}  // namespace

std::optional<bool> readHullKey(const YamlMap& map) {
  const YamlValue* convex = map.find("convex");
  const bool isKey =
      map.find("mesh") && convex && (convex->text == "true" || convex->text == "false");
  const bool hull = isKey && convex->text == "true";
  if (hull && map.find("solid"))
    map.fault("solid", "is for meshes without convex: true; a convex hull is always solid");
  if (!hull && map.find("deviation"))
    map.fault("deviation", "is for meshes with convex: true, whose convex hull is the model");
  return isKey ? std::optional(hull) : std::nullopt;
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
  if (map.find("deviation")) {
    const auto given = map.number("deviation", Range::Positive);
    if (!given) return false;
    limit = *given;
  }
  std::optional<Polytope> hull;
  try {
    hull.emplace(points);
  } catch (const std::invalid_argument&) {
    map.fault("convex", "needs a mesh whose vertices are not all in one plane; leave it out");
    return false;
  }
  const HullDeviation deviation = hullDeviation(*hull, mesh, limit);
  if (!deviation.within) {
    const std::string allowed = metres(limit, false);
    if (deviation.found > limit)
      map.fault("convex", "the convex hull is " + metres(deviation.found, false) +
                              " or more away from the mesh, and " + allowed +
                              " is allowed; leave out convex, or set deviation (metres)");
    else
      map.fault("convex", "it takes too long to prove that the convex hull is within " + allowed +
                              " of the mesh; set a larger deviation (metres)");
    return false;
  }
  shape.notes.push_back({shape.file.string() + ": the model is the convex hull of the mesh, with " +
                             std::to_string(hull->vertices().size()) +
                             " corners; its surface is at most " + metres(deviation.upper, true) +
                             " away from the mesh",
                         NoteWeight::coverage});
  const std::vector<Vec3> corners(hull->vertices().begin(), hull->vertices().end());
  shape.primitive = Convex{corners};
  shape.parts = {{corners, 0, false}};
  shape.mesh = nullptr;
  return true;
}

}  // namespace corridor
