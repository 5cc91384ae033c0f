#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "collision/core/swept_sphere.h"

namespace corridor {

/// Swept spheres around the bodies of a scene, in the world frame, for one time interval. Each is
/// computed when it is first needed.
class SweptSpheres {
 public:
  void makeRoom(std::size_t bodies) {
    if (spheres_.size() < bodies) spheres_.resize(bodies);
  }
  /// Discards all spheres. Must be called before each time interval, also before the first.
  void forget() { ++stamp_; }
  /// Returns the body's swept sphere. Calls `make` to compute it if there is none yet.
  /// @pre `makeRoom` included the body, and `make` calls no member of this class.
  template <class Make>
  const SweptSphere& of(std::size_t body, const Make& make) {
    Stamped& known = spheres_[body];
    if (known.stamp != stamp_) known = {make(), stamp_};
    return known.sphere;
  }

 private:
  struct Stamped {
    SweptSphere sphere;
    std::uint64_t stamp = 0;
  };
  std::vector<Stamped> spheres_;
  std::uint64_t stamp_ = 0;
};

}  // namespace corridor
