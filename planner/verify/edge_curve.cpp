#include "planner/verify/edge_curve.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor::verify {
namespace {

constexpr Real kPi = std::numbers::pi_v<Real>;
constexpr Real kAmbiguous = 1e-9L;  // radians; as in ConfigurationSpace::ambiguous()

RealMat rotationOf(const Eigen::Matrix<Real, 4, 1>& q) {
  const Real x = q[0], y = q[1], z = q[2], w = q[3], k = 2 / q.squaredNorm();
  RealMat R;
  R << 1 - k * (y * y + z * z), k * (x * y - w * z), k * (x * z + w * y), k * (x * y + w * z),
      1 - k * (x * x + z * z), k * (y * z - w * x), k * (x * z - w * y), k * (y * z + w * x),
      1 - k * (x * x + y * y);
  return R;
}

RealMat turnBy(const RealVec& axis, Real angle) {
  RealMat K;
  K << 0, -axis[2], axis[1], axis[2], 0, -axis[0], -axis[1], axis[0], 0;
  return RealMat::Identity() + std::sin(angle) * K + (1 - std::cos(angle)) * (K * K);
}

RealVec axisOf(const Frame& frame) {
  return frame.axis.cast<Real>().normalized();
}

/// Returns whether the circle moves the frame, and a full turn of the circle leaves the frame in
/// another pose.
bool leavesCircle(const Frame& frame, const Coordinate& circle) {
  if (frame.joint == Frame::Joint::none || frame.variable != circle.first) return false;
  return frame.joint != Frame::Joint::revolute || frame.multiplier != std::trunc(frame.multiplier);
}

}  // namespace

KinematicChain chainOf(const KinematicTree& tree, std::size_t base, std::size_t frame) {
  KinematicChain chain{base, frame, {}};
  for (std::size_t f = frame; f != base; f = tree.frames[f].parent) chain.path.push_back(f);
  std::reverse(chain.path.begin(), chain.path.end());
  return chain;
}

std::size_t commonAncestor(const KinematicTree& tree, std::size_t a, std::size_t b) {
  while (a != b) {  // parents come before their children
    std::size_t& later = a > b ? a : b;
    later = tree.frames[later].parent;
  }
  return a;
}

Real circleDifference(double from, double to) {
  const Real way = Real(to) - Real(from);
  if (std::abs(way) <= kPi) return way;
  const Real s0 = std::sin(Real(from)), c0 = std::cos(Real(from));
  const Real s1 = std::sin(Real(to)), c1 = std::cos(Real(to));
  return std::atan2(s1 * c0 - c1 * s0, c1 * c0 + s1 * s0);
}

EdgeCurve::EdgeCurve(const KinematicTree& tree, const std::vector<Coordinate>& coordinates,
                     const Configuration& from, const Configuration& to)
    : tree_(tree),
      coordinates_(coordinates),
      numbers_(static_cast<std::size_t>(from.size())),
      bounds_(numbers_.size()),
      arcAt_(numbers_.size(), 0) {
  for (const Coordinate& c : coordinates) {
    if (c.kind == Coordinate::Kind::rotation) {
      addRotation(c.first, from, to);
      continue;
    }
    const auto i = static_cast<Eigen::Index>(c.first);
    const bool circle = c.kind == Coordinate::Kind::circle;
    const Real way = circle ? circleDifference(from[i], to[i]) : Real(to[i]) - Real(from[i]);
    // `way` is off by u·|way|, or by 32u for a circle. Each product and each sum is off by u times
    // the absolute value of its result.
    Number& number = numbers_[c.first];
    number.from = from[i];
    number.way = way;
    number.terms = std::abs(Real(from[i])) + std::abs(way) + (circle ? 4 : 0);
    boundsOf(c.first, {}) = {number.terms, std::abs(way), 0, number.terms};
    if (!circle) continue;
    ambiguous_ |= kPi - std::abs(way) <= kAmbiguous;
    const bool wraps = std::abs(Real(to[i]) - Real(from[i])) > kPi;
    jumps_ |= wraps && std::any_of(tree.frames.begin(), tree.frames.end(),
                                   [&](const Frame& f) { return leavesCircle(f, c); });
  }
}

