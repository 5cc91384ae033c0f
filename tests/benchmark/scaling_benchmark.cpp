/// Measures the cost of queries as meshes get finer: `scaling_benchmark [--out FOLDER] [--largest
/// N] [--poses N] [--gap G]…`.
///
/// Two bumpy tori of the same shape have 10^3 to N triangles each (default 10^6), and a gap of G
/// times their size (default 0.1, 0.01, 0.001). The query is interference; nothing touches. Our
/// 4-wide OBB tree runs at all sizes. The reference tree and FCL's OBB tree need several times the
/// memory, and run up to 10^6 triangles only. All competitors run in turns (competitors.h). Before
/// each turn the program reads other memory, so that no nodes of a tree are in the processor's
/// caches.
///
/// Prints CSV on stdout. At the end, for each competitor and gap, it prints by which factors time,
/// the number of volume tests (N_v) and the logarithm of the number of triangles grew from the
/// smallest mesh to the largest. It also prints these factors from the first mesh whose facets are
/// closer to the true surface than the gap is wide. On coarser meshes, a refinement also adds
/// places where the two surfaces are close. The plot is written to FOLDER.
#include <iostream>
#include <map>

#include "collision/core/quantiles.h"
#include "collision/queries/interference.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/competitors.h"
#include "tests/benchmark/placement.h"
#include "tests/benchmark/plot.h"

namespace corridor {
namespace {

using namespace bench;

struct Options {
  std::filesystem::path out;
  double largest = 0;
  int poses = 0;
  std::vector<double> gaps;
};

constexpr double kOthersUpTo = 1.1e6;
constexpr double kSize =
    2 * 1.44 * std::numbers::sqrt2;  // horizontal diagonal of the torus' box, metres

/// One competitor's results at one gap, over the size of the mesh.
struct Curve {
  double gap = 0;
  std::vector<PlotPoint> us, boxTests;
};

/// Returns the largest distance of the facets of a torus of n triangles from the true surface
/// (without the bumps): the sagitta of a circle of radius 0.4 that is divided into √(n/4) chords.
double sagitta(double n) {
  return 0.4 * (1 - std::cos(std::numbers::pi / std::sqrt(n / 4)));
}

/// Reads enough other memory to remove a tree completely from every cache.
void sweepCaches() {
  static std::vector<std::uint64_t> other(std::size_t{8} << 20, 1);  // 64 MB
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < other.size(); i += 8) sum += other[i];
  other[0] = sum;  // so that the compiler keeps the reads
}

/// Measures one size; prints one row per competitor and gap.
void measure(std::size_t triangles, const Options& o, std::map<std::string, Curve>& curves) {
  test::Workload w;
  w.a = bumpyTorus(triangles);
  w.b = w.a;
  const auto n = static_cast<double>(w.a.triangles.size());
  std::mt19937_64 random(2026);
  {
    const Obb4Tree tree(w.a);
    for (const double gap : o.gaps) {
      const auto poses = posesAtGap(tree, tree, gap * kSize, o.poses, random);
      w.poses.insert(w.poses.end(), poses.begin(), poses.end());
    }
  }
  std::vector<std::unique_ptr<Competitor>> field;
  const int builds = n < 2e5 ? 5 : 1;
  const auto enter = [&]<class Library>(const std::string& name, Library*) {
    field.push_back(std::make_unique<Timed<Library>>(
        name, w, builds, [&] { return std::make_unique<Library>(Query::interference, 0.0, w); }));
  };
  enter("ours (wide)", static_cast<Ours<Obb4Tree>*>(nullptr));
  if (n < kOthersUpTo) {
    enter("ours (reference)", static_cast<Ours<ObbTree>*>(nullptr));
#ifdef CORRIDOR_WITH_FCL
    enter("FCL OBB", static_cast<Fcl<fcl::OBB<double>>*>(nullptr));
#endif
  }
  for (int i = 0; i < 5; ++i)
    for (const auto& competitor : field) {
      sweepCaches();
      competitor->pass();
    }
  for (const auto& competitor : field) {
    const Record& r = competitor->record;
    const auto count = static_cast<std::size_t>(o.poses);
    for (std::size_t g = 0; g < o.gaps.size(); ++g) {
      std::vector<double> us;
      double boxTests = 0;
      int hits = 0;
      for (std::size_t i = g * count; i < (g + 1) * count; ++i) {
        us.push_back(r.ns[i] / 1e3);
        boxTests += static_cast<double>(r.answers[i].boxTests) / o.poses;
        hits += r.answers[i].hit;
      }
      const double middle = medianOf(us);
      std::cout << n << "," << o.gaps[g] << "," << r.name << "," << middle << "," << boxTests << ","
                << hits << "," << r.buildMs / (2 * n) * 1e3 << "," << r.bytesPerTriangle
                << std::endl;
      Curve& curve = curves[r.name + ", gap " + text(o.gaps[g])];
      curve.gap = o.gaps[g] * kSize;
      curve.us.push_back({n, middle});
      curve.boxTests.push_back({n, boxTests});
    }
  }
}

void report(const Options& o) {
  std::cout << "triangles,gap,who,median_us,bv_tests,hits,build_us_per_triangle,bytes_per_"
               "triangle\n";
  std::map<std::string, Curve> curves;
  for (double n = 1e3; n < 1.1 * o.largest; n *= std::sqrt(10.0))
    measure(static_cast<std::size_t>(n), o, curves);
  Plot plot{"scaling",
            "Interference, nothing touches, gap by size",
            "triangles of each mesh",
            "µs per query (one core)",
            true,
            true};
  std::cout << "\nwho,from_triangles,to_triangles,logarithm_grew,time_grew,N_v_grew\n";
  for (const auto& [name, curve] : curves) {
    const std::size_t last = curve.us.size() - 1;
    const auto row = [&, &name = name, &curve = curve](std::size_t first) {
      const PlotPoint from = curve.us[first], to = curve.us[last];
      std::cout << '"' << name << "\"," << from.x << "," << to.x << ","
                << text(std::log(to.x) / std::log(from.x)) << "," << text(to.y / from.y) << ",";
      if (curve.boxTests[first].y > 0)  // FCL's tests are not counted
        std::cout << text(curve.boxTests[last].y / curve.boxTests[first].y);
      std::cout << "\n";
    };
    row(0);
    std::size_t fine = 0;
    while (fine < last && sagitta(curve.us[fine].x) > curve.gap) ++fine;
    if (fine > 0) row(fine);
    addLine(plot, name, curve.us);
  }
  if (!o.out.empty()) writePlot(plot, o.out);
}

void run(const Arguments& arguments) {
  Options o;
  o.out = arguments.text("--out");
  o.largest = arguments.number("--largest", 1e6);
  o.poses = static_cast<int>(arguments.number("--poses", 40));
  o.gaps = arguments.numbers("--gap", {0.1, 0.01, 0.001});
  report(o);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--out", "--largest", "--poses", "--gap"},
                                  corridor::run);
}
