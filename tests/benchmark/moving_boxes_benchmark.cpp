/// Measures the broad phase of many moving bodies: `moving_boxes_benchmark [--most N] [--cpu N]`.
///
/// n boxes of size 1 fill a cube, so that each overlaps 0.8 others in the mean; n is 10, 100, … up
/// to N (default 10^5). In each step a fraction of the boxes moves, each by 1 % of its size in its
/// own direction. Prints CSV: the time of one step in microseconds (the median of 20 steps), for
/// * `sweep and prune`: the ends of the moved boxes are sorted into the lists of ends; the
///   overlapping pairs are then known;
/// * `tree`: the moved boxes are refitted in the scene's tree over bodies, and each moved box
///   queries the tree;
/// * `tree rebuilt`: the tree is built anew, and each box queries it.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <random>
#include <vector>

#include "collision/core/quantiles.h"
#include "collision/course/sweep_and_prune.h"
#include "tests/benchmark/arguments.h"

namespace corridor {
namespace {

constexpr int kSteps = 20;

template <class Call>
double microseconds(const Call& call) {
  const auto before = std::chrono::steady_clock::now();
  call();
  const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - before;
  return time.count();
}

/// Returns the number of boxes that overlap this one, itself included.
std::size_t query(const BoxTree& tree, const BoundingBox& box) {
  std::size_t count = 0;
  const double within = 0;
  tree.walk(
      [&](const BoundingBox& node) {
        return std::max((node.lower - box.upper).maxCoeff(), (box.lower - node.upper).maxCoeff());
      },
      within,
      [&](std::size_t) {
        ++count;
        return false;
      });
  return count;
}

void measure(std::size_t n, double share) {
  std::mt19937_64 random(n);
  std::uniform_real_distribution<double> real(-1, 1);
  const double side = std::cbrt(10.0 * static_cast<double>(n));
  std::vector<BoundingBox> boxes(n);
  std::vector<Vec3> velocity(n);
  for (std::size_t i = 0; i < n; ++i) {
    boxes[i].lower = 0.5 * side * Vec3(real(random), real(random), real(random));
    boxes[i].upper = boxes[i].lower + Vec3(1, 1, 1);
    velocity[i] = 0.01 * Vec3(real(random), real(random), real(random)).normalized();
  }
  SweepAndPrune sweep(boxes);
  BoxTree tree(boxes);
  const auto moving =
      std::max<std::size_t>(1, static_cast<std::size_t>(share * static_cast<double>(n)));
  std::vector<double> sweepTimes, treeTimes, rebuiltTimes;
  std::size_t found = 0;
  for (int step = 0; step < kSteps; ++step) {
    for (std::size_t i = 0; i < moving; ++i) {
      boxes[i].lower += velocity[i];
      boxes[i].upper += velocity[i];
    }
    sweepTimes.push_back(microseconds([&] {
      for (std::size_t i = 0; i < moving; ++i) sweep.move(i, boxes[i]);
    }));
    treeTimes.push_back(microseconds([&] {
      for (std::size_t i = 0; i < moving; ++i) tree.refit(i, boxes[i]);
      for (std::size_t i = 0; i < moving; ++i) found += query(tree, boxes[i]);
    }));
    rebuiltTimes.push_back(microseconds([&] {
      const BoxTree fresh(boxes);
      for (std::size_t i = 0; i < moving; ++i) found += query(fresh, boxes[i]);
    }));
  }
  // Uses the results, so that the compiler can't remove the queries.
  if (found == 1) std::cerr << ' ';
  const auto row = [&](const char* by, const std::vector<double>& times) {
    std::cout << n << ',' << share << ',' << by << ',' << medianOf(times) << std::endl;
  };
  row("sweep and prune", sweepTimes);
  row("tree", treeTimes);
  row("tree rebuilt", rebuiltTimes);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  using namespace corridor;
  return bench::runWith(argc, argv, {"--most", "--cpu"}, [](const bench::Arguments& a) {
    std::cerr << "pinned to CPU " << bench::pin(a) << "\n";
    std::cout << "boxes,moving,by,step_us\n" << std::setprecision(4);
    const double most = a.number("--most", 1e5);
    for (std::size_t n = 10; static_cast<double>(n) <= most; n *= 10)
      for (const double share : {0.01, 0.1, 1.0}) measure(n, share);
  });
}
