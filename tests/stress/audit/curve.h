#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"
#include "tests/stress/audit/quad.h"

namespace corridor::audit {

/// An edge or a piece of a curve as plain data, and the two frames that carry the bodies.
struct Edge {
  KinematicTree tree;
  ConfigurationSpace space;
  Configuration from, to;
  Configuration tube;                 ///< half widths, as `EdgeMotion` takes them; zero in most
                                      ///< cases
  std::size_t first = 0, second = 0;  ///< frames
  /// If set, the bodies move along this piece. `from` and `to` are then its ends.
  std::optional<CurvePiece> piece = {};

  /// Returns the exact sum of the tube's half width and the piece's error for one component of the
  /// configuration. A proof must cover all curves whose component strays no farther than this from
  /// the edge or piece. @param number the component's index.
  Quad strayOf(std::size_t number) const {
    const auto i = static_cast<Eigen::Index>(number);
    return piece ? Quad(tube[i]) + Quad(piece->error[i]) : Quad(tube[i]);
  }
};

/// A polynomial in Bernstein form on [0, 1].
template <class S>
struct Polynomial {
  int degree = 0;
  std::array<S, CurvePiece::kLargestDegree + 1> d{};  ///< coefficients

  /// Evaluates by Horner's scheme in t and 1 − t.
  S at(S t) const {
    if (degree == 0) return d[0];
    const S u = 1 - t;
    S sum = d[0] * u, power = 1, binomial = 1;
    for (int i = 1; i < degree; ++i) {
      power = power * t;
      binomial = binomial * S(degree - i + 1) / S(i);
      sum = (sum + power * binomial * d[static_cast<std::size_t>(i)]) * u;
    }
    return sum + power * t * d[static_cast<std::size_t>(degree)];
  }
};

/// A perturbation of a curve: the amount that is added to each component of its configurations. For
/// a rotation, the first three of its four components hold a rotation vector instead; that rotation
/// is applied after the curve's rotation.
using Perturbation = std::vector<Quad>;

/// The motion of one frame as seen from another along an edge or a piece. It follows the definition
/// of an edge, or of a CurvePiece:
/// - line coordinates: linear in t; in a piece, the polynomial in Bernstein form;
/// - circle coordinates: linear in t, by the exact difference modulo 2π, the shorter way round; in
///   a piece, the polynomial, without removing revolutions;
/// - rotation coordinates: slerp of the normalised quaternions along the shorter arc, also in a
///   piece;
/// - value of a joint: multiplier·q + offset, where q is the joint's coordinate.
template <class S>
class Curve {
 public:
  /// @param watcher the frame in which the motion is expressed. @param watched the frame that
  /// moves. @param stray the perturbation of the curve; empty: none.
  Curve(const Edge& edge, std::size_t watcher, std::size_t watched, const Perturbation& stray = {});
  /// Converts a curve to another number type, which has fewer digits.
  template <class Other>
  explicit Curve(const Curve<Other>& other);

  /// Returns the map from the watched frame to the watcher frame at t.
  Pose<S> at(S t) const;

  /// Return bounds of |x'| (`speed`) and |x''| (`bend`) for points x of the watched frame within
  /// `radius` of its origin. The bounds are ΩR + V and Ω²R + 2ΩV + AR + B. Ω is the sum of the
  /// largest rates of all rotations, V the same for all translations; A and B are the sums of the
  /// largest accelerations of rotations and of translations. R is the sum of all lengths, `radius`
  /// included. On an edge, A and B are 0.
  double speed(double radius) const { return turned_ * (length_ + radius) + slid_; }
  double bend(double radius) const {
    return turned_ * (speed(radius) + slid_) + turnBend_ * (length_ + radius) + slideBend_;
  }
  double turned() const { return turned_; }        ///< Ω, rad
  double turnBend() const { return turnBend_; }    ///< A, rad
  double slideBend() const { return slideBend_; }  ///< B, m
  /// Returns an upper bound of the chain's length at every t, metres.
  double length() const { return length_; }
  /// Returns the sum, over all rotating joints, of n times the largest coefficient of the joint's
  /// polynomial of degree n, rad. This angle, times the unit roundoff of the number type, bounds
  /// the rounding errors of the evaluated polynomials.
  double terms() const { return terms_; }
  double largest() const { return largest_; }  ///< the largest stored value of a joint, rad or m
  /// Returns whether exactly one joint rotates. Then all accelerations, except those of
  /// translations (B), are orthogonal to that joint's axis.
  bool hasOneRotation() const { return turning_ == 1; }
  /// Returns the unit axis at t of the first joint that rotates, in the watcher frame; the x axis
  /// if no joint rotates.
  Vec<S> axisAt(S t) const;

  std::size_t joints() const { return elements_.size(); }

 private:
  template <class Other>
  friend class Curve;

