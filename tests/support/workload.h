#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "collision/geometry/triangle_mesh.h"

namespace corridor::test {

/// Reads a plain `v`/`f` OBJ file of the shared data, without the mesh readers under test.
TriangleMesh plainObj(const std::filesystem::path& file);

/// One workload of the shared collision data: two meshes, and poses of B; the pose of A is the
/// identity.
struct Workload {
  std::string name;
  TriangleMesh a, b;
  std::vector<Transform> poses;
  std::vector<int> hit;
  std::vector<double> distance;  ///< 0 where hit, NaN where not computed

  bool hasDistances() const;  ///< true if at least one distance is known
};
std::vector<std::string> workloadNames(const std::filesystem::path& collisionFolder);
Workload loadWorkload(const std::filesystem::path& collisionFolder, const std::string& name);

/// Returns the indices of the poses on which the `way`-th of `ways` tree variants is tested. Under
/// CORRIDOR_STRESS these are all poses. Otherwise, to save time, only every `step`-th pose is
/// tested, and the variants take turns. If a workload has few poses, building several trees would
/// take longer than the queries. Then variant 0 gets all of these poses, and the others get none.
std::vector<std::size_t> posesInTurn(const Workload& w, std::size_t step, std::size_t way,
                                     std::size_t ways);

}  // namespace corridor::test