EdgeCurve::EdgeCurve(const KinematicTree& tree, const std::vector<Coordinate>& coordinates,
                     const CurvePiece& piece)
    : tree_(tree),
      coordinates_(coordinates),
      isPiece_(true),
      numbers_(static_cast<std::size_t>(piece.coefficients.rows())),
      bounds_(numbers_.size() * ((std::size_t(2) << kSegmentDepth) - 1)),
      arcAt_(numbers_.size(), 0) {
  for (const Coordinate& c : coordinates) {
    if (c.kind == Coordinate::Kind::rotation) {
      addRotation(c.first, piece.coefficients.col(0),
                  piece.coefficients.col(piece.coefficients.cols() - 1));
      continue;
    }
    const Configuration row = piece.coefficients.row(static_cast<Eigen::Index>(c.first));
    Number& number = numbers_[c.first];
    number.polynomial = Bernstein({row.data(), static_cast<std::size_t>(row.size())});
    number.derivative = derivativeOf(number.polynomial);
    number.terms = 3 * number.polynomial.largest();
    addSegments(c.first, number.polynomial, number.derivative, derivativeOf(number.derivative), {});
  }
}

void EdgeCurve::addRotation(std::size_t first, const Configuration& from, const Configuration& to) {
  const auto i = static_cast<Eigen::Index>(first);
  Arc arc;
  arc.q0 = from.segment<4>(i).cast<Real>().normalized();
  arc.q1 = to.segment<4>(i).cast<Real>().normalized();
  if (arc.q0.dot(arc.q1) < 0) arc.q1 = -arc.q1;
  arc.omega = 2 * std::atan2((arc.q1 - arc.q0).norm(), (arc.q1 + arc.q0).norm());
  ambiguous_ |= kPi - 2 * arc.omega <= kAmbiguous;
  // The vector part of q1·q0⁻¹ is w0 v1 − w1 v0 − v1 × v0.
  const RealVec v0 = arc.q0.head<3>(), v1 = arc.q1.head<3>();
  const RealVec v = arc.q0[3] * v1 - arc.q1[3] * v0 - v1.cross(v0);
  const Real length = v.norm();
  if (arc.omega > 0 && length > 0) arc.turn = v * (2 * arc.omega / length);
  arcAt_[first] = arcs_.size();
  arcs_.push_back(arc);
}

/// Sets the bounds of a number in a segment and in all segments within it. The polynomials are
/// those of the segment, reparametrised to [0, 1]; the values of `rate` and `bend` are derivatives
/// by t.
void EdgeCurve::addSegments(std::size_t number, const Bernstein& value, const Bernstein& rate,
                            const Bernstein& bend, const Segment& segment) {
  boundsOf(number, segment) = {value.largest(), rate.largest(), bend.largest(),
                               numbers_[number].terms};
  if (segment.depth == kSegmentDepth) return;
  const auto values = verify::halvesOf(value), rates = verify::halvesOf(rate),
             bends = verify::halvesOf(bend);
  for (std::size_t i = 0; i < 2; ++i)
    addSegments(number, values[i], rates[i], bends[i], {segment.depth + 1, 2 * segment.index + i});
}

EdgeCurve::Bounds& EdgeCurve::boundsOf(std::size_t number, const Segment& segment) {
  const std::size_t place = (std::size_t(1) << segment.depth) - 1 + segment.index;
  return bounds_[place * numbers_.size() + number];
}

const EdgeCurve::Bounds& EdgeCurve::boundsOf(std::size_t number, const Segment& segment) const {
  return const_cast<EdgeCurve&>(*this).boundsOf(number, segment);
}

Segment EdgeCurve::segmentOf(Real middle, Real half) const {
  if (!isPiece_ || half == 0) return {};
  // The interval is one of those that halving makes: its width is 2^-k.
  const int depth = std::clamp(-std::ilogb(half) - 1, 0, kSegmentDepth);
  return {depth, static_cast<std::size_t>(std::ldexp(middle - half, depth))};
}

const EdgeCurve::Arc& EdgeCurve::arcOf(const Frame& frame) const {
  return arcs_[arcAt_[frame.variable]];
}

RealMat EdgeCurve::arcAt(const Arc& arc, Real t) const {
  const Real sine = std::sin(arc.omega);
  const Real w0 = sine > 0 ? std::sin((1 - t) * arc.omega) / sine : 1 - t;
  const Real w1 = sine > 0 ? std::sin(t * arc.omega) / sine : t;
  return rotationOf(w0 * arc.q0 + w1 * arc.q1);
}

Real EdgeCurve::numberAt(std::size_t number, Real t) const {
  const Number& of = numbers_[number];
  return isPiece_ ? of.polynomial.at(t) : of.from + t * of.way;
}

Real EdgeCurve::rateAt(std::size_t number, Real t) const {
  const Number& of = numbers_[number];
  return isPiece_ ? of.derivative.at(t) : of.way;
}

