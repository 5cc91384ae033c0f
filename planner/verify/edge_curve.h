#pragma once

#include <cstddef>
#include <vector>

#include "planner/robot/curve.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/verify/bernstein.h"

namespace corridor::verify {

/// The map x ↦ rotation·x + position. Its numbers are rounded; the caller bounds their error.
struct Placement {
  RealMat rotation = RealMat::Identity();
  RealVec position = RealVec::Zero();
};

/// The placement of a frame at a time t of an edge, and its velocity there. A point x, in the
/// coordinates of the base, has the velocity linear + angular × x per unit of t.
struct FrameState {
  Placement at;
  RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
};

/// The first-order perturbations of the points of a frame at one time, for all curves within the
/// tube. In the coordinates of the base, a curve displaces a point x by a sum of
/// - c·(linear + angular × x) for each twist, with any c in [−1, 1];
/// - w × (x − at) for each pivot rotation, with any vector w of length at most `angle`.
struct Perturbation {
  struct Twist {
    RealVec linear = RealVec::Zero(), angular = RealVec::Zero();
    /// Index of a number in a configuration. All joints that this number moves share one twist.
    std::size_t number = 0;
  };
  struct PivotRotation {
    RealVec at = RealVec::Zero();
    Real angle = 0;
  };
  std::vector<Twist> twists;
  std::vector<PivotRotation> pivots;
};

/// A kinematic chain: the joints after the frame `base`, up to and including the joint of `frame`.
struct KinematicChain {
  std::size_t base = 0, frame = 0;
  std::vector<std::size_t> path;  ///< the frames after `base`, in order; the last is `frame`
};

/// @pre `base` is `frame` or one of its ancestors.
KinematicChain chainOf(const KinematicTree& tree, std::size_t base, std::size_t frame);
std::size_t commonAncestor(const KinematicTree& tree, std::size_t a, std::size_t b);

/// Bounds on the motion of points of a frame, for all times of a segment of an edge or of a piece
/// of a curve. The points are at most `radius` from the frame's origin. The weights R_j are
/// constant (Schwarzer, Saha, Latombe 2005).
///
/// Let q_j be the value of joint j, V_j ≥ |q_j'| and A_j ≥ |q_j''| on the segment, with derivatives
/// by t. (The numbers of a translation are one joint, with the norms of its vectors.) Along an
/// edge, and in a slerp, V_j = |Δ_j| is the joint's whole displacement, and A_j = 0. For a
/// polynomial, V_j and A_j are the largest coefficients of its derivatives in Bernstein form, such
/// as V_j = n·max |d_(i+1) − d_i| for the whole piece. Let R_j be the length of the chain from
/// joint j to the frame, plus `radius`. Let P_j = Σ V_i over the revolute joints i before j. Then
///   |x'| ≤ speed = Σ_revolute V_j R_j + Σ_prismatic V_j,
///   |x''| ≤ bend = Σ_revolute V_j R_j (V_j + 2 P_j) + Σ_prismatic 2 V_j P_j
///                  + Σ_revolute A_j R_j + Σ_prismatic A_j.
/// The reason: x'' = Σ_ij q_i' q_j' ∂²x/∂q_i∂q_j + Σ_j q_j'' ∂x/∂q_j. The first sum is over ordered
/// pairs of joints. The term of a pair is the cross product of two vectors: the rotation vector of
/// the joint nearer to the base, and the other joint's share of x'. This share is not longer than
/// V_j R_j (revolute) or V_j (prismatic). A prismatic joint moves in a straight line, so its pair
/// with itself is zero. In the second sum, |∂x/∂q_j| is at most R_j (revolute) or 1 (prismatic). A
/// perturbation of each number within its tube moves x by at most
///   tube = Σ_revolute τ_j R_j + Σ_prismatic τ_j.
///
/// Second order with perturbations. Let joint j deviate by δ_j, |δ_j| ≤ τ_j, from its value at a
/// time t + s of the segment. Then the joint is a_j = q_j(t + s) − q_j(t) + δ_j away from its value
/// at t, and |a_j| ≤ |s| V_j + τ_j. Let all joints move linearly from their values at t to these
/// values. This is a motion like an edge, with |a_j| instead of |Δ_j|. (The perturbation of a free
/// rotation is a rotation by at most τ about any axis, after the rotation of the slerp. Two
/// successive rotations about one point have the same R. They are bounded like one rotation by the
/// sum of their angles.) So x differs from x(t) + Σ a_j ∂x/∂q_j(t) by at most half of the first
/// line of `bend`, computed with |s| V_j + τ_j. This first line is a quadratic form in the V_j.
/// Moreover, |q_j(t + s) − q_j(t) − s q_j'(t)| ≤ s² A_j / 2. So Σ a_j ∂x/∂q_j(t) differs from s
/// x'(t) + Σ δ_j ∂x/∂q_j(t) by at most half of s² times the second line. Hence
///   |x − x(t) − s x'(t) − Σ δ_j ∂x/∂q_j(t)| ≤ (s² bend + |s| bendCross + bendTube) / 2.
///
/// R_j assumes a range of joint values. During this linear motion, too, all joints stay within this
/// range: the range is convex, and includes τ_j.
struct Reach {
  Real speed = 0, bend = 0, tube = 0;
  Real bendCross = 0;  ///< the mixed terms of V and τ in the quadratic form
  Real bendTube = 0;   ///< the quadratic form with τ instead of V
  Real size = 0;       ///< upper bound of all lengths in the pose; rounding is below 2^-50 of it
  Real lengths = 0;    ///< `size` before it is increased for large angles
};

/// Returns the difference to − from along the shorter way round a circle, radians, in [−π, π]: the
/// real value of to − from, minus whole turns. The result is off by at most 32u, u = 2^-64, for
/// angles of any size.
///
/// Error: if |to − from| ≤ π, the difference is rounded by at most πu. Otherwise the sines and
/// cosines of both angles are off by at most 2u, because the C library reduces its arguments with
/// enough digits of π. The sine and the cosine of the difference are off by at most 11u. The arc
/// tangent computed from them is off by at most 11√2·u + 2πu.
Real circleDifference(double from, double to);

/// A time interval of an edge or a piece: [index, index + 1] / 2^depth.
struct Segment {
  int depth = 0;
  std::size_t index = 0;
};

/// The curve of an edge, as ConfigurationSpace defines it, in the verifier's own arithmetic. There
/// are three kinds of coordinates. Lines (bounded numbers) are linear in t. Circles (angles without
/// bounds) go the shorter way round. Rotations (quaternions) are the slerp along the shorter arc,
/// with the quaternions normalised in real arithmetic. Frames follow by forward kinematics on the
/// tree's stored doubles, with quaternions and axes normalised.
///
/// The object may also be the curve of a CurvePiece, as CurvePiece defines it, with t = τ. The
/// bounds are then computed for each segment of the piece: for wavy pieces, bounds of the whole
/// piece would be too large.
///
/// Rounding, with u = 2^-64, and t of at most 63 bits:
/// - Normalised quaternions are off by ≤ 5u each, their slerp by < 128u, the rotation by < 256u.
///   (The angle Ω = 2 atan2(|q1 − q0|, |q1 + q0|) is off by ≤ 32u. The weights of the slerp are off
///   by ≤ 0.6 times this error plus 8u.)
/// - A revolute joint with the multiplier m and the offset o has the value m·q0 + o + t·m·Δ. It is
///   off by ≤ 8u times `Number::terms` (products, sums and the rounding of Δ). Sine, cosine and
///   Rodrigues' matrix are off by < 16u. The value of a polynomial with coefficients ≤ M is off by
///   < 19u·M (Bernstein::at), and m·q + o by < 21u·|m|·M + u·|o|. So `terms` = 3M covers m·q + o. A
///   prismatic joint is off by < 21u times its length.
/// - The derivative of a polynomial is off by < 21u times the V_j of the whole piece (rounding of
///   the differences, and of Bernstein::at). This displaces no point by more than 21u·speed.
/// - Each frame multiplies two such matrices into the rotation, which adds 10u. In all, a frame
///   with a free rotation adds < 300u, and any other frame < 40u.
/// - With n frames a point is off by ≤ n·300u times the length of the chain. This is below
///   2^14·u·size = 2^-50·size for n ≤ 54. For larger n, `Reach::size` is increased in proportion to
///   n. `Reach::size` is also increased for large `Number::terms` of angles.
class EdgeCurve {
 public:
  /// Pieces are cut into segments of this depth, and their bounds are computed for each.
  static constexpr int kSegmentDepth = 3;

