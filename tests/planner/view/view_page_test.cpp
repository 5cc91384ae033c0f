// Tests that a page shows the problem correctly: meshes, poses on Corridor's own edges, distances,
// boxes and findings, whatever names occur.
#include "planner/view/view_page.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "planner/checker/checker.h"
#include "planner/model/model_builder.h"
#include "planner/view/path_samples.h"
#include "planner/view/tessellate.h"
#include "tests/planner/problem/problem_fixture.h"
#include "tests/planner/view/page_reader.h"

namespace corridor {
namespace {

using test::PageReader;
using view::PathSample;
using view::PathSamples;
using view::samplePath;

Problem ownProblem(const std::string& name) {
  return readProblem(std::string(CORRIDOR_SOURCE_DIR "/problems/") + name);
}

/// Returns a path and the verifier's report on it.
ViewedPath viewed(const Problem& problem, const Path& path) {
  ViewedPath result;
  result.solution.path = path;
  result.solution.planner = "by hand";
  result.report = verifySolution(problem, result.solution);
  return result;
}

/// Returns a straight path from start to goal, with one more state on it.
Path straight(const Problem& problem) {
  return {problem.task.start,
          problem.model.space.interpolate(problem.task.start, problem.task.goals.at(0), 0.4),
          problem.task.goals.at(0)};
}

Vec3 vectorOf(const nlohmann::json& j) {
  return {j.at(0).get<double>(), j.at(1).get<double>(), j.at(2).get<double>()};
}

/// Returns a bound of the rounding to float, for lengths up to `size`.
double rounding(double size) {
  return 0x1p-22 * size + 1e-12;
}

Transform poseAt(const std::vector<double>& poses, std::size_t i, const Vec3& origin) {
  const double* p = poses.data() + 7 * i;
  const Eigen::Quaterniond q(p[6], p[3], p[4], p[5]);
  return {q.normalized().toRotationMatrix(), Vec3(p[0], p[1], p[2]) + origin};
}

void expectSamePose(const Transform& shown, const Transform& real, double size) {
  EXPECT_LT((shown.t - real.t).norm(), rounding(size + real.t.norm()));
  EXPECT_LT((shown.m - real.m).norm(), 1e-6);
}

TEST(ViewPage, MeshesAreThoseOfTheProblem) {
  for (const char* name : {"two_arms", "piano", "gantry_bins"}) {
    const Problem problem = ownProblem(name);
    const PageReader page(viewPage(problem, std::nullopt));
    ASSERT_EQ(page.json["bodies"].size(), problem.model.bodies.size());
    for (std::size_t b = 0; b < problem.model.bodies.size(); ++b) {
      const auto& body = page.json["bodies"][b];
      EXPECT_EQ(body["name"], problem.model.bodies[b].name);
      EXPECT_EQ(body["frame"] == -1, problem.model.bodies[b].frame == 0);
      const auto& mesh = page.json["meshes"][body["mesh"].get<std::size_t>()];
      const Vec3 origin = vectorOf(mesh["origin"]);
      const auto positions = page.array<float>(mesh["positions"]);
      const auto indices = page.array<std::uint32_t>(mesh["indices"]);
      for (const std::uint32_t index : indices) ASSERT_LT(index, positions.size() / 3);
      std::size_t vertex = 0, corner = 0;
      for (const PlacedShape& shape : problem.model.bodies[b].shapes) {
        if (!shape.mesh) break;  // curved shapes are tessellated
        const std::size_t first = vertex;
        for (const Vec3& p : shape.mesh->mesh.vertices) {
          for (int i = 0; i < 3; ++i)
            ASSERT_EQ(positions.at(3 * vertex + i), static_cast<float>(p[i] - origin[i]));
          ++vertex;
        }
        for (const auto& triangle : shape.mesh->mesh.triangles)
          for (const std::uint32_t v : triangle) ASSERT_EQ(indices.at(corner++), first + v);
      }
      EXPECT_EQ(corner, problem.model.bodies[b].shapes[0].mesh ? indices.size() : 0);
      EXPECT_GT(indices.size(), 0U);
    }
  }
  const PageReader arms(viewPage(ownProblem("two_arms"), std::nullopt));
  EXPECT_LE(arms.json["meshes"].size() + 7, arms.json["bodies"].size()) << "two arms of one kind";
}

/// An obstacle on a frame of its own, which shares its mesh, is shown as an obstacle.
TEST(ViewPage, ObstaclesOnFramesStandStill) {
  Problem problem = ownProblem("piano");
  const PageReader before(viewPage(problem, std::nullopt));
  const std::size_t robots = before.array<float>(before.json["start"]).size();
  std::size_t obstacle = 0;
  while (problem.model.bodies.at(obstacle).robot) ++obstacle;
  const RigidPose at{Vec3(1, 2, 3), Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5)};
  problem.model.bodies[obstacle].frame = problem.model.tree.add({.name = "own", .fixed = at});
  const PageReader page(viewPage(problem, std::nullopt));
  const auto& body = page.json["bodies"][obstacle];
  EXPECT_EQ(body["frame"], -1);
  EXPECT_EQ(page.array<float>(page.json["start"]).size(), robots) << "poses are of the robots only";
  const auto pose = body["pose"].get<std::vector<double>>();
  ASSERT_EQ(pose.size(), 7u);
  expectSamePose(poseAt(pose, 0, vectorOf(page.json["origin"])), {rotationMatrix(at.q), at.p}, 10);
  for (std::size_t b = 0; b < problem.model.bodies.size(); ++b)
    EXPECT_EQ(page.json["bodies"][b].contains("pose"), b == obstacle);
}

/// Floats are coarse far from the origin, so positions must be relative to a point near by.
TEST(ViewPage, FarFromTheOriginNoPrecisionIsLost) {
  Problem problem = ownProblem("piano");
  const Vec3 far(3e6, -2e6, 1e5);
  for (ModelBody& body : problem.model.bodies)
    if (body.frame == 0)
      for (PlacedShape& shape : body.shapes) {
        TriangleMesh moved = shape.mesh->mesh;
        for (Vec3& p : moved.vertices) p += far;
        shape = shapeOf(shape.name, std::move(moved));
      }
  problem.task.start.head<3>() += far;
  for (Configuration& goal : problem.task.goals) goal.head<3>() += far;
  const PageReader page(viewPage(problem, std::nullopt));
  const Vec3 origin = vectorOf(page.json["origin"]);
  for (std::size_t b = 0; b < problem.model.bodies.size(); ++b) {
    const ModelBody& body = problem.model.bodies[b];
    const auto& mesh = page.json["meshes"][page.json["bodies"][b]["mesh"].get<std::size_t>()];
    const auto positions = page.array<double>(mesh["positions"]);
    for (std::size_t v = 0; v < positions.size() / 3; ++v) {
      const Vec3 shown = vectorOf(mesh["origin"]) +
                         Vec3(positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]);
      ASSERT_LT((shown - body.shapes[0].mesh->mesh.vertices[v]).norm(), 1e-6) << body.name;
    }
  }
  const Transform start = poseAt(page.array<double>(page.json["start"]), 0, origin);
  EXPECT_LT((start.t - problem.task.start.head<3>()).norm(), 1e-6);
}

