/// Measures the cost of overlap tests of two oriented boxes: `overlap_benchmark [--data DIR]
/// [--workload TEXT]… [--rounds N] [--cpu N]`.
///
/// The tests are separating axes, and the tests that separating axes replaced in the literature:
/// closest features (GJK, and V-Clip), linear programming, and edges against faces. Gottschalk,
/// Lin, Manocha 1996, section 5, found separating axes some 10 times faster than closest features
/// and some 30 times faster than linear programming.
///
/// Pairs of boxes are those that real queries meet. Trees over the workloads of DIR/collision are
/// traversed at all their poses. (DIR defaults to $CORRIDOR_DATA; without data, the workload is a
/// sphere and a torus made here.) Up to 2,000 pairs that are separated and 2,000 that overlap are
/// kept, sampled evenly, in the order in which the queries test them. Each test gets the pairs in
/// the same form as in a query: boxes in their meshes' frames, and the relative pose. In every
/// round each test runs on all pairs; the least time of the rounds counts. *Mixed* is the mean time
/// over separated and overlapping pairs, weighted by how often queries test each kind.
///
/// *Posing* is the first step of all our tests: computing the pose of one box relative to the
/// other. Competitors are FCL's overlap test of OBBs, which guarantees nothing about rounding, and
/// the kernel of our 4-wide OBB tree. The kernel's C_v, the traversal included, is fitted by least
/// squares over whole queries (collision/course/cost_model.h).
///
/// CSV follows the table: each test's mixed cost (geometric mean over the workloads), and its ratio
/// to that of separating axes. A second CSV has the number of arithmetic operations of a test by
/// separating axes: the least, the mean and the largest over all kept pairs. These numbers include
/// our margins for rounding, and posing; the operations of posing alone are given, too.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <iterator>
#include <memory>
#include <random>
#include <sched.h>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef CORRIDOR_WITH_FCL
#include <fcl/math/bv/OBB.h>
#endif

#include "collision/core/simd_target.h"
#include "collision/course/cost_model.h"
#include "collision/course/query_timing.h"
#include "collision/course/vclip.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/hierarchy/traverse.h"
#include "collision/queries/interference_obb4.h"
#include "collision/queries/touching_pairs.h"
#include "collision/volumes/overlap_obb_obb_variants.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/counted.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

constexpr std::size_t kKept = 2'000;

double nanosecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
}

struct BoxPair {
  Obb a, b;
  std::size_t pose;
  std::uint64_t met;  ///< the pair's index among all pairs that the queries test
};

/// Keeps some of the pairs that are passed to it, each with equal probability (reservoir sampling).
struct Sample {
  std::vector<BoxPair> kept;
  std::uint64_t seen = 0;
  std::mt19937_64 random{1};
  void show(const BoxPair& pair) {
    const std::uint64_t place = seen++ < kKept ? seen - 1 : random() % seen;
    if (place >= kKept) return;
    if (place == kept.size())
      kept.push_back(pair);
    else
      kept[place] = pair;
  }
};

/// An overlap test for a query. It also passes each tested pair to a sample.
struct Recorder {
  const PairTest<Obb>& test;
  std::size_t pose;
  Sample &apart, &meet;
  bool separated(const Obb& a, const Obb& b, double pad) const {
    const bool isApart = test.separated(a, b, pad);
    Sample& sample = isApart ? apart : meet;
    sample.show({a, b, pose, apart.seen + meet.seen});
    return isApart;
  }
};

/// Nanoseconds per test: for pairs that are separated, and for pairs that overlap.
struct Cost {
  double apart = HUGE_VAL, meet = HUGE_VAL;
  double mixed(double share) const { return share * apart + (1 - share) * meet; }
};

struct Recorded {
  test::Workload w;
  Sample apart, meet;
  double wideNs = 0;  ///< per box test of the 4-wide tree's queries

