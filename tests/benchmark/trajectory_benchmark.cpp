/// Compares trajectories that a robot may execute: `trajectory_benchmark --problem FILE… [--count
/// N] [--seed N] [--fcl]`. FILE is a problem, or a set of MotionBenchMaker; the first N problems of
/// a set are taken (default 20).
///
/// Each problem is solved once by its own planner. Along this path, four trajectories are compared,
/// with the same limits and the same law (planner/benchmark/trajectory_run.h): `blends` (ours),
/// `stop`, `spline` and `inserted`. The independent verifier judges the rows of all of them.
/// `corridor benchmark` compares the same trajectories in campaigns.
///
/// Prints one CSV line per problem, then the summary. `free` is the duration of the law for the
/// path as if its inner corners set no limits: no motion along the path is faster. `saved` is (stop
/// − ours)/(stop − free), in durations. With --fcl, the program also compares the cost of proving
/// our trajectory with the cost of FCL's samples of this trajectory, one every 0.01 rad or m.
/// `bulge_ratio` is the cost of proving cubic pieces whose middle is off the chord by 5 % of the
/// chord's length, divided by the cost of proving the chords. The chords are the edges of the path;
/// only edges count for which both are free.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "collision/core/quantiles.h"
#include "planner/benchmark/fcl_scene.h"
#include "planner/benchmark/trajectory_run.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/solve/solve.h"
#include "planner/trajectory/curve_pieces.h"
#include "tests/benchmark/arguments.h"

