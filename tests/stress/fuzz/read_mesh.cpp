// Fuzz target: mesh files. The first line of an input is the file's extension.
#include "collision/geometry/mesh_file.h"
#include "collision/geometry/mesh_health.h"
#include "tests/stress/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  const auto input = fuzz::namedInput(data, size);
  if (!input) return 0;
  const auto file = folder.write("a." + input->ending, input->bytes);
  MeshFileOptions options;
  if (input->ending == "3mf") options.metresPerUnit = 0.5;  // without a unit, it is refused
  fuzz::readsOrRefuses([&] {
    const MeshFile mesh = readMeshFile(file, options);
    if (mesh.mesh.triangles.empty()) fuzz::fail("a mesh without a triangle");
    if (const auto complaint = checkMesh(mesh.mesh)) fuzz::fail(*complaint);
  });
  std::filesystem::remove(file);
  return 0;
}
