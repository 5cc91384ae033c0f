#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

namespace corridor::test {

/// A plain `v`/`f` OBJ of the shared data; tests of readers don't use it.
TriangleMesh plainObj(const std::filesystem::path& file);

/// One workload of the shared collision data: two meshes, and poses of B with A at the identity.
struct Workload {
  std::string name;
  TriangleMesh a, b;
  std::vector<Transform> poses;
  std::vector<int> hit;
  std::vector<double> distance;  ///< 0 where hit, NaN where not computed

  bool hasDistances() const;  ///< one at least
};
std::vector<std::string> workloadNames(const std::filesystem::path& collisionFolder);
Workload loadWorkload(const std::filesystem::path& collisionFolder, const std::string& name);

/// The poses, by their numbers, that the `way`-th of so many ways of building meets: under
/// CORRIDOR_STRESS all of them, else every `step`-th, on which the ways (modulo `ways`) take turns;
/// but of workloads with few poses, for which it doesn't pay to build, way 0 meets them all.
std::vector<std::size_t> posesInTurn(const Workload& w, std::size_t step, std::size_t way,
                                     std::size_t ways);

}  // namespace corridor::test
