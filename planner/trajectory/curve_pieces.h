#pragma once

#include <vector>

#include "planner/robot/curve.h"

/// Conversions of curves to `CurvePiece`s. A piece stands for a polynomial in real arithmetic. The
/// `error` of a piece bounds two distances of this polynomial: from the given curve, and from the
/// positions that a controller computes when it evaluates the same formula in doubles.
///
/// The error of a Hermite piece: let u = 2^-53, let T be the duration, and let p, v and a be the
/// position, velocity and acceleration at the start (0) and at the end (1). A controller computes
/// the coefficients of the power series in t, such as (−3p0 + 3p1 − 2v0·T − v1·T)/T², and sums the
/// series. (The controllers of ros_control and ros2_control do so.) Its result is a sum of terms
/// that are p0, p1, v0·T, v1·T, a0·T² or a1·T² times a factor and a power of τ = t/T in [0, 1].
/// Each term is off by a factor (1 + u)^±n. Here n counts the term's roundings, and 8 more for each
/// factor T of v·T and a·T², because the controller's T may be off by 8u·T. For each of the six
/// quantities, add up the absolute factors of its terms, and let f be the largest of these sums.
/// The sum of the absolute values of all terms is at most f·M, with
///     M = |p0| + |p1| + T(|v0| + |v1|) + T²(|a0| + |a1|).
/// Hence the error is at most n·f·u·M:
///
/// | piece | n | f | n·f | bound |
/// |---|---|---|---|---|
/// | linear | 4: difference, quotient, product, sum | 2 | 8 | 2^-49·M = 16u·M |
/// | cubic | 22 | 6 (p0: 1 + 3 + 2) | 132 | 2^-45·M = 256u·M |
/// | quintic | 41 | 32 (p0: 1 + 10 + 15 + 6) | 1312 | 2^-42·M = 2048u·M |
///
/// Roundings of the cubic, n = 22: product with T 2, sum 3, quotient by T³ 3, t³ 2, product 1, sum
/// 3, the error of T 8. Roundings of the quintic, n = 41: products with T² 3, sum 5, quotient by
/// 2T⁵ 6, t⁵ 4, product 1, sum 5, the error of T² 16, and one in reserve.
///
/// The bounds have room for the terms of second order, and for the rounding of the Bernstein
/// coefficients, which are computed in long double and rounded once: at most 2u·M.
///
/// A controller that computes the duration from times in doubles has a less exact duration, with an
/// error of up to δ seconds. The controller's curve then has up to T + δ in place of T in the terms
/// v·T and a·T². These terms are multiplied by polynomials that are below 1 on [0, 1]. So the
/// controller's curve deviates by at most δ·(|v0| + |v1|) + (2T + δ)·δ·(|a0| + |a1|). The functions
/// below add this bound to the error, with δ = `durationError`.
namespace corridor {

/// The state of a trajectory at one time, in m, rad and s. Empty vectors: unknown.
struct CurvePoint {
  Configuration position, velocity, acceleration;
};

/// Returns the straight line from one configuration to another. Angles are literal: an angle is
/// linear from the first value to the second, even if the other way round is shorter. Rotations
/// (quaternions) are interpolated by slerp.
CurvePiece linearPiece(const ConfigurationSpace& space, const Configuration& from,
                       const Configuration& to);
/// Returns the cubic polynomials with the positions and velocities of `from` and `to` at the ends.
/// Rotations (quaternions) are not polynomials: they are interpolated by slerp.
/// @param duration seconds, > 0.
/// @param durationError seconds: the largest difference of a controller's duration from `duration`.
CurvePiece cubicPiece(const ConfigurationSpace& space, const CurvePoint& from, const CurvePoint& to,
                      long double duration, long double durationError = 0);
/// Returns the polynomials of degree 5 with the positions, velocities and accelerations of `from`
/// and `to` at the ends. Rotations and parameters are the same as for `cubicPiece`.
CurvePiece quinticPiece(const ConfigurationSpace& space, const CurvePoint& from,
                        const CurvePoint& to, long double duration, long double durationError = 0);

/// Returns the polynomials Σ_k coefficients(row, k)·t^k for t in [0, duration]; each row is one
/// component of a configuration. The space must have no rotation coordinate (quaternion).
///
/// The error bound is 2^-47·Σ_k |coefficients(row, k)|·duration^k, for degrees up to 9. It covers
/// the evaluation by Horner's rule in doubles, which has at most 18 roundings. The conversion
/// computes a weighted mean of the terms in long double, and rounds it once. This error is below 2u
/// of the same sum, with u = 2^-53. If terms cancel, the bound is large compared with the
/// positions: a power series is ill-conditioned.
/// @throws std::invalid_argument for a degree that CurvePiece does not support.
CurvePiece powerPiece(const Eigen::MatrixXd& coefficients, double duration);

/// Returns the pieces of a B-spline, one for each knot interval that is not empty, and their knots.
/// The Bernstein coefficients are values of the spline's polar form, computed by de Boor's
/// recursion. (Knot insertion would give the same coefficients.) The space must have no rotation
/// coordinate (quaternion).
///
/// For each component, let `max` be the largest absolute value of its control points. The error
/// bound is 2^-46·max = 128u·max, with u = 2^-53. It covers the evaluation by de Boor's recursion
/// in doubles: 9 levels of at most 8u·max each. (The weight α is off by 3u, which moves a
/// combination by up to 6u·max. 1 − α, the products and the sum add 2u·max.) The conversion does
/// the same recursion in long double, and rounds once.
/// @param points one column for each control point.
/// @param knots points.cols() + degree + 1 knots, in ascending order. The curve is defined on
/// [knots[degree], knots[points.cols()]].
/// @throws std::invalid_argument for a wrong number of knots, knots that do not ascend, or a degree
/// that CurvePiece does not support.
Curve splineCurve(const Eigen::MatrixXd& points, const std::vector<double>& knots, int degree);

/// Returns the curve of a path whose edges are those of ConfigurationSpace: a piece for each edge,
/// with the knots 0, 1, 2, … A circle coordinate (the angle of a continuous joint, or a yaw) goes
/// the shorter way. So the curve's angles may leave [−π, π]; they differ by whole turns from the
/// angles of the states.
///
/// The error of a circle coordinate: whole turns are added in long double, and the sum is rounded
/// once. Both errors together are at most 2^-52·|angle|, plus 2^-60 rad for each turn.
/// @throws std::invalid_argument if there are fewer than two states, or the shorter way of an edge
/// is ambiguous.
Curve curveOfPath(const ConfigurationSpace& space, const std::vector<Configuration>& states);

}  // namespace corridor