  explicit Recorded(test::Workload workload) : w(std::move(workload)) {
    const ObbTree a(w.a), b(w.b);
    QueryContext context;
    for (std::size_t i = 0; i < w.poses.size(); ++i) {
      const Posed posedA(a), posedB(b, w.poses[i]);
      const auto test = pairTestOf<Obb>(posedA, posedB);
      const Recorder recorder{test, i, apart, meet};
      const auto first = [](std::uint32_t, std::uint32_t) { return true; };
      TouchingPairs query(posedA, posedB, recorder, context.counters, first);
      traverse(a, b, NodePair{0, 0}, *context.scratch.use<NodePairs>(), query);
    }
    for (Sample* sample : {&apart, &meet}) std::ranges::sort(sample->kept, {}, &BoxPair::met);
    bounds_[0] = a.bounds();
    bounds_[1] = b.bounds();
  }
  double shareApart() const {
    return static_cast<double>(apart.seen) / static_cast<double>(apart.seen + meet.seen);
  }
  const VolumeBounds& boundsA() const { return bounds_[0]; }
  const VolumeBounds& boundsB() const { return bounds_[1]; }

 private:
  VolumeBounds bounds_[2];
};

/// Returns the mean time in ns of `separated(i)` over all pairs i, and adds the number of separated
/// pairs to `found`. Costs are comparable only between tests with the same verdicts, so the report
/// shows how far the numbers of separated pairs differ.
template <class Separated>
double pass(std::size_t count, std::uint64_t& found, const Separated& separated) {
  if (count == 0) return 0;
  const auto start = std::chrono::steady_clock::now();
  for (std::size_t i = 0; i < count; ++i) found += separated(i);
  return nanosecondsSince(start) / static_cast<double>(count);
}

/// One of our overlap tests, prepared for all pairs of a workload.
template <class Overlap>
class Ours {
 public:
  explicit Ours(const Recorded& r) : r_(r) {
    for (const Transform& X : r.w.poses) tests_.emplace_back(r.boundsA(), r.boundsB(), X, 0.0);
  }
  void pass(Cost& cost, std::uint64_t& found) const {
    const auto over = [&](const Sample& sample, double& least) {
      least = std::min(least, corridor::pass(sample.kept.size(), found, [&](std::size_t i) {
                         const BoxPair& p = sample.kept[i];
                         return tests_[p.pose].separated(p.a, p.b, 0);
                       }));
    };
    over(r_.apart, cost.apart);
    over(r_.meet, cost.meet);
  }

 private:
  const Recorded& r_;
  std::vector<PairTest<Obb, Overlap>> tests_;
};

/// Closest features by V-Clip, from a cold start. Boxes without thickness have no features; pairs
/// with such boxes are left out.
class ClosestFeaturesOfBoxes {
 public:
  explicit ClosestFeaturesOfBoxes(const Recorded& r)
      : r_(r), apart_(boxes(r.apart)), meet_(boxes(r.meet)) {}
  void pass(Cost& cost, std::uint64_t& found) const {
    const auto over = [&](const std::vector<Boxes>& boxes, double& least) {
      if (boxes.empty()) return;
      least = std::min(least, corridor::pass(boxes.size(), found, [&](std::size_t i) {
                         FeaturePair cold;
                         return closestFeatures(*boxes[i].a, {}, *boxes[i].b,
                                                r_.w.poses[boxes[i].pose], cold)
                                    .distance.distance > 0;
                       }));
    };
    over(apart_, cost.apart);
    over(meet_, cost.meet);
  }

 private:
  /// A box as a polytope, with its features.
  struct Features {
    Polytope polytope;
    PolytopeFeatures features;
    explicit Features(const std::vector<Vec3>& corners)
        : polytope(corners), features(ConvexSet(polytope)) {}
  };
  struct Boxes {
    std::shared_ptr<const PolytopeFeatures> a, b;
    std::size_t pose;
  };
  static std::shared_ptr<const PolytopeFeatures> featuresOf(const Obb& box) {
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k)
      corners.push_back(box.center + box.axes * Vec3(k & 1 ? box.half.x() : -box.half.x(),
                                                     k & 2 ? box.half.y() : -box.half.y(),
                                                     k & 4 ? box.half.z() : -box.half.z()));
    const auto made = std::make_shared<const Features>(corners);
    return {made, &made->features};
  }
  static std::vector<Boxes> boxes(const Sample& sample) {
    std::vector<Boxes> all;
    for (const BoxPair& p : sample.kept) try {
        all.push_back({featuresOf(p.a), featuresOf(p.b), p.pose});
      } catch (const std::invalid_argument&) {  // a flat box
      }
    return all;
  }
  const Recorded& r_;
  std::vector<Boxes> apart_, meet_;
};

