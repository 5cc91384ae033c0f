// Fuzz target: mesh files that assimp reads. assimp reads the files with other extensions than
// those of Corridor's own readers, and every file that is read by OMPL.app's rules. The first line
// of an input is the file's extension.
#include <algorithm>

#include "collision/geometry/mesh_file.h"
#include "collision/geometry/mesh_health.h"
#include "tests/stress/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  const auto input = fuzz::namedInput(data, size);
  if (!input) return 0;
  const auto file = folder.write("a." + input->ending, input->bytes);
  const auto check = [](const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) fuzz::fail("a mesh without a triangle");
    if (const auto complaint = checkMesh(mesh)) fuzz::fail(*complaint);
  };
  fuzz::readsOrRefuses([&] { check(readMeshFile(file, {.metresPerUnit = 0.5}).mesh); });
  fuzz::readsOrRefuses([&] { check(readMeshFile(file).mesh); });
  fuzz::readsOrRefuses([&] { check(readOmplAppMesh(file).mesh); });
  std::filesystem::remove(file);
  return 0;
}
