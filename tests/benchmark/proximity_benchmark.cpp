/// Measures parallel close proximity (Gottschalk, Lin, Manocha 1996, section 6) for every volume:
/// `proximity_benchmark [--out FOLDER] [--frequency N]… [--rotations N]`.
///
/// A sphere of 20·N² triangles (corners at radius 1) is inside a second, concentric sphere, and
/// rotated at random. The facet planes of the outer sphere are 1 + gap away from the centre. The
/// query is interference. Nothing touches, but every point of one sphere is near the other. Gaps go
/// from 0.3 down to 30 sagittas, where the spheres are still parallel for boxes of a leaf's size.
///
/// Prints CSV on stdout:
/// * N_v and N_p (means over the rotations) and the median time;
/// * the slope of log N_v over log 1/gap, for all gaps, and for those gaps at which fewer than one
///   test in 100 is a test of triangles (at smaller gaps, the queries reach the leaves nearly
///   everywhere);
/// * the same measurements for a pair of such spheres at several placements, and the best of the
///   trees that share one traversal.
///
/// FOLDER gets the plots.
#include <functional>
#include <iomanip>
#include <iostream>

#include "collision/core/quantiles.h"
#include "collision/course/query_timing.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/volumes/pair_tests.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/plot.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

using namespace bench;

struct Cost {
  double boxTests = 0, primitiveTests = 0, us = 0;
};

/// Measures the queries at all poses of b; the pose of a is the identity. b is a scaled copy of a.
/// Returns one cost per scale.
using Ask = std::function<std::vector<Cost>(
    const TriangleMesh& a, const std::vector<double>& scales, const std::vector<Transform>&)>;

TriangleMesh scaled(TriangleMesh mesh, double factor) {
  for (Vec3& v : mesh.vertices) v *= factor;
  return mesh;
}

template <class Tree>
std::vector<Cost> ask(const TriangleMesh& sphere, const std::vector<double>& scales,
                      const std::vector<Transform>& poses) {
  const Tree a(sphere);
  QueryContext context;
  std::vector<Cost> costs;
  for (const double scale : scales) {
    const Tree b(scaled(sphere, scale));
    Cost cost;
    std::vector<double> ns;
    for (const Transform& X : poses) {
      const auto query = [&] { interference(Posed(a), Posed(b, X), context); };
      const auto counted = [&] {
        context.counters = {};
        query();
      };
      double least = nanosecondsOf(counted, counted);
      cost.boxTests += static_cast<double>(context.counters.boxTests);
      cost.primitiveTests += static_cast<double>(context.counters.primitiveTests);
      for (int i = 0; i < 2 && least < 1e8; ++i)  // no repeat above 0.1 s
        least = std::min(least, nanosecondsOf(query, query));
      ns.push_back(least);
    }
    cost.boxTests /= static_cast<double>(poses.size());
    cost.primitiveTests /= static_cast<double>(poses.size());
    cost.us = medianOf(ns) / 1e3;
    costs.push_back(cost);
  }
  return costs;
}

const std::vector<std::pair<std::string, Ask>>& volumes() {
  static const std::vector<std::pair<std::string, Ask>> all = {
      {"obb (wide)", ask<Obb4Tree>},         {"obb", ask<VolumeTree<Obb>>},
      {"rss", ask<VolumeTree<Rss>>},         {"kdop26", ask<VolumeTree<Kdop<26>>>},
      {"kdop18", ask<VolumeTree<Kdop<18>>>}, {"kdop14", ask<VolumeTree<Kdop<14>>>},
      {"aabb", ask<VolumeTree<Aabb>>},       {"sphere", ask<VolumeTree<BoundingSphere>>}};
  return all;
}

/// Adds a dashed line of this slope, from `first` at the plot's largest gap up to the largest N_v.
void addGuide(Plot& plot, int slope, double first) {
  double most = 0;
  for (const PlotSeries& series : plot.series)
    for (const PlotPoint& p : series.points) most = std::max(most, p.y);
  PlotSeries guide{"slope " + std::to_string(slope), 10, PlotSeries::Style::dashes, {}};
  const std::vector<PlotPoint> points = plot.series[0].points;
  for (const PlotPoint& p : points)
    if (const double y = first * std::pow(p.x / points[0].x, slope); y <= 2 * most)
      guide.points.push_back({p.x, y});
  plot.series.push_back(guide);
}

struct Options {
  std::filesystem::path out;
  std::vector<double> frequencies;
  int rotations = 0;
};

