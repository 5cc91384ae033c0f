#include "planner/problem/bounds.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

int dimensions(const Problem& problem) {
  return problem.space == RigidSpace::SE3 ? 3 : 2;
}

}  // namespace

void setBoundsOfWorld(Problem& problem) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  Vec3 lower = Vec3::Constant(infinity), upper = Vec3::Constant(-infinity);
  for (const ProblemMesh& body : problem.world)
    for (const auto& triangle : body.source.mesh.triangles)
      for (const std::uint32_t i : triangle) {
        lower = lower.cwiseMin(body.source.mesh.vertices[i]);
        upper = upper.cwiseMax(body.source.mesh.vertices[i]);
      }
  for (int k = 0; k < dimensions(problem); ++k) {
    problem.lower[k] = lower[k];
    problem.upper[k] = upper[k];
  }
}

bool enlargeBounds(Problem& problem) {
  const Vec3 lower = problem.lower, upper = problem.upper;
  for (int k = 0; k < dimensions(problem); ++k)
    for (const RigidPose* pose : {&problem.start, &problem.goal}) {
      problem.lower[k] = std::min(problem.lower[k], pose->p[k]);
      problem.upper[k] = std::max(problem.upper[k], pose->p[k]);
    }
  return lower != problem.lower || upper != problem.upper;
}

std::string whyBadBounds(const Problem& problem) {
  for (int k = 0; k < dimensions(problem); ++k) {
    const double lower = problem.lower[k], upper = problem.upper[k];
    if (lower < upper && std::isfinite(upper - lower)) continue;
    return std::string("lower corner first, then the upper one: in ") + "xyz"[k] + ", " +
           shortest(lower) + " is not below " + shortest(upper);
  }
  return "";
}

std::string whyOutside(const Problem& problem, const RigidPose& pose) {
  for (int k = 0; k < dimensions(problem); ++k) {
    const double lower = problem.lower[k], upper = problem.upper[k];
    if (lower <= pose.p[k] && pose.p[k] <= upper) continue;
    return std::string("outside of the bounds: ") + "xyz"[k] + " = " + shortest(pose.p[k]) +
           " is not in [" + shortest(lower) + ", " + shortest(upper) + "]";
  }
  return "";
}

}  // namespace corridor
