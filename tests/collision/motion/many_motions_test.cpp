// Tests queries of several motions at once. Spheres that are swept in the world frame separate some
// of the bodies.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/chain_motion.h"

namespace corridor {
namespace {

using test::bodyOf;
using test::box;
using test::ChainMotion;

/// A motion source that consists of several motions, which are selected by their indices.
class Motions final : public MotionSource {
 public:
  explicit Motions(std::vector<ChainMotion> motions) : motions_(std::move(motions)) {}
  RelativeMotion relativeMotion(std::size_t i, double t, double h) override {
    return motions_.at(i).relativeMotion(0, t, h);
  }
  bool ambiguous() const override { return false; }
  bool still() const override { return false; }

 private:
  std::vector<ChainMotion> motions_;
};

Body cube(double half, const Vec3& center = Vec3::Zero()) {
  return bodyOf(box(center - half * Vec3::Ones(), center + half * Vec3::Ones()));
}

ChainMotion::Joint slide(const Vec3& axis, double from, double to) {
  return {.slides = true, .axis = axis, .from = from, .to = to};
}

/// Two cubes move along side by side. Their spheres are closer than the margin, but their faces are
/// not. The first pair has a body with a large rotation; its swept spheres separate it
/// nevertheless. This early separation must not affect the pair of cubes.
TEST(ManyMotions, CertificateChangesNoVerdict) {
  const Body obstacle = cube(1, Vec3(100, 0, 0)), tip = cube(0.05, Vec3(1, 0, 0)), left = cube(0.5),
             right = cube(0.5);
  Motions motions({ChainMotion({{.from = 0, .to = 1}}),
                   ChainMotion({slide(Vec3::UnitY(), 1.78, 1.78)}),
                   ChainMotion({slide(Vec3::UnitX(), 0, 1)}),
                   ChainMotion({slide(Vec3::UnitY(), 1.78, 1.78), slide(Vec3::UnitX(), 0, 1)})});
  const std::vector<MotionPair> pairs = {
      {.a = &obstacle, .b = &tip, .motion = 0, .bodyA = 0, .bodyB = 1, .worldMotionB = 0},
      {.a = &left,
       .b = &right,
       .motion = 1,
       .bodyA = 2,
       .bodyB = 3,
       .worldMotionA = 2,
       .worldMotionB = 3}};
  MotionOptions options;
  options.tolerance = 1e-7;
  options.margin = 0.1;
  options.workLimit = 10'000;
  QueryContext context;
  for (const bool earliest : {false, true}) {
    options.earliest = earliest;
    MotionCertificate certificate;
    EXPECT_EQ(certifyMotion(motions, pairs, options, context).verdict, MotionVerdict::free);
    EXPECT_EQ(certifyMotion(motions, pairs, options, context, &certificate).verdict,
              MotionVerdict::free);
    EXPECT_FALSE(checkCertificate(motions, pairs, options, 1, certificate, context));
  }
}

/// A joint may make any number of revolutions. Intervals that are too wide to be tested must count
/// as work. Otherwise the query would take nearly forever.
TEST(ManyMotions, ManyRevolutionsEndAtTheWorkLimit) {
  const Body hub = cube(0.1), tip = cube(0.05, Vec3(1, 0, 0));
  Motions motions({ChainMotion({{.from = 0, .to = 1e6}})});
  const MotionPair pair = {.a = &hub, .b = &tip, .worldMotionB = 0};
  MotionOptions options;
  options.tolerance = 1e-7;
  options.workLimit = 10'000;
  for (const bool earliest : {false, true}) {
    options.earliest = earliest;
    QueryContext context;
    const MotionResult result = certifyMotion(motions, {&pair, 1}, options, context);
    EXPECT_EQ(result.verdict, MotionVerdict::undecided);
    EXPECT_EQ(result.reason, UndecidedReason::workLimit);
    EXPECT_LT(context.counters.splits, options.workLimit);
  }
}

/// Indices of bodies may be arbitrarily large, because bodies without a sphere in the world need no
/// memory.
TEST(ManyMotions, IndicesOfBodiesMayBeLarge) {
  const Body a = cube(1), b = cube(1, Vec3(10, 0, 0));
  Motions motions({ChainMotion({slide(Vec3::UnitX(), 0, -9)})});
  const std::size_t last = static_cast<std::size_t>(-1);
  const MotionPair pair = {.a = &a, .b = &b, .bodyA = last / 1000, .bodyB = last};
  MotionOptions options;
  options.tolerance = 1e-7;
  QueryContext context;
  const MotionResult result = certifyMotion(motions, {&pair, 1}, options, context);
  EXPECT_EQ(result.verdict, MotionVerdict::contact);
  ASSERT_TRUE(result.pair);
  EXPECT_EQ(result.pair->bodyB, last);
}

}  // namespace
}  // namespace corridor
