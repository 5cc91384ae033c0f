/// Compares refitting with rebuilding while a mesh deforms: `refit_benchmark [--out FOLDER]
/// [--triangles N] [--frames N]`.
/// A bumpy torus bends to a half circle, twists by a full rotation between its ends, or has a wave
/// running through it. The deformation is an animation in N steps, with the frames 0 to N. In every
/// frame there are two trees: one that was built in the first frame and has only been refitted
/// since, and one that is built anew. The program measures the milliseconds for refitting and for
/// building (least of three). With either tree it measures the cost of queries against a sphere, at
/// poses where mesh and sphere are 0.02 apart and at poses where they just touch: means of N_v and
/// N_p, and the median time. Prints CSV on stdout, with the means over the frames at the end;
/// FOLDER gets plots of N_v. "obb (wide)" is the 4-wide OBB tree; its N_v counts tests of pairs of
/// boxes, as those of the binary trees do.
#include <functional>
#include <iostream>
#include <limits>
#include <map>

#include "collision/core/quantiles.h"
#include "collision/course/query_timing.h"
#include "collision/queries/interference.h"
#include "collision/queries/interference_obb4.h"
#include "collision/volumes/pair_tests.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/placement.h"
#include "tests/benchmark/plot.h"

namespace corridor {
namespace {

using namespace bench;

struct Options {
  std::filesystem::path out;
  std::size_t triangles = 0;
  int frames = 0;
};

/// Maps a point of the torus, in the torus' own coordinates. The second argument is the progress of
/// the deformation, 0 to 1.
using Deformation = std::function<Vec3(const Vec3&, double)>;

Vec3 bent(const Vec3& p, double s) {
  const double curvature = s * std::numbers::pi / 2.8;  // the torus is 2.8 long
  if (curvature == 0) return p;
  const double r = 1 / curvature + p.z(), angle = curvature * p.x();
  return {r * std::sin(angle), p.y(), r * std::cos(angle) - 1 / curvature};
}
Vec3 twisted(const Vec3& p, double s) {
  const double angle = 2 * std::numbers::pi * s * p.x() / 2.8;
  return {p.x(), std::cos(angle) * p.y() - std::sin(angle) * p.z(),
          std::sin(angle) * p.y() + std::cos(angle) * p.z()};
}
Vec3 waving(const Vec3& p, double s) {  // two periods, and at full height after a quarter
  const double height = 0.3 * std::min(1.0, 4 * s);
  return p + Vec3(0, 0, height * std::sin(4 * p.x() - 4 * std::numbers::pi * s));
}

double milliseconds(const std::function<void()>& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) least = std::min(least, nanosecondsOf(work, work) / 1e6);
  return least;
}

struct Cost {
  double boxTests = 0, primitiveTests = 0, us = 0;
};
template <class Tree>
Cost ask(const Tree& a, const Tree& b, const std::vector<Transform>& poses) {
  QueryContext context;
  Cost cost;
  std::vector<double> ns;
  const auto count = static_cast<double>(poses.size());
  for (const Transform& X : poses) {
    context.counters = {};
    interference(Posed(a), Posed(b, X), context);
    cost.boxTests += static_cast<double>(context.counters.boxTests) / count;
    cost.primitiveTests += static_cast<double>(context.counters.primitiveTests) / count;
    const auto query = [&] { interference(Posed(a), Posed(b, X), context); };
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) least = std::min(least, nanosecondsOf(query, query));
    ns.push_back(least);
  }
  cost.us = medianOf(ns) / 1e3;
  return cost;
}

struct Frame {
  TriangleMesh mesh;
  std::vector<Transform> poses;  ///< poses of the sphere
};

struct Sums {
  double rebuild = 0, refit = 0, boxes = 0, us = 0, frames = 0, lastBoxes = 0, lastUs = 0;
};

