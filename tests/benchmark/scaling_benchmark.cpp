/// What queries cost as meshes get finer: `scaling_benchmark [--out FOLDER] [--largest N]
/// [--poses N] [--gap G]…`.
///
/// Two bumpy tori of the same shape at every size, from 10^3 to N triangles each (default 10^6),
/// apart by a gap of G times their size (default 0.1, 0.01, 0.001): interference, nothing touches.
/// Our wide tree at all sizes; the reference tree and FCL's OBB tree, which need several times the
/// memory, up to 10^6. All in one run, in turns (competitors.h), each turn after other memory was
/// read, so that no size has its nodes in the caches and another has not. CSV on stdout; then, of
/// each, how its time and N_v grew from the smallest mesh to the largest, against how the logarithm
/// did: also from the first mesh whose facets are flatter than the gap (before that, finer meshes
/// have more places that are close, not only more triangles). FOLDER gets the plot.
#include <iostream>
#include <map>

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
constexpr double kSize = 2 * 1.44 * std::numbers::sqrt2;  // across the torus' box, metres

/// One competitor at one gap: by size of mesh.
struct Curve {
  double gap = 0;
  std::vector<Point> us, boxTests;
};

/// How far a facet of a torus of n triangles is from its circle: radius 0.4, √(n/4) chords.
double sagitta(double n) {
  return 0.4 * (1 - std::cos(std::numbers::pi / std::sqrt(n / 4)));
}

/// Reads so much that nothing of a tree is left in any cache.
void sweepCaches() {
  static std::vector<std::uint64_t> other(std::size_t{8} << 20, 1);  // 64 MB
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < other.size(); i += 8) sum += other[i];
  other[0] = sum;  // else nothing would be read
}

/// One size: a row a competitor and gap.
void measure(std::size_t triangles, const Options& o, std::map<std::string, Curve>& curves) {
  test::Workload w;
  w.a = bumpyTorus(triangles);
  w.b = w.a;
  const auto n = static_cast<double>(w.a.triangles.size());
  std::mt19937_64 random(2026);
  {
    const WideObbTree tree(w.a);
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
  enter("ours (wide)", static_cast<Ours<WideObbTree>*>(nullptr));
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
      const double middle = app::median(us);
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
  Plot plot("Interference, nothing touches, gap by size", "triangles of each mesh",
            "µs a query (one core)");
  std::cout << "\nwho,from_triangles,to_triangles,logarithm_grew,time_grew,N_v_grew\n";
  for (const auto& [name, curve] : curves) {
    const std::size_t last = curve.us.size() - 1;
    const auto row = [&, &name = name, &curve = curve](std::size_t first) {
      const Point from = curve.us[first], to = curve.us[last];
      std::cout << '"' << name << "\"," << from.x << "," << to.x << ","
                << text(std::log(to.x) / std::log(from.x)) << "," << text(to.y / from.y) << ",";
      if (curve.boxTests[first].y > 0)  // FCL's are not counted
        std::cout << text(curve.boxTests[last].y / curve.boxTests[first].y);
      std::cout << "\n";
    };
    row(0);
    std::size_t fine = 0;
    while (fine < last && sagitta(curve.us[fine].x) > curve.gap) ++fine;
    if (fine > 0) row(fine);
    plot.add({name, curve.us});
  }
  if (!o.out.empty()) plot.write(o.out / "scaling.svg");
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
