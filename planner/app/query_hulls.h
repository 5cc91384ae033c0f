#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/core/transform.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor::app {

/// The methods of `corridor query --hulls`; the first is the default: how the vertex of a hull is
/// found that is farthest along a direction, or `lp`, linear programming.
const std::vector<std::string>& hullMethods();

/// Checks the names that `queryHulls` takes.
/// @param query  interference, distance or depth; unset: interference.
/// @throws InputError for an unknown query or method, and for `lp` with another query than
/// interference.
void requireHullQuery(const std::string& method, const std::optional<std::string>& query);

/// A mesh, and its file for messages.
struct HullInput {
  const TriangleMesh& mesh;
  std::string file;
};

/// Queries the convex hulls of the vertices of two meshes at many poses of b: CSV on stdout, a
/// summary on stderr.
/// @param repeat  passes over all poses.
/// @throws InputError for a mesh whose vertices are all on one plane. @pre `requireHullQuery`.
void queryHulls(const HullInput& a, const HullInput& b, const std::vector<Transform>& poses,
                const std::string& method, const std::optional<std::string>& query, int repeat);

}  // namespace corridor::app
