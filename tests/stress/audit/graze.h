#pragma once

#include <optional>

#include "tests/stress/audit/curve.h"
#include "tests/stress/audit/shapes.h"

namespace corridor::audit {

/// What is known of a case: from stored doubles, in 128 bits.
struct Truth {
  double t = 0;              ///< where the two come closest, by construction
  bool violates = false;     ///< at t, and so on the edge, they are closer than `keep`, or touch
  double apart = -HUGE_VAL;  ///< no less than this apart all along the edge, metres
};

/// Two bodies that just meet, by construction. A body with a feature (the tip) is put above a plane
/// with another feature (the rest) at a time t, such that the tip moves along the plane there, or
/// leaves it, or comes to it at the end. Then `rest(gap)` puts the other body below the plane at a
/// distance, and the truth follows.
///
/// The plane is in the frame of the rest: the pair of frames is seen from either side. Heights
/// above it are proved over the whole edge by intervals: between two times a height is at least the
/// lesser one less bend·w²/8. Long double proves what is far from the plane, 128 bits the rest.
class Graze {
 public:
  enum class Meeting { along, start, end, slide };

  struct Wish {
    double size = 1;      ///< m, of the bodies
    double keep = 0;      ///< m, the distance at gap 0
    bool inTube = false;  ///< a curve in the edge's tube is what meets
  };
  Graze(Dice& dice, const Edge& edge, const Wish& wish);

  /// Something can be said: else the case is to be thrown away.
  bool usable() const { return usable_; }

  double size() const { return size_; }
  const Shape& tip() const { return tip_; }
  std::size_t tipFrame() const { return tipFrame_; }
  std::size_t restFrame() const { return restFrame_; }
  /// The other body, `gap` metres farther down. @param[out] truth  of the two.
  Shape rest(double gap, Truth& truth) const;
  /// How far apart the two are at a time, at least: along the best direction known.
  double apartAt(const Shape& rest, double t) const;

  /// No less than what rounding may do to poses anywhere, as Corridor's README promises it: 2^-43
  /// of all lengths for each joint, and 2^-48 of what angles of many turns are worth.
  double rounding() const { return rounding_; }
  /// What one operation may round, metres: 2^-53 of all lengths.
  double ulp() const { return ulp_; }
  /// The tip moves along the plane where they meet; else straight to it or from it, or not at all.
  bool passesAlong() const { return passesAlong_; }

 private:
  template <class S>
  struct Look {
    S t = 0;
    Pose<S> X;
    Vec<S> normal;   // a direction from the rest's feature to the tip's
    S flat = 0;      // apart along the plane's normal
    S along = 0;     // apart along `normal`
    S features = 0;  // the features alone, along `normal`
    S sine = 1;      // between two edges
  };
  template <class S>
  Look<S> look(const Curve<S>& curve, const Shape& rest, S t) const;
  template <class S>
  S boundOf(const Curve<S>& curve, const Look<S>& a, const Look<S>& b) const;
  bool chooseNormal(Dice& dice, Meeting meeting);
  void proveHeights();
  void strayToWorst(const Edge& edge);
  std::optional<Quad> distanceAtMost(const Shape& rest) const;
  bool crosses(const Shape& rest) const;

  bool usable_ = false, passesAlong_ = false;
  std::size_t tipFrame_ = 0, restFrame_ = 0;
  double size_, keep_, time_ = 0, rounding_ = 0, ulp_ = 0;
  bool inTube_;
  std::optional<Curve<Quad>> curve_;
  std::optional<Curve<Quad>> nominal_;
  Vec<Quad> normal_, touch_;  // in the rest's frame: the plane's, upwards; and where they meet
  Plan restPlan_;
  Shape tip_, base_;
  double baseError_ = 0;
  double lowest_ = -HUGE_VAL;  // proved: with the rest at gap 0
};

}  // namespace corridor::audit