#ifdef CORRIDOR_WITH_FCL
class Fcl {
 public:
  explicit Fcl(const Recorded& r) : r_(r), apart_(boxes(r.apart)), meet_(boxes(r.meet)) {}
  void pass(Cost& cost, std::uint64_t& found) const {
    const auto over = [&](const Sample& sample, const std::vector<Boxes>& boxes, double& least) {
      least = std::min(least, corridor::pass(boxes.size(), found, [&](std::size_t i) {
                         const Transform& X = r_.w.poses[sample.kept[i].pose];
                         return !fcl::overlap(X.m, X.t, boxes[i].a, boxes[i].b);
                       }));
    };
    over(r_.apart, apart_, cost.apart);
    over(r_.meet, meet_, cost.meet);
  }

 private:
  struct Boxes {
    fcl::OBB<double> a, b;
  };
  static std::vector<Boxes> boxes(const Sample& sample) {
    std::vector<Boxes> all;
    for (const BoxPair& p : sample.kept)
      all.push_back({{p.a.axes, p.a.center, p.a.half}, {p.b.axes, p.b.center, p.b.half}});
    return all;
  }
  const Recorded& r_;
  std::vector<Boxes> apart_, meet_;
};
#endif

/// C_v of queries on the 4-wide OBB tree, from each query's least time.
class Wide {
 public:
  explicit Wide(const Recorded& r) : r_(r), a_(r.w.a), b_(r.w.b), costs_(r.w.poses.size()) {
    for (QueryCost& c : costs_) c.ns = HUGE_VAL;
  }
  void pass() {
    for (std::size_t i = 0; i < costs_.size(); ++i) {
      const auto ask = [&] { interference(Posed(a_), Posed(b_, r_.w.poses[i]), context_); };
      context_.counters = {};
      ask();
      costs_[i].boxTests = static_cast<double>(context_.counters.boxTests);
      costs_[i].primitiveTests = static_cast<double>(context_.counters.primitiveTests);
      costs_[i].ns = std::min(costs_[i].ns, nanosecondsOf(ask, ask));
    }
  }
  double boxTestNs() const {
    // Queries that the first node decides are left out: they measure only the overhead of a call.
    std::vector<QueryCost> walked;
    std::ranges::copy_if(costs_, std::back_inserter(walked),
                         [](const QueryCost& c) { return c.boxTests > 32; });
    return walked.empty() ? 0 : fittedCosts(walked).box;
  }

 private:
  const Recorded& r_;
  Obb4Tree a_, b_;
  QueryContext context_;
  std::vector<QueryCost> costs_;
};

/// Posing alone, which is the first step of all our tests.
struct Posing {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB, const BoxPairMargins&,
                        double) {
    const internal::BoxPair pair(a, b, X_AB);
    return pair.absR.sum() + pair.T.sum() > 0;
  }
};

/// Returns the workload for a machine without shared data: a sphere inside the tube of a torus and
/// beside this tube, at random poses.
test::Workload made() {
  test::Workload w;
  w.name = "made: torus, sphere";
  const auto surface = [](int nu, int nv, const auto& point) {
    TriangleMesh mesh;
    for (int u = 0; u < nu; ++u)
      for (int v = 0; v < nv; ++v)
        mesh.vertices.push_back(point(2 * M_PI * u / nu, 2 * M_PI * v / nv));
    const auto at = [&](int u, int v) { return static_cast<std::uint32_t>(u % nu * nv + v % nv); };
    for (int u = 0; u < nu; ++u)
      for (int v = 0; v < nv; ++v) {
        mesh.triangles.push_back({at(u, v), at(u + 1, v), at(u + 1, v + 1)});
        mesh.triangles.push_back({at(u, v), at(u + 1, v + 1), at(u, v + 1)});
      }
    return mesh;
  };
  w.a = surface(64, 32, [](double u, double v) {
    return Vec3((1 + 0.3 * std::cos(v)) * std::cos(u), (1 + 0.3 * std::cos(v)) * std::sin(u),
                0.3 * std::sin(v));
  });
  w.b = surface(48, 24, [](double u, double v) {
    return Vec3(0.25 * std::cos(u) * std::sin(v / 2), 0.25 * std::sin(u) * std::sin(v / 2),
                0.25 * std::cos(v / 2));
  });
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> real(-1, 1);
  for (int i = 0; i < 400; ++i) {
    Transform X;
    const double angle = M_PI * real(random);
    X.m << std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle), 0, 0, 0, 1;
    X.t = Vec3(std::cos(angle), std::sin(angle), 0) +
          0.5 * Vec3(real(random), real(random), real(random));
    w.poses.push_back(X);
  }
  return w;
}

