#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "collision/core/transform.h"
#include "collision/geometry/mesh_file.h"
#include "collision/geometry/stated_unit.h"

namespace corridor {

/// Points in space, such as a sensor's measurements. As an obstacle, a cloud is the union of balls
/// about its points (a `Body` of many spheres).
struct PointCloud {
  std::vector<Vec3> points;  ///< metres
  std::string format;        ///< "PLY (ASCII)", "PCD (binary)", …
  /// Number of points that were left out because a coordinate is NaN or infinite. Sensors mark
  /// directions without a measurement in this way.
  std::size_t notFinite = 0;
  /// True if a PCD file has a viewpoint (the pose of the sensor) other than the identity.
  /// `readPointCloud` does not apply the viewpoint.
  bool hasViewpoint = false;
  /// The line of the first comment before the points of a text file that may say what the columns
  /// mean (it has letters) and does not name x, y, z in this order; 0: none. It is not read.
  int comment = 0;
  /// The number of columns after the third of a text file without a header. They are not read.
  int unnamedColumns = 0;
  /// The units that comments of a PLY or PCD file state. They are not applied.
  std::vector<StatedUnit> statedUnits = {};
  /// The elements of a PLY file other than its vertices, such as "face". They are not read.
  std::vector<std::string> unreadElements = {};
};

/// Reads the points of a file: the vertices of PLY; PCD (ASCII, binary and compressed); or a text
/// file (.xyz, .txt, .asc, .pts, .csv) with three numbers or more in each line, of which the first
/// three are x, y and z. Refused in text files: a header, or a comment before the points, that
/// names x, y and z in another order or place; and another unit than that of `options` (1 m without
/// one), in a header, in a comment or after a point. If the content begins
/// like PLY or PCD, it is read in this format, whatever the extension. Normals, colours and faces
/// are not read. As in PCL, the viewpoint of a PCD file is not applied.
/// @throws InputError that names the file and the line or byte: unreadable, no points, truncated,
/// counts that do not fit the file, unknown extension, …
PointCloud readPointCloud(const std::filesystem::path& file, const MeshFileOptions& options = {});

}  // namespace corridor
