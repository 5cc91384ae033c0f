// NaN and ±infinity in every number that the verifier takes, one at a time: no verdict is ever
// `proved`.
#include "tests/support/not_finite.h"

#include <gtest/gtest.h>

#include "planner/verify/polynomial_range.h"
#include "planner/verify/verify_path.h"
#include "tests/planner/verify/random_arm.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::forEachNotFinite;
using test::kNotFinite;

/// An arm with every kind of joint, with a rod at its tip and a ball on a side branch, and a mesh
/// that is far away. Every path is proved.
struct FreeArm {
  test::Arm arm;
  std::vector<ConvexPart> parts{{{Vec3(0, 0, 0), Vec3(0.1, 0, 0)}, 0.01, false},
                                {{Vec3(0, 0.1, 0)}, 0.01, false}};
  TriangleMesh mesh = test::boxMesh(Vec3(90, 80, 70), Vec3(91, 81, 71));
  double margin = 0.001, padding = 0.001, wanted = 0, tolerance = 1e-7;
  Configuration tube, provedLower, provedUpper;
  std::vector<Configuration> states;
  CurvePiece piece;

  explicit FreeArm(std::mt19937_64& random) : arm(random) {
    tube = Configuration::Constant(static_cast<Eigen::Index>(arm.space.size()), 1e-6);
    for (int i = 0; i < 3; ++i) states.push_back(arm.random(random));
    provedLower = Configuration::Constant(tube.size(), -10);
    provedUpper = -provedLower;
    piece.coefficients.resize(tube.size(), 3);
    for (int i = 0; i < 3; ++i) piece.coefficients.col(i) = states[static_cast<std::size_t>(i)];
    piece.error = tube;
  }

  PathProblem problem() const {
    PathProblem problem;
    problem.tree = &arm.tree;
    problem.space = &arm.space;
    problem.bodies = {{"rod", nullptr, {&parts[0], 1}, false, arm.tip},
                      {"ball", nullptr, {&parts[1], 1}, false, arm.side},
                      {"far", &mesh, {}, true, 0}};
    problem.pairs = {{0, 2, padding}, {1, 2, 0}};
    problem.margin = margin;
    problem.wantedClearance = wanted;
    problem.tolerance = tolerance;
    problem.tube = tube;
    problem.provedLower = provedLower;
    problem.provedUpper = provedUpper;
    return problem;
  }
  PathVerdict pathVerdict() const { return verifyPath(problem(), states).verdict; }
  PathVerdict curveVerdict() const { return verifyCurve(problem(), std::span(&piece, 1)).verdict; }
};

FreeArm freeArm() {
  std::mt19937_64 random(test::testSeed(5101));
  return FreeArm(random);
}

TEST(VerifyNotFinite, StatesArentProved) {
  const FreeArm good = freeArm();
  ASSERT_EQ(good.pathVerdict(), PathVerdict::proved);
  const auto numbersOf = [](FreeArm& arm) {
    std::vector<double*> numbers;
    test::addNumbers(arm.states, numbers);
    return numbers;
  };
  forEachNotFinite(good, numbersOf, [](const FreeArm& bad, const std::string& what) {
    const PathReport report = verifyPath(bad.problem(), bad.states);
    EXPECT_EQ(report.verdict, PathVerdict::refuted) << what;
    ASSERT_FALSE(report.findings.empty()) << what;
    EXPECT_EQ(report.findings[0].reason, "not a valid state") << what;
    EXPECT_EQ(report.provedClearance, 0) << what;
    for (const Configuration& state : bad.states)
      if (!state.allFinite()) {
        EXPECT_EQ(verifyPath(bad.problem(), {state}).verdict, PathVerdict::refuted) << what;
      }
  });
}

TEST(VerifyNotFinite, CurvesArentProved) {
  const FreeArm good = freeArm();
  ASSERT_EQ(good.curveVerdict(), PathVerdict::proved);
  const auto numbersOf = [](FreeArm& arm) {
    std::vector<double*> numbers;
    test::addNumbers(arm.piece.coefficients, numbers);
    return numbers;
  };
  forEachNotFinite(good, numbersOf, [](const FreeArm& bad, const std::string& what) {
    EXPECT_EQ(bad.curveVerdict(), PathVerdict::refuted) << what;
  });
  const auto errorsOf = [](FreeArm& arm) {
    std::vector<double*> numbers;
    test::addNumbers(arm.piece.error, numbers);
    return numbers;
  };
  forEachNotFinite(good, errorsOf, [](const FreeArm& bad, const std::string& what) {
    EXPECT_THROW(bad.curveVerdict(), std::invalid_argument) << what;
  });
}

