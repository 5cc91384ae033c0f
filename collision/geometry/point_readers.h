#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "collision/geometry/mesh_text.h"
#include "collision/geometry/point_cloud.h"

/// The readers of `readPointCloud`, one per format. Each reader takes the bytes of a file, and
/// returns its points with the coordinates as stored. Points that are not finite are included.
/// Readers add every fault to `faults`. They throw InputError at a fault after which they cannot go
/// on, and at the tenth fault. After other faults they return, so the caller must call
/// `faults.throwIfAny()`.
namespace corridor {

/// The maximum number of points in a file.
constexpr std::uint64_t kMostPoints = 10'000'000;
/// Throws InputError if `count`, a number of points, exceeds `kMostPoints`. Readers of formats with
/// a header call this function before they allocate memory for the points. `readXyz` calls it after
/// each point.
inline void limitPoints(std::uint64_t count, int line, MeshFaults& faults) {
  if (count > kMostPoints)
    faults.fail(line, "has " + std::to_string(count) + " points or more; a file may have at most " +
                          std::to_string(kMostPoints) + ": thin the cloud out");
}

PointCloud readPlyPoints(std::string_view bytes, MeshFaults& faults);
PointCloud readPcd(std::string_view bytes, MeshFaults& faults);
/// @param metresPerUnit that will be applied, to compare it with the unit in comments.
PointCloud readXyz(std::string_view text, double metresPerUnit, MeshFaults& faults);

}  // namespace corridor