TEST(ViewPage, PosesAreThoseOfCorridorsEdges) {
  for (const char* name : {"two_arms", "piano", "hook_maze", "rover_door"}) {
    SCOPED_TRACE(name);
    const Problem problem = ownProblem(name);
    const Path path = straight(problem);
    const PageReader page(viewPage(problem, viewed(problem, path)));
    const Vec3 origin = vectorOf(page.json["origin"]);
    std::set<std::size_t> frames;
    for (const ModelBody& body : problem.model.bodies)
      if (body.frame != 0) frames.insert(body.frame);
    const auto& json = page.json["path"];
    const auto poses = page.array<double>(json["poses"]), t = page.array<double>(json["t"]),
               at = page.array<double>(json["at"]);
    const auto edge = page.array<std::size_t>(json["edge"]);
    ASSERT_EQ(poses.size(), 7 * frames.size() * t.size());
    const std::vector<std::size_t> states = json["states"];
    ASSERT_EQ(states.size(), path.size());
    EXPECT_EQ(states.back(), t.size() - 1);
    EXPECT_EQ(at.front(), 0);
    EXPECT_EQ(at.back(), 1);
    for (std::size_t i = 0; i < t.size(); ++i) {
      ASSERT_GE(at[i], i > 0 ? at[i - 1] : 0);
      // The page's t is a float, while its pose was computed for the double.
      const std::vector<Transform> real =
          framePoses(problem.model.tree,
                     problem.model.space.interpolate(path[edge[i]], path[edge[i] + 1], t[i]));
      std::size_t k = 0;
      for (const std::size_t frame : frames)
        expectSamePose(poseAt(poses, i * frames.size() + k++, origin), real[frame], 10);
    }
    for (std::size_t s = 0; s < states.size(); ++s) {
      const std::vector<Transform> real = framePoses(problem.model.tree, path[s]);
      std::size_t k = 0;
      for (const std::size_t frame : frames)
        expectSamePose(poseAt(poses, states[s] * frames.size() + k++, origin), real[frame], 10);
    }
  }
}

