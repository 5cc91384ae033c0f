/// Compares the time of the tolerance query with that of interference, at poses at which both must
/// prove the same gap: `tolerance_benchmark [--data DIR] [--workload TEXT]… [--poses N] [--rounds
/// N]`.
///
/// Runs every workload of DIR/collision whose name contains a TEXT (DIR defaults to
/// $CORRIDOR_DATA). It uses the first N poses without contact that the root boxes alone do not
/// decide. The gap of such a pose is g. The program compares interference at this pose with "closer
/// than t?" at a pose where the gap is g + t, for t = 10^-4, 10^-3 and 10^-2 of the smaller mesh's
/// size. Both queries have g left to prove: the former that the gap is above 0, the latter that it
/// is above t.
///
/// To widen the gap, B is moved along the line between the closest points, as far as needed. If one
/// mesh is inside the other (concentric spheres), no such motion helps; then A is scaled about the
/// origin. A pose is left out if the widened gap is off by more than 1 % of g. The program reports
/// the median, over the poses, of the ratio of the times of both queries. Each time is the least of
/// the rounds, in which both queries take turns. Trees are 4-wide OBB trees.
#include <limits>
#include <optional>

#include "collision/core/quantiles.h"
#include "collision/core/simd_target.h"
#include "collision/course/query_timing.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/plot.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

using namespace bench;

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& v : mesh.vertices) v *= factor;
  return mesh;
}

/// Returns the pose moved along the line between the closest points until the gap is `wanted`, or
/// nullopt if that never happens.
std::optional<Transform> widened(const Obb4Tree& a, const Obb4Tree& b, Transform X, double wanted,
                                 double accuracy, QueryContext& context) {
  const Distance start = distance(Posed(a), Posed(b, X), {}, context);
  const Vec3 away = (start.p_WB - start.p_WA) / start.distance;
  const Vec3 from = X.t;
  double moved = 0, gap = start.distance;
  for (int i = 0; i < 100; ++i) {
    // The gap grows by at most the length that b moves, so no step overshoots.
    moved += wanted - gap;
    if (moved > 4 * (wanted - start.distance)) return {};
    X.t = from + moved * away;
    gap = distance(Posed(a), Posed(b, X), {}, context).distance;
    if (std::abs(wanted - gap) <= accuracy) return X;
  }
  return {};
}

struct Row {
  int poses = 0;
  std::vector<double> interferenceNs, toleranceNs, ratios, testRatios;
};

struct Options {
  int poses = 0, rounds = 0;
};

Row measure(const test::Workload& w, double relative, const Options& o) {
  const double tolerance = relative * std::min(diagonal(w.a), diagonal(w.b));
  const Obb4Tree a(w.a), b(w.b);
  // Concentric spheres: A has the radius 1, and shrinks by t.
  const bool concentric = w.name.find("spheres") != w.name.npos;
  const Obb4Tree smaller(concentric ? scaled(w.a, 1 - tolerance) : w.a);
  QueryContext context;
  const auto inner = [&](const Transform& X) {  // returns whether there is no contact, and the root
                                                // boxes alone don't decide this
    context.counters = {};
    const bool hit = interference(Posed(a), Posed(b, X), context).has_value();
    return !hit && context.counters.boxTests > Obb4Tree::kWidth * Obb4Tree::kWidth;
  };
  Row row;
  for (const Transform& X : w.poses) {
    if (row.poses == o.poses) break;
    if (!inner(X)) continue;
    const double gap = distance(Posed(a), Posed(b, X), {}, context).distance;
    std::optional<Transform> wide;
    const Obb4Tree* other = &a;
    if (concentric) {
      other = &smaller;
      if (std::abs(distance(Posed(smaller), Posed(b, X), {}, context).distance - gap - tolerance) <=
          0.01 * gap)
        wide = X;
    } else {
      wide = widened(a, b, X, gap + tolerance, 0.01 * gap, context);
    }
    if (!wide) continue;
    const auto touch = [&] { interference(Posed(a), Posed(b, X), context); };
    const auto close = [&] { closerThan(Posed(*other), Posed(b, *wide), tolerance, context); };
    double touchNs = std::numeric_limits<double>::infinity(), closeNs = touchNs;
    for (int i = 0; i < o.rounds; ++i) {
      touchNs = std::min(touchNs, nanosecondsOf(touch, touch));
      closeNs = std::min(closeNs, nanosecondsOf(close, close));
    }
    context.counters = {};
    touch();
    const auto touchTests = static_cast<double>(context.counters.boxTests);
    context.counters = {};
    if (closerThan(Posed(*other), Posed(b, *wide), tolerance, context))
      throw std::logic_error(w.name + ": closerThan is true below the distance");
    ++row.poses;
    row.interferenceNs.push_back(touchNs);
    row.toleranceNs.push_back(closeNs);
    row.ratios.push_back(closeNs / touchNs);
    row.testRatios.push_back(static_cast<double>(context.counters.boxTests) / touchTests);
  }
  return row;
}

void run(const Arguments& arguments) {
  const Options o{static_cast<int>(arguments.number("--poses", 50)), arguments.rounds(5)};
  std::cout << "# instruction set: " << simdTarget()
            << "\nworkload,tolerance/size,poses,interference_ns,tolerance_ns,ratio,ratio of N_v\n";
  double worst = 0, logs = 0, count = 0;
  for (const std::string& name : arguments.workloads()) {
    const test::Workload w = test::loadWorkload(arguments.data() / "collision", name);
    for (const double relative : {1e-4, 1e-3, 1e-2}) {
      const Row row = measure(w, relative, o);
      std::cout << name << "," << relative << "," << row.poses;
      if (row.poses > 0) {
        const double ratio = medianOf(row.ratios);
        std::cout << "," << text(medianOf(row.interferenceNs), 4) << ","
                  << text(medianOf(row.toleranceNs), 4) << "," << text(ratio) << ","
                  << text(medianOf(row.testRatios));
        worst = std::max(worst, ratio);
        logs += std::log(ratio), ++count;
      }
      std::cout << std::endl;
    }
  }
  std::cout << "\nratio: geometric mean " << text(std::exp(logs / count)) << ", greatest "
            << text(worst) << ", of " << count << " rows\n";
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--data", "--workload", "--poses", "--rounds"},
                                  corridor::run);
}
