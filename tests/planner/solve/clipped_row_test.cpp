// Tests with trajectory files of arms. A single row is moved so that the curve penetrates an
// obstacle by 10^-6 m, for about a millisecond. The verifier must refute the file, at that time and
// for that pair of bodies. If the same row is moved so that a distance of 10^-6 m remains, the
// verifier must prove the file.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <optional>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "planner/solve/make_trajectory.h"
#include "planner/solve/verify_solution.h"
#include "planner/trajectory/trajectory_text.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using ClipRandom = std::mt19937_64;

Configuration randomStep(const Configuration& from, double length, ClipRandom& random) {
  std::normal_distribution<double> normal;
  Configuration direction(from.size());
  for (double& d : direction) d = normal(random);
  return from + direction.normalized() * length;
}

/// A trajectory file of a problem, and one row of this file, which can be moved.
class ClippedRow {
 public:
  ClippedRow(const Problem& problem, const Checker& checker, TrajectoryRows rows, std::size_t row,
             Configuration direction)
      : problem_(problem),
        checker_(checker),
        rows_(std::move(rows)),
        row_(row),
        direction_(std::move(direction)) {}

  /// Writes a file in which the row is moved by `by`, and returns the rows that are read from it.
  TrajectoryRows moved(double by) const {
    TrajectoryRows rows = rows_;
    rows.rows[row_].positions += by * direction_;
    const std::string text = csvText(rows, problem_.model);
    return readTrajectory("clip.csv", text, problem_.model);
  }
  /// A contact on one of the two pieces beside the row.
  struct Touch {
    std::size_t piece = 0;
    double tau = 0;
  };
  /// Returns the first contact beside the row, or nullopt.
  std::optional<Touch> touchOf(double by) const {
    const Curve curve = curveOf(moved(by), problem_.model.space, RowInterpolation::cubic);
    for (std::size_t k = row_ - 1; k <= row_; ++k) {
      const MotionResult r = checker_.certifyCurve(curve.pieces[k]);
      if (r.verdict == MotionVerdict::contact) return Touch{k, r.time};
    }
    return std::nullopt;
  }
  /// Finds the smallest move of the row, up to 2.5 rad, with a contact beside the row, by
  /// bisection. Returns false if there is none.
  bool findTouch() {
    double high = 0.05;
    while (high <= 2.5 && !touchOf(high)) high *= 1.4;
    if (high > 2.5) return false;
    double low = 0;
    for (int i = 0; i < 45; ++i) {
      const double middle = (low + high) / 2;
      (touchOf(middle) ? high : low) = middle;
    }
    by_ = high;
    return true;
  }
  double by() const { return by_; }
  std::size_t row() const { return row_; }

 private:
  const Problem& problem_;
  const Checker& checker_;
  TrajectoryRows rows_;
  std::size_t row_;
  Configuration direction_;
  double by_ = 0;
};

struct ClipCounts {
  int cases = 0;
  double shortest = HUGE_VAL, longest = 0;  // seconds in contact
};

