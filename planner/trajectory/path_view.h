#pragma once

#include <cstddef>
#include <vector>

#include "planner/robot/configuration_space.h"
#include "planner/robot/curve.h"

namespace corridor {

/// Configurations and derivatives along a path of pieces, by the parameter τ in [0, 1] of each
/// piece. The object keeps references: path and space must outlive it.
class PathView {
 public:
  PathView(const std::vector<CurvePiece>& path, const ConfigurationSpace& space);

  const std::vector<CurvePiece>& path() const { return path_; }
  const ConfigurationSpace& space() const { return space_; }
  /// Returns the configuration at τ of a piece. Quaternions are normalised.
  Configuration value(std::size_t piece, double tau) const;
  /// Computes dq/dτ and d²q/dτ². For a rotation, the first three of its four components are its
  /// angular velocity by τ, in radians per unit of τ and in the coordinates of the frame before the
  /// joint. The angular velocity in `first` is constant in a piece.
  void derivatives(std::size_t piece, double tau, Configuration& first,
                   Configuration& second) const;
  /// Returns d³q/dτ³.
  Configuration thirdDerivative(std::size_t piece, double tau) const;
  /// Returns a bound of the length of dq/dτ in a piece; 0 if the piece has no length.
  double speedBound(std::size_t piece) const;
  /// Returns whether the piece has degree 1: a straight line at a constant rate.
  bool isStraight(std::size_t piece) const;
  /// Returns, for each rotation, the index of its first component in a Configuration.
  const std::vector<Eigen::Index>& rotations() const { return rotations_; }
  /// Returns the rotation vector (radians) from the start to the end of a piece. @param r index
  /// into `rotations()`.
  Eigen::Vector3d turn(std::size_t piece, std::size_t r) const {
    return turns_[piece * rotations_.size() + r];
  }

 private:
  const std::vector<CurvePiece>& path_;
  const ConfigurationSpace& space_;
  std::vector<Eigen::Index> rotations_;
  std::vector<Eigen::Vector3d> turns_;
};

}  // namespace corridor