TEST(ViewPage, SamplesAreDenseEnoughForStraightLines) {
  for (const char* name : {"two_arms", "piano", "snake_posts"}) {
    SCOPED_TRACE(name);
    const Problem problem = ownProblem(name);
    const Path path = straight(problem);
    const PathSamples samples = samplePath(problem, path, {});
    EXPECT_LE(samples.samples.size(), 1600U);
    for (std::size_t i = 1; i < samples.samples.size(); ++i) {
      const auto &from = samples.samples[i - 1].X_WF, &to = samples.samples[i].X_WF;
      for (std::size_t f = 0; f < from.size(); ++f)
        EXPECT_LT(Eigen::Quaterniond(from[f].m).angularDistance(Eigen::Quaterniond(to[f].m)),
                  4.0 * M_PI / 180);
    }
  }
}

TEST(ViewPage, DistancesAreThoseOfTheChecker) {
  for (const char* name : {"two_arms", "cubicles"}) {
    SCOPED_TRACE(name);
    const Problem problem = ownProblem(name);
    const Checker checker(problem);
    const Path path = straight(problem);
    const PageReader page(viewPage(problem, viewed(problem, path)));
    const auto& json = page.json["distances"];
    const auto sample = page.array<std::size_t>(json["sample"]),
               bodies = page.array<std::size_t>(json["bodies"]);
    const auto metres = page.array<double>(json["metres"]),
               points = page.array<double>(json["points"]);
    const PathSamples samples =
        samplePath(problem, path, viewed(problem, path).report.pathReport.findings);
    ASSERT_GT(sample.size(), 20U);
    bool contact = false, apart = false;
    for (std::size_t i = 0; i < sample.size(); ++i) {
      const PathSample& place = samples.samples[sample[i]];
      const Configuration q =
          problem.model.space.interpolate(path[place.edge], path[place.edge + 1], place.t);
      EXPECT_EQ(metres[i], static_cast<float>(checker.clearance(q) + problem.task.margin));
      EXPECT_EQ(metres[i] == 0, checker.interference(q).has_value());
      (metres[i] == 0 ? contact : apart) = true;
      const Vec3 a(points[6 * i], points[6 * i + 1], points[6 * i + 2]),
          b(points[6 * i + 3], points[6 * i + 4], points[6 * i + 5]);
      EXPECT_NEAR((a - b).norm(), metres[i], rounding(20));
      bool tested = false;
      forEachTestedPair(
          problem.model, requiredBy(problem.task), [&](std::size_t one, std::size_t other) {
            tested = tested || std::set<std::size_t>{one, other} ==
                                   std::set<std::size_t>{bodies[2 * i], bodies[2 * i + 1]};
          });
      EXPECT_TRUE(tested);
    }
    EXPECT_TRUE(contact && apart) << "the straight path shows both";
  }
}

