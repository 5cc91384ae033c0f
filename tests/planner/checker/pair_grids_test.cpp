// The grids of pairs of links: a marked cell is never wrong, and no verdict depends on a grid.
#include "planner/checker/pair_grids.h"

#include <array>
#include <cmath>
#include <fstream>
#include <memory>
#include <random>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "collision/core/file_cache.h"
#include "planner/checker/checker.h"
#include "planner/problem/problem.h"
#include "tests/planner/checker/cube_file.h"
#include "tests/support/support.h"

namespace corridor {

/// Gives tests access to the grids.
struct PairGridsAccess {
  static const auto& pairs(const PairGrids& grids) { return grids.pairs_; }
};

namespace {

using Random = std::mt19937_64;

/// Writes a problem: an arm whose last link can fold back onto its base, by two joints of which one
/// turns without limits.
std::filesystem::path writeFoldingArm(const std::filesystem::path& folder) {
  test::writeCube(folder);
  const auto link = [](const std::string& name, const std::string& at, const std::string& shape) {
    return "<link name='" + name + "'><collision><origin xyz='" + at +
           "' rpy='0.1 0.2 0'/><geometry>" + shape + "</geometry></collision></link>\n";
  };
  const auto box = [](const std::string& halves) {
    return "<mesh filename='cube.obj' scale='" + halves + "'/>";
  };
  const auto joint = [](const std::string& parent, const std::string& child,
                        const std::string& rest) {
    return "<joint name='to_" + child + "' " + rest + "<parent link='" + parent +
           "'/><child link='" + child + "'/></joint>\n";
  };
  std::ofstream(folder / "arm.urdf")
      << "<robot name='folding'>\n" +
             link("base", "0 0 0", "<cylinder radius='0.22' length='0.2'/>") +
             link("middle", "0 0 0.1", box("0.025 0.025 0.05")) +
             link("end", "0.3 0 0", box("0.25 0.05 0.03")) +
             joint("base", "middle",
                   "type='continuous'><origin xyz='0.05 0 0.15'/><axis xyz='0.1 0 1'/>") +
             joint("middle", "end",
                   "type='revolute'><origin xyz='0 0 0.15'/><axis xyz='0 1 0.05'/>"
                   "<limit lower='-2' upper='1.9' effort='1' velocity='1'/>") +
             "</robot>\n";
  std::ofstream(folder / "problem.yaml")
      << "format: corridor-problem-1\nrobot: arm.urdf\nworld: {post: {sphere: 0.1, at: [1, 1, "
         "1]}}\nstart: {to_middle: 0, to_end: -1}\ngoal: {to_middle: 1, to_end: -1}\n";
  return folder / "problem.yaml";
}

class PairGridsOf : public testing::TestWithParam<const char*> {
 protected:
  PairGridsOf() {
    problem_.model.cache = std::make_shared<FileCache>(folder_ / "cache", "code");
    const Checker checker(problem_);
    PairGrids::compute(problem_.model, checker.scene());
    problem_.model.cache->save();
  }
  ~PairGridsOf() override { std::filesystem::remove_all(folder_); }

  Configuration stateWithin(Random& random) const {
    Configuration q(static_cast<Eigen::Index>(problem_.model.space.size()));
    for (const Coordinate& c : problem_.model.space.coordinates()) {
      const bool line = c.kind == Coordinate::Kind::line;
      q[static_cast<Eigen::Index>(c.first)] =
          std::uniform_real_distribution(line ? c.lower : -3.1, line ? c.upper : 3.1)(random);
    }
    return q;
  }

