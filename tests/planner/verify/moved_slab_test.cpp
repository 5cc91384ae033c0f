// Compares the slab between two moving bodies with the motions and perturbations that it bounds.
#include "planner/verify/moved_slab.h"

#include <gtest/gtest.h>

#include "tests/planner/verify/random_arm.h"
#include "tests/support/support.h"

namespace corridor::verify {
namespace {

using test::Arm;
using test::placementOf;
using test::randomPose;
using test::randomSet;
using test::randomVec;

constexpr Real kInfinity = std::numeric_limits<Real>::infinity();

ConvexSet moved(const ConvexSet& set, const Placement& by) {
  ConvexSet image = set;
  for (RealVec& x : image.points) x = by.rotation * x + by.position;
  image.axis = by.rotation * set.axis;
  return image;
}

Real gapAlong(const ConvexSet& a, const ConvexSet& b, const RealVec& n) {
  return n.dot(b.farthest(-n)) - b.sweptRadius() - n.dot(a.farthest(n)) - a.sweptRadius();
}

/// Returns the largest distance from the origin of any point of the set, including the set's
/// radius.
Real radiusOf(const ConvexSet& set) {
  Real radius = 0;
  for (const RealVec& x : set.points) radius = std::max(radius, x.norm());
  return radius + set.radius;
}

/// Two bodies on an arm, in a time interval of an edge or a piece with a tube, and the slab between
/// them along `n`.
struct Case {
  const Arm& arm;
  KinematicChain chainA, chainB;
  ConvexSet a, b;  // each in the frame of its own body
  Configuration from, to, tube;
  Real middle, half;
  std::optional<EdgeCurve> curve;
  PairMotion motion;
  Placement atA;                   // placement of a at the middle
  RealVec n;                       // unit, in a's frame at the middle
  RealVec spin = RealVec::Zero();  // angular velocity of n

  /// @param degree the degree of a polynomial piece; 0: the motion is an edge.
  Case(const Arm& onArm, bool fork, std::mt19937_64& random, double size, int kinds, int degree = 0)
      : arm(onArm),
        chainA(chainOf(arm.tree, fork ? 3 : 0, fork ? arm.side : 0)),
        chainB(chainOf(arm.tree, fork ? 3 : 0, arm.tip)),
        a(randomSet(random, kinds % 5, Vec3::Zero())),
        b(randomSet(random, kinds / 5 % 5, randomVec(random, 0.3))),
        from(arm.random(random)),
        to(from),
        tube(Configuration::Zero(from.size())),
        middle(0.5L),
        half(0.5L) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const Configuration other = arm.random(random);
    to += size * (other - from);
    for (double& stray : tube) stray = 0.3 * size * uniform(random);
    if (degree == 0) {
      curve.emplace(arm.tree, arm.space.coordinates(), from, to);
      middle = static_cast<Real>(0.5 + 0.2 * uniform(random));
      half = static_cast<Real>(0.3 * uniform(random));
    } else {
      CurvePiece piece{Eigen::MatrixXd(from.size(), degree + 1), Configuration::Zero(from.size())};
      for (int k = 0; k <= degree; ++k) {
        piece.coefficients.col(k) = from + (to - from) * k / degree;
        if (k > 0 && k < degree) piece.coefficients.col(k) += size * arm.random(random);
      }
      curve.emplace(arm.tree, arm.space.coordinates(), piece);
      const int depth = std::uniform_int_distribution<int>(0, 4)(random);
      half = std::ldexp(0.5L, -depth);
      middle = half * static_cast<Real>(
                          2 * std::uniform_int_distribution<int>(0, (1 << depth) - 1)(random) + 1);
    }
    const FrameState stateA = curve->at(chainA, middle), stateB = curve->at(chainB, middle);
    atA = stateA.at;
    motion.half = half;
    motion.a = motionSeenFrom(atA, stateA, curve->perturbationAt(chainA, middle, tube));
    motion.b = motionSeenFrom(atA, stateB, curve->perturbationAt(chainB, middle, tube));
    for (const auto& [chain, set] : {std::pair{&chainA, &a}, std::pair{&chainB, &b}}) {
      const Reach reach =
          curve->reach(*chain, radiusOf(*set), tube, curve->segmentOf(middle, half));
      motion.motionBound += reach.speed * half;
      motion.tube += reach.tube;
      motion.secondOrder +=
          (half * half * reach.bend + half * reach.bendCross + reach.bendTube) / 2;
    }
    n = randomVec(random, 1).cast<Real>().normalized();
  }
  Case(const Case&) = delete;

  ConvexSet placedB() const {
    const Placement at = curve->at(chainB, middle).at;
    const RealMat back = atA.rotation.transpose();
    return moved(b, {back * at.rotation, back * (at.position - atA.position)});
  }
  Real firstOrder() const {
    return MovedSlab(motion.a, motion.b, half, n, spin, motion.motionBound + motion.tube)
        .width(a, placedB());
  }
  Real still() const { return gapAlong(a, placedB(), n); }