/// Tests two files: in one, the row is moved until a distance of 10^-6 m remains; in the other,
/// until the bodies overlap by 10^-6 m. Returns early if the case does not fit.
void testClip(const Problem& problem, const Checker& checker, ClippedRow& clip,
              ClipCounts& counts) {
  const auto touch = clip.touchOf(clip.by());
  ASSERT_TRUE(touch);
  const ConfigurationSpace& space = problem.model.space;
  // At the point of the curve where the bodies touch, the distance grows by `slope` metres per
  // radian that the row is moved back.
  const double back = 1e-4;
  const Curve before = curveOf(clip.moved(clip.by() - back), space, RowInterpolation::cubic);
  const double slope =
      checker.clearance(configurationAt(space, before.pieces[touch->piece], touch->tau)) / back;
  if (!(slope > 1e-2)) return;  // moving the row mostly slides one body along the other

  const TrajectoryRows apart = clip.moved(clip.by() - 1e-6 / slope);
  EXPECT_EQ(verifyTrajectory(problem, apart).pathReport.verdict, PathVerdict::proved);

  const TrajectoryRows rows = clip.moved(clip.by() + 1e-6 / slope);
  const Curve curve = curveOf(rows, space, RowInterpolation::cubic);
  const auto timeOf = [&](std::size_t piece, double tau) {
    return curve.knots[piece] + tau * (curve.knots[piece + 1] - curve.knots[piece]);
  };
  const auto contactAt = [&](double time) {
    const auto next = std::upper_bound(curve.knots.begin(), curve.knots.end(), time);
    const auto k = std::min<std::size_t>(
        static_cast<std::size_t>(std::max<std::ptrdiff_t>(next - curve.knots.begin() - 1, 0)),
        curve.pieces.size() - 1);
    const double tau = (time - curve.knots[k]) / (curve.knots[k + 1] - curve.knots[k]);
    return checker.interference(configurationAt(space, curve.pieces[k], tau));
  };
  const double middle = timeOf(touch->piece, touch->tau);
  const auto contact = contactAt(middle);
  // Without one, the contact is not at `middle`: moving the row shifts it quickly along the curve.
  if (!contact) return;
  // Finds an end of the time in contact by bisection.
  const auto endOf = [&](double direction) {
    double in = middle, out = middle + direction * 0.05;
    for (int i = 0; i < 40; ++i) ((contactAt((in + out) / 2) ? in : out)) = (in + out) / 2;
    return in;
  };
  const double begin = endOf(-1), end = endOf(1);
  // A much longer or shorter contact occurs if the robot passes the row at an unusual speed; leave
  // such cases out.
  if (!(end - begin > 1e-4 && end - begin < 1e-2)) return;

  const VerifyReport report = verifyTrajectory(problem, rows);
  ASSERT_EQ(report.pathReport.verdict, PathVerdict::refuted);
  const PathFinding& finding = report.pathReport.findings.front();
  ASSERT_TRUE(finding.freeUntil);
  const auto edge = static_cast<std::size_t>(finding.edge);
  const double time = timeOf(edge, finding.t), freeUntil = timeOf(edge, *finding.freeUntil);
  // The verifier's tolerance is 10^-8 m or less, a hundredth of the depth. An error of this size
  // shifts the begin and the end of the contact by less than a hundredth of the contact's duration.
  // The bracket of the first contact is as short as the time in which the robot moves by the
  // tolerance.
  const double within = (end - begin) / 100;
  EXPECT_GE(time, begin - within);
  EXPECT_LE(time, end + within);
  EXPECT_LE(freeUntil, begin + within);
  EXPECT_GE(freeUntil, begin - 1e-4);
  const auto nameOfBody = [&](std::size_t shape) {
    return problem.model.bodies[checker.bodyOf(shape)].name;
  };
  const std::set<std::string> pair{nameOfBody(contact->bodyA), nameOfBody(contact->bodyB)};
  EXPECT_EQ(pair, (std::set{finding.a, finding.b}));
  ++counts.cases;
  counts.shortest = std::min(counts.shortest, end - begin);
  counts.longest = std::max(counts.longest, end - begin);
}

/// Makes trajectories along free edges near the start, and moves one row of each.
void testProblem(Problem problem, std::uint64_t seed, int wanted, ClipCounts& counts) {
  problem.task.margin = 0;
  problem.task.limits.velocity *= 0.1;  // so that the trajectory has some rows
  ClipRandom random(seed);
  CheckerOptions fine = checkerOptions(problem.task, problem.settings.checker);
  fine.tolerance = 1e-9;  // so that contacts are found to 1e-9 m
  const Checker checker(problem.model, fine);
  // 1 row per second: a row that is moved by 1 rad needs only 6 rad/s².
  problem.settings.trajectory.rate = 1;
  const int before = counts.cases;
  for (int attempt = 0; attempt < 100 && counts.cases < before + wanted; ++attempt) {
    const Configuration& from = problem.task.start;
    const Path path{from, randomStep(from, 0.4, random)};
    if (!checker.inBounds(path[1]) || !checker.isProvedFree(path[0], path[1])) continue;
    const MadeTrajectory made = makeTrajectory(problem, checker, path);
    ASSERT_TRUE(made.proved()) << made.fault;
    const TrajectoryRows rows = readTrajectory("made.csv", made.text, problem.model);
    const std::size_t row = rows.rows.size() / 2;
    // The row is moved along one of the four joints next to the base, in one of its two directions.
    Configuration direction = Configuration::Zero(from.size());
    direction[static_cast<Eigen::Index>(random() % 4)] = random() % 2 ? 1 : -1;
    ClippedRow clip(problem, checker, rows, row, direction);
    if (clip.findTouch()) testClip(problem, checker, clip, counts);
  }
  EXPECT_EQ(counts.cases, before + wanted);
}

void print(const ClipCounts& counts) {
  std::cout << counts.cases << " files, in contact for " << 1e3 * counts.shortest << " to "
            << 1e3 * counts.longest << " ms\n";
}

TEST(ClippedRow, IsRefutedForAnArmAtAShelf) {
  ClipCounts counts;
  testProblem(readProblem(CORRIDOR_SOURCE_DIR "/problems/arm_at_shelf"), test::testSeed(71),
              test::isStressRun() ? 20 : 2, counts);
  print(counts);
}

class ClippedRowOfArms : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Arms, ClippedRowOfArms, testing::Values("panda", "ur5"));

TEST_P(ClippedRowOfArms, IsRefuted) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  ClipCounts counts;
  const std::uint64_t seed = test::testSeed(72);
  // (A file of the ur5, which has large meshes, takes a second to verify.)
  for (const char* scene : {"cage", "bookshelf_thin", "table_pick"}) {
    if (counts.cases > 0 && !test::isStressRun()) break;
    SCOPED_TRACE(scene);
    testProblem(readProblem((*data / "mbm" / GetParam() / scene).string() + ".json#1"), seed,
                test::isStressRun() ? 3 : 1, counts);
  }
  print(counts);
}

}  // namespace
}  // namespace corridor
