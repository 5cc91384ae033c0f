/// What a robot executes: `trajectory_benchmark --problem FILE… [--count N] [--seed N] [--fcl]`.
/// FILE is a problem, or a set of MotionBenchMaker, of which the first N problems are taken (20).
///
/// Each problem is solved once by its own planner. Along this path, four motions are compared, with
/// the same limits and the same law:
/// * `ours`: corners rounded by proved curves (`corridor solve --trajectory`);
/// * `stop`: the path with a stop at each state;
/// * `spline`: the natural cubic spline through the states, with chord lengths as parameters, as
///   retiming tools make it;
/// * `checked spline`: the same, with a state inserted in the middle of the edge wherever a sample,
///   every 0.05 rad or m, touches something; at most 20 times.
/// All of them are judged by the independent verifier, without a tube and with the problem's
/// margin.
///
/// Prints one CSV line per problem, then the summary. `free` is the law of the path without its
/// inner corners' limits: no motion along the path is faster. `saved` is (stop − ours)/(stop −
/// free). With --fcl: the cost of proving our trajectory against FCL's samples of it, one every
/// 0.01 rad or m. `bulge_ratio`: the cost of cubic pieces whose middle is 5 % of the chord's length
/// off the chord, over the cost of the chords, for the path's edges where both are free.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>
#include <random>
#include <vector>

#include "collision/core/quantiles.h"
#include "planner/benchmark/fcl_scene.h"
#include "planner/robot/kinematic_tree.h"
#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "planner/trajectory/curve_pieces.h"
#include "planner/trajectory/time_law.h"
#include "planner/verify/verify_path.h"
#include "tests/benchmark/arguments.h"

namespace corridor::bench {
namespace {

template <class Call>
double secondsOf(const Call& call) {
  const auto before = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - before).count();
}

/// Returns the natural cubic spline through the states, with chord lengths as parameters (de Boor,
/// A Practical Guide to Splines, chapter IV), as Bernstein pieces.
std::vector<CurvePiece> naturalSpline(const std::vector<Configuration>& q) {
  const auto n = static_cast<Eigen::Index>(q.size()) - 1;
  const Eigen::Index numbers = q[0].size();
  Eigen::VectorXd h(n);
  for (Eigen::Index i = 0; i < n; ++i) h[i] = (q[i + 1] - q[i]).norm();
  // The second derivatives m_i solve a tridiagonal system; m_0 = m_n = 0.
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(n + 1, n + 1);
  Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n + 1, numbers);
  for (Eigen::Index i = 1; i < n; ++i) {
    A(i, i - 1) = h[i - 1];
    A(i, i) = 2 * (h[i - 1] + h[i]);
    A(i, i + 1) = h[i];
    b.row(i) = 6 * ((q[i + 1] - q[i]) / h[i] - (q[i] - q[i - 1]) / h[i - 1]).transpose();
  }
  const Eigen::MatrixXd m = A.partialPivLu().solve(b);
  std::vector<CurvePiece> pieces;
  for (Eigen::Index i = 0; i < n; ++i) {
    const Configuration m0 = m.row(i).transpose(), m1 = m.row(i + 1).transpose();
    const Configuration v0 = (q[i + 1] - q[i]) / h[i] - h[i] / 6 * (2 * m0 + m1),
                        v1 = (q[i + 1] - q[i]) / h[i] + h[i] / 6 * (m0 + 2 * m1);
    CurvePiece piece;
    piece.coefficients.resize(numbers, 4);
    piece.coefficients << q[i], q[i] + h[i] / 3 * v0, q[i + 1] - h[i] / 3 * v1, q[i + 1];
    piece.error = Configuration::Zero(numbers);
    pieces.push_back(piece);
  }
  return pieces;
}

double lengthOf(const CurvePiece& piece) {
  return (piece.coefficients.rightCols(piece.degree()) -
          piece.coefficients.leftCols(piece.degree()))
      .colwise()
      .norm()
      .sum();
}

/// Inserts the middle of the edge below each piece of the spline with a sample that touches.
std::vector<CurvePiece> checkedSpline(std::vector<Configuration> q, const Checker& checker) {
  for (int inserted = 0;; ++inserted) {
    std::vector<CurvePiece> pieces = naturalSpline(q);
    if (inserted == 20) return pieces;
    std::size_t touching = pieces.size();
    for (std::size_t k = 0; k < pieces.size() && touching == pieces.size(); ++k) {
      const int samples = static_cast<int>(std::ceil(lengthOf(pieces[k]) / 0.05));
      for (int i = 0; i <= samples && touching == pieces.size(); ++i)
        if (checker.interference(
                configurationAt(checker.space(), pieces[k], static_cast<double>(i) / samples)))
          touching = k;
    }
    if (touching == pieces.size()) return pieces;
    q.insert(q.begin() + static_cast<std::ptrdiff_t>(touching) + 1,
             0.5 * (q[touching] + q[touching + 1]));
  }
}