  /// Returns the width along n, at the time middle + s, of a perturbed curve. `share`, in [−1, 1]
  /// for each component, is the perturbation divided by the tube's half width. `turn` is a rotation
  /// that is applied after the free rotation (in the base's coordinates; base 0 only).
  Real widthAt(Real s, const Configuration& share, const RealVec& turn) const {
    Configuration q = curve->configuration(middle + s);
    const Eigen::Quaterniond rotation(q[6], q[3], q[4], q[5]);
    q += share.cwiseProduct(tube);
    q.segment<4>(3) = rotation.coeffs();
    if (turn.norm() > 0) {
      // `turn` is converted from the base's coordinates to the joint's. The translation's frame and
      // the joint's own fixed frame come before the joint.
      const RealMat before = curve->at(chainOf(arm.tree, 0, 1), middle).at.rotation *
                             placementOf(arm.tree.frames[2].fixed).rotation;
      const Eigen::Vector3d w = (before.transpose() * turn).cast<double>();
      const Eigen::Quaterniond by(Eigen::AngleAxisd(w.norm(), w.normalized()));
      q.segment<4>(3) = (by * rotation).coeffs();
    }
    const EdgeCurve stray(arm.tree, arm.space.coordinates(), q, q);
    const RealVec along = atA.rotation * (n + s * spin.cross(n)).normalized();
    return gapAlong(moved(a, stray.at(chainA, 0).at), moved(b, stray.at(chainB, 0).at), along);
  }

