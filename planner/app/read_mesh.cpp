#include "planner/app/read_mesh.h"

namespace corridor::app {

MeshFile readMeshAs(const std::string& file, const std::optional<std::string>& unit,
                    const std::optional<std::string>& up) {
  MeshFileOptions options;
  if (unit)
    options.metresPerUnit = *unit == "m"    ? 1
                            : *unit == "cm" ? 0.01
                            : *unit == "mm" ? 0.001
                                            : 0.0254;
  if (up) options.up = up->front();
  return readMeshFile(file, options);
}

}  // namespace corridor::app