  std::filesystem::path folder_ = test::newFolder();
  Problem problem_ = readProblem(std::string(GetParam()) == "folding"
                                     ? writeFoldingArm(folder_)
                                     : std::filesystem::path(CORRIDOR_SOURCE_DIR) / "problems" /
                                           GetParam() / "problem.yaml");
};
INSTANTIATE_TEST_SUITE_P(Problems, PairGridsOf,
                         testing::Values("arm_at_shelf", "two_arms", "folding"));

/// The distance at the corners of marked cells beside cells without a mark, where a mark is most
/// likely to be wrong. The tube belongs to the cell.
TEST_P(PairGridsOf, MarkedCellsKeepTheClearance) {
  const Checker checker(problem_);
  const PairGrids grids(problem_.model, checker.scene(), checker.tube());
  int tested = 0, outside = 0;
  for (const auto& pair : PairGridsAccess::pairs(grids))
    for (const PairGrid& grid : pair.grids) {
      const std::size_t axes = grid.axes().size();
      std::vector<double> within(checker.scene().pairs().size(), 0);
      within[pair.pair] = 2 * grid.clearance();
      const PairMargins search(within);
      const std::vector<std::uint32_t> only = {pair.pair};
      const auto distanceAt = [&](const Configuration& q) {
        const auto near = checker.pairsWithin(q, search, {&only, 1});
        return near.empty() ? HUGE_VAL : near.front().distance.distance;
      };
      const auto valuesAt = [&](std::array<double, 2> places) {
        Configuration q = problem_.task.start;
        for (std::size_t i = 0; i < axes; ++i)
          q[static_cast<Eigen::Index>(grid.axes()[i].number)] =
              grid.axes()[i].lower + places[i] * grid.axes()[i].cell;
        return q;
      };
      const std::int64_t rows = axes == 2 ? PairGrid::kSide : 1;
      for (std::int64_t r = 0; r < rows; ++r)
        for (std::int64_t c = 0; c + 1 < PairGrid::kSide; ++c) {
          const auto column = static_cast<double>(c), row = static_cast<double>(r);
          const bool isMarked = PairGrid::isMarked(grid.marks(), c, r);
          if (!isMarked)
            outside += distanceAt(valuesAt({column + 0.5, row + 0.5})) < grid.clearance();
          const bool isInside = PairGrid::isMarked(grid.marks(), c + 1, r) &&
                                (r + 1 == rows || PairGrid::isMarked(grid.marks(), c, r + 1));
          if (!isMarked || isInside) continue;
          for (const double x : {-PairGrid::kWidestTube, 1 + PairGrid::kWidestTube})
            for (const double y : {-PairGrid::kWidestTube, 1 + PairGrid::kWidestTube}) {
              // Distances are computed with a relative error of 1e-3.
              EXPECT_GE(distanceAt(valuesAt({column + x, row + y})), grid.clearance() * (1 - 2e-3));
              ++tested;
            }
        }
    }
  if (std::string(GetParam()) != "folding") return;  // in the others, no pair comes this close
  EXPECT_GT(tested, 100);
  EXPECT_GT(outside, 100) << "the marks end where the clearance ends";
}

TEST_P(PairGridsOf, ChangeNoVerdict) {
  Problem plain = problem_;
  plain.model.cache = nullptr;
  const Checker checker(problem_), without(plain);
  const PairGrids grids(problem_.model, checker.scene(), checker.tube());
  ASSERT_FALSE(grids.empty());
  EXPECT_TRUE(PairGrids(plain.model, without.scene(), without.tube()).empty());
  const PairMargins margins(std::vector(checker.scene().pairs().size(), 0.005));
  MotionOptions options = checker.options();
  Random random(test::testSeed(94));
  std::vector<std::uint8_t> proved;
  std::size_t all = 0;
  for (int n = 0; n < test::casesOf(400, 20'000); ++n) {
    const Configuration from = stateWithin(random);
    const double part = std::array{0.0, 0.02, 0.3, 1.0}[static_cast<std::size_t>(n % 4)];
    const Configuration to = from + part * (stateWithin(random) - from);
    const MotionResult result = checker.certifyEdge(from, to),
                       plainly = without.certifyEdge(from, to);
    EXPECT_EQ(result.verdict, plainly.verdict);
    EXPECT_EQ(result.time, plainly.time);
    EXPECT_EQ(checker.certifyEdge(from, to, {.margins = &margins}).verdict,
              without.certifyEdge(from, to, {.margins = &margins}).verdict);
    options.pairMargins = n % 2 ? &margins : nullptr;
    grids.prove(from, to, options, proved);
    // What a grid proves, the trees prove, too.
    const std::vector<Checker::PairNotFree> notFree = without.pairsNotFree(from);
    for (std::size_t k = 0; k < proved.size(); ++k) {
      all += proved[k];
      if (!proved[k]) continue;
      const Scene::Pair& pair = checker.scene().pairs()[k];
      for (const Checker::PairNotFree& other : notFree)
        EXPECT_FALSE(other.a == checker.bodyOf(pair.a) && other.b == checker.bodyOf(pair.b));
    }
  }
  EXPECT_GT(all, std::string(GetParam()) == "folding" ? 50u : 400u);
}

std::size_t gridsFoundOf(const Model& model) {
  const Checker checker(model);
  return PairGridsAccess::pairs(PairGrids(model, checker.scene(), checker.tube())).size();
}

TEST_P(PairGridsOf, BelongToTheBodies) {
  ASSERT_GT(gridsFoundOf(problem_.model), 0u);
  const auto changed = [&](const auto& change) {
    Model model = problem_.model;
    for (ModelBody& body : model.bodies) {
      if (!body.robot) continue;
      for (PlacedShape& shape : body.shapes) {
        MeshFile mesh = shape.mesh ? *shape.mesh : MeshFile();
        change(shape, mesh.mesh);
        if (shape.mesh) shape.mesh = std::make_shared<const MeshFile>(std::move(mesh));
      }
    }
    return gridsFoundOf(model);
  };
  EXPECT_EQ(changed([](PlacedShape&, TriangleMesh&) {}), gridsFoundOf(problem_.model));
  EXPECT_EQ(changed([](PlacedShape& shape, TriangleMesh& mesh) {
              double& x =
                  shape.mesh ? mesh.vertices.front().x() : shape.parts.front().points.front().x();
              x = std::nextafter(x, 10);
            }),
            0u);
  EXPECT_EQ(changed([](PlacedShape& shape, TriangleMesh& mesh) {
              if (shape.mesh) std::swap(mesh.triangles.front(), mesh.triangles.back());
            }),
            0u);
  if (std::string(GetParam()) != "folding") return;  // there, one of the bodies is a cylinder
  EXPECT_EQ(changed([](PlacedShape& shape, TriangleMesh&) {
              if (!shape.mesh) shape.parts.front().radius *= 1.1;
            }),
            0u);
  EXPECT_EQ(changed([](PlacedShape& shape, TriangleMesh&) {
              if (!shape.mesh) shape.parts.front().flatEnds = false;
            }),
            0u);
  EXPECT_EQ(changed([](PlacedShape& shape, TriangleMesh&) {
              if (shape.mesh) shape.solid = true;
            }),
            0u)
      << "a body may be inside a solid mesh";
}

/// The only pair with a grid depends on each of these.
TEST(PairGrids, BelongToTheFramesAndLimits) {
  const std::filesystem::path folder = test::newFolder();
  const Problem problem = readProblem(writeFoldingArm(folder));
  Model model = problem.model;
  model.cache = std::make_shared<FileCache>(folder / "cache", "code");
  {
    const Checker checker(model);
    PairGrids::compute(model, checker.scene());
    model.cache->save();
  }
  ASSERT_EQ(gridsFoundOf(model), 1u);
  const auto changed = [&](const auto& change) {
    std::size_t most = 0;
    for (std::size_t f = 1; f < model.tree.frames.size(); ++f) {
      if (!model.tree.frames[f].moves()) continue;
      Model other = model;
      change(other.tree.frames[f]);
      most = std::max(most, gridsFoundOf(other));
    }
    return most;
  };
  EXPECT_EQ(changed([](Frame&) {}), 1u);
  EXPECT_EQ(changed([](Frame& f) { f.fixed.p.x() = std::nextafter(f.fixed.p.x(), 10); }), 0u);
  EXPECT_EQ(changed([](Frame& f) { f.fixed.q.x() += 1e-15; }), 0u);
  EXPECT_EQ(changed([](Frame& f) { f.axis.x() = std::nextafter(f.axis.x(), 10); }), 0u);
  EXPECT_EQ(changed([](Frame& f) { f.joint = Frame::Joint::prismatic; }), 0u);
  EXPECT_EQ(changed([](Frame& f) { f.multiplier = -1; }), 0u);
  EXPECT_EQ(changed([](Frame& f) { f.offset = 1e-15; }), 0u);
  EXPECT_EQ(changed([](Frame& f) { f.variable = 1 - f.variable; }), 0u) << "one joint, twice";
  Model exchanged = model;  // each joint is moved by the other one's number
  for (Frame& frame : exchanged.tree.frames)
    if (frame.moves()) frame.variable = 1 - frame.variable;
  EXPECT_EQ(gridsFoundOf(exchanged), 0u);

  // Of three frames and two numbers, the third is moved by the first number, or by the second.
  std::vector<std::size_t> moving;
  for (std::size_t f = 1; f < model.tree.frames.size(); ++f)
    if (model.tree.frames[f].moves()) moving.push_back(f);
  ASSERT_EQ(moving.size(), 2u);
  Model three = model;
  Frame third = three.tree.frames[moving[1]];
  third.parent = moving[1];
  const std::size_t tip = three.tree.add(third);
  for (ModelBody& body : three.bodies)
    if (body.frame == moving[1]) body.frame = tip;
  {
    const Checker checker(three);
    PairGrids::compute(three, checker.scene());
    three.cache->save();
  }
  ASSERT_EQ(gridsFoundOf(three), 1u);
  three.tree.frames[tip].variable = 1 - third.variable;
  EXPECT_EQ(gridsFoundOf(three), 0u);

  const auto withLimits = [&](double lower, double upper) {
    Model other = model;
    other.space = ConfigurationSpace();
    CoordinateGroup group = model.space.groups().front();
    for (Coordinate c : model.space.coordinates()) {
      if (c.kind == Coordinate::Kind::line) c.lower = lower, c.upper = upper;
      other.space.add(c);
    }
    other.space.addGroup(group);
    return gridsFoundOf(other);
  };
  EXPECT_EQ(withLimits(-2, 1.9), 1u);
  EXPECT_EQ(withLimits(-2, std::nextafter(1.9, 9)), 0u);
  EXPECT_EQ(withLimits(std::nextafter(-2.0, 9), 1.9), 0u);
  std::filesystem::remove_all(folder);
}

TEST_P(PairGridsOf, AWideTubeUsesNoGrid) {
  const Checker checker(problem_);
  const auto size = static_cast<Eigen::Index>(problem_.model.space.size());
  EXPECT_FALSE(
      PairGrids(problem_.model, checker.scene(), Configuration::Constant(size, 1e-5)).empty());
  EXPECT_TRUE(
      PairGrids(problem_.model, checker.scene(), Configuration::Constant(size, 0.01)).empty());
}

}  // namespace
}  // namespace corridor
