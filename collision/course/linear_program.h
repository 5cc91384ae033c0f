#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "collision/core/transform.h"

namespace corridor {

/// The half-space {x : normal·x ≤ offset} in D variables: of the plane (D = 2), of space (D = 3),
/// or in more dimensions. The normal may have any length. If the normal is 0, the set is all points
/// (offset ≥ 0) or none.
template <int D>
struct HalfSpace {
  Eigen::Matrix<double, D, 1> normal = Eigen::Matrix<double, D, 1>::Zero();
  double offset = 0;
};

enum class LinearProgramStatus { optimal, unbounded, infeasible };

/// A half-space, by its index in the linear program, with its weight in a proof.
struct WeightedHalfSpace {
  std::size_t index = 0;
  /// Above 0 before rounding; tiny and huge weights may be rounded to 0 or infinity.
  double weight = 0;
};

/// The answer of a linear program. The status is exact: it is that of real arithmetic on the given
/// doubles. All other numbers are rounded.
template <int D>
struct LinearProgramAnswer {
  LinearProgramStatus status = LinearProgramStatus::infeasible;
  /// `optimal`: a point of all half-spaces with the largest goal·x. `unbounded`: a point of all
  /// half-spaces.
  Eigen::Matrix<double, D, 1> x = Eigen::Matrix<double, D, 1>::Zero();
  /// `unbounded`: a direction that leaves no half-space (normal·ray ≤ 0 for all), and along which
  /// goal·x grows.
  Eigen::Matrix<double, D, 1> ray = Eigen::Matrix<double, D, 1>::Zero();
  /// The proof.
  /// * `optimal`: at most D half-spaces. The weighted sum of their normals is the goal, and their
  ///   planes contain an optimal point.
  /// * `infeasible`: at most D + 1 half-spaces (Farkas' lemma). The weighted sum of their normals
  ///   is 0, and the weighted sum of their offsets is below 0.
  std::vector<WeightedHalfSpace> proof;
  bool exact = false;  ///< the status was decided in rational arithmetic
};

/// Maximises goal·x over all points x that are in all half-spaces, in 2 to 6 variables.
///
/// Method: Seidel's algorithm in double, in random order (seidel-inl.h), gives a candidate. The
/// candidate's own witness, with a bound of all rounding, proves whether the half-spaces have a
/// common point: it is a point inside all half-spaces, or weights whose signs are those of small
/// determinants. What the witness does not decide is decided in rationals. If the goal is not 0,
/// rationals always decide `unbounded` and the optimum. The rational computation uses the few
/// half-spaces that determine the answer; all others are tested against the result. Cost: O(D!·n)
/// in the mean for n half-spaces.
/// @param goal  the objective vector. If it is 0, any point of all half-spaces is optimal.
/// @param seed  seed of the random order. It changes neither the status nor the optimal value.
/// @throws std::invalid_argument if a component of a normal or of the goal, or an offset, is not
/// finite.
template <int D>
LinearProgramAnswer<D> solveLinearProgram(std::span<const HalfSpace<D>> halfSpaces,
                                          const Eigen::Matrix<double, D, 1>& goal,
                                          std::uint64_t seed = 1);

/// Finds a common point of two polytopes (or unbounded polyhedra), each given by its half-spaces,
/// by the linear program of all half-spaces with the goal 0. Touching counts. In the proof, indices
/// of b's half-spaces begin at a.size().
template <int D>
LinearProgramAnswer<D> commonPoint(std::span<const HalfSpace<D>> a, std::span<const HalfSpace<D>> b,
                                   std::uint64_t seed = 1);

}  // namespace corridor