TEST(ViewPage, FindingsHaveTheirPlaces) {
  const Problem problem = ownProblem("thin_plate");
  const Path path = straight(problem);
  const ViewedPath refuted = viewed(problem, path);
  ASSERT_EQ(refuted.report.verdict, PathVerdict::refuted);
  const PageReader page(viewPage(problem, refuted));
  EXPECT_EQ(page.json["verdict"]["verdict"], "refuted");
  const auto& findings = page.json["verdict"]["findings"];
  ASSERT_EQ(findings.size(), refuted.report.pathReport.findings.size());
  ASSERT_GE(findings.size(), 1U);
  const auto t = page.array<double>(page.json["path"]["t"]);
  const auto edge = page.array<int>(page.json["path"]["edge"]);
  for (std::size_t i = 0; i < findings.size(); ++i) {
    const PathFinding& real = refuted.report.pathReport.findings[i];
    const std::size_t sample = page.json["path"]["findings"][i];
    if (real.t > 0) {
      EXPECT_EQ(edge[sample], real.edge);
    }
    EXPECT_EQ(t[sample], static_cast<float>(real.t));
    const std::set<std::string> pair = {
        problem.model.bodies[findings[i]["a"].get<std::size_t>()].name,
        problem.model.bodies[findings[i]["b"].get<std::size_t>()].name};
    EXPECT_EQ(pair, (std::set<std::string>{real.a, real.b}));
    EXPECT_LT((vectorOf(findings[i]["point"]) + vectorOf(page.json["origin"]) - real.point).norm(),
              1e-12);
  }
}

/// On each level of the tree, every vertex of the mesh must be in a box of this level, or in a leaf
/// of a higher level.
TEST(ViewPage, BoxesHoldTheirMeshOnEveryLevel) {
  const Problem problem = ownProblem("piano");
  const PageReader page(viewPage(problem, std::nullopt));
  std::size_t levels = 0;
  for (const auto& tree : page.json["trees"]) {
    const auto& mesh = page.json["meshes"][tree["mesh"].get<std::size_t>()];
    const auto positions = page.array<double>(mesh["positions"]);
    ASSERT_EQ(tree["shapes"].size(), 1U);
    const auto& shape = tree["shapes"][0];
    const auto boxes = page.array<double>(shape["boxes"]);
    const auto leaves = page.array<int>(shape["leaves"]);
    const std::vector<std::size_t> counts = shape["counts"];
    ASSERT_EQ(counts[0], 1U);
    ASSERT_EQ(boxes.size(), 10 * leaves.size());
    levels = std::max(levels, counts.size());
    for (std::size_t level = 0; level < counts.size(); ++level)
      for (std::size_t v = 0; v < positions.size(); v += 3) {
        const Vec3 p(positions[v], positions[v + 1], positions[v + 2]);
        bool held = false;
        for (std::size_t at = 0, box = 0; at <= level; ++at)
          for (std::size_t i = 0; i < counts[at]; ++i, ++box) {
            if (at < level && !leaves[box]) continue;
            const double* b = boxes.data() + 10 * box;
            const Eigen::Quaterniond q(b[6], b[3], b[4], b[5]);
            const Vec3 x = q.conjugate() * (p - Vec3(b[0], b[1], b[2]));
            held = held || (x.cwiseAbs() - Vec3(b[7], b[8], b[9])).maxCoeff() < 1e-5;
          }
        ASSERT_TRUE(held) << "level " << level;
      }
  }
  EXPECT_GE(levels, 4U);
}