  /// Returns the least width over many curves in the tube: all corners of the tube's box at both
  /// ends of the interval, rotations about the worst axis for each corner of b, and some curves
  /// inside the tube.
  Real leastWidth(std::mt19937_64& random) const {
    const Eigen::Index numbers[] = {0, 1, 2, 7, 8, 9};
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<RealVec> turns = {RealVec::Zero()};
    if (!motion.b.perturbation.pivots.empty()) {
      const Perturbation::PivotRotation& pivot = motion.b.perturbation.pivots[0];
      for (const RealVec& x : placedB().points)
        turns.push_back(atA.rotation * ((x - pivot.at).cross(-n).normalized() * pivot.angle));
    }
    Real least = kInfinity;
    for (unsigned corner = 0; corner < 64; ++corner) {
      Configuration share = Configuration::Zero(tube.size());
      for (unsigned k = 0; k < 6; ++k) share[numbers[k]] = corner >> k & 1u ? 1 : -1;
      for (const RealVec& turn : turns)
        for (const Real s : {-half, half}) least = std::min(least, widthAt(s, share, turn));
      for (double& part : share) part = uniform(random);
      const RealVec turn = turns.back() * static_cast<Real>(uniform(random));
      least = std::min(least, widthAt(half * static_cast<Real>(uniform(random)), share, turn));
    }
    return least;
  }
};

TEST(MovedSlab, BoundsAllCurvesOfTheTube) {
  std::mt19937_64 random(test::testSeed(8));
  const int cases = test::isStressRun() ? 3000 : 200;
  Real fullest = 0;
  for (int i = 0; i < cases; ++i) {
    const Arm arm(random);
    const double size = i % 3 == 0 ? 1 : i % 3 == 1 ? 0.1 : 0.001;
    const Case one(arm, i % 2 == 1, random, size, i / 2, i % 4 < 2 ? 0 : 1 + i / 4 % 9);
    const Real bound = one.firstOrder() - one.motion.secondOrder, least = one.leastWidth(random);
    EXPECT_GE(least, bound - 1e-13L) << i;
    fullest = std::max(fullest, (one.still() - least) / (one.still() - bound));
  }
  EXPECT_GT(fullest, 0.999L);
}

/// The slab also bounds the width of all curves in the tube if its direction turns: with a body, or
/// at a random angular velocity.
TEST(MovedSlab, DirectionsMayTurn) {
  std::mt19937_64 random(test::testSeed(11));
  const int cases = test::isStressRun() ? 3000 : 200;
  int bounded = 0;
  for (int i = 0; i < cases; ++i) {
    const Arm arm(random);
    const double size = i % 3 == 0 ? 0.2 : i % 3 == 1 ? 0.05 : 0.001;
    Case one(arm, i % 2 == 1, random, size, i / 2, i % 4 < 2 ? 0 : 1 + i / 4 % 9);
    const Real rate = one.motion.b.angular.norm();
    one.spin = i % 5 < 2   ? one.motion.b.angular
               : i % 5 < 4 ? RealVec(randomVec(random, 1).cast<Real>() * rate)
                           : one.motion.a.angular;
    const Real bound = one.firstOrder() - one.motion.secondOrder;
    bounded += std::isfinite(bound);
    EXPECT_GE(one.leastWidth(random), bound - 1e-13L) << i;
  }
  EXPECT_GT(bounded, cases / 2);
}

/// A bar turns about the centre of a ball, at a constant distance. Its ends cross every slab of a
/// fixed direction.
TEST(MovedSlab, ABarThatTurnsAboutABall) {
  const ConvexSet bar{{RealVec(-1, 0.5L, 0), RealVec(1, 0.5L, 0)}, 0.1L, false, RealVec::Zero()},
      ball{{RealVec::Zero()}, 0.375L, false, RealVec::Zero()};
  const BodyMotion turning{RealVec::Zero(), RealVec(0, 0, 1), {}};
  const Real half = 0.01L, gap = 0.025L, across = half * std::sqrt(1.25L);
  const auto width = [&](const RealVec& turn) {
    return MovedSlab({}, turning, half, RealVec::UnitY(), turn, across).width(ball, bar);
  };
  EXPECT_NEAR(static_cast<double>(width(RealVec::Zero())), double(gap - half), 1e-15);
  // half·|m|·displacement, and (half·|m|)²/2 of the distance of the cores
  const Real lost = half * across, shorter = half * half / 2;
  EXPECT_NEAR(static_cast<double>(width(turning.angular)),
              double(gap - lost - shorter * (0.5L - lost)), 1e-15);
  EXPECT_EQ(MovedSlab({}, turning, 0.2L, RealVec::UnitY(), turning.angular, 1).width(ball, bar),
            -kInfinity);
}

// If motion and tube are small, the first-order term of the bound dominates, and some curve attains
// the bound.
TEST(MovedSlab, IsAttained) {
  std::mt19937_64 random(test::testSeed(9));
  Real worst = kInfinity, gained = 0;
  int cases = 0;
  const int count = test::casesOf(90, 150);
  for (int i = 0; i < count; ++i) {
    const Arm arm(random);
    for (const int kind : {0, 1, 3, 4}) {  // no cylinders: the bound for a disc is not attained
      const Case one(arm, i % 2 == 1, random, 1e-6, kind + 5 * kind);
      const Real lost = one.still() - one.firstOrder() + one.motion.secondOrder;
      worst = std::min(worst, (one.still() - one.leastWidth(random)) / lost);
      gained += lost / (one.motion.motionBound + one.motion.tube);
      ++cases;
    }
  }
  EXPECT_GT(worst, 0.999L);
  EXPECT_LT(gained / cases, 0.35L);  // relative to the isotropic bound
}

// A point rotates about z, and an obstacle is between the point and the axis. The point approaches
// the obstacle in second order only, by 1 − cos(h|Δ| + τ). So the second-order term must be that of
// the sum of motion and perturbation, not the sum of their two terms.
TEST(MovedSlab, SecondOrderIsThatOfMotionPlusPerturbation) {
  KinematicTree tree;
  ConfigurationSpace space;
  Frame turn;
  turn.joint = Frame::Joint::revolute;
  turn.variable = space.coordinates()[space.add(Coordinate{})].first;
  const KinematicChain chain = chainOf(tree, 0, tree.add(turn));
  const ConvexSet a{{RealVec(0.5L, 0, 0)}, 0, false, RealVec::Zero()},
      b{{RealVec(1, 0, 0)}, 0, false, RealVec::Zero()};
  for (const double way : {0.0, 0.02, 0.05, 0.2})
    for (const double stray : {0.0, 0.01, 0.05}) {
      const Configuration from = Configuration::Constant(1, -way), to = -from,
                          tube = Configuration::Constant(1, stray);
      const EdgeCurve curve(tree, space.coordinates(), from, to);
      const BodyMotion moving =
          motionSeenFrom({}, curve.at(chain, 0.5L), curve.perturbationAt(chain, 0.5L, tube));
      const Reach reach = curve.reach(chain, 1, tube);
      const Real bound = MovedSlab({}, moving, 0.5L, RealVec::UnitX()).width(a, b) -
                         (0.25L * reach.bend + 0.5L * reach.bendCross + reach.bendTube) / 2;
      const Real all = way + stray, least = std::cos(all) - 0.5L;
      EXPECT_LE(bound, least + 1e-15L) << way << " " << stray;
      EXPECT_GE(bound, least - all * all * all * all / 24 - 1e-12L) << way << " " << stray;
    }
}

TEST(MovedSlab, BoxesHoldWhatIsInThem) {
  std::mt19937_64 random(test::testSeed(10));
  for (int i = 0; i < 500; ++i) {
    const Arm arm(random);
    const Case one(arm, i % 2 == 1, random, 0.1, i / 2);
    const auto boxOf = [](const ConvexSet& set) {
      RealVec lower = set.points[0], upper = set.points[0];
      for (const RealVec& x : set.points) lower = lower.cwiseMin(x), upper = upper.cwiseMax(x);
      const RealVec more = RealVec::Constant(set.radius);
      return CentredBox{(lower + upper) / 2, (upper - lower) / 2 + more};
    };
    const MovedSlab slab(one.motion.a, one.motion.b, one.half, one.n);
    EXPECT_LE(slab.width(boxOf(one.a), boxOf(one.placedB())), one.firstOrder() + 1e-15L) << i;
  }
  EXPECT_EQ(MovedSlab({}, {}, 1, RealVec::Zero()).width(CentredBox{}, CentredBox{}), -kInfinity);
}

}  // namespace
}  // namespace corridor::verify