  struct Element {
    Frame::Joint joint = Frame::Joint::none;
    bool inverted = false;
    Pose<S> fixed;
    Vec<S> axis;           // axis of a rotation, or direction of a translation
    S value = 0;           // the joint's value at t = 0
    Polynomial<S> change;  // change since t = 0
    bool turns = false;    // a rotation that is not constant
    Vec<S> shift;
    std::array<Polynomial<S>, 3> shiftChange;
    std::array<S, 4> q0{}, q1{};
    S omega = 0, sineOfOmega = 0;
    Mat<S> stray;  // perturbation of a rotation; it is multiplied from the left
  };
  Pose<S> poseOf(const Element& e, S t) const;
  void add(const Edge& edge, std::size_t frame, bool inverted, const Perturbation& stray);
  void addRotation(const Edge& edge, std::size_t number, const Vec<Quad>& aside, Element& e);

  std::vector<Element> elements_;  // from the frame `watcher` to the frame `watched`
  double turned_ = 0, slid_ = 0, turnBend_ = 0, slideBend_ = 0;
  double length_ = 0, largest_ = 0, terms_ = 0;
  int turning_ = 0;
};

/// Returns the change of a circle coordinate from angle `from` to angle `to`, the shorter way
/// round, to 33 digits, rad.
Quad circleDifference(double from, double to);

template <class S>
template <class Other>
Curve<S>::Curve(const Curve<Other>& o)
    : turned_(o.turned_),
      slid_(o.slid_),
      turnBend_(o.turnBend_),
      slideBend_(o.slideBend_),
      length_(o.length_),
      largest_(o.largest_),
      terms_(o.terms_),
      turning_(o.turning_) {
  const auto mat = [](const Mat<Other>& m) {
    Mat<S> n;
    for (std::size_t i = 0; i < 3; ++i) n.row[i] = Vec<S>(m.row[i]);
    return n;
  };
  const auto polynomial = [](const Polynomial<Other>& p) {
    Polynomial<S> n;
    n.degree = p.degree;
    std::transform(p.d.begin(), p.d.end(), n.d.begin(), [](const Other& x) { return S(x); });
    return n;
  };
  for (const auto& e : o.elements_) {
    Element n;
    n.joint = e.joint, n.inverted = e.inverted;
    n.fixed = {mat(e.fixed.R), Vec<S>(e.fixed.p)};
    n.axis = Vec<S>(e.axis), n.value = S(e.value), n.change = polynomial(e.change);
    n.turns = e.turns, n.shift = Vec<S>(e.shift);
    for (std::size_t i = 0; i < 3; ++i) n.shiftChange[i] = polynomial(e.shiftChange[i]);
    for (std::size_t i = 0; i < 4; ++i) n.q0[i] = S(e.q0[i]), n.q1[i] = S(e.q1[i]);
    n.omega = S(e.omega), n.sineOfOmega = S(e.sineOfOmega);
    n.stray = mat(e.stray);
    elements_.push_back(n);
  }
}

template <class S>
Pose<S> Curve<S>::poseOf(const Element& e, S t) const {
  Pose<S> joint;
  switch (e.joint) {
    case Frame::Joint::none:
      break;
    case Frame::Joint::revolute: {
      const S phi = e.value + e.change.at(t);
      joint.R = turnAbout(e.axis, sine(phi), cosine(phi));
      break;
    }
    case Frame::Joint::prismatic:
      joint.p = e.axis * (e.value + e.change.at(t));
      break;
    case Frame::Joint::translation:
      for (std::size_t i = 0; i < 3; ++i) joint.p[i] = e.shift[i] + e.shiftChange[i].at(t);
      break;
    case Frame::Joint::rotation: {
      const bool turns = e.sineOfOmega > 0;
      const S a = turns ? sine((1 - t) * e.omega) / e.sineOfOmega : 1 - t;
      const S b = turns ? sine(t * e.omega) / e.sineOfOmega : t;
      std::array<S, 4> q;
      for (std::size_t i = 0; i < 4; ++i) q[i] = a * e.q0[i] + b * e.q1[i];
      joint.R = e.stray * rotationOf(q);
      break;
    }
  }
  return e.fixed * joint;
}

template <class S>
Pose<S> Curve<S>::at(S t) const {
  Pose<S> X;
  for (const Element& e : elements_) X = X * (e.inverted ? poseOf(e, t).inverse() : poseOf(e, t));
  return X;
}

template <class S>
Vec<S> Curve<S>::axisAt(S t) const {
  Pose<S> X;
  for (const Element& e : elements_) {
    const Pose<S> own = poseOf(e, t);
    if (e.joint == Frame::Joint::revolute && e.turns)
      return e.inverted ? X.R * e.axis : (X * e.fixed).R * e.axis;
    if (e.joint == Frame::Joint::rotation && e.omega > 0) {
      // The vector part of q1·q0⁻¹, in the frame after `fixed`: w0 v1 − w1 v0 − v1 × v0.
      const Vec<S> v0(e.q0[0], e.q0[1], e.q0[2]), v1(e.q1[0], e.q1[1], e.q1[2]);
      const Vec<S> k = e.stray * unit(v1 * e.q0[3] - v0 * e.q1[3] - cross(v1, v0));
      return e.inverted ? (X * own.inverse()).R * (e.fixed.R * k) : (X * e.fixed).R * k;
    }
    X = X * (e.inverted ? own.inverse() : own);
  }
  return {1, 0, 0};
}

}  // namespace corridor::audit
