#include "planner/app/read_mesh.h"

#include <iostream>
#include <vector>

#include "collision/core/spelling.h"
#include "collision/geometry/stated_unit.h"

namespace corridor::app {

MeshFile readMeshAs(const std::string& file, const std::optional<std::string>& unit,
                    const std::optional<std::string>& up) {
  MeshFileOptions options;
  if (unit) options.metresPerUnit = metresPerUnitNamed(*unit);
  if (up) options.up = up->front();
  return readMeshFile(file, options);
}

MeshFile readMeshAndPrintNotes(const std::string& file) {
  MeshFile mesh = readMeshFile(file);
  std::vector<std::string> notes = mesh.notes;
  if (mesh.fileUp.value_or('z') != 'z')
    notes.push_back(std::string("the file's up-axis, ") + *mesh.fileUp + ", is not applied");
  for (const std::string& text : notes)
    std::cerr << "note: " << withoutControls(file + ": " + text) << '\n';
  return mesh;
}

}  // namespace corridor::app