  EdgeCurve(const KinematicTree& tree, const std::vector<Coordinate>& coordinates,
            const Configuration& from, const Configuration& to);
  /// @pre the piece's coefficients are finite, and their rows and degree are valid. The first and
  /// the last column of a rotation are not 0.
  EdgeCurve(const KinematicTree& tree, const std::vector<Coordinate>& coordinates,
            const CurvePiece& piece);

  /// Returns whether a rotation, or a circle of an edge, makes a half turn, within 1e-9 rad. The
  /// shorter way round is then not defined, so the edge or piece defines no curve.
  bool ambiguous() const { return ambiguous_; }
  /// Returns whether a joint would jump. The edge then defines no curve. A joint jumps if two
  /// conditions hold: it mimics a circle whose two stored angles differ by more than half a turn,
  /// so that the shorter way ends full turns away from the second angle; and a full turn of this
  /// circle leaves the joint in another pose. Such a joint is prismatic, or revolute with a
  /// multiplier that is not a whole number.
  bool jumps() const { return jumps_; }
  FrameState at(const KinematicChain& chain, Real t) const;
  Perturbation perturbationAt(const KinematicChain& chain, Real t, const Configuration& tube) const;
  Configuration configuration(Real t) const;  ///< rounded
  /// Returns the smallest segment with bounds of its own that contains [middle − half, middle +
  /// half]. @pre the ends of this interval are multiples of 2·half, or half = 0.
  Segment segmentOf(Real middle, Real half) const;
  Reach reach(const KinematicChain& chain, Real radius, const Configuration& tube,
              const Segment& segment = {}) const;

