// Fuzz target: point clouds (PLY, PCD, text) and maps of OctoMap. The first line of an input is the
// file's extension.
#include "collision/geometry/occupancy_map.h"
#include "collision/geometry/point_cloud.h"
#include "tests/stress/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  const auto input = fuzz::namedInput(data, size);
  if (!input) return 0;
  const std::string& ending = input->ending;
  if (ending == "bt" || ending == "ot") {
    for (const bool unknown : {false, true})
      fuzz::readsOrRefuses([&] {
        const OccupancyMap map =
            parseOccupancyMap(input->bytes, {.unknownIsOccupied = unknown}, "map");
        for (const OccupancyMap::Cube& cube : map.cubes) {
          if (cube.size < 1) fuzz::fail("an empty cube");
          if (!map.centerOf(cube).allFinite()) fuzz::fail("a centre that is not finite");
        }
      });
    return 0;
  }
  if (ending != "ply" && ending != "pcd" && ending != "xyz") return 0;
  const auto file = folder.write("a." + ending, input->bytes);
  fuzz::readsOrRefuses([&] {
    const PointCloud cloud = readPointCloud(file);
    if (cloud.points.empty()) fuzz::fail("a cloud without a point");
    for (const Vec3& point : cloud.points)
      if (!point.allFinite()) fuzz::fail("a point that is not finite");
  });
  return 0;
}
