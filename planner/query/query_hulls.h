#pragma once

#include <optional>
#include <string>
#include <vector>

#include "collision/core/transform.h"
#include "collision/geometry/triangle_mesh.h"

namespace corridor::app {

/// Returns the names of the methods of `corridor query --hulls`. The first one is the default.
/// - `hierarchy`, `climbing`, `every-vertex`: GJK. The name says how GJK finds the vertex of a hull
///   that is farthest along a direction.
/// - `lp`: linear programming.
/// - `vclip`: closest features.
/// - `axes`: separating axes.
/// - `barba-langerman`: inner and outer hierarchies.
/// - `descent`: Dobkin and Kirkpatrick's own descent in both hierarchies.
const std::vector<std::string>& hullMethods();

/// Checks the query that `queryHulls` takes.
/// @param method one of `hullMethods`. @param query interference, distance or depth; unset:
/// interference.
/// @param hasDirection whether a direction is given, for the depth.
/// @throws InputError for another query, for a query that the method does not have, and for
/// `coherent` if the method, or the query `depth`, keeps nothing from pose to pose.
void requireHullQuery(const std::string& method, const std::optional<std::string>& query,
                      bool hasDirection, bool coherent);

/// A mesh, and its file for messages.
struct HullInput {
  const TriangleMesh& mesh;
  std::string file;
};

/// Queries the convex hulls of the vertices of two meshes at many poses of b: CSV on stdout, a
/// summary on stderr.
/// @param direction with the query depth: the direction along which b leaves a, not 0; nullopt:
/// any.
/// @param coherent each query begins with data that the query at the preceding pose has kept, such
/// as a separating axis or a pair of features.
/// @param repeat the number of passes over all poses.
/// @throws InputError for a mesh whose vertices are all on one plane, unless the method is GJK or
/// lp, and for a pose that the method does not take. @pre `requireHullQuery` accepts the arguments.
void queryHulls(const HullInput& a, const HullInput& b, const std::vector<Transform>& poses,
                const std::string& method, const std::optional<std::string>& query,
                const std::optional<Vec3>& direction, bool coherent, int repeat);

}  // namespace corridor::app