namespace corridor::bench {
namespace {

template <class Call>
double secondsOf(const Call& call) {
  const auto before = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
}

/// Returns an upper bound of the length of a piece: the length of its control polygon.
double lengthOf(const CurvePiece& piece) {
  return (piece.coefficients.rightCols(piece.degree()) -
          piece.coefficients.leftCols(piece.degree()))
      .colwise()
      .norm()
      .sum();
}

/// Returns the cost of proving bulging cubic pieces, divided by the cost of proving their chords,
/// which are the edges of the path; 0 if no bulging piece is free.
double bulgeRatio(const Checker& checker, const Path& path, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  double chords = 0, curves = 0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    CurvePiece piece = curveOfPath(checker.space(), {path[k], path[k + 1]}).pieces[0];
    const Configuration a = piece.coefficients.col(0), b = piece.coefficients.col(1);
    const double length = (b - a).norm();
    for (int n = 0; n < 10; ++n) {
      Configuration side(a.size());
      for (double& x : side) x = normal(random);
      side -= (b - a) * (side.dot(b - a) / (length * length));
      // The middle of a cubic is displaced by 3/4 of the displacement of its inner coefficients.
      side *= 0.05 * length / 0.75 / side.norm();
      piece.coefficients.resize(a.size(), 4);
      piece.coefficients << a, a + (b - a) / 3 + side, b - (b - a) / 3 + side, b;
      if (checker.certifyCurve(piece).verdict != MotionVerdict::free) continue;
      double chord = HUGE_VAL, curve = HUGE_VAL;
      for (int round = 0; round < 3; ++round) {
        curve = std::min(curve, secondsOf([&] { checker.certifyCurve(piece); }));
        chord = std::min(chord, secondsOf([&] { checker.certifyEdge(path[k], path[k + 1]); }));
      }
      chords += chord, curves += curve;
    }
  }
  return chords > 0 ? curves / chords : 0;
}

struct Tally {
  std::vector<double> saved, overSpline, makeMs, verifyMs, fclRatio, bulge;
  int problems = 0, ours = 0, limits = 0, refuted[2] = {}, splines = 0;
};

void compare(const std::string& name, const Problem& problem, std::uint64_t seed, bool fcl,
             Tally& tally) {
  Problem own = problem;
  own.settings.seed = seed;
  const SolveReport report = solveProblem(own);
  if (report.outcome != SolveOutcome::solved || !report.certified) {
    std::cout << name << ": not solved\n";
    return;
  }
  ++tally.problems;
  [[maybe_unused]] const ConfigurationSpace& space = own.model.space;
  const Checker checker(own);
  const MadeTrajectory made = makeTrajectory(own, checker, report.path);  // builds the trees
  const auto run = [&](TrajectoryMaker maker) {
    return runTrajectory(maker, own, checker, report.path);
  };
  const TrajectoryRun ours = run(TrajectoryMaker::blends), stop = run(TrajectoryMaker::stop),
                      spline = run(TrajectoryMaker::spline),
                      inserted = run(TrajectoryMaker::inserted);
  const double free = optimumAlong(own, report.path);
  const bool good = made.proved() && ours.verdict == "proved";
  tally.ours += good;
  tally.limits += good && keepsLimits(made.ratios);
  tally.refuted[0] += spline.verdict == "refuted";
  tally.refuted[1] += inserted.verdict == "refuted";
  tally.makeMs.push_back(1e3 * ours.makeTime);
  tally.verifyMs.push_back(1e3 * ours.verifyTime);
  const bool bounded = spline.fault.empty() && spline.beyondBounds <= kLimitSlack;
  if (good && made.corners > 0 && stop.fault.empty() && stop.duration > free)
    tally.saved.push_back((stop.duration - ours.duration) / (stop.duration - free));
  if (good && bounded) tally.overSpline.push_back(ours.duration / spline.duration);
  const double bulge = bulgeRatio(checker, report.path, seed);
  if (bulge > 0) tally.bulge.push_back(bulge);
  double ratio = 0;
#ifdef CORRIDOR_WITH_FCL
  if (fcl && good) {
    FclScene scene(checker);
    const auto prove = [&] {
      for (const CurvePiece& piece : made.curve.pieces) checker.certifyCurve(piece);
    };
    const auto sample = [&] {
      for (const CurvePiece& piece : made.curve.pieces) {
        const int samples = std::max(1, static_cast<int>(std::ceil(lengthOf(piece) / 0.01)));
        for (int i = 0; i < samples; ++i)
          scene.touches(framePoses(
              own.model.tree, configurationAt(space, piece, static_cast<double>(i) / samples)));
      }
    };
    prove(), sample();
    const double proof = secondsOf(prove);
    ratio = secondsOf(sample) / proof;
    tally.fclRatio.push_back(ratio);
  }
#else
  static_cast<void>(fcl);
#endif
  std::cout << name << ',' << made.corners << ',' << made.rounded << ',' << ours.rows << ','
            << 1e3 * ours.makeTime << ',' << ours.duration << ',' << stop.duration << ',' << free
            << ',' << spline.duration << ',' << ours.verdict << ',' << stop.verdict << ','
            << spline.verdict << ',' << inserted.verdict << ',' << (bounded ? "yes" : "no") << ','
            << ours.velocity << ',' << ours.acceleration << ',' << made.stretch << ','
            << 1e3 * ours.verifyTime << ',' << ratio << ',' << bulge
            << (made.fault.empty() ? "" : "," + made.fault) << std::endl;
}

double geometricMean(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += std::log(v);
  return values.empty() ? 0 : std::exp(sum / static_cast<double>(values.size()));
}

void run(const Arguments& arguments) {
  pin(arguments);
  const auto count = static_cast<int>(arguments.number("--count", 20));
  const auto seed = static_cast<std::uint64_t>(arguments.number("--seed", 1));
  std::cout << "problem,corners,rounded,rows,make_ms,ours_s,stop_s,free_s,spline_s,ours,stop,"
               "spline,inserted,spline_in_bounds,velocity_share,acceleration_share,stretch,"
               "verify_ms,fcl_ratio,bulge_ratio\n";
  Tally tally;
  for (const std::string& file : arguments.texts("--problem")) {
    const bool isSet = file.size() > 5 && file.ends_with(".json");
    for (int i = 1; i <= (isSet ? count : 1); ++i) {
      const std::string name = isSet ? file + "#" + std::to_string(i) : file;
      compare(name, readProblem(name), seed, arguments.has("--fcl"), tally);
    }
  }
  const auto median = [](const std::vector<double>& v) { return v.empty() ? 0 : medianOf(v); };
  std::cout << tally.problems << " solved; ours proved " << tally.ours << ", limits proved "
            << tally.limits << "; refuted: spline " << tally.refuted[0] << ", inserted "
            << tally.refuted[1] << "\nsaved of what stopping costs, median " << median(tally.saved)
            << " (" << tally.saved.size() << "); duration over the spline's, geometric mean "
            << geometricMean(tally.overSpline) << " (" << tally.overSpline.size()
            << ")\nmake and prove, median " << median(tally.makeMs) << " ms; verify, median "
            << median(tally.verifyMs) << " ms\n";
  std::cout << "bulging pieces over their chords, median " << median(tally.bulge) << "\n";
  if (!tally.fclRatio.empty())
    std::cout << "FCL's samples over our proof, geometric mean " << geometricMean(tally.fclRatio)
              << "\n";
}

}  // namespace
}  // namespace corridor::bench

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--problem", "--count", "--seed", "--cpu"},
                                  corridor::bench::run, {"--fcl"});
}