 private:
  /// The value of a number of the configuration: from + t·way, or the polynomial.
  struct Number {
    Real from = 0, way = 0;
    Real terms = 0;                    ///< 8u·terms bounds the rounding of the value
    Bernstein polynomial, derivative;  ///< for a piece: the value, and its derivative by t
  };
  /// Bounds of a number of the configuration, or of a joint's value, in one segment.
  struct Bounds {
    Real value = 0, rate = 0, bend = 0;  ///< of |value|, |1st derivative|, |2nd derivative|
    Real terms = 0;                      ///< see Number::terms
  };
  struct Arc {
    Eigen::Matrix<Real, 4, 1> q0, q1;  // x, y, z, w
    Real omega = 0;                    // angle between the vectors q0 and q1, rad
    RealVec turn = RealVec::Zero();    // rotation vector of the whole arc, in the joint's frame
  };
  /// Computes the placement of the chain's last frame at t. Calls see(frame, X) for every joint,
  /// where X is the placement before the joint.
  template <class See>
  Placement walk(const KinematicChain& chain, Real t, const See& see) const;
  void addRotation(std::size_t first, const Configuration& from, const Configuration& to);
  void addSegments(std::size_t number, const Bernstein& value, const Bernstein& rate,
                   const Bernstein& bend, const Segment& segment);
  const Arc& arcOf(const Frame& frame) const;
  RealMat arcAt(const Arc& arc, Real t) const;
  Real numberAt(std::size_t number, Real t) const;
  Real rateAt(std::size_t number, Real t) const;
  /// The value and the derivative of a revolute or prismatic joint.
  Real valueAt(const Frame& frame, Real t) const;
  Real rateAt(const Frame& frame, Real t) const;
  Bounds& boundsOf(std::size_t number, const Segment& segment);
  const Bounds& boundsOf(std::size_t number, const Segment& segment) const;
  Bounds boundsOf(const Frame& frame, const Segment& segment) const;

  const KinematicTree& tree_;
  const std::vector<Coordinate>& coordinates_;
  bool isPiece_ = false;
  std::vector<Number> numbers_;     // one per number of a configuration
  std::vector<Bounds> bounds_;      // [segment][number], the longest segments first
  std::vector<Arc> arcs_;           // one per rotation
  std::vector<std::size_t> arcAt_;  // index in arcs_, by the rotation's first number
  bool ambiguous_ = false, jumps_ = false;
};

}  // namespace corridor::verify