/// Measures all frames with one kind of tree, prints the rows, and adds the costs to `sums`.
/// Returns, for each frame, the ratio of N_v after refitting to N_v after rebuilding.
template <class Tree>
std::vector<PlotPoint> sequence(const std::string& deformation, const std::string& name,
                                const std::vector<Frame>& frames, const TriangleMesh& sphere,
                                Sums& sums) {
  std::vector<PlotPoint> ratios;
  const Tree b(sphere);
  Tree refitted(frames[0].mesh);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Frame& f = frames[i];
    Tree rebuilt(f.mesh);
    const double rebuild = milliseconds([&] { rebuilt = Tree(f.mesh); });
    const Cost anew = ask(rebuilt, b, f.poses);
    const double refit = milliseconds([&] { refitted.refit(f.mesh); });
    const Cost kept = ask(refitted, b, f.poses);
    std::cout << deformation << "," << i << "," << name << "," << rebuild << "," << refit << ","
              << anew.boxTests << "," << kept.boxTests << "," << anew.primitiveTests << ","
              << kept.primitiveTests << "," << anew.us << "," << kept.us << std::endl;
    ratios.push_back({static_cast<double>(i), kept.boxTests / anew.boxTests});
    sums.rebuild += rebuild, sums.refit += refit, sums.frames += 1;
    sums.boxes += kept.boxTests / anew.boxTests, sums.us += kept.us / anew.us;
    sums.lastBoxes = kept.boxTests / anew.boxTests, sums.lastUs = kept.us / anew.us;
  }
  return ratios;
}

void report(const Options& o) {
  const TriangleMesh torus = bumpyTorus(o.triangles);
  TriangleMesh sphere =
      icosphere(static_cast<int>(std::sqrt(static_cast<double>(o.triangles) / 20)));
  for (Vec3& v : sphere.vertices) v *= 0.5;
  const Obb4Tree wideSphere(sphere);
  std::cout << "deformation,frame,volume,rebuild_ms,refit_ms,bv_tests_rebuilt,bv_tests_refitted,"
               "triangle_tests_rebuilt,triangle_tests_refitted,us_rebuilt,us_refitted\n";
  std::string table =
      "\ndeformation,volume,rebuild_ms,refit_ms,N_v refitted/rebuilt,at the last frame,"
      "time refitted/rebuilt,at the last frame\n";
  const std::vector<std::pair<std::string, Deformation>> deformations = {
      {"bend", bent}, {"twist", twisted}, {"wave", waving}};
  for (const auto& [deformation, deform] : deformations) {
    std::mt19937_64 random(1998);
    std::vector<Frame> frames;
    for (int i = 0; i <= o.frames; ++i) {
      frames.push_back({torus, {}});
      for (Vec3& v : frames.back().mesh.vertices) v = deform(v, static_cast<double>(i) / o.frames);
      const Obb4Tree tree(frames.back().mesh);
      frames.back().poses = posesAtGap(tree, wideSphere, 0.02, 15, random);
      for (Transform& X : posesAtGap(tree, wideSphere, 1e-3, 5, random)) {
        X.t *= 1 - 5e-3;  // into contact
        frames.back().poses.push_back(X);
      }
    }
    Plot plot{"refit_" + deformation, "Trees refitted since frame 0: " + deformation, "frame",
              "N_v refitted / N_v rebuilt"};
    const auto measure = [&, &name = deformation]<class Tree>(const std::string& volume, Tree*) {
      Sums s;
      const auto ratios = sequence<Tree>(name, volume, frames, sphere, s);
      addLine(plot, volume, ratios);
      table += name + "," + volume + "," + text(s.rebuild / s.frames) + "," +
               text(s.refit / s.frames) + "," + text(s.boxes / s.frames) + "," + text(s.lastBoxes) +
               "," + text(s.us / s.frames) + "," + text(s.lastUs) + "\n";
    };
    measure("obb", static_cast<VolumeTree<Obb>*>(nullptr));
    measure("rss", static_cast<VolumeTree<Rss>*>(nullptr));
    measure("aabb", static_cast<VolumeTree<Aabb>*>(nullptr));
    measure("sphere", static_cast<VolumeTree<BoundingSphere>*>(nullptr));
    measure("kdop14", static_cast<VolumeTree<Kdop<14>>*>(nullptr));
    measure("kdop18", static_cast<VolumeTree<Kdop<18>>*>(nullptr));
    measure("kdop26", static_cast<VolumeTree<Kdop<26>>*>(nullptr));
    measure("obb (wide)", static_cast<Obb4Tree*>(nullptr));
    if (!o.out.empty()) writePlot(plot, o.out);
  }
  std::cout << table;
}

void run(const Arguments& arguments) {
  Options o;
  o.out = arguments.text("--out");
  o.triangles = static_cast<std::size_t>(arguments.number("--triangles", 20'000));
  o.frames = static_cast<int>(arguments.number("--frames", 12));
  report(o);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--out", "--triangles", "--frames"}, corridor::run);
}
