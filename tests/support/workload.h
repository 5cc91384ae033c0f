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
  std::vector<int> hit;          ///< per pose: 1 if the meshes touch, else 0
  std::vector<double> distance;  ///< per pose: 0 if they touch, NaN if not computed

  bool hasDistances() const;  ///< true if at least one distance is known
};
std::vector<std::string> workloadNames(const std::filesystem::path& collisionFolder);
Workload loadWorkload(const std::filesystem::path& collisionFolder, const std::string& name);

/// Returns the indices of the poses on which the `way`-th of `ways` tree variants is tested. Under
/// CORRIDOR_STRESS every variant gets all poses. Otherwise, to save time, only every `step`-th pose
/// is tested, and the variants take turns. For a workload of fewer than 100 poses, building several
/// trees would take longer than the queries. So variant 0 is tested on the poses of all variants,
/// and the other variants on none. In slow builds only every `kSlowdown`-th of all these poses is
/// tested.
std::vector<std::size_t> posesInTurn(const Workload& w, std::size_t step, std::size_t way,
                                     std::size_t ways);

}  // namespace corridor::test
