// Compares certified motions of a triangle with an exact oracle (tests/support/sturm_contact.h),
// whose motion is exactly that of the edge. Therefore every proof must hold to the last digit.
#include <array>
#include <random>

#include <gtest/gtest.h>

#include "tests/collision/motion/bodies.h"
#include "tests/collision/motion/rational_scenes.h"
#include "tests/support/rational_contact.h"
#include "tests/support/reference_distance.h"
#include "tests/support/reference_motion.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::add;
using test::bodyOf;
using test::ClosedForm;
using test::FirstContact;
using test::Proof;
using test::RationalMotion;
using test::RationalScene;
using test::ReferenceMotion;

/// A query and its tolerances. The interval [certifiedUntil, time] of a first contact must
/// be at most `timeTolerance` wide if the body moves by more than the tolerance in that time.
/// Otherwise the answer may be `undecided`.
struct Question {
  bool earliest;
  double tolerance, timeTolerance;
};
constexpr std::array<Question, 3> kQuestions = {
    {{false, 1e-7, 1}, {true, 1e-7, 1.0 / 1024}, {true, 1e-10, 1e-9}}};

/// The error of RationalMotion::time, doubled.
constexpr long double kTimeError = 0x1p-59L;

/// Returns how far, in metres, a corner at a rounded pose may be from its exact position. This is
/// the sum of two bounds of rigid_motion.cpp: 2^-43 of the lever for the rotation, and 16u of the
/// largest coordinate for the position.
double poseError(const Triangle& moving, const RigidPose& from, const RigidPose& to) {
  double lever = 0;
  for (const Vec3& p : moving) lever = std::max(lever, p.norm());
  return 0x1p-43 * lever +
         0x1p-49 * std::max(from.p.cwiseAbs().maxCoeff(), to.p.cwiseAbs().maxCoeff());
}

class Sturm : public testing::TestWithParam<Proof> {
 protected:
  /// Compares the answer for one motion with the oracle.
  void check(const Triangle& fixed, const Triangle& moving, const RationalMotion& path,
             const Question& question) {
    const bool earliest = question.earliest;
    const FirstContact known = sturmContact(fixed, moving, path);
    TriangleMesh a, b;
    add(a, fixed);
    add(b, moving);
    const RigidPose &from = path.from(), &to = path.to();
    const RigidMotion motion = RigidMotion::spatial(from, to, {});
    MotionOptions options;
    options.tolerance = question.tolerance;
    options.timeTolerance = question.timeTolerance;
    options.earliest = earliest;
    options.workLimit = 100'000;
    const MotionResult r =
        test::certify(bodyOf(b), bodyOf(a), motion, options, context_, GetParam());
    const Transform X = motion.at(r.time);
    const auto distance = [&](double t) {
      const Transform pose = motion.at(t);
      return test::rationalContact(fixed, {}, moving, pose)
                 ? 0
                 : test::referenceDistance(fixed, {}, moving, pose);
    };
    ++counts_.asked;
    counts_.inContact += known.contact;
    switch (r.verdict) {
      case MotionVerdict::free:
        ++counts_.free;
        ASSERT_FALSE(known.contact) << "at s = " << known.low;
        break;
      case MotionVerdict::contact: {
        ++counts_.contact;
        ASSERT_TRUE(test::rationalContact(fixed, {}, moving, X));
        const ReferenceMotion real(from, to);
        for (const Vec3& p : moving)
          ASSERT_LE((real.point(r.time, p) - (X.m * p + X.t).cast<long double>()).norm(),
                    poseError(moving, from, to) + 0x1p-50 * p.norm() + 0x1p-50 * X.t.norm());
        // Therefore, at the reported time, the exact motion is at most the rounding of the pose
        // away from a contact. The exact motion has a contact at or before the reported time, too,
        // unless the reported contact exists only because of that rounding.
        counts_.onlyRounded += !known.contact || r.time < path.time(known.low) - kTimeError;
        if (!earliest) break;
        if (!r.grazing) {
          ASSERT_LE(r.time - r.certifiedUntil, question.timeTolerance);
        }
        for (int i = 0; i <= 4 && r.grazing; ++i)
          ASSERT_LE(distance(r.certifiedUntil + i / 4.0 * (r.time - r.certifiedUntil)),
                    2 * question.tolerance);
        break;
      }
      case MotionVerdict::undecided:
        if (r.reason == UndecidedReason::workLimit) {
          ++counts_.workLimit;
        } else {
          ASSERT_EQ(r.reason, UndecidedReason::clearance);
          ASSERT_LE(distance(r.time), 2 * question.tolerance);
          counts_.undecided++;
        }
    }
    if (earliest && known.contact && r.certifiedUntil > 0) {
      ASSERT_LE(r.certifiedUntil, path.time(known.high) + kTimeError);
    }
  }

  struct Counts {
    int asked = 0, inContact = 0, free = 0, contact = 0, undecided = 0, workLimit = 0,
        onlyRounded = 0;
  };
  Counts counts_;
  QueryContext context_;
};

INSTANTIATE_TEST_SUITE_P(All, Sturm, test::everyProof(), test::proofName);

TEST_P(Sturm, ClosedForms) {
  for (const ClosedForm& form : test::closedForms())
    for (const Question& question : kQuestions) {
      SCOPED_TRACE(form.name);
      counts_ = {};
      check(form.fixed, form.moving, form.motion, question);
      if (HasFatalFailure()) return;
      EXPECT_EQ(counts_.inContact, form.first >= 0);
    }
}

/// Most kinds of random scenes are hard on purpose. But queries must decide nearly all scenes of
/// the kind `nearby`, which are not constructed as near misses.
TEST_P(Sturm, Motions) {
  std::mt19937_64 random(test::testSeed(41));
  const int count = test::casesOf(1'000, 40'000);
  const std::array<const char*, RationalScene::kinds> names = {"nearby", "coplanar", "meeting",
                                                               "tangential"};
  for (int kind = 0; kind < RationalScene::kinds; ++kind) {
    counts_ = {};
    for (int n = 0; n < count / RationalScene::kinds; ++n) {
      SCOPED_TRACE(testing::Message() << names[kind] << " " << n);
      const RationalScene scene(random, static_cast<RationalScene::Kind>(kind), n % 5 != 0);
      check(scene.fixed, scene.moving, scene.motion, kQuestions[n % 3]);
      if (HasFatalFailure()) return;
    }
    std::cout << names[kind] << ": " << counts_.asked << " motions, " << counts_.inContact
              << " in contact; called free " << counts_.free << ", contact " << counts_.contact
              << " (" << counts_.onlyRounded << " by rounding), undecided " << counts_.undecided
              << ", too much work " << counts_.workLimit << "\n";
    EXPECT_GT(counts_.inContact, counts_.asked / 10);
    EXPECT_GT(counts_.asked - counts_.inContact, counts_.asked / 10);
    EXPECT_LE(counts_.onlyRounded, 1 + counts_.asked / 1000);
    if (kind == RationalScene::nearby) {
      EXPECT_LE(counts_.undecided + counts_.workLimit, 1 + counts_.asked / 50);
    }
    if (GetParam().method == EdgeMethod::certified) {
      EXPECT_LE(counts_.workLimit, 1 + counts_.asked / 1000);
    }
  }
}

}  // namespace
}  // namespace corridor
