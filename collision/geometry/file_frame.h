#pragma once

#include "collision/core/transform.h"
#include "collision/geometry/mesh_file.h"
#include "collision/geometry/mesh_text.h"

namespace corridor {

/// Maps the coordinates of a file to metres. If the options name an up-axis (`MeshFileOptions`),
/// also rotates this axis to z.
class FileFrame {
 public:
  /// @param metresPerUnit the unit to use if the options do not state a unit.
  FileFrame(const MeshFileOptions& options, double metresPerUnit)
      : scale_(options.metresPerUnit.value_or(metresPerUnit)), up_(options.up.value_or('z')) {}

  bool isIdentity() const { return scale_ == 1 && up_ == 'z'; }
  double scale() const { return scale_; }
  /// Returns the point in metres, rotated so that the up-axis becomes z. The axes that Collada
  /// calls "right" and "in" for this up-axis become x and -y.
  Vec3 operator*(const Vec3& p) const {
    Vec3 q = scale_ * p;
    switch (up_) {
      case 'x':
        return {-q.y(), -q.z(), q.x()};
      case 'y':
        return {q.x(), -q.z(), q.y()};
      default:
        return q;
    }
  }

 private:
  double scale_;
  char up_;
};

/// Adds a fault for each option that is out of range, and throws InputError if `faults` has any
/// fault.
void checkOptions(const MeshFileOptions& options, MeshFaults& faults);

}  // namespace corridor