Real EdgeCurve::valueAt(const Frame& frame, Real t) const {
  const Real offset = frame.offset, multiplier = frame.multiplier;
  if (frame.variable == Frame::noVariable) return offset;
  const Number& of = numbers_[frame.variable];
  if (isPiece_) return multiplier * of.polynomial.at(t) + offset;
  return multiplier * of.from + offset + t * (multiplier * of.way);
}

Real EdgeCurve::rateAt(const Frame& frame, Real t) const {
  if (frame.variable == Frame::noVariable) return 0;
  return Real(frame.multiplier) * rateAt(frame.variable, t);
}

EdgeCurve::Bounds EdgeCurve::boundsOf(const Frame& frame, const Segment& segment) const {
  const Real offset = std::abs(Real(frame.offset)), times = std::abs(Real(frame.multiplier));
  if (frame.variable == Frame::noVariable) return {offset, 0, 0, offset};
  const Bounds& of = boundsOf(frame.variable, segment);
  return {times * of.value + offset, times * of.rate, times * of.bend, times * of.terms + offset};
}

template <class See>
Placement EdgeCurve::walk(const KinematicChain& chain, Real t, const See& see) const {
  Placement at;
  for (const std::size_t f : chain.path) {
    const Frame& frame = tree_.frames[f];
    at.position += at.rotation * frame.fixed.p.cast<Real>();
    at.rotation = at.rotation * rotationOf(frame.fixed.q.coeffs().cast<Real>());
    see(frame, at);
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute:
        at.rotation = at.rotation * turnBy(axisOf(frame), valueAt(frame, t));
        break;
      case Frame::Joint::prismatic:
        at.position += valueAt(frame, t) * (at.rotation * axisOf(frame));
        break;
      case Frame::Joint::translation: {
        RealVec shift = RealVec::Zero();
        for (std::size_t k = 0; k < frame.count; ++k)
          shift[static_cast<Eigen::Index>(k)] = numberAt(frame.variable + k, t);
        at.position += at.rotation * shift;
        break;
      }
      case Frame::Joint::rotation:
        at.rotation = at.rotation * arcAt(arcOf(frame), t);
        break;
    }
  }
  return at;
}

FrameState EdgeCurve::at(const KinematicChain& chain, Real t) const {
  FrameState state;
  const auto turns = [&](const RealVec& vector, const Placement& at) {
    state.angular += vector;
    state.linear -= vector.cross(at.position);
  };
  state.at = walk(chain, t, [&](const Frame& frame, const Placement& at) {
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute:
        turns(rateAt(frame, t) * (at.rotation * axisOf(frame)), at);
        break;
      case Frame::Joint::prismatic:
        state.linear += rateAt(frame, t) * (at.rotation * axisOf(frame));
        break;
      case Frame::Joint::translation:
        for (std::size_t k = 0; k < frame.count; ++k)
          state.linear +=
              rateAt(frame.variable + k, t) * at.rotation.col(static_cast<Eigen::Index>(k));
        break;
      case Frame::Joint::rotation:
        turns(at.rotation * arcOf(frame).turn, at);
        break;
    }
  });
  return state;
}

Perturbation EdgeCurve::perturbationAt(const KinematicChain& chain, Real t,
                                       const Configuration& tube) const {
  Perturbation perturbation;
  const auto twist = [&](std::size_t number, const RealVec& linear, const RealVec& angular) {
    const Real stray = tube[static_cast<Eigen::Index>(number)];
    auto at =
        std::find_if(perturbation.twists.begin(), perturbation.twists.end(),
                     [&](const Perturbation::Twist& other) { return other.number == number; });
    if (at == perturbation.twists.end())
      at = perturbation.twists.insert(at, {RealVec::Zero(), RealVec::Zero(), number});
    at->linear += stray * linear;
    at->angular += stray * angular;
  };
  walk(chain, t, [&](const Frame& frame, const Placement& at) {
    if (frame.variable == Frame::noVariable) return;
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute: {
        const RealVec axis = Real(frame.multiplier) * (at.rotation * axisOf(frame));
        twist(frame.variable, -axis.cross(at.position), axis);
        break;
      }
      case Frame::Joint::prismatic:
        twist(frame.variable, Real(frame.multiplier) * (at.rotation * axisOf(frame)),
              RealVec::Zero());
        break;
      case Frame::Joint::translation:
        for (std::size_t k = 0; k < frame.count; ++k)
          twist(frame.variable + k, at.rotation.col(static_cast<Eigen::Index>(k)), RealVec::Zero());
        break;
      case Frame::Joint::rotation:
        perturbation.pivots.push_back(
            {at.position, Real(tube[static_cast<Eigen::Index>(frame.variable)])});
        break;
    }
  });
  return perturbation;
}

