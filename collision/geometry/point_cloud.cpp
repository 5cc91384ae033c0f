#include "collision/geometry/point_cloud.h"

#include <cmath>
#include <utility>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/geometry/file_frame.h"
#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

using Reader = PointCloud (*)(std::string_view, MeshFaults&);

Reader readerOf(const std::string& extension) {
  if (extension == ".ply") return readPlyPoints;
  if (extension == ".pcd") return readPcd;
  for (const char* text : {".xyz", ".txt", ".asc", ".pts"})
    if (extension == text) return readXyz;
  return nullptr;
}

}  // namespace

PointCloud readPointCloud(const std::filesystem::path& file, const MeshFileOptions& options) {
  MeshFaults faults(file.string());
  checkOptions(options, faults);
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) faults.fail(0, why);
  const Reader reader = readerOf(lowered(file.extension().string()));
  if (!reader)
    faults.fail(0, "points are read from .ply, .pcd, .xyz, .txt, .asc and .pts, not from " +
                       (file.extension().empty() ? std::string("a name without an extension")
                                                 : inQuotes(file.extension().string())));
  PointCloud cloud = reader(readFile(file, "a point cloud"), faults);
  faults.throwIfAny();
  const std::size_t all = cloud.points.size();
  std::erase_if(cloud.points, [](const Vec3& p) { return !p.allFinite(); });
  cloud.notFinite = all - cloud.points.size();
  if (cloud.points.empty())
    faults.fail(0, all ? "none of its " + std::to_string(all) + " points is finite"
                       : std::string("it has no points"));
  if (const FileFrame frame(options, 1); !frame.isIdentity())
    for (Vec3& point : cloud.points) point = frame * point;
  for (const Vec3& point : cloud.points)
    if (!point.allFinite()) faults.fail(0, "its coordinates in metres are too large for a double");
  return cloud;
}

}  // namespace corridor