TEST(VerifyNotFinite, ProblemsAreRefused) {
  const FreeArm good = freeArm();
  const auto numbersOf = [](FreeArm& arm) {
    std::vector<double*> numbers{&arm.margin, &arm.padding, &arm.wanted, &arm.tolerance};
    test::addNumbers(arm.tube, numbers);
    test::addNumbers(arm.parts, numbers);
    test::addNumbers(arm.mesh, numbers);
    for (Frame& frame : arm.arm.tree.frames) {
      test::addNumbers(frame.fixed, numbers);
      test::addNumbers(frame.axis, numbers);
      numbers.push_back(&frame.multiplier);
      numbers.push_back(&frame.offset);
    }
    return numbers;
  };
  forEachNotFinite(good, numbersOf, [](const FreeArm& bad, const std::string& what) {
    EXPECT_THROW(bad.pathVerdict(), std::invalid_argument) << what;
    EXPECT_THROW(bad.curveVerdict(), std::invalid_argument) << what;
  });
  FreeArm zero = good;
  zero.arm.tree.frames[1].fixed.q.coeffs().setZero();
  EXPECT_THROW(zero.pathVerdict(), std::invalid_argument);
  FreeArm negative = good;
  negative.parts[0].radius = -0.01;
  EXPECT_THROW(negative.pathVerdict(), std::invalid_argument);
}

TEST(VerifyNotFinite, ProvedRangesWithNaNHoldNothing) {
  const FreeArm good = freeArm();
  const auto numbersOf = [](FreeArm& arm) {
    std::vector<double*> numbers;
    test::addNumbers(arm.provedLower, numbers), test::addNumbers(arm.provedUpper, numbers);
    return numbers;
  };
  forEachNotFinite(good, numbersOf, [](const FreeArm& bad, const std::string& what) {
    if (!std::isnan(bad.provedLower.sum() + bad.provedUpper.sum())) return;  // no limit
    EXPECT_FALSE(test::claims([&] { return bad.pathVerdict() == PathVerdict::proved; })) << what;
    EXPECT_FALSE(test::claims([&] { return bad.curveVerdict() == PathVerdict::proved; })) << what;
  });
}

TEST(VerifyNotFinite, MessagesNameThePlace) {
  const auto message = [](const FreeArm& arm) -> std::string {
    try {
      arm.pathVerdict();
    } catch (const std::invalid_argument& e) {
      return e.what();
    }
    return "";
  };
  FreeArm arm = freeArm();
  arm.mesh.vertices[3][1] = kNotFinite[0];
  EXPECT_EQ(message(arm), "verifyPath: body far has a number that is not finite");
  arm = freeArm();
  arm.arm.tree.frames[2].name = "fork";
  arm.arm.tree.frames[2].axis[1] = kNotFinite[0];
  EXPECT_EQ(message(arm), "verifyPath: frame fork has a number that is not finite");
}

TEST(VerifyNotFinite, RangesOfPolynomialsAreUndecided) {
  using verify::Bernstein;
  const std::vector<double> good{0.1, 0.4, -0.2, 0.3};
  ASSERT_EQ(verify::rangeOf(Bernstein(good), -1, 1).verdict, verify::RangeAnswer::Verdict::within);
  forEachNotFinite(good, [](const std::vector<double>& bad, const std::string& what) {
    EXPECT_NE(verify::rangeOf(Bernstein(bad), -1, 1).verdict, verify::RangeAnswer::Verdict::within)
        << what;
  });
  const double nan = kNotFinite[0];
  EXPECT_NE(verify::rangeOf(Bernstein(good), nan, 1).verdict, verify::RangeAnswer::Verdict::within);
  EXPECT_NE(verify::rangeOf(Bernstein(good), -1, nan).verdict,
            verify::RangeAnswer::Verdict::within);
}

}  // namespace
}  // namespace corridor
