#include "collision/motion/rigid_motion.h"

#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include "tests/support/reference_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::ReferenceMotion;

class Cases {
 public:
  explicit Cases(std::uint64_t seed) : random_(seed) {}
  double real(double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  Vec3 vector(double size = 1) { return size * Vec3(real(), real(), real()); }
  Eigen::Quaterniond orientation() {
    return Eigen::Quaterniond(real(), real(), real(), real()).normalized();
  }
  /// Returns a pair of poses. Their rotations differ by angles of every size: some are nearly
  /// equal, some differ by nearly a half turn.
  std::pair<RigidPose, RigidPose> edge() {
    RigidPose a{vector(10), orientation()}, b{vector(10), {}};
    const double angles[] = {0,    1e-300, 1e-17, 1e-12, 5e-5, 8.9e-5,
                             9e-5, 1e-3,   0.3,   1.5,   3,    std::numbers::pi - 1e-8};
    const double angle = n_ % 3 ? angles[n_ % std::size(angles)] : real(0, 3.1);
    b.q = Eigen::Quaterniond(Eigen::AngleAxisd(angle, vector().normalized())) * a.q;
    if (n_ % 5 == 0) b.q.coeffs() *= -3e150;  // the same orientation
    if (n_ % 7 == 0) a.q.coeffs() *= 1e-160;
    ++n_;
    return {a, b};
  }

 private:
  std::mt19937_64 random_;
  int n_ = 0;
};

/// With a tube of zero, the error of the pose at a point y must be at most fixedError +
/// reachError·|y|, as the header promises.
TEST(RigidMotion, PosesAreWithinTheirStatedError) {
  Cases cases(test::testSeed(1));
  double worst = 0;  // the largest error, divided by its bound
  for (int n = 0; n < 20'000; ++n) {
    const auto [a, b] = cases.edge();
    const RigidMotion motion = RigidMotion::spatial(a, b, {});
    const ReferenceMotion reference(a, b);
    const double t = n % 10 == 0 ? n / 10 % 2 : cases.real(0, 1);
    const RelativeMotion w = RigidEdge(motion).relativeMotion(0, t, 0);
    const Vec3 p = cases.vector(3);
    const long double off =
        ((w.X_AB.m * p + w.X_AB.t).cast<long double>() - reference.point(t, p)).norm();
    const double bound = w.fixedError + w.reachError * p.norm();
    worst = std::max(worst, static_cast<double>(off) / bound);
    ASSERT_LE(off, bound) << "case " << n << ", t = " << t;
  }
  std::cout << "worst error " << worst << " of its bound\n";
  EXPECT_GT(worst, 1e-4) << "a bound that no case comes near is not measured by this test";
}

/// For random points, times and directions in random intervals, the bound must not be below the
/// displacement. In some intervals the displacement must be close to the bound.
TEST(RigidMotion, IntervalsBoundTheDisplacement) {
  Cases cases(test::testSeed(2));
  double tightest = 0, tightestDirectional = 0;
  const int count = test::isStressRun() ? 2'000'000 : 100'000;
  for (int n = 0; n < count; ++n) {
    const auto [a, b] = cases.edge();
    const RigidMotion motion = RigidMotion::spatial(a, b, {});
    const ReferenceMotion reference(a, b);
    const double h = std::ldexp(0.5, -(n % 12));
    const double t = h + 2 * h * std::floor(cases.real(0, 0.5 / h));
    RigidEdge edge(motion);
    const RelativeMotion w = edge.relativeMotion(0, t, h);
    const Vec3 p = cases.vector(3), direction = cases.vector().normalized();
    const Vec3 y = w.X_AB.m * p, spin = w.angular.cross(y);
    const MotionBound bounds = motionBound(w, y + w.X_AB.t, 0);
    const double error = 2 * bounds.pad;
    for (const double s : {-1.0, 1.0, cases.real()}) {
      const Eigen::Matrix<long double, 3, 1> moved =
          reference.point(static_cast<long double>(t) + s * h, p) - reference.point(t, p);
      const auto bound = static_cast<double>(moved.norm());
      ASSERT_LE(bound, bounds.isotropic + error) << "case " << n;
      const double along = std::abs(static_cast<double>(moved.dot(direction.cast<long double>())));
      const double directional = std::abs(direction.dot(w.linear + spin)) +
                                 bounds.secondOrderAcross * direction.cross(w.angular).norm() +
                                 bounds.secondOrder;
      ASSERT_LE(along, directional + error) << "case " << n;
      if (bound > 1e-3) tightest = std::max(tightest, bound / bounds.isotropic);
      if (along > 1e-3) tightestDirectional = std::max(tightestDirectional, along / directional);
    }
  }
  EXPECT_GT(tightest, 0.999);
  EXPECT_GT(tightestDirectional, 0.999);
}

TEST(RigidMotion, PlanarIsTheShorterWayRound) {
  const double pi = std::numbers::pi;
  const auto yawAt = [](const Vec3& a, const Vec3& b, double t) {
    const Transform X = RigidMotion::planar(a, b, {}).at(t);
    return std::atan2(X.m(1, 0), X.m(0, 0));
  };
  EXPECT_NEAR(yawAt(Vec3(0, 0, 3), Vec3(0, 0, -3), 0.5), pi, 1e-15);
  EXPECT_NEAR(yawAt(Vec3(0, 0, 0.5), Vec3(0, 0, 1.5), 0.25), 0.75, 1e-15);
  EXPECT_NEAR(yawAt(Vec3(0, 0, 7), Vec3(0, 0, 1), 1), 1, 1e-14);  // a yaw of more than one turn
  EXPECT_TRUE(RigidMotion::planar(Vec3(0, 0, 0), Vec3(0, 0, pi), {}).ambiguous());
  EXPECT_TRUE(RigidMotion::planar(Vec3(0, 0, pi / 2), Vec3(0, 0, -pi / 2 + 1e-10), {}).ambiguous());
  EXPECT_FALSE(RigidMotion::planar(Vec3(0, 0, pi / 2), Vec3(0, 0, -pi / 2 + 1e-8), {}).ambiguous());
  EXPECT_FALSE(RigidMotion::planar(Vec3(0, 0, pi), Vec3(0, 0, -pi), {}).ambiguous());
}

TEST(RigidMotion, PlanarPosesAreWithinTheirStatedError) {
  Cases cases(test::testSeed(3));
  for (int n = 0; n < 20'000; ++n) {
    const double range = n % 2 ? 3 : 300;
    Vec3 a = cases.vector(range), b = cases.vector(range);
    if (n % 4 == 0) b[2] = a[2];  // a fixed rotation, which is only rounded
    const RelativeMotion w = RigidEdge(RigidMotion::planar(a, b, {})).relativeMotion(0, 0.375, 0);
    const long double twoPi = 2 * std::numbers::pi_v<long double>;
    const long double turn =
        std::remainder(static_cast<long double>(b[2]) - static_cast<long double>(a[2]), twoPi);
    const long double yaw = a[2] + 0.375L * turn;
    const long double off =
        std::hypot(std::cos(yaw) - w.X_AB.m(0, 0), std::sin(yaw) - w.X_AB.m(1, 0));
    ASSERT_LE(off, w.reachError) << n;
  }
}

/// No curve in the tube may deviate from the nominal motion by more than the stated errors, and
/// some curve must come close to these errors.
TEST(RigidMotion, TubesAreWithinTheStatedError) {
  Cases cases(test::testSeed(5));
  for (const bool planar : {false, true}) {
    double fullest = 0;  // the largest deviation, divided by its bound
    for (int n = 0; n < 2'000; ++n) {
      const Tube tube{n % 3 ? 0.01 : 0, n % 3 != 1 ? 0.02 : 0};
      auto [a, b] = cases.edge();
      const Vec3 flatA = cases.vector(2), flatB = cases.vector(2);
      const RigidMotion motion =
          planar ? RigidMotion::planar(flatA, flatB, tube) : RigidMotion::spatial(a, b, tube);
      const RelativeMotion w = RigidEdge(motion).relativeMotion(0, cases.real(0, 1), 0);
      const Vec3 y = cases.vector(3);  // the lever of a point
      Vec3 shift(1, n % 2 ? 1 : -1, planar ? 0 : 1);
      const Vec3 axis = planar ? Vec3::UnitZ() : Vec3(y.cross(shift).normalized());
      const Vec3 moved = Eigen::AngleAxisd(tube.rotation, axis) * y + tube.position * shift;
      const double bound = w.fixedError + w.reachError * y.norm();
      ASSERT_LE((moved - y).norm(), bound) << n << (planar ? ", planar" : "");
      fullest = std::max(fullest, (moved - y).norm() / bound);
    }
    EXPECT_GT(fullest, 0.99) << (planar ? "planar" : "spatial");
  }
}

TEST(RigidMotion, HalfTurnsAreAmbiguous) {
  Cases cases(test::testSeed(4));
  for (int n = 0; n < 1000; ++n) {
    const RigidPose a{Vec3::Zero(), cases.orientation()};
    const Vec3 axis = cases.vector().normalized();
    const auto turned = [&](double angle) {
      return RigidMotion::spatial(
                 a, {Vec3::Zero(), Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)) * a.q}, {})
          .ambiguous();
    };
    EXPECT_TRUE(turned(std::numbers::pi));
    EXPECT_TRUE(turned(std::numbers::pi - 0.9e-9));
    EXPECT_TRUE(turned(std::numbers::pi + 0.9e-9));
    EXPECT_FALSE(turned(std::numbers::pi - 1.1e-9));
    EXPECT_FALSE(turned(std::numbers::pi + 1.1e-9));
  }
}

}  // namespace
}  // namespace corridor
