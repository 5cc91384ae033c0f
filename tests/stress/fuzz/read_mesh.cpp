// Fuzz target: mesh files of Corridor's own readers: OBJ, STL, PLY, OFF. The first line of an input
// is the file's extension.
#include "collision/geometry/mesh_file.h"
#include "collision/geometry/mesh_health.h"
#include "tests/stress/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  const auto input = fuzz::namedInput(data, size);
  if (!input) return 0;
  const std::string& ending = input->ending;
  if (ending != "obj" && ending != "stl" && ending != "ply" && ending != "off") return 0;
  const auto file = folder.write("a." + ending, input->bytes);
  fuzz::readsOrRefuses([&] {
    const MeshFile mesh = readMeshFile(file);
    if (mesh.mesh.triangles.empty()) fuzz::fail("a mesh without a triangle");
    if (const auto complaint = checkMesh(mesh.mesh)) fuzz::fail(*complaint);
  });
  return 0;
}
