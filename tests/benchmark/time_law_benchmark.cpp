/// Measures how long it takes to compute time laws and their rows, for paths of 7 joints: one of 20
/// pieces (the law should take less than 3 ms), and one of 1000 pieces. Prints medians over
/// repeats.

#include <algorithm>
#include <chrono>
#include <cstdio>

#include "planner/trajectory/emit.h"
#include "tests/planner/trajectory/paths.h"

namespace {

template <class Run>
double medianMilliseconds(int repeats, const Run& run) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    times.push_back(
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
            .count());
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

}  // namespace

int main() {
  using namespace corridor;
  const KinematicTree tree;
  const ConfigurationSpace space = test::jointSpace(7);
  const JointLimits limits = test::uniformLimits(7, 2, 5, 60);
  for (const std::size_t pieces : {20, 1000}) {
    std::mt19937 random(11);
    const std::vector<CurvePiece> path = test::randomSpline(7, pieces, random);
    const int repeats = pieces == 20 ? 51 : 5;
    const TimeLaw law = timeLaw(path, space, limits, tree);
    const double time = medianMilliseconds(repeats, [&] { timeLaw(path, space, limits, tree); });
    const Emission rows = emitRows(law, path, space, limits, tree);
    const double emitted =
        medianMilliseconds(repeats / 4 + 1, [&] { emitRows(law, path, space, limits, tree); });
    std::printf(
        "7 joints, %zu pieces: law %.2f ms (%.3f s long, %zu segments); rows with proofs %.2f ms "
        "(%zu rows, stretch %.6f)\n",
        pieces, time, law.duration, law.segments.size(), emitted, rows.rows.size(), rows.stretch);
    if (pieces == 20) {
      const TimeLawOptions smooth{.smooth = true};
      const double smoothTime =
          medianMilliseconds(5, [&] { timeLaw(path, space, limits, tree, smooth); });
      std::printf("  smooth, with limits of jerk: %.2f ms (%.3f s long)\n", smoothTime,
                  timeLaw(path, space, limits, tree, smooth).duration);
    }
  }
}
