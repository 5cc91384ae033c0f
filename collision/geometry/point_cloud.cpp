#include "collision/geometry/point_cloud.h"

#include <cmath>
#include <functional>
#include <utility>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/core/text_encoding.h"
#include "collision/geometry/file_frame.h"
#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

using CloudReader = std::function<PointCloud(std::string_view, MeshFaults&)>;

bool isRead(const std::string& extension) {
  for (const char* known : {".ply", ".pcd", ".xyz", ".txt", ".asc", ".pts", ".csv"})
    if (extension == known) return true;
  return false;
}

/// Returns the reader of a file. The content decides, because files of every format may have the
/// extension .xyz or .txt. The extension decides only if the content does not begin like a known
/// format.
CloudReader readerOf(std::string_view bytes, const std::string& extension, double metresPerUnit) {
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return readPlyPoints;
  if (bytes.starts_with("# .PCD") || bytes.starts_with("# PCD")) return readPcd;
  if (extension == ".ply") return readPlyPoints;
  if (extension == ".pcd") return readPcd;
  return [=](std::string_view text, MeshFaults& faults) {
    return readXyz(text, metresPerUnit, faults);
  };
}

}  // namespace

PointCloud readPointCloud(const std::filesystem::path& file, const MeshFileOptions& options) {
  MeshFaults faults(file.string());
  checkOptions(options, faults);
  if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) faults.fail(0, why);
  const std::string extension = lowered(file.extension().string());
  if (!isRead(extension))
    faults.fail(0, "points are read from .ply, .pcd, .xyz, .txt, .asc, .pts and .csv, not from " +
                       (file.extension().empty() ? std::string("a name without an extension")
                                                 : inQuotes(file.extension().string())));
  const std::string bytes = readFile(file, "a point cloud");
  requireOwnFormat(bytes, file, "a point cloud");
  const std::string_view content = withoutByteOrderMark(bytes);
  const double unit = options.metresPerUnit.value_or(1);
  PointCloud cloud = readerOf(content, extension, unit)(content, faults);
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
