// Every query of a scene must have the same answer on all kinds of trees.
#include <array>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include "collision/motion/check_certificate.h"
#include "collision/world/rigid_scene.h"
#include "tests/collision/motion/bodies.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::treeName;

std::vector<TreeKind> everyKind() {
  std::vector<TreeKind> kinds;
  for (const VolumeKind& volume : volumeKinds())
    for (const std::string& overlap : volume.overlaps)
      kinds.push_back(treesNamed({volume.name, "", overlap}).trees);
  return kinds;
}

/// A random scene. Both the moving and the fixed bodies include surfaces, solid meshes and convex
/// parts, so that all pairs of kinds occur.
struct RandomScene {
  explicit RandomScene(std::mt19937_64& random)
      : scene(bodies(random, 2, 0.5), bodies(random, 6, 2)) {}

  static std::vector<Body> bodies(std::mt19937_64& random, int count, double spread) {
    const auto real = [&](double low, double high) {
      return std::uniform_real_distribution(low, high)(random);
    };
    std::vector<Body> all;
    std::vector<ConvexPart> parts = test::parts(random, 5, 0.5);
    const int first = std::uniform_int_distribution(0, 2)(random);
    for (int i = 0; i < count; ++i) {
      const Vec3 at = spread * Vec3(real(-1, 1), real(-1, 1), real(-1, 1));
      const int kind = (first + i) % 3;
      if (kind == 0) {
        ConvexPart& part = parts[static_cast<std::size_t>(i) % parts.size()];
        for (Vec3& p : part.points) p += at;
        all.emplace_back("part", part);
      } else if (kind == 1) {
        const Vec3 size(real(0.1, 0.6), real(0.1, 0.6), real(0.1, 0.6));
        TriangleMesh mesh;
        test::addBox(mesh, at - size, at + size);
        all.emplace_back("solid", std::move(mesh), true);
      } else {
        TriangleMesh mesh = test::soup(random, 30, 0.1);
        for (Vec3& p : mesh.vertices) p = at + 0.5 * p;
        all.emplace_back("surface", std::move(mesh));
      }
    }
    return all;
  }

  RigidScene scene;
};