void sweep(const Options& o, std::mt19937_64& random) {
  std::vector<Transform> poses(static_cast<std::size_t>(o.rotations));
  for (Transform& X : poses) X.m = randomRotation(random);
  std::cout << "triangles,gap,volume,bv_tests,triangle_tests,us\n";
  std::string slopes;
  for (const double frequency : o.frequencies) {
    const TriangleMesh sphere = icosphere(static_cast<int>(frequency));
    const double in = inradius(sphere);
    std::vector<double> gaps, scales;
    for (double gap = 0.3; gap > 30 * (1 - in); gap /= std::cbrt(10)) {
      gaps.push_back(gap);
      scales.push_back((1 + gap) / in);
    }
    const std::string n = std::to_string(sphere.triangles.size());
    const std::string title = "Two concentric spheres of " + n + " triangles";
    Plot nv{"proximity_tests_" + n, title, "1 / gap (radius 1)", "N_v", true, true},
        us{"proximity_time_" + n,     title, "1 / gap (radius 1)",
           "µs per query (one core)", true,  true};
    for (const auto& [name, measure] : volumes()) {
      const std::vector<Cost> costs = measure(sphere, scales, poses);
      std::vector<PlotPoint> counts, times, unsaturated;
      for (std::size_t i = 0; i < gaps.size(); ++i) {
        const Cost& c = costs[i];
        std::cout << n << "," << gaps[i] << "," << name << "," << c.boxTests << ","
                  << c.primitiveTests << "," << c.us << std::endl;
        counts.push_back({1 / gaps[i], c.boxTests});
        times.push_back({1 / gaps[i], c.us});
        if (c.primitiveTests < 0.01 * c.boxTests) unsaturated.push_back(counts.back());
      }
      slopes += n + "," + name + "," + text(logSlope(counts)) + "," + text(logSlope(unsaturated)) +
                "," + std::to_string(unsaturated.size()) + "\n";
      addLine(nv, name, counts);
      addLine(us, name, times);
    }
    if (!o.out.empty()) {
      addGuide(nv, 1, 200);     // below the curves of boxes
      addGuide(nv, 2, 30'000);  // above the curve of spheres
      writePlot(nv, o.out);
      writePlot(us, o.out);
    }
  }
  std::cout << "\ntriangles,volume,slope_all_gaps,slope_unsaturated,gaps_unsaturated\n" << slopes;
}

/// Measures a pair of spheres at several placements.
void placements(std::mt19937_64& random) {
  const TriangleMesh sphere = icosphere(32);
  constexpr double gap = 0.02;
  // Distance of the outer sphere's corners from its centre.
  const double reach = (1 + gap) / inradius(sphere);
  const Vec3 diagonal = Vec3::Ones().normalized(), axis = Vec3::UnitX();
  const Vec3 slanted = Vec3(3, 2, 1).normalized();
  struct Placement {
    std::string name;
    Vec3 at;
    bool rotated;
  };
  const std::vector<Placement> all = {
      {"concentric, rotated", {0, 0, 0}, true},
      {"inside, off centre by 0.95 gap, rotated", 0.95 * gap * slanted, true},
      {"beside along an axis, gap 0.01", (1 + reach + 0.01) * axis, false},
      {"beside along an axis, gap 0.0001, rotated", (1 + reach + 1e-4) * axis, true},
      {"beside along the diagonal, gap 0.01", (1 + reach + 0.01) * diagonal, false},
      {"beside along the diagonal, gap 0.01, rotated", (1 + reach + 0.01) * diagonal, true},
      {"beside, slanted, gap 0.2, rotated", (1 + reach + 0.2) * slanted, true},
      {"beside, slanted, gap 0.01, rotated", (1 + reach + 0.01) * slanted, true},
      {"beside, slanted, gap 0.0001, rotated", (1 + reach + 1e-4) * slanted, true},
      {"through each other by 0.05, rotated", (1 + reach - 0.05) * slanted, true},
      {"through each other by half, rotated", slanted, true}};
  std::cout << "\nplacement";
  for (const auto& [name, measure] : volumes()) std::cout << "," << name << " us (N_v)";
  std::cout << ",quickest VolumeTree,least N_v\n";
  for (const Placement& p : all) {
    std::vector<Transform> poses(p.rotated ? 11 : 1);
    for (Transform& X : poses) {
      X.t = p.at;
      if (p.rotated) X.m = randomRotation(random);
    }
    std::cout << '"' << p.name << '"';
    std::pair<double, std::string> quickest = {HUGE_VAL, ""}, fewest = quickest;
    for (const auto& [name, measure] : volumes()) {
      const Cost c = measure(sphere, {reach}, poses)[0];
      std::cout << "," << text(c.us) << " (" << std::round(c.boxTests) << ")";
      if (name == "obb (wide)") continue;  // another layout: not comparable between volumes
      quickest = std::min(quickest, {c.us, name});
      fewest = std::min(fewest, {c.boxTests, name});
    }
    std::cout << "," << quickest.second << "," << fewest.second << std::endl;
  }
}

void run(const Arguments& arguments) {
  Options o;
  o.out = arguments.text("--out");
  o.frequencies = arguments.numbers("--frequency", {7, 22, 71, 223});
  o.rotations = static_cast<int>(arguments.number("--rotations", 3));
  std::mt19937_64 random(1996);
  sweep(o, random);
  placements(random);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--out", "--frequency", "--rotations"},
                                  corridor::run);
}
