// The audit: the checker and the verifier decide edges, states and pieces of curves on which bodies
// graze by construction. The true verdicts are computed in 128 bits. ../README.md describes the
// audit.
#include "tests/stress/audit/audit.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/collision/queries/every_target.h"
#include "tests/support/support.h"

namespace corridor::audit {
namespace {

/// One case in this many is verified. The short run has few cases of each family of edges.
std::size_t casesPerVerified() {
  return static_cast<std::size_t>(test::casesOf(2, 6));
}

TEST(Audit, Edges) {
  Audit audit(1, {.verify = casesPerVerified()});
  audit.run(countOf(450, 1'000'000));
  audit.report("edges");
  audit.expectDecided();
}

/// A `Checker` asks its `EdgeFilter` first, which computes in float, on each SIMD target.
TEST(Audit, EdgesAndStatesOfModels) {
  for (const std::int64_t target : test::simdTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const bool states : {false, true}) {
      Audit audit(21, {.states = states, .ofModels = true, .verify = casesPerVerified()});
      audit.run(countOf(states ? 300 : 600, states ? 100'000 : 400'000));
      audit.report(std::string(hwy::TargetName(target)) + (states ? ", states" : ", edges"));
      audit.expectDecided();
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Audit, States) {
  Audit audit(2, {.states = true});
  audit.run(countOf(2'500, 1'000'000));
  audit.report("states");
  audit.expectDecided();
}

TEST(Audit, Curves) {
  Audit audit(12, {.curves = true, .verify = casesPerVerified()});
  audit.run(countOf(420, 400'000));
  audit.report("curves");
  audit.expectDecided();
}

/// The gap or depth of the bodies is less than the rounding of poses: if an error bound were too
/// small, bodies that penetrate would be proved free.
TEST(Audit, DepthsOfRounding) {
  for (const bool states : {false, true}) {
    Audit audit(9, {.states = states, .fine = true, .verify = 20});
    audit.run(countOf(280, 200'000));
    audit.report(states ? "depths of rounding, states" : "depths of rounding, edges");
  }
  Audit curves(13, {.curves = true, .fine = true, .verify = 20});
  curves.run(countOf(130, 100'000));
  curves.report("depths of rounding, curves");
}

/// The angles of continuous joints are up to 10^25 rad in `from`, in `to`, or in both. If rounding
/// decides which way round is the shorter one, the only right answer is `undecided`.
TEST(Audit, LargeValuesOfCircles) {
  for (const bool states : {false, true}) {
    Audit audit(3, {.states = states, .verify = 1, .family = Family::largeCircles});
    audit.run(countOf(200, 50'000));
    audit.report(states ? "large circles, states" : "large circles, edges");
  }
}

/// Queries run in another floating-point mode than the usual one. Each answer must be right, or the
/// query must refuse. Under flush-to-zero, queries must not refuse.
class Modes : public testing::TestWithParam<Mode> {};

TEST_P(Modes, RightOrRefused) {
  for (const bool states : {false, true}) {
    Audit audit(4, {.states = states, .verify = 2, .mode = GetParam()});
    audit.run(countOf(200, 50'000));
    audit.report(states ? "states" : "edges");
    if (GetParam() == Mode::flushToZero) audit.expectDecided();
  }
}

std::string nameOfMode(const testing::TestParamInfo<Mode>& mode) {
  const char* names[] = {"Usual", "FlushToZero", "Upward", "Downward", "TowardZero", "ShortX87"};
  return names[static_cast<int>(mode.param)];
}

INSTANTIATE_TEST_SUITE_P(Audit, Modes,
                         testing::Values(Mode::flushToZero, Mode::upward, Mode::downward,
                                         Mode::towardZero, Mode::shortX87),
                         nameOfMode);

}  // namespace
}  // namespace corridor::audit