TEST(EveryTreeKind, StatesAndClearances) {
  std::mt19937_64 random(test::testSeed(61));
  const int count = test::casesOf(100, 10'000);
  int contacts = 0, asked = 0;
  std::map<TreeKind, Counters> counters;
  for (int n = 0; n < count; ++n) {
    const RandomScene scenes(random);
    const Scene& scene = scenes.scene.scene();
    for (int k = 0; k < 6; ++k) {
      const std::array poses = {Transform(), test::anyPose(random, 1)};
      std::map<TreeKind, bool> touches;
      std::map<TreeKind, double> clearances;
      for (const TreeKind trees : everyKind()) {
        QueryContext context;
        touches[trees] = scene.interference(poses, context, trees).has_value();
        counters[trees] += context.counters;
        if (k == 0) clearances[trees] = scene.clearance(poses, context, trees);
      }
      ++asked;
      contacts += touches[TreeKind::obb4];
      for (const auto& [trees, touch] : touches)
        ASSERT_EQ(touch, touches[TreeKind::obb4]) << n << ", " << treeName(trees);
      for (const auto& [trees, clearance] : clearances) {
        ASSERT_EQ(clearance == 0, touches[TreeKind::obb4]) << n << ", " << treeName(trees);
        ASSERT_NEAR(clearance, clearances[TreeKind::obb4], 1e-11) << n << ", " << treeName(trees);
      }
    }
  }
  std::cout << contacts << " of " << asked << " in contact\n";
  EXPECT_GT(contacts, asked / 5);
  EXPECT_GT(asked - contacts, asked / 5);
  // Queries have used trees of each kind, and the counts of tests differ from kind to kind.
  for (const auto& [trees, counted] : counters) {
    EXPECT_GT(counted.boxTests, 0u) << treeName(trees);
    EXPECT_GT(counted.primitiveTests, 0u) << treeName(trees);
  }
  EXPECT_GT(counters[TreeKind::sphere].boxTests, counters[TreeKind::obbBinary].boxTests);
  EXPECT_NE(counters[TreeKind::kdop14].boxTests, counters[TreeKind::kdop26].boxTests);
}

/// The verdict must be `free`, or `contact` at a pose that touches. Bodies of these scenes are
/// rarely close to each other, so only a few edges may be `undecided`.
TEST(EveryTreeKind, Edges) {
  std::mt19937_64 random(test::testSeed(62));
  const int count = test::casesOf(160, 20'000);
  std::array<int, 3> verdicts = {};
  for (int n = 0; n < count; ++n) {
    const RandomScene scenes(random);
    const Scene& scene = scenes.scene.scene();
    const auto [from, to] = test::randomEdge(random);
    const RigidMotion motion = RigidMotion::spatial(from, n % 10 ? to : from, {0x1p-38, 0x1p-38});
    MotionOptions options;
    options.tolerance = scene.defaultTolerance();
    options.clearanceSlack = options.tolerance;
    options.earliest = n % 2;
    options.margin = n % 3 ? 0 : 0.01;
    std::map<TreeKind, MotionResult> results;
    for (const TreeKind trees : everyKind()) {
      QueryContext context;
      RigidEdge edge(motion);
      options.trees = trees;
      results[trees] = scene.certify(edge, options, context);
    }
    const MotionResult& usual = results[TreeKind::obb4];
    ++verdicts.at(static_cast<std::size_t>(usual.verdict));
    for (const auto& [trees, r] : results) {
      SCOPED_TRACE(testing::Message() << n << ", " << treeName(trees));
      ASSERT_EQ(r.verdict, usual.verdict);
      QueryContext context;
      const auto touches = [&](double t) {
        const double clearance = scene.clearance(std::array{Transform(), motion.at(t)}, context);
        return clearance <= options.margin * (1 + 1e-9);
      };
      if (r.verdict == MotionVerdict::contact) {
        ASSERT_TRUE(touches(r.time));
        if (options.earliest) {
          ASSERT_TRUE(r.grazing || r.time - r.certifiedUntil <= options.timeTolerance);
        }
      }
      if (trees != TreeKind::obb4 && n % 5) continue;  // others: in every fifth case
      for (int i = 0; i <= 20 && r.certifiedUntil > 0; ++i)
        ASSERT_FALSE(touches(r.certifiedUntil * i / 20)) << i;
    }
  }
  std::cout << verdicts[0] << " free, " << verdicts[1] << " contact, " << verdicts[2]
            << " undecided\n";
  EXPECT_GT(verdicts[0], count / 5);
  EXPECT_GT(verdicts[1], count / 5);
  EXPECT_LE(verdicts[2], 1 + count / 1000);
}

/// Queries on another kind of trees than the default, too, test the bounds of bodies first, and
/// build no tree for bodies that are far away.
TEST(EveryTreeKind, FarBodiesGetNoTree) {
  std::vector<Body> fixed, moving;
  fixed.push_back(test::bodyOf(test::box(Vec3(1, -1, -1), Vec3(2, 1, 1))));
  fixed.push_back(test::bodyOf(test::box(Vec3(100, 0, 0), Vec3(101, 1, 1))));
  moving.push_back(test::bodyOf(test::box(-0.5 * Vec3::Ones(), 0.5 * Vec3::Ones())));
  const RigidScene rigid(std::move(moving), std::move(fixed));
  MotionOptions options;
  options.tolerance = rigid.defaultTolerance();
  options.trees = TreeKind::sphere;
  QueryContext context;
  const RigidPose from = test::at(Vec3::Zero());
  EXPECT_EQ(
      rigid.certifyEdge(from, test::turned(Vec3(0.2, 1, 0), 1, Vec3::UnitZ()), options, context)
          .verdict,
      MotionVerdict::free);
  EXPECT_GT(context.counters.boxTests, 0u);
  EXPECT_TRUE(rigid.fixed()[0].body.treeBuilt());
  EXPECT_FALSE(rigid.fixed()[1].body.treeBuilt());
}

/// Certificates that were made with any kind of trees must be accepted by `checkCertificate`, which
/// uses another method and other trees.
TEST(EveryTreeKind, CertificateHolds) {
  std::mt19937_64 random(test::testSeed(63));
  const int count = (test::isStressRun() ? 400 : 40) / test::kSlowdown + 1;
  int free = 0;
  for (int n = 0; n < count; ++n) {
    const Body fixed = test::bodyOf(test::blob(random, 60, 2, 0.3)),
               moving = test::bodyOf(test::blob(random, 12, 0.3, 0.3));
    const auto [a, b] = test::randomEdge(random);
    for (const TreeKind trees : everyKind()) {
      RigidEdge edge(RigidMotion::spatial(a, b, {}));
      const MotionPair pair{&fixed, &moving};
      MotionOptions options;
      options.tolerance = 1e-7;
      options.clearanceSlack = 1e-7;
      options.trees = trees;
      QueryContext context;
      MotionCertificate certificate;
      const MotionResult r = certifyMotion(edge, {&pair, 1}, options, context, &certificate);
      free += r.verdict == MotionVerdict::free;
      const auto fault =
          checkCertificate(edge, {&pair, 1}, options, r.certifiedUntil, certificate, context);
      ASSERT_FALSE(fault) << n << ", " << treeName(trees) << ": " << static_cast<int>(fault->kind)
                          << " at " << fault->t;
    }
  }
  EXPECT_GT(free, count);
}

}  // namespace
}  // namespace corridor
