#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace corridor {

/// A state of all robots of a problem: one number for each line or circle coordinate of a
/// ConfigurationSpace and four for each rotation, in the order of the coordinates. Metres, radians;
/// quaternions as (x, y, z, w).
using Configuration = Eigen::VectorXd;

/// One coordinate of a configuration: a number, or the four numbers of a quaternion.
struct Coordinate {
  enum class Kind {
    line,      ///< a real number in [lower, upper]
    circle,    ///< an angle without limits; `normalise` brings it into [−π, π]
    rotation,  ///< four numbers (qx, qy, qz, qw), not all 0, of any norm
  };
  Kind kind = Kind::line;
  std::string name;       ///< single joint: "pan", "left/pan"; rigid robot: "x", "y", "z", "yaw",
                          ///< "rotation", "left/x"; planar or floating joint: "base/x"
  std::size_t first = 0;  ///< index of its first number in a Configuration
  double lower = 0, upper = 0;  ///< inclusive bounds of a line; not used for other kinds
  bool angular = false;         ///< line only: in radians, not metres
  double weight = 1;            ///< factor of this coordinate's difference (m or rad) in distances

  std::size_t size() const { return kind == Kind::rotation ? 4 : 1; }
};

/// Coordinates that are combined in a distance: the position and the rotation of a planar or
/// floating joint, or all single joints of the problem.
struct CoordinateGroup {
  enum class Kind { joints, planar, floating };
  Kind kind = Kind::joints;
  std::string name;  ///< name of the joint or robot; empty for `joints`
  /// Indices. For `joints`: all single joints; `planar`: x, y, yaw; `floating`: x, y, z, rotation.
  std::vector<std::size_t> coordinates;
};

/// The space of all configurations, and the definition of an edge in it. Along an edge, for t in
/// [0, 1], the coordinates move as follows:
/// - a line is linear in t;
/// - a circle goes the shorter way round, linear in t;
/// - a rotation is the slerp of the two quaternions, normalised in real arithmetic, along the
///   shorter arc.
/// If a circle or rotation turns by a half turn, to within 1e-9 rad, neither way is shorter, and
/// the edge defines no curve; see ambiguous().
class ConfigurationSpace {
 public:
  /// Adds a coordinate and sets its `first`. Each coordinate must be in exactly one group; see
  /// addGroup().
  /// @returns the index of the coordinate.
  std::size_t add(Coordinate coordinate);
  void addGroup(CoordinateGroup group);

  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  std::vector<Coordinate>& coordinates() { return coordinates_; }
  const std::vector<CoordinateGroup>& groups() const { return groups_; }
  std::size_t size() const { return size_; }  ///< the length of a Configuration
  /// Returns the kind of the coordinate to which a number of a Configuration belongs.
  /// @throws std::invalid_argument if there is no such number.
  Coordinate::Kind kindOfNumber(std::size_t number) const;
  /// Returns a name for each number of a Configuration: "x", "pan", …; for a rotation "qx", "qy",
  /// "qz" and "qw", after the coordinate's prefix ("left/qx").
  std::vector<std::string> numberNames() const;

  bool inBounds(const Configuration& q) const;  ///< tests lines only; inclusive
  bool isFinite(const Configuration& q) const;  ///< also requires that no quaternion is zero
  /// Brings the angles of circles into [−π, π] and quaternions to norm 1.
  void normalise(Configuration& q) const;

  /// Returns the configuration on the edge at t in [0, 1]. The rounding error is a few ulp, however
  /// far a circle or rotation turns between `from` and `to`, except for half turns. At t = 0 the
  /// result is `from`, and at t = 1 it is `to`, bit for bit, except that the angles of circles are
  /// brought into [−π, π]. The value of a line is always between its values in `from` and `to`.
  Configuration interpolate(const Configuration& from, const Configuration& to, double t) const;
  /// Returns the sum of the groups' distances. The distance of the single joints is the square root
  /// of Σ (weight·difference)². The distance of a planar or floating joint is w_p·|Δp| + w_r·angle,
  /// where w_p is the weight of the position coordinates and w_r the weight of the yaw or rotation.
  /// The angle of a `rotation` is its quaternion angle, half of the rotation angle. The distance is
  /// 0 only for equal configurations.
  double distance(const Configuration& a, const Configuration& b) const {
    return distance(a.data(), b.data());
  }
  /// Returns the distance of two configurations given by pointers to `size()` numbers each.
  double distance(const double* a, const double* b) const;
  /// Returns whether two configurations are the same up to the rounding of `normalise`: the values
  /// of lines are equal, the angles of circles differ by at most 32u rad, and the quaternion angle
  /// between rotations is at most 32u rad (a rotation angle of 64u), with u = 2^-53.
  bool equal(const Configuration& a, const Configuration& b) const;
  /// Returns whether some circle or rotation turns by a half turn from a to b, to within 1e-9 rad.
  /// Then the edge from a to b defines no curve.
  bool ambiguous(const Configuration& a, const Configuration& b) const;
  /// Returns the largest angle by which a circle or rotation turns from a to b, radians in [0, π].
  double largestTurn(const Configuration& a, const Configuration& b) const;

 private:
  std::vector<Coordinate> coordinates_;
  std::vector<CoordinateGroup> groups_;
  /// The weights of all coordinates, if these are one group of joints, each of kind `line`.
  std::vector<double> lineWeights_;
  std::size_t size_ = 0;
};

}  // namespace corridor
