// Tests of collision/ in several threads, which share bodies and have a QueryContext each. The
// tests of queries start with bodies that have no trees yet, so that some threads build trees while
// others wait for them. The answers must be those of one thread: to the last bit on the same
// bodies; on copies of these bodies, only the verdicts must agree.
#include "tests/collision/motion/bodies.h"

#include <array>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "collision/core/simd_target.h"
#include "collision/geometry/mesh_file.h"
#include "collision/hierarchy/with_trees.h"
#include "collision/motion/check_certificate.h"
#include "collision/queries/contacts.h"
#include "collision/queries/self_intersections.h"
#include "collision/world/body_queries.h"
#include "collision/world/rigid_scene.h"
#include "tests/support/soups.h"
#include "tests/support/support.h"
#include "tests/threads/in_threads.h"

namespace corridor {
namespace {

using test::Answers;
using test::inThreads;
using test::kThreads;

/// All kinds of trees.
constexpr TreeKind kKinds[] = {TreeKind::obb4,
#define CORRIDOR_KIND(kind, Volume, Overlap, volumeName, overlapName) TreeKind::kind,
                               CORRIDOR_EACH_OVERLAP(CORRIDOR_KIND)
#undef CORRIDOR_KIND
};

/// Returns bodies of every kind: soups, solid meshes, primitives. All calls return equal bodies.
std::vector<Body> someBodies() {
  std::mt19937_64 random(61);
  TriangleMesh rooms;  // two separate boxes
  test::addBox(rooms, Vec3(-0.6, -0.6, -0.6), Vec3(0.6, 0.6, 0.6));
  test::addBox(rooms, Vec3(1, -0.2, -0.2), Vec3(1.5, 0.2, 0.2));
  std::vector<Body> bodies;
  bodies.emplace_back("soup", test::soup(random, 120, 0.1));
  bodies.emplace_back("blob", test::blob(random, 60, 0.4, 0.1));
  bodies.emplace_back("rooms", rooms, true);
  bodies.emplace_back("cube", test::box(Vec3(-0.1, -0.1, -0.1), Vec3(0.1, 0.1, 0.1)), true);
  for (ConvexPart& part : test::parts(random, 5, 0.3)) bodies.emplace_back("part", std::move(part));
  return bodies;
}

/// Runs all static queries of all pairs at random poses, on trees of one kind.
Answers askStill(const std::vector<Body>& bodies, TreeKind trees) {
  std::mt19937_64 random(62);
  QueryContext context;
  Answers answers;
  const auto addPair = [&](const std::optional<PrimitivePair>& pair) {
    answers.addVerdict(pair.has_value());
    if (!pair) return;
    answers.add(pair->a);
    answers.add(pair->b);
  };
  for (const Body& a : bodies)
    for (const Body& b : bodies) {
      const Transform X_WA = test::anyPose(random, 0.5), X_WB = test::anyPose(random, 0.5);
      addPair(interference(Posed(a, X_WA), Posed(b, X_WB), context, trees));
      const Distance d = distance(Posed(a, X_WA), Posed(b, X_WB), {}, context, trees);
      answers.add(d.distance);
      answers.add(d.p_WA);
      answers.add(d.p_WB);
      answers.add(d.a);
      answers.add(d.b);
      for (const double tolerance : {0.0, 0.01, 0.3})
        answers.addVerdict(closerThan(Posed(a, X_WA), Posed(b, X_WB), tolerance, context, trees));
      addPair(findOneInsideOther(Posed(a, X_WA), Posed(b, X_WB), context));
      if (!a.isMesh() || !b.isMesh()) continue;
      for (const TriangleContact& contact :
           contacts(Posed(a, X_WA), Posed(b, X_WB), context, trees)) {
        answers.add(contact.a);
        answers.add(contact.b);
        answers.add(contact.p_W);
        answers.add(contact.q_W);
      }
    }
  for (const Body& body : bodies)
    if (body.isMesh())
      for (const PrimitivePair& pair : selfIntersections(body.mesh(), context)) {
        answers.add(pair.a);
        answers.add(pair.b);
      }
  answers.add(context.counters);
  return answers;
}

/// Runs `ask(bodies, kind)` in several threads and in one thread, for each kind of trees, and
/// compares the answers. On the same bodies all bits must agree. On copies of the bodies that only
/// the one thread has used, the verdicts must agree. `make` makes the bodies. Half of the threads
/// start with the second kind of trees. Returns the answers of the one thread, for each kind.
template <class Make, class Ask>
std::vector<Answers> expectOneAnswerOfEachKind(const Make& make, const Ask& ask) {
  constexpr std::size_t kinds = std::size(kKinds);
  const auto shared = make(), own = make();
  std::array<std::array<Answers, kinds>, kThreads> answers;
  inThreads([&](int k) {
    for (std::size_t i = 0; i < kinds; ++i) {
      const std::size_t kind = (i + static_cast<std::size_t>(k % 2)) % kinds;
      answers[k][kind] = ask(shared, kKinds[kind]);
    }
  });
  std::vector<Answers> alone;
  for (std::size_t kind = 0; kind < kinds; ++kind) {
    alone.push_back(ask(shared, kKinds[kind]));
    for (const auto& mine : answers)
      EXPECT_TRUE(mine[kind] == alone[kind]) << test::treeName(kKinds[kind]);
    EXPECT_EQ(ask(own, kKinds[kind]).verdicts(), alone[kind].verdicts())
        << test::treeName(kKinds[kind]);
  }
  return alone;
}

TEST(Threads, StillBodies) {
  for (const Answers& answers : expectOneAnswerOfEachKind(someBodies, askStill)) {
    EXPECT_GT(answers.count(true), 30);
    EXPECT_GT(answers.count(false), 30);
  }
}

/// Threads use the trees of bodies for the first time. All threads must get the same trees, at the
/// same addresses.
TEST(Threads, TreesAreBuiltOnce) {
  for (int round = 0; round < 20; ++round) {
    const std::vector<Body> bodies = someBodies();
    std::array<std::vector<const void*>, kThreads> seen;
    inThreads([&](int k) {
      for (const Body& body : bodies) {
        if (k % 2) seen[k].push_back(&body.tree().nodes()[0]);
        withVolume(TreeKind::obbBinary, [&]<class Volume, class Overlap>() {
          seen[k].push_back(body.volumeTree<Volume>().nodes().data());
        });
        if (k % 2 == 0) seen[k].insert(seen[k].end() - 1, &body.tree().nodes()[0]);
        if (body.isMesh()) seen[k].push_back(body.components().components.data());
        EXPECT_TRUE(body.treeBuilt());
      }
    });
    for (const auto& mine : seen) EXPECT_EQ(mine, seen[0]);
  }
}

/// Builds two trees at a time, each by several threads. Both must equal a tree built by one thread.
TEST(Threads, TreesBuiltByThreads) {
  std::mt19937_64 random(63);
  const TriangleMesh mesh = test::soup(random, 40'000, 0.02);
  const Obb4Tree alone(mesh);
  inThreads([&](int k) {
    if (k > 1) return;
    const Obb4Tree tree(mesh, ObbFit::triangles, 2 + k);
    ASSERT_EQ(tree.nodes().size(), alone.nodes().size());
    for (std::size_t i = 0; i < tree.nodes().size(); ++i)
      ASSERT_EQ(std::memcmp(&tree.nodes()[i], &alone.nodes()[i], sizeof(Obb4Tree::Node)), 0);
  });
}

/// Returns a scene in which two bodies move as one rigid body among fixed bodies.
RigidScene someScene() {
  std::vector<Body> moving, fixed;
  for (Body& body : someBodies())
    (body.name() == "blob" || body.name() == "cube" ? moving : fixed).push_back(std::move(body));
  return RigidScene(std::move(moving), std::move(fixed));
}

/// Runs motion queries of random edges on trees of one kind, and checks their certificates.
Answers askMoving(const RigidScene& scene, TreeKind trees) {
  std::mt19937_64 random(64);
  QueryContext context;
  Answers answers;
  MotionOptions options;
  options.tolerance = 1e-4;
  options.clearanceSlack = options.tolerance;
  options.trees = trees;
  for (int i = 0; i < 10; ++i) {
    auto [from, to] = test::randomEdge(random);
    if (i % 2) {  // half of the edges pass at a distance
      from.p[0] += 3;
      to.p[0] += 3;
    }
    options.earliest = i % 3 == 0;
    RigidEdge edge(RigidMotion::spatial(from, to, {.position = 1e-6, .rotation = 1e-6}));
    for (const EdgeMethod method :
         {EdgeMethod::certified, EdgeMethod::adaptive, EdgeMethod::advancement})
      answers.add(scene.scene().certify(edge, options, context, method));
    answers.add(scene.certifyState(from, options, context));
    answers.add(scene.certifyEdgePlanar({from.p[0], from.p[1], 0.1}, {to.p[0], to.p[1], 1}, options,
                                        context));
    const Transform X[] = {Transform(), RigidMotion::spatial(from, to, {}).at(0.5)};
    answers.addVerdict(scene.scene().interference(X, context, trees).has_value());
    answers.add(scene.scene().clearance(X, context, trees));
    for (const MotionResult& result : scene.scene().certifyEachPair(edge, options, context))
      answers.add(result);

    MotionCertificate certificate;
    const MotionResult result = scene.scene().certify(edge, options, context, certificate);
    answers.add(result);
    for (const FreeInterval& interval : certificate.free) {
      answers.add(interval.pair);
      answers.add(interval.t0);
      answers.add(interval.t1);
      answers.add(interval.clearance);
    }
    if (result.verdict != MotionVerdict::free) continue;
    const auto fault = checkCertificate(edge, scene.scene().motionPairs(), options,
                                        result.certifiedUntil, certificate, context);
    EXPECT_FALSE(fault);
  }
  answers.add(context.counters);
  return answers;
}

TEST(Threads, MovingBodies) {
  for (const Answers& answers : expectOneAnswerOfEachKind(someScene, askMoving)) {
    EXPECT_GT(answers.count(MotionVerdict::free), 10);
    EXPECT_GT(answers.count(MotionVerdict::contact), 10);
  }
}

/// A Collada file with one triangle.
const char* const kCollada = R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset/><library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0  1 0 0  0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/>
<param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles>
</mesh></geometry></library_geometries><library_visual_scenes><visual_scene id="s">
<node id="a"><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>
)";

/// The library creates some data when they are first used. Here all threads use these data for the
/// first time, at the same moment. This works because ctest starts each test in its own process.
TEST(Threads, FirstUse) {
  const std::filesystem::path folder = test::newFolder();
  std::ofstream(folder / "a.dae") << kCollada;
  std::array<std::string, kThreads> seen;
  inThreads([&](int k) {
    seen[k] = simdTarget();
    for (const VolumeKind& kind : volumeKinds()) seen[k] += kind.name;
    for (const std::string& method : edgeMethodNames()) seen[k] += method;
    const OmplAppMesh file = readOmplAppMesh(folder / "a.dae");  // starts the helper of assimp
    const Body body("", file.mesh);
    seen[k] += std::to_string(body.volumeTree<Kdop<18>>().nodes().size());
  });
  std::filesystem::remove_all(folder);
  for (const std::string& mine : seen) EXPECT_EQ(mine, seen[0]);
}

}  // namespace
}  // namespace corridor
