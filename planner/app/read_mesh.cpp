#include "planner/app/read_mesh.h"

#include "collision/geometry/stated_unit.h"

namespace corridor::app {

MeshFile readMeshAs(const std::string& file, const std::optional<std::string>& unit,
                    const std::optional<std::string>& up) {
  MeshFileOptions options;
  if (unit) options.metresPerUnit = metresPerUnitNamed(*unit);
  if (up) options.up = up->front();
  return readMeshFile(file, options);
}

}  // namespace corridor::app