TEST(ViewPage, ExcludedPairsAreReported) {
  const Problem problem = ownProblem("arm_at_shelf");
  const PageReader page(viewPage(problem, std::nullopt));
  std::size_t skipped = 0, tested = 0;
  const Required need = requiredBy(problem.task);
  forEachPair(problem.model, need, [&](std::size_t, std::size_t, std::string_view why) {
    ++(why.empty() ? tested : skipped);
  });
  ASSERT_GT(skipped, 0U);
  EXPECT_EQ(page.json["pairs"]["tested"], tested);
  for (const auto& group : page.json["pairs"]["skipped"]) {
    const auto list = page.array<std::size_t>(group["pairs"]);
    for (std::size_t i = 0; i < list.size(); i += 2) {
      --skipped;
      EXPECT_LT(list[i], list[i + 1]);
      EXPECT_EQ(problem.model.filter.whyNotTested(list[i], list[i + 1], need),
                group["reason"].get<std::string>());
    }
  }
  EXPECT_EQ(skipped, 0U);
}

TEST(ViewPage, PlanarMotionIsSeenFromAbove) {
  for (const auto& [name, planar] :
       std::initializer_list<std::pair<const char*, bool>>{{"hook_maze", true},
                                                           {"snake_posts", true},
                                                           {"piano", false},
                                                           {"two_arms", false},
                                                           {"rover_door", false},
                                                           {"gantry_bins", false}})
    EXPECT_EQ(PageReader(viewPage(ownProblem(name), std::nullopt)).json["planar"], planar) << name;
}

TEST(ViewPage, SameInputGivesTheSameBytes) {
  const Problem problem = ownProblem("two_arms");
  const ViewedPath path = viewed(problem, straight(problem));
  EXPECT_TRUE(viewPage(problem, path) == viewPage(problem, path));
}

TEST(ViewPage, NamesPairsThatAreNotProved) {
  Problem problem = ownProblem("two_arms");
  problem.task.margin = 5;
  const PageReader page(viewPage(problem, std::nullopt));
  EXPECT_THAT(page.json["notes"][0].get<std::string>(),
              testing::StartsWith("in every state, these bodies are closer than the margin: "));
}

TEST(ViewPage, OneStateIsAPath) {
  const Problem problem = ownProblem("piano");
  const PageReader page(viewPage(problem, viewed(problem, {problem.task.start})));
  EXPECT_EQ(page.json["path"]["states"], nlohmann::json::array({0}));
}

using HostileNames = test::ProblemTest;

TEST_F(HostileNames, AreShownAsText) {
  const std::string name = "</script><img src=x onerror=alert(1)>\\\"'&{{data}}";
  Problem problem = read(head + poses);
  problem.source.name = name;
  problem.model.bodies[0].name = name;
  problem.model.bodies[1].name = "\xff not UTF-8 \x80";
  problem.source.notes.push_back({"<!-- <script>"});
  const std::string page = viewPage(problem, viewed(problem, straight(problem)));
  EXPECT_EQ(page.find("<img"), std::string::npos);
  EXPECT_EQ(page.find("<!-- <script>"), std::string::npos);
  const PageReader reader(page);
  EXPECT_EQ(reader.json["name"], name);
  EXPECT_EQ(reader.json["bodies"][0]["name"], name);
  const std::string replaced = reader.json["bodies"][1]["name"];
  EXPECT_NE(replaced.find(" not UTF-8 "), std::string::npos);
  EXPECT_NE(page.find("<title>&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;\\&quot;&#39;&amp;"),
            std::string::npos);
}

/// The page shows only some balls of a large cloud, and has a note on it.
TEST(ViewPage, SaysThatACloudIsThinned) {
  Problem problem = ownProblem("two_arms");
  const auto body = std::find_if(
      problem.model.bodies.begin(), problem.model.bodies.end(),
      [](const ModelBody& b) { return !b.shapes.empty() && !b.shapes[0].parts.empty(); });
  ASSERT_NE(body, problem.model.bodies.end());
  std::vector<ConvexPart>& parts = body->shapes[0].parts;
  parts.resize(view::kMostParts + 1, parts.front());
  const PageReader page(viewPage(problem, std::nullopt));
  EXPECT_THAT(page.json["notes"].dump(),
              testing::HasSubstr("this page shows some of its 20001 parts, evenly chosen"));
}

}  // namespace
}  // namespace corridor
