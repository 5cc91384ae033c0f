#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace corridor {

/// A state of everything that moves: the variables of a ConfigurationSpace, in its order. Metres,
/// radians; quaternions as (x, y, z, w).
using Configuration = Eigen::VectorXd;

/// One variable, or the four of a quaternion.
struct Coordinate {
  enum class Kind {
    line,      ///< a real number in [lower, upper]
    circle,    ///< an angle, in [−π, π]
    rotation,  ///< four numbers (qx, qy, qz, qw), not all 0; need not have norm 1
  };
  Kind kind = Kind::line;
  std::string name;       ///< "pan", "left/pan"; "x", "y", "z", "yaw", "rotation" of a body that
                          ///< moves as a whole, or "left/x"
  std::size_t first = 0;  ///< index of its first number in a Configuration
  double lower = 0, upper = 0;  ///< line only; inclusive
  bool angular = false;         ///< line only: radians, not metres
  double weight = 1;            ///< in distances: of the difference (m, or rad)

  std::size_t size() const { return kind == Kind::rotation ? 4 : 1; }
};

/// Coordinates that belong together in a distance: those of a planar or floating joint (position,
/// and angle), or all single joints of the problem.
struct CoordinateGroup {
  enum class Kind { joints, planar, floating };
  Kind kind = Kind::joints;
  std::string name;                      ///< of the joint or robot; "" for the joints
  std::vector<std::size_t> coordinates;  ///< indices: joints…; x, y, yaw; x, y, z, rotation
};

/// The space in which is planned, and Corridor's edges in it (design: «What an edge is»): lines
/// linear in t, circles the shorter way, rotations by slerp of the quaternions normalised in real
/// arithmetic, the shorter arc.
class ConfigurationSpace {
 public:
  /// Adds a coordinate (its `first` is set), in a group. @returns its index.
  std::size_t add(Coordinate coordinate);
  void addGroup(CoordinateGroup group);

  const std::vector<Coordinate>& coordinates() const { return coordinates_; }
  std::vector<Coordinate>& coordinates() { return coordinates_; }
  const std::vector<CoordinateGroup>& groups() const { return groups_; }
  std::size_t size() const { return size_; }  ///< numbers in a Configuration
  /// "x", "pan", …: a name for each number (rotations: qx, qy, qz, qw).
  std::vector<std::string> numberNames() const;

  bool inBounds(const Configuration& q) const;  ///< lines only; inclusive
  bool isFinite(const Configuration& q) const;  ///< and no quaternion is zero
  /// Angles of circles into [−π, π], quaternions to norm 1.
  void normalise(Configuration& q) const;

  /// The configuration on the edge at t in [0, 1], to a few ulp at every angle, half turns
  /// excepted. Bit for bit `from` at 0 and `to` at 1 (a circle outside [−π, π] excepted: it comes
  /// back inside); lines never leave [from, to].
  Configuration interpolate(const Configuration& from, const Configuration& to, double t) const;
  /// Sum over the groups: joints, the root of Σ (weight·difference)²; planar and floating,
  /// weight·|Δp| + weight·(angle; a rotation's is the quaternion angle, half the rotation's). 0
  /// only for equal configurations.
  double distance(const Configuration& a, const Configuration& b) const {
    return distance(a.data(), b.data());
  }
  /// Of configurations in other memory, `size()` numbers each.
  double distance(const double* a, const double* b) const;
  /// The same configuration, but for the rounding of normalised quaternions.
  bool equal(const Configuration& a, const Configuration& b) const;
  /// Some circle or rotation turns by a half turn within 1e-9 rad: no edge.
  bool ambiguous(const Configuration& a, const Configuration& b) const;
  /// The largest angle that a circle or rotation turns from a to b, radians in [0, π].
  double largestTurn(const Configuration& a, const Configuration& b) const;

 private:
  std::vector<Coordinate> coordinates_;
  std::vector<CoordinateGroup> groups_;
  std::size_t size_ = 0;
};

}  // namespace corridor