/// The columns, in the order of `costs` in `run`.
constexpr const char* kNames[] = {"SAT", "GJK", "LP", "edges, faces", "FCL", "posing", "V-Clip"};
constexpr std::size_t kTests = std::size(kNames);

/// Sums over workloads.
struct Means {
  double logs[kTests] = {};  ///< sums of logarithms of the mixed cost relative to SAT's
  double satLogs = 0;        ///< sum of logarithms of SAT's mixed cost
  double wideLogs = 0;
  int count = 0, wideCount = 0;
};

/// The operations of tests by separating axes.
struct Operations {
  std::uint64_t least = UINT64_MAX, most = 0, tests = 0;
  /// Operations in each test that compute the pose of one box relative to the other.
  std::uint64_t posing = 0;
  bench::OperationCounts sum;

  void add(const bench::OperationCounts& n) {
    least = std::min(least, n.total());
    most = std::max(most, n.total());
    ++tests;
    sum.sums += n.sums, sum.products += n.products;
    sum.comparisons += n.comparisons, sum.absolutes += n.absolutes;
  }
};

/// A pair of boxes like `internal::BoxPair`, in numbers that count their operations.
struct CountedPair {
  Eigen::Matrix<bench::Counted, 3, 3> R, absR;
  Eigen::Matrix<bench::Counted, 3, 1> T;
  CountedPair(const Obb& a, const Obb& b, const Transform& X_AB) {
    using bench::Counted;
    const auto inverse = a.axes.transpose().cast<Counted>().eval();
    const auto m = X_AB.m.cast<Counted>().eval();
    R = inverse * (m * b.axes.cast<Counted>()).eval();
    absR = R.cwiseAbs();
    T = inverse *
        ((m * b.center.cast<Counted>() + X_AB.t.cast<Counted>()) - a.center.cast<Counted>()).eval();
  }
};

void countOperations(const Recorded& r, Operations& operations) {
  for (const Sample* sample : {&r.apart, &r.meet})
    for (const BoxPair& p : sample->kept) {
      const Transform& X_AB = r.w.poses[p.pose];
      const BoxPairMargins margins =
          boxPairMargins(r.boundsA().axisDefect, r.boundsA().centerReach, r.boundsB().axisDefect,
                         r.boundsB().centerReach, X_AB);
      bench::Counted::counts() = {};
      const CountedPair pair(p.a, p.b, X_AB);
      operations.posing = bench::Counted::counts().total();
      const bool apart = internal::separated(pair, p.a.half.cast<bench::Counted>().eval(),
                                             p.b.half.cast<bench::Counted>().eval(), margins, 0);
      operations.add(bench::Counted::counts());
      if (apart != (sample == &r.apart)) throw std::logic_error("counting changed a verdict");
    }
}

