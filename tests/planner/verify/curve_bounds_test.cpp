// Compares the curve of a piece, and the bounds of this curve, with an independent oracle
// (curve_oracle.h).
#include <gtest/gtest.h>

#include "planner/verify/edge_curve.h"
#include "tests/planner/verify/curve_oracle.h"
#include "tests/support/support.h"

namespace corridor::verify {
namespace {

using test::Arm;
using test::CurveOracle;
using test::randomPiece;
using test::randomVec;

/// Tests random points of random arms, in one random segment of each depth: the placement equals
/// the oracle's, and no displacement exceeds its bound.
TEST(EdgeCurve, PiecesStayWithinTheirReach) {
  std::mt19937_64 random(test::testSeed(36));
  Real fullestSpeed = 0, fullestBend = 0;
  for (int i = 0; i < 90; ++i) {
    const Arm arm(random);
    const CurvePiece piece = randomPiece(arm, 1 + i % 9, random);
    const EdgeCurve curve(arm.tree, arm.space.coordinates(), piece);
    ASSERT_FALSE(curve.ambiguous() || curve.jumps());
    const CurveOracle oracle(arm.tree, piece);
    const std::size_t frame = i % 2 ? arm.tip : arm.side;
    const KinematicChain chain = chainOf(arm.tree, 0, frame);
    const Vec3 x = randomVec(random, 0.5);
    const auto image = [&](Real t) -> RealVec {
      return oracle.pose(frame, t) * RealVec(x.cast<Real>());
    };
    for (int depth = 0; depth < 6; ++depth) {
      const Real half = std::ldexp(0.5L, -depth);
      const int index = std::uniform_int_distribution<int>(0, (1 << depth) - 1)(random);
      const Real middle = half * static_cast<Real>(2 * index + 1);
      const Segment segment = curve.segmentOf(middle, half);
      EXPECT_EQ(segment.depth, std::min(depth, EdgeCurve::kSegmentDepth));
      EXPECT_EQ(segment.index, std::size_t(index) >> (depth - segment.depth));
      const Reach reach = curve.reach(chain, x.norm(), Configuration::Zero(10), segment);
      const FrameState state = curve.at(chain, middle);
      const RealVec centre = image(middle);
      EXPECT_LE((state.at.rotation * x.cast<Real>() + state.at.position - centre).norm(), 1e-16L);
      const RealVec velocity = state.linear + state.angular.cross(centre);
      for (const Real share : {-1.0L, -0.6L, 0.3L, 1.0L}) {
        const Real s = share * half;
        const RealVec moved = image(middle + s) - centre;
        EXPECT_LE(moved.norm(), reach.speed * std::abs(s) + 1e-16L);
        EXPECT_LE((moved - s * velocity).norm(), reach.bend * s * s / 2 + 1e-16L);
        fullestSpeed = std::max(fullestSpeed, moved.norm() / (reach.speed * std::abs(s)));
        fullestBend =
            std::max(fullestBend, (moved - s * velocity).norm() / (reach.bend * s * s / 2));
      }
    }
  }
  EXPECT_GT(fullestSpeed, 0.4);
  EXPECT_GT(fullestBend, 0.2);
}

/// For a single joint, the bounds of a segment are attained at the ends of the segment.
TEST(EdgeCurve, TheBoundsOfAPieceAreAttained) {
  KinematicTree tree;
  ConfigurationSpace space;
  space.add(Coordinate{});
  Frame slide;
  slide.joint = Frame::Joint::prismatic;
  slide.variable = 0;
  slide.multiplier = -3;
  const KinematicChain chain = chainOf(tree, 0, tree.add(slide));
  CurvePiece piece{Eigen::MatrixXd(1, 4), Configuration::Zero(1)};
  piece.coefficients << 0, 0, 0, 1;  // τ³
  const EdgeCurve curve(tree, space.coordinates(), piece);
  const Configuration none = Configuration::Zero(1);
  for (int depth = 0; depth <= EdgeCurve::kSegmentDepth; ++depth) {
    const Real width = std::ldexp(1.0L, -depth);
    for (std::size_t index = 0; index < std::size_t(1) << depth; ++index) {
      const Real end = width * static_cast<Real>(index + 1);
      const Reach reach = curve.reach(chain, 0, none, {depth, index});
      EXPECT_NEAR(static_cast<double>(reach.speed), static_cast<double>(9 * end * end), 1e-12);
      EXPECT_NEAR(static_cast<double>(reach.bend), static_cast<double>(18 * end), 1e-12);
      EXPECT_GE(reach.speed, 9 * end * end);
      EXPECT_GE(reach.bend, 18 * end);
    }
  }
}

}  // namespace
}  // namespace corridor::verify
