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
};
std::vector<std::string> workloadNames(const std::filesystem::path& collisionFolder);
Workload loadWorkload(const std::filesystem::path& collisionFolder, const std::string& name);

}  // namespace corridor::test
