// NaN and ±infinity in every number that motion queries take, one at a time: no answer is ever
// `free`, and no certificate is accepted.
#include <array>
#include <span>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/not_finite.h"

namespace corridor::test {
namespace {

TriangleMesh cube(double size) {
  return box(Vec3::Constant(-size / 2), Vec3::Constant(size / 2));
}
Transform farAway() {
  Transform X;
  X.t = Vec3(5, 4, 3);
  return X;
}
const Transform kFar = farAway();

MotionOptions someOptions() {
  MotionOptions options;
  options.tolerance = options.clearanceSlack = 1e-6;
  options.margin = 0.001;
  return options;
}

class NotFiniteMotions : public testing::TestWithParam<Proof> {};
INSTANTIATE_TEST_SUITE_P(Every, NotFiniteMotions, everyProof(), proofName);

MotionResult certifyFar(MotionSource& source, const MotionOptions& options, const Proof& proof,
                        const Body& b = Body("b", placed(Box{Vec3(1, 0.8, 0.6)}, {}))) {
  static const Body a("a", cube(1));
  const MotionPair pair{&a, &b};
  QueryContext context;
  return proof(source, {&pair, 1}, options, context);
}

void expectAmbiguous(const RigidMotion& motion, const Proof& proof, const std::string& what) {
  RigidEdge edge(motion);
  const MotionResult result = certifyFar(edge, someOptions(), proof);
  EXPECT_EQ(result.verdict, MotionVerdict::undecided) << what;
  EXPECT_EQ(result.reason, UndecidedReason::ambiguous) << what;
  EXPECT_EQ(result.certifiedUntil, 0) << what;
}

TEST_P(NotFiniteMotions, RigidEdgesAreAmbiguous) {
  const std::array<RigidPose, 2> ends{at(Vec3(5, 4, 3)), turned(Vec3(4, 5, 4), 0.3, Vec3(1, 2, 3))};
  const std::array<Vec3, 2> planar{Vec3(5, 4, 0.1), Vec3(4, 5, 0.3)};
  const auto isFree = [&](const RigidMotion& motion) {
    RigidEdge edge(motion);
    return certifyFar(edge, someOptions(), GetParam()).verdict == MotionVerdict::free;
  };
  ASSERT_TRUE(isFree(RigidMotion::spatial(ends[0], ends[1], {})));
  ASSERT_TRUE(isFree(RigidMotion::planar(planar[0], planar[1], {})));
  ASSERT_TRUE(isFree(RigidMotion::translation(kFar, Vec3(1, 1, 1))));
  forEachNotFinite(ends, [&](const auto& bad, const std::string& what) {
    expectAmbiguous(RigidMotion::spatial(bad[0], bad[1], {}), GetParam(), what);
  });
  // States: both ends have the same number that is not finite.
  forEachNotFinite(ends[1], [&](const RigidPose& bad, const std::string& what) {
    expectAmbiguous(RigidMotion::spatial(bad, bad, {}), GetParam(), what);
  });
  forEachNotFinite(planar, [&](const auto& bad, const std::string& what) {
    expectAmbiguous(RigidMotion::planar(bad[0], bad[1], {}), GetParam(), what);
    if (!bad[0].allFinite())
      expectAmbiguous(RigidMotion::planar(bad[0], bad[0], {}), GetParam(), what);
  });
  forEachNotFinite(kFar, [&](const Transform& bad, const std::string& what) {
    expectAmbiguous(RigidMotion::translation(bad, Vec3(1, 1, 1)), GetParam(), what);
  });
  forEachNotFinite(Vec3(1, 1, 1), [&](const Vec3& bad, const std::string& what) {
    expectAmbiguous(RigidMotion::translation(kFar, bad), GetParam(), what);
  });
  for (const double bad : kNotFinite) {
    expectAmbiguous(RigidMotion::spatial(ends[0], ends[1], {bad, 0}), GetParam(), "tube");
    expectAmbiguous(RigidMotion::spatial(ends[0], ends[1], {0, bad}), GetParam(), "tube");
    expectAmbiguous(RigidMotion::planar(planar[0], planar[1], {bad, 0}), GetParam(), "tube");
  }
  RigidPose zero = ends[0];
  zero.q.coeffs().setZero();
  expectAmbiguous(RigidMotion::spatial(ends[0], zero, {}), GetParam(), "zero quaternion");
  expectAmbiguous(RigidMotion::spatial(zero, zero, {}), GetParam(), "zero quaternions");
}

TEST_P(NotFiniteMotions, OptionsAreRefused) {
  const RigidMotion motion = RigidMotion::spatial(at(Vec3(5, 4, 3)), at(Vec3(4, 5, 4)), {});
  const auto numbersOf = [](MotionOptions& o) {
    return std::vector{&o.tolerance, &o.margin, &o.clearanceSlack, &o.timeTolerance};
  };
  forEachNotFinite(someOptions(), numbersOf, [&](const MotionOptions& bad, const auto& what) {
    RigidEdge edge(motion);
    EXPECT_THROW(certifyFar(edge, bad, GetParam()), std::invalid_argument) << what;
  });
  const PairMargins two({0.1, 0.1});
  MotionOptions options = someOptions();
  options.pairMargins = &two;
  RigidEdge edge(motion);
  EXPECT_THROW(certifyFar(edge, options, GetParam()), std::invalid_argument) << "two margins";
}

/// A source of one motion with numbers of the caller's choice.
class FixedMotion final : public MotionSource {
 public:
  RelativeMotion w;
  std::array<ScrewMotion, 2> screws;
  RelativeMotion relativeMotion(std::size_t, double, double) override {
    w.screws = screws;
    return w;
  }
  bool ambiguous() const override { return false; }
  bool still() const override { return false; }
};

TEST_P(NotFiniteMotions, ASourceWithNaNProvesNothing) {
  FixedMotion good;
  good.w.X_AB = kFar;
  good.w.linear = Vec3(0.01, 0, 0);
  good.w.speed = 0.0101;
  good.w.angular = Vec3(0, 0, 0.001);
  good.w.angle = 0.00101;
  good.w.fixedError = good.w.reachError = 1e-12;
  good.screws = {ScrewMotion{ScrewMotion::Kind::prismatic, Vec3::UnitX(), Vec3::Zero(), 0.0101, 0},
                 ScrewMotion{ScrewMotion::Kind::revolute, Vec3::UnitZ(), kFar.t, 0.00101, 0}};
  ASSERT_EQ(certifyFar(good, someOptions(), GetParam()).verdict, MotionVerdict::free);
  // A translation's bounds use neither the axis nor the point of its screw.
  const auto numbersOf = [](FixedMotion& f) {
    std::vector<double*> numbers;
    addNumbers(f.w.X_AB, numbers), addNumbers(f.w.linear, numbers);
    addNumbers(f.w.angular, numbers), addNumbers(f.screws[1].axis, numbers);
    addNumbers(f.screws[1].point, numbers);
    for (double* number : {&f.w.speed, &f.w.angle, &f.w.fixedError, &f.w.reachError})
      numbers.push_back(number);
    for (ScrewMotion& screw : f.screws)
      for (double* number : {&screw.amount, &screw.tube, &screw.deviation})
        numbers.push_back(number);
    return numbers;
  };
  for (const double size : {1.0, 12.0}) {  // the larger body is not separated by its bounds
    const Body b("b", cube(size));
    forEachNotFinite(good, numbersOf, [&](const FixedMotion& bad, const std::string& what) {
      if (what.find("nan") == std::string::npos) return;
      FixedMotion source = bad;
      EXPECT_NE(certifyFar(source, someOptions(), GetParam(), b).verdict, MotionVerdict::free)
          << what;
    });
  }
}

TEST(NotFiniteCertificates, HaveAFault) {
  const Body a("a", cube(1)), b("b", cube(1));
  const MotionPair pair{&a, &b};
  const RigidMotion motion = RigidMotion::spatial(at(Vec3(5, 4, 3)), at(Vec3(4, 5, 4)), {});
  RigidEdge edge(motion);
  QueryContext context;
  MotionCertificate good;
  ASSERT_EQ(certifyMotion(edge, {&pair, 1}, someOptions(), context, &good).verdict,
            MotionVerdict::free);
  const auto faultOf = [&](MotionSource& source, const MotionCertificate& certificate, double until,
                           const MotionOptions& options) {
    return checkCertificate(source, {&pair, 1}, options, until, certificate, context);
  };
  ASSERT_FALSE(faultOf(edge, good, 1, someOptions()));
  const auto numbersOf = [](MotionCertificate& certificate) {
    std::vector<double*> numbers;
    for (FreeInterval& i : certificate.free)
      for (double* number : {&i.t0, &i.t1, &i.clearance}) numbers.push_back(number);
    return numbers;
  };
  forEachNotFinite(good, numbersOf, [&](const MotionCertificate& bad, const std::string& what) {
    EXPECT_TRUE(faultOf(edge, bad, 1, someOptions())) << what;
  });
  for (const double bad : kNotFinite) EXPECT_TRUE(faultOf(edge, good, bad, someOptions()));
  const auto optionNumbers = [](MotionOptions& o) {
    return std::vector{&o.tolerance, &o.margin, &o.clearanceSlack};
  };
  forEachNotFinite(someOptions(), optionNumbers, [&](const MotionOptions& bad, const auto& what) {
    EXPECT_TRUE(faultOf(edge, good, 1, bad)) << what;
  });
  const std::array<RigidPose, 2> ends{at(Vec3(5, 4, 3)), at(Vec3(4, 5, 4))};
  forEachNotFinite(ends, [&](const auto& bad, const std::string& what) {
    RigidEdge other(RigidMotion::spatial(bad[0], bad[1], {}));
    const auto fault = faultOf(other, good, 1, someOptions());
    ASSERT_TRUE(fault) << what;
    EXPECT_EQ(fault->kind, CertificateFault::Kind::ambiguous) << what;
  });
}

}  // namespace
}  // namespace corridor::test