Configuration EdgeCurve::configuration(Real t) const {
  Configuration q(static_cast<Eigen::Index>(numbers_.size()));
  for (std::size_t i = 0; i < numbers_.size(); ++i)
    q[static_cast<Eigen::Index>(i)] = static_cast<double>(numberAt(i, t));
  for (const Coordinate& c : coordinates_) {
    if (c.kind != Coordinate::Kind::rotation) continue;
    const Arc& arc = arcs_[arcAt_[c.first]];
    const Real sine = std::sin(arc.omega);
    const Real w0 = sine > 0 ? std::sin((1 - t) * arc.omega) / sine : 1 - t;
    const Real w1 = sine > 0 ? std::sin(t * arc.omega) / sine : t;
    q.segment<4>(static_cast<Eigen::Index>(c.first)) =
        (w0 * arc.q0 + w1 * arc.q1).normalized().cast<double>();
  }
  return q;
}

Reach EdgeCurve::reach(const KinematicChain& chain, Real radius, const Configuration& tube,
                       const Segment& segment) const {
  Reach reach;
  // The loop goes from the frame back to the base. `length` is the length of the chain after the
  // current joint. Each revolute joint i adds to `bend` its term with itself, V_i² R_i, and its
  // terms with all joints j after it, 2 V_i D. Here D is `speed` so far: the sum of V_j R_j
  // (revolute) and V_j (prismatic). The same holds with τ instead of V.
  Real length = radius, manyTurns = 1;
  const auto turn = [&](Real rate, Real bend, Real stray) {
    reach.bend += rate * (rate * length + 2 * reach.speed) + bend * length;
    reach.bendCross += 2 * (rate * stray * length + rate * reach.tube + stray * reach.speed);
    reach.bendTube += stray * (stray * length + 2 * reach.tube);
    reach.speed += rate * length;
    reach.tube += stray * length;
  };
  const auto slide = [&](Real rate, Real bend, Real stray, Real longest) {
    reach.bend += bend;
    reach.speed += rate;
    reach.tube += stray;
    length += longest + stray;
  };
  const auto strayOf = [&](std::size_t number) {
    return Real(tube[static_cast<Eigen::Index>(number)]);
  };
  for (std::size_t k = chain.path.size(); k-- > 0;) {
    const Frame& frame = tree_.frames[chain.path[k]];
    const bool single =
        frame.joint == Frame::Joint::revolute || frame.joint == Frame::Joint::prismatic;
    const Bounds most = single ? boundsOf(frame, segment) : Bounds{};
    const Real strayOfJoint = single && frame.variable != Frame::noVariable
                                  ? std::abs(Real(frame.multiplier)) * strayOf(frame.variable)
                                  : 0;
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute:
        turn(most.rate, most.bend, strayOfJoint);
        manyTurns += 0x1p-11L * most.terms;
        break;
      case Frame::Joint::prismatic:
        slide(most.rate, most.bend, strayOfJoint, most.value);
        break;
      case Frame::Joint::translation: {
        Real rate = 0, bend = 0, stray = 0, longest = 0;
        for (std::size_t i = 0; i < frame.count; ++i) {
          const Bounds& each = boundsOf(frame.variable + i, segment);
          rate += each.rate * each.rate;
          bend += each.bend * each.bend;
          stray += strayOf(frame.variable + i) * strayOf(frame.variable + i);
          longest += each.value * each.value;
        }
        slide(std::sqrt(rate), std::sqrt(bend), std::sqrt(stray), std::sqrt(longest));
        break;
      }
      case Frame::Joint::rotation:
        turn(arcOf(frame).turn.norm(), 0, strayOf(frame.variable));
        break;
    }
    length += frame.fixed.p.cast<Real>().norm();
  }
  const Real frames = std::max<Real>(1, Real(chain.path.size()) / 54);
  reach.lengths = (length + reach.speed + reach.tube) * frames * kUp;
  reach.size = reach.lengths * manyTurns * kUp;
  reach.speed *= kUp;
  reach.bend *= kUp;
  reach.tube *= kUp;
  reach.bendCross *= kUp;
  reach.bendTube *= kUp;
  return reach;
}

}  // namespace corridor::verify
