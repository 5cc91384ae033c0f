#pragma once

#include <optional>

#include "tests/stress/audit/curve.h"
#include "tests/stress/audit/shapes.h"

namespace corridor::audit {

/// The facts from which the true verdict of a case follows, computed from the stored doubles in 128
/// bits.
struct Truth {
  double t = 0;              ///< the time at which the bodies are made to meet (at gap 0)
  bool violates = false;     ///< proved: at t the bodies are closer than `keep`, or cross
  double apart = -HUGE_VAL;  ///< lower bound of the bodies' distance along the whole edge, metres
};

/// Two bodies that just meet, by construction.
///
/// At a time t one body, the tip, touches a plane with one feature (a corner, an edge or a face),
/// and lies above the plane. At t the tip moves along the plane, or leaves the plane at the start
/// of the edge, or reaches the plane at the end. The other body is called the rest. It lies below
/// the plane, at a distance of `keep` + gap; `rest(gap)` returns this body. The true verdict
/// follows from this distance.
///
/// The plane is fixed in the frame of the rest, which is one of the edge's two frames. The height
/// of the tip above the plane is bounded from below over the whole edge, by intervals: between two
/// times that differ by w, the height is at least the smaller of the heights at these times, minus
/// bend·w²/8, where `bend` bounds the height's second derivative. Heights are computed in long
/// double far from the plane, and in 128 bits close to it.
class Graze {
 public:
  enum class Meeting { along, start, end, slide };

  struct Wish {
    double size = 1;      ///< m, size of the bodies
    double keep = 0;      ///< m, distance of the bodies at gap 0
    bool inTube = false;  ///< the bodies meet on a curve in the edge's tube, not on the edge
  };
  Graze(Dice& dice, const Edge& edge, const Wish& wish);

  /// Returns whether the construction succeeded. Otherwise no other function may be called.
  bool usable() const { return usable_; }

  double size() const { return size_; }
  const Shape& tip() const { return tip_; }
  std::size_t tipFrame() const { return tipFrame_; }
  std::size_t restFrame() const { return restFrame_; }
  /// Returns the rest, `keep` + `gap` metres below the plane. The gap may be negative.
  /// @param[out] truth the facts from which the true verdict of the case with this body follows.
  Shape rest(double gap, Truth& truth) const;
  /// Returns a lower bound of the bodies' distance at t: the larger of their distances along two
  /// directions.
  double apartAt(const Shape& rest, double t) const;

  /// Returns the rounding of poses that Corridor may have, metres: L·((n + 2)·2^-43 + v·2^-48) for
  /// n joints, where L is the sum of all lengths, and v is the largest joint value in rad or m
  /// (../README.md).
  double rounding() const { return rounding_; }
  /// Returns the rounding of one operation, metres: 2^-53·L.
  double ulp() const { return ulp_; }
  /// Returns whether the tip moves along the plane at the time of meeting. Otherwise the tip moves
  /// towards the plane or away from it, or stands still.
  bool passesAlong() const { return passesAlong_; }

 private:
  template <class S>
  struct Look {
    S t = 0;
    Pose<S> X;
    Vec<S> normal;   // direction from the rest's feature to the tip's feature
    S flat = 0;      // distance of the bodies along the plane's normal
    S along = 0;     // distance of the bodies along `normal`
    S features = 0;  // distance of the features along `normal`
    S sine = 1;      // sine of the angle between two edges
  };
  template <class S>
  Look<S> look(const Curve<S>& curve, const Shape& rest, S t) const;
  template <class S>
  S boundOf(const Curve<S>& curve, const Look<S>& a, const Look<S>& b) const;
  bool chooseNormal(Dice& dice, Meeting meeting);
  void proveHeights();
  void perturbToWorstCorner(const Edge& edge);
  std::optional<Quad> distanceAtMost(const Shape& rest) const;
  bool crosses(const Shape& rest) const;

  bool usable_ = false, passesAlong_ = false;
  std::size_t tipFrame_ = 0, restFrame_ = 0;
  double size_, keep_, time_ = 0, rounding_ = 0, ulp_ = 0, error128_ = 0;
  bool inTube_;
  std::optional<Curve<Quad>> curve_;
  std::optional<Curve<Quad>> nominal_;
  // The plane's upward normal, in the rest's frame; the meeting point, in the tip's frame.
  Vec<Quad> normal_, touch_;
  ExactBody restPlan_;
  Shape tip_, base_;
  double baseError_ = 0;
  double lowest_ = -HUGE_VAL;  // proved lower bound of the distance along the edge, at gap 0
};

}  // namespace corridor::audit
