#pragma once

#include <limits>

#include <Eigen/Geometry>

namespace corridor::verify {

/// The verifier's own arithmetic. Its proofs count roundings of u = 2^-64.
using Real = long double;
static_assert(std::numeric_limits<Real>::digits >= 64,
              "the verifier needs a long double of 64 bits");

/// An upper bound of a real value, if a value that was computed from numbers that are not negative,
/// by sums and products with up to 2^13 roundings one after another, is multiplied by this factor.
inline constexpr Real kUp = 1 + 0x1p-50L;
using RealVec = Eigen::Matrix<Real, 3, 1>;
using RealMat = Eigen::Matrix<Real, 3, 3>;

/// Lower and upper bound of the distance of two closed triangles.
///
/// `upper` is the distance of the two witness points. These are the closest points of the closest
/// pair of features, out of 15 pairs: 6 of a vertex and a face, 9 of two edges. `lower` doesn't
/// depend on that computation. It is the width of a slab between two parallel planes, with one
/// triangle on each side. Any direction n gives a true bound:
///     distance ≥ (min over B of n·b − max over A of n·a) / |n|.
/// If the triangles meet, every slab has width ≤ 0. So `lower` is right without a test for
/// intersection.
///
/// Rounding: let S be the largest norm of a corner. A dot product is off by at most 3u|n|S(1 +
/// O(u)). The difference of two dot products adds u·2|n|S, and the division by |n| a factor 1 ± 4u.
/// So `lower` exceeds the true distance of the given triangles by less than (3 + 3 + 2 + 8)u·S =
/// 2^-60·S. `upper` may be below the distance of the witness points, also by less than 2^-60·S.
/// Callers must account for this error.
struct DistanceBounds {
  Real lower = 0;
  Real upper = std::numeric_limits<Real>::infinity();
  RealVec onA = RealVec::Zero(), onB = RealVec::Zero();
};

/// Returns the width of the slab along `direction`, a vector of any length; 0 if `direction` is
/// zero.
Real slabWidth(const RealVec a[3], const RealVec b[3], const RealVec& direction);

DistanceBounds triangleGap(const RealVec a[3], const RealVec b[3]);

}  // namespace corridor::verify
