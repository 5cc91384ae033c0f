#pragma once

#include "collision/motion/rigid_motion.h"
#include "collision/predicates/triangle.h"

namespace corridor::test {

/// A rigid motion under which every point's coordinates are rational in a parameter s in [0, 1]. It
/// is a straight line, or a rotation about the reference point and a fixed axis, by the quaternion
/// (1, s·m) (Cayley).
///
/// It is exactly the motion of an edge (RigidMotion::spatial) between `from()` and `to()`, because
/// an edge normalises its quaternions in real arithmetic. Only the parameter differs. The edge's t
/// is s on a line, and atan(s|m|)/atan(|m|) in a rotation.
class RationalMotion {
 public:
  /// Returns the straight line from from.p to p with constant orientation.
  static RationalMotion line(const RigidPose& from, const Vec3& p);
  /// Returns the rotation by the angle 2·atan(|m|) about m, an axis in the world. @pre m is not
  /// zero.
  /// @throws std::invalid_argument  if the quaternion at s = 1, (1, m)·from.q, is not exact in
  /// doubles.
  static RationalMotion turn(const RigidPose& from, const Vec3& m);

  const RigidPose& from() const { return from_; }
  const RigidPose& to() const { return to_; }
  /// Returns the vector m of a rotation, or zero for a line.
  const Vec3& m() const { return m_; }
  /// Returns the edge's t at the parameter s, with an error below 2^-60. In long double, s|m|, both
  /// arcs, |m| and the ratio are each off by a few units of 2^-64, and the relative error of an arc
  /// is at most that of its argument.
  long double time(long double s) const;

  /// The pose at s, multiplied by a weight > 0 so that it has no fractions: X has the pose's matrix
  /// and translation, each times `weight`.
  struct Scaled {
    Transform X;
    double weight = 1;
  };
  /// Returns the multiplied pose at s, exactly. @pre 0 ≤ s ≤ 1. @throws std::invalid_argument if
  /// doubles can't hold it.
  Scaled at(double s) const;

 private:
  RigidPose from_, to_;
  Vec3 m_ = Vec3::Zero();
};

/// When a moving triangle first touches a fixed one: s in [low, high], high − low ≤ 2^-60.
struct FirstContact {
  bool contact = false;
  long double low = -1, high = -1;  ///< if `contact`
};

/// The oracle: computes exactly when a moving triangle first touches a fixed one, by another method
/// than the code under test.
///
/// Triangles that are separated at first begin to touch with a corner in a face or with two edges
/// that cross. For each such pair of features, a polynomial in s vanishes when the pair is
/// coplanar. Sturm's theorem isolates the roots of this polynomial. At each root, an algebraic
/// number, the signs of further polynomials decide exactly whether the features meet. No case is
/// left out: if a corner stays in a face's plane, the oracle uses the times at which the corner
/// crosses the lines of the face's edges.
///
/// All polynomials are determinants of the corners. They are divided by the pose's denominator as
/// often as possible, which leaves them quadratic.
/// @param fixed  in the world.
/// @param moving  in the frame of the motion.
/// @pre Both triangles have an area above 0.
FirstContact sturmContact(const Triangle& fixed, const Triangle& moving,
                          const RationalMotion& motion);

/// Returns whether the triangles touch at s, exactly. @throws std::invalid_argument  if s has so
/// many digits that doubles cannot hold the pose.
bool touchesAt(const Triangle& fixed, const Triangle& moving, const RationalMotion& motion,
               double s);

}  // namespace corridor::test