/// Returns the cost of proving bulging cubic pieces over that of their chords, the path's edges; 0
/// if no bulging piece is free.
double bulgeRatio(const Checker& checker, const Path& path, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  double chords = 0, curves = 0;
  for (std::size_t k = 0; k + 1 < path.size(); ++k) {
    CurvePiece piece = straightPiece(checker.space(), path[k], path[k + 1]);
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
        chord =
            std::min(chord, secondsOf([&] { checker.certifyEdge(path[k], path[k + 1], false); }));
      }
      chords += chord, curves += curve;
    }
  }
  return chords > 0 ? curves / chords : 0;
}

bool keepsBounds(const ConfigurationSpace& space, const std::vector<CurvePiece>& pieces) {
  for (const CurvePiece& piece : pieces)
    for (int i = 0; i <= 100; ++i)
      if (!space.inBounds(configurationAt(space, piece, i / 100.0))) return false;
  return true;
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
  const ConfigurationSpace& space = own.model.space;
  const Checker checker(own);
  makeTrajectory(own, checker, report.path);  // builds the trees
  MadeTrajectory made;
  const double make = secondsOf([&] { made = makeTrajectory(own, checker, report.path); });
  const auto lawOf = [&](const std::vector<CurvePiece>& pieces, double cornerAngle = 1e-6) {
    TimeLawOptions options;
    options.cornerAngle = cornerAngle;
    return timeLaw(pieces, space, own.task.limits, own.model.tree, options).duration;
  };
  const std::vector<CurvePiece> lines = curveOfPath(space, report.path).pieces;
  std::vector<Configuration> states = {lines[0].coefficients.col(0)};
  for (const CurvePiece& line : lines) states.push_back(line.coefficients.col(1));
  PathProblem plain = plainProblem(own);
  const auto verdictOf = [&](const std::vector<CurvePiece>& pieces) {
    return verifyCurve(plain, pieces).verdict;
  };
  const std::vector<CurvePiece> spline = naturalSpline(states),
                                checked = checkedSpline(states, checker);
  const double stop = lawOf(lines), free = lawOf(lines, 4), splineTime = lawOf(spline);
  PathVerdict verdict = PathVerdict::undecided;
  const double verify =
      made.fault.empty() ? secondsOf([&] { verdict = verdictOf(made.curve.pieces); }) : 0;
  const PathVerdict splineVerdict = verdictOf(spline), checkedVerdict = verdictOf(checked);
  const bool good = made.proved() && verdict == PathVerdict::proved;
  tally.ours += good;
  tally.limits += good && made.keepsLimits();
  tally.refuted[0] += splineVerdict == PathVerdict::refuted;
  tally.refuted[1] += checkedVerdict == PathVerdict::refuted;
  tally.makeMs.push_back(1e3 * make);
  tally.verifyMs.push_back(1e3 * verify);
  const bool bounded = keepsBounds(space, spline);
  if (good && made.corners > 0 && stop > free)
    tally.saved.push_back((stop - made.duration) / (stop - free));
  if (good && bounded) tally.overSpline.push_back(made.duration / splineTime);
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
  std::cout << name << ',' << made.corners << ',' << made.rounded << ',' << made.rows << ','
            << 1e3 * make << ',' << made.duration << ',' << stop << ',' << free << ',' << splineTime
            << ',' << nameOf(verdict) << ',' << nameOf(splineVerdict) << ','
            << nameOf(checkedVerdict) << ',' << (bounded ? "yes" : "no") << ','
            << made.ratios.velocity.share << ',' << made.ratios.acceleration.share << ','
            << made.stretch << ',' << 1e3 * verify << ',' << ratio << ',' << bulge
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
  std::cout << "problem,corners,rounded,rows,make_ms,ours_s,stop_s,free_s,spline_s,ours,spline,"
               "checked_spline,spline_in_bounds,velocity_share,acceleration_share,stretch,"
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
            << tally.limits << "; refuted: spline " << tally.refuted[0] << ", checked spline "
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