void run(test::Workload workload, int rounds, Means& means, Operations& operations) {
  const Recorded r(std::move(workload));
  countOperations(r, operations);
  const Ours<StandardOverlap> sat(r);
  const Ours<Gjk> gjk(r);
  const Ours<LinearProgram> lp(r);
  const Ours<EdgeFace> edges(r);
  const Ours<Posing> posing(r);
  const ClosestFeaturesOfBoxes features(r);
  Wide wide(r);
  Cost costs[kTests];
  std::uint64_t found[kTests] = {};
#ifdef CORRIDOR_WITH_FCL
  const Fcl fcl(r);
#endif
  for (int i = 0; i < rounds; ++i) {
    sat.pass(costs[0], found[0]);
    gjk.pass(costs[1], found[1]);
    lp.pass(costs[2], found[2]);
    edges.pass(costs[3], found[3]);
#ifdef CORRIDOR_WITH_FCL
    fcl.pass(costs[4], found[4]);
#endif
    posing.pass(costs[5], found[5]);
    features.pass(costs[6], found[6]);
    if (i < 3) wide.pass();
  }
  const double share = r.shareApart(), first = costs[0].mixed(share), wideNs = wide.boxTestNs();
  std::printf("| %s | %.0f %% |", r.w.name.c_str(), 100 * share);
  for (std::size_t i = 0; i < kTests; ++i) {
    const double ratio = costs[i].mixed(share) / first;
    if (!(ratio < HUGE_VAL))
      std::printf(" |");
    else if (i == 0)
      std::printf(" %.0f, %.0f |", costs[i].apart, costs[i].meet);
    else
      std::printf(" %.0f, %.0f: %.2g |", costs[i].apart, costs[i].meet, ratio);
    means.logs[i] += std::log(ratio);
  }
  means.satLogs += std::log(first);
  ++means.count;
  if (wideNs > 0) {
    std::printf(" %.1f: %.2g |", wideNs, wideNs / first);
    means.wideLogs += std::log(wideNs / first);
    ++means.wideCount;
  } else {
    std::printf(" |");
  }
  for (std::size_t i = 1; i < 4; ++i)  // numbers of separated pairs, in both samples together
    std::printf(" %+.2g",
                100 * (static_cast<double>(found[i]) / static_cast<double>(found[0]) - 1));
  std::printf(" |\n");
  std::fflush(stdout);
}

void report(const bench::Arguments& arguments) {
  const int rounds = arguments.rounds(15);
  bench::pin(arguments);
  std::printf(
      "Nanoseconds per test of boxes that are separated, and of boxes that overlap; after the "
      "colon the mixed cost relative to SAT's. Wide kernel: %s.\n\n| workload | apart |",
      simdTarget());
  for (const char* name : kNames) std::printf(" %s |", name);
  std::printf(" wide, C_v | separated, %% over SAT: GJK, LP, edges |\n|---|--:|");
  for (std::size_t i = 0; i < kTests + 2; ++i) std::printf("--:|");
  std::printf("\n");
  Means means;
  Operations operations;
  if (arguments.data().empty()) {
    run(made(), rounds, means, operations);
  } else {
    for (const std::string& name : arguments.workloads())
      run(test::loadWorkload(arguments.data() / "collision", name), rounds, means, operations);
  }
  const double sat = std::exp(means.satLogs / means.count);
  std::printf("\ntest,ns,ratio\n");
  const auto print = [&](const char* name, double logs, int count) {
    const double ratio = std::exp(logs / count);
    if (count > 0 && ratio < HUGE_VAL) std::printf("\"%s\",%.2f,%.2f\n", name, sat * ratio, ratio);
  };
  for (std::size_t i = 0; i < kTests; ++i) print(kNames[i], means.logs[i], means.count);
  print("wide", means.wideLogs, means.wideCount);
  const auto n = static_cast<double>(operations.tests);
  const auto mean = [&](std::uint64_t sum) { return static_cast<double>(sum) / n; };
  std::printf("\noperations_least,mean,most,posing,sums,products,comparisons,absolutes\n");
  std::printf("%llu,%.1f,%llu,%llu,%.1f,%.1f,%.1f,%.1f\n",
              static_cast<unsigned long long>(operations.least), mean(operations.sum.total()),
              static_cast<unsigned long long>(operations.most),
              static_cast<unsigned long long>(operations.posing), mean(operations.sum.sums),
              mean(operations.sum.products), mean(operations.sum.comparisons),
              mean(operations.sum.absolutes));
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--data", "--workload", "--rounds", "--cpu"},
                                  corridor::report);
}
