#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "collision/world/rigid_scene.h"
#include "tests/support/meshes.h"

namespace corridor {
namespace {

RigidScene scene(const Triangle& moving, const Triangle& fixed) {
  const auto body = [](const Triangle& t) {
    std::vector<Body> one;
    one.emplace_back("body", TriangleMesh{{t[0], t[1], t[2]}, {{0, 1, 2}}});
    return one;
  };
  return RigidScene(body(moving), body(fixed));
}

/// The squared distance of a bounding sphere and a box overflows, but the radius of the sphere does
/// not.
TEST(SceneLimits, HugeBodiesAreNotSkipped) {
  const double b = 1e170, l = 1e160;
  const RigidScene s = scene({Vec3(-b, 0, 0), Vec3(b, b, 0), Vec3(b, -b, 0)},
                             {Vec3(l, 0, -l), Vec3(l, 0, l), Vec3(l, 1e150, 0)});
  QueryContext context;
  EXPECT_TRUE(s.interference({}, context));
}

/// A map far from a rotation, under which the computed image of the centre consists only of
/// rounding errors.
TEST(SceneLimits, CancellingMapsAreNotSkipped) {
  QueryContext context;
  for (int i = 1; i <= 100; ++i) {
    const Vec3 p(0.1 * i, 0.7, 0.3);
    Transform X;
    X.m.setZero();
    X.m(0, 0) = 3.1, X.m(0, 1) = -3.1 * p[0] / p[1];
    // The first coordinate of X·p, with a relative error of some 2^-106: fma computes the rounding
    // errors of the products.
    const double big = X.m(0, 0) * p[0], other = X.m(0, 1) * p[1];
    const double exact =
        (big + other) + (std::fma(X.m(0, 0), p[0], -big) + std::fma(X.m(0, 1), p[1], -other));
    const double s = 1e-3 * std::abs(exact);
    const RigidScene point =
        scene({p, p, p}, {Vec3(exact - s, 0, 0), Vec3(exact + s, 0, 0), Vec3(exact, s, 0)});
    EXPECT_TRUE(point.interference(X, context)) << i;
  }
}

/// Maps that stretch: the mapped body reaches beyond its bounding sphere, by less than a thousandth
/// of the radius.
TEST(SceneLimits, StretchingMapsAreNotSkipped) {
  QueryContext context;
  for (const double stretch : {1 + 0x1p-12, 1 + 0x1p-20, 1 + 0x1p-30}) {
    // The body's tip is stretched to x = `stretch`, where it touches the plate.
    const RigidScene s = scene({Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 0)},
                               {Vec3(stretch, 1, 0), Vec3(stretch, -1, 1), Vec3(stretch, -1, -1)});
    EXPECT_FALSE(s.interference({}, context)) << stretch;
    EXPECT_TRUE(s.interference({stretch * Mat3::Identity(), Vec3::Zero()}, context)) << stretch;
  }
}

/// Under a map that shrinks, lengths in the body's frame differ from those in the world. The second
/// pair is closer than the first pair, by less than the amount by which the map shrinks lengths.
TEST(SceneLimits, ClearanceUnderMapsThatAreNotRigid) {
  const auto box = [](const Vec3& low, const Vec3& high) { return Body("", test::box(low, high)); };
  std::vector<Scene::Placed> bodies;
  bodies.push_back({box(Vec3(-1000, -1, -1), Vec3(-999, 1, 1)), 1});
  bodies.push_back({box(-0.01 * Vec3::Ones(), 0.01 * Vec3::Ones()), 2});
  bodies.push_back({box(-0.01 * Vec3::Ones(), 0.01 * Vec3::Ones()), 3});
  Transform shrinks;
  shrinks.m *= 1 - 0x1p-12;
  const std::vector<Transform> X_WF = {{}, shrinks, {Mat3::Identity(), Vec3(0.124, 0, 0)}, {}};
  QueryContext context;
  const Scene both(std::move(bodies), {{0, 1}, {0, 2}});
  EXPECT_NEAR(both.clearance(X_WF, context), 999 * (1 - 0x1p-12) - 0.01, 1e-9);
}

TEST(SceneLimits, RefusesOptionsOutOfRange) {
  const RigidScene s = scene({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)},
                             {Vec3(0, 0, 5), Vec3(1, 0, 5), Vec3(0, 1, 5)});
  QueryContext context;
  MotionOptions good;
  good.tolerance = 1e-7;
  EXPECT_EQ(s.certifyState({}, good, context).verdict, MotionVerdict::free);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [&](auto change) {
    MotionOptions options = good;
    change(options);
    EXPECT_THROW(s.certifyState({}, options, context), std::invalid_argument);
    EXPECT_THROW(s.certifyStatePlanar(Vec3::Zero(), options, context), std::invalid_argument);
  };
  refused([](MotionOptions& o) { o.tolerance = 0; });
  refused([](MotionOptions& o) { o.margin = -1; });
  refused([&](MotionOptions& o) { o.margin = nan; });
  refused([](MotionOptions& o) { o.timeTolerance = 0; });
  EXPECT_THROW(s.certifyState({}, good, context, {-1, 0}), std::invalid_argument);
  EXPECT_THROW(s.certifyState({}, good, context, {0, HUGE_VAL}), std::invalid_argument);
  EXPECT_THROW(s.certifyState({Vec3(nan, 0, 0), {}}, good, context), std::invalid_argument);
  EXPECT_THROW(s.certifyState({Vec3::Zero(), {0, 0, 0, 0}}, good, context), std::invalid_argument);
  EXPECT_THROW(s.certifyStatePlanar(Vec3(0, 0, nan), good, context), std::invalid_argument);
  EXPECT_THROW(s.interference({Mat3::Constant(nan), Vec3::Zero()}, context), std::invalid_argument);
}

}  // namespace
}  // namespace corridor
