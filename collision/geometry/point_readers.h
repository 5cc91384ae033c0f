#pragma once

#include <string_view>

#include "collision/geometry/mesh_text.h"
#include "collision/geometry/point_cloud.h"

/// The readers of `readPointCloud`, one per format. Each takes the bytes of a file, and returns
/// coordinates as stored, those included that are not finite. Readers add every fault to `faults`,
/// and throw InputError if there is one.
namespace corridor {

PointCloud readPlyPoints(std::string_view bytes, MeshFaults& faults);
PointCloud readPcd(std::string_view bytes, MeshFaults& faults);
PointCloud readXyz(std::string_view text, MeshFaults& faults);

}  // namespace corridor
