/// Compares our distances and contacts of convex shapes with those of FCL's two solvers:
/// `shape_distance_benchmark [SEED]`.
///
/// The gap of each pair is known by construction. For each pair of kinds and each gap, the program
/// prints the median nanoseconds of a query with witness points (batches of 100 pairs, interleaved)
/// and the largest error in metres. Shapes are some 1 m in size. `-` means that FCL reported
/// contact of shapes that are apart. A second table has the median nanoseconds of a contact query,
/// and the number of wrong verdicts out of 100. A negative gap is a depth.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#ifdef CORRIDOR_WITH_FCL
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#endif

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/core/quantiles.h"
#include "tests/collision/convex/touching_pairs.h"

namespace corridor {
namespace {

using test::Shape;
using test::ShapeFeature;

constexpr const char* kNames[] = {"box", "sphere", "capsule", "cylinder", "convex"};
constexpr int kBatch = 100, kRounds = 15;

/// Returns a shape that is nowhere thinner than 5 cm. The convex polytope is an octahedron; its
/// feature is its top corner.
ShapeFeature featureOf(test::Touching& make, Shape shape) {
  if (shape != Shape::convex)
    while (true) {
      ShapeFeature f = make.feature(shape);
      const auto& p = f.part.points;
      const double length = p.size() > 1 ? (p[1] - p[0]).norm() : 1;
      const double thin = p.size() == 8 ? 2 * p[7].minCoeff() : std::min(f.part.radius, length);
      if (thin >= 0.05) return f;
    }
  ShapeFeature f;
  for (int i = 0; i < 3; ++i)
    for (const double side : {-1.0, 1.0})
      f.part.points.push_back(side * make.real(0.1, 0.7) * Vec3::Unit(i));
  f.x = f.part.points[5];
  return f;
}

struct Case {
  ShapeFeature a, b;
  Transform X_WA, X_WB;
};

#ifdef CORRIDOR_WITH_FCL
std::unique_ptr<fcl::CollisionGeometryd> fclShape(Shape shape, const ConvexPart& part) {
  const auto& p = part.points;
  const double length = p.size() > 1 ? (p[1] - p[0]).norm() : 0;
  switch (shape) {
    case Shape::box:
      return std::make_unique<fcl::Boxd>(2 * p[7]);
    case Shape::sphere:
      return std::make_unique<fcl::Sphered>(part.radius);
    case Shape::capsule:
      return std::make_unique<fcl::Capsuled>(part.radius, length);
    case Shape::cylinder:
      return std::make_unique<fcl::Cylinderd>(part.radius, length);
    default: {
      const auto faces = std::make_shared<std::vector<int>>();
      for (int i = 0; i < 8; ++i) {
        const int x = i & 1, y = 2 + (i >> 1 & 1), z = 4 + (i >> 2 & 1);
        const bool outward = (x + y + z) % 2 != 0;
        faces->insert(faces->end(), {3, x, outward ? y : z, outward ? z : y});
      }
      return std::make_unique<fcl::Convexd>(std::make_shared<const std::vector<Vec3>>(p), 8, faces);
    }
  }
}

fcl::Transform3d fclPose(const Transform& X) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.linear() = X.m;
  pose.translation() = X.t;
  return pose;
}

struct FclCase {
  std::unique_ptr<fcl::CollisionGeometryd> a, b;
  fcl::Transform3d X_WA, X_WB;

  double distance(fcl::GJKSolverType solver) const {
    const fcl::DistanceRequestd request(true, false, 0, 0, 1e-6, solver);
    fcl::DistanceResultd result;
    fcl::distance(a.get(), X_WA, b.get(), X_WB, request, result);
    return result.min_distance;
  }
  bool touch(fcl::GJKSolverType solver) const {
    fcl::CollisionRequestd request(1, false);
    request.gjk_solver_type = solver;
    fcl::CollisionResultd result;
    return fcl::collide(a.get(), X_WA, b.get(), X_WB, request, result) > 0;
  }
};
#endif

struct Competitor {
  const char* name;
  std::function<double(std::size_t)> ask;
  std::vector<double> ns{};
  double worst = 0;
  int wrong = 0;  ///< contact queries only
};

/// Returns pairs whose features are `gap` apart.
std::vector<Case> casesOf(test::Touching& make, Shape sa, Shape sb, double gap) {
  std::vector<Case> cases;
  for (int i = 0; i < kBatch; ++i) {
    Case c{featureOf(make, sa), featureOf(make, sb), {}, {}};
    const Vec3 normal = make.vector().normalized(), x = make.vector();
    c.X_WA = make.pose(c.a, x, normal);
    c.X_WB = make.pose(c.b, x, -normal);
    c.X_WB.t = (c.X_WB.t.cast<long double>() + normal.cast<long double>() * gap).cast<double>();
    cases.push_back(std::move(c));
  }
  return cases;
}

/// Runs all competitors on all cases, interleaved. `check(competitor, answer)` is called for each
/// answer.
template <class Check>
void race(std::vector<Competitor>& all, const Check& check) {
  for (int round = 0; round < kRounds; ++round)
    for (Competitor& who : all) {
      std::vector<double> found(kBatch);
      const auto start = std::chrono::steady_clock::now();
      for (std::size_t i = 0; i < found.size(); ++i) found[i] = who.ask(i);
      const std::chrono::duration<double, std::nano> took =
          std::chrono::steady_clock::now() - start;
      who.ns.push_back(took.count() / kBatch);
      if (round == 0)
        for (const double d : found) check(who, d);
    }
}

void measureContact(test::Touching& make, Shape sa, Shape sb, double gap) {
  const auto cases = casesOf(make, sa, sb, gap);
  std::vector<Competitor> all;
  all.push_back({"ours", [&](std::size_t i) {
                   const Case& c = cases[i];
                   return convexSetsTouch({c.a.part, c.X_WA}, {c.b.part, c.X_WB}) ? 1.0 : 0.0;
                 }});
#ifdef CORRIDOR_WITH_FCL
  std::vector<FclCase> theirs;
  for (const Case& c : cases)
    theirs.push_back(
        {fclShape(sa, c.a.part), fclShape(sb, c.b.part), fclPose(c.X_WA), fclPose(c.X_WB)});
  for (const auto solver : {fcl::GST_LIBCCD, fcl::GST_INDEP})
    all.push_back({solver == fcl::GST_LIBCCD ? "FCL libccd" : "FCL indep",
                   [&, solver](std::size_t i) { return theirs[i].touch(solver) ? 1.0 : 0.0; }});
#endif
  race(all, [&](Competitor& who, double touch) { who.wrong += (touch > 0) != (gap < 0); });
  std::printf("| %s, %s | %.0e |", kNames[int(sa)], kNames[int(sb)], gap);
  for (Competitor& who : all) std::printf(" %.0f, %d |", medianOf(who.ns), who.wrong);
  std::printf("\n");
}

void measure(test::Touching& make, Shape sa, Shape sb, double gap) {
  const auto cases = casesOf(make, sa, sb, gap);
  std::vector<Competitor> all;
  all.push_back({"ours", [&](std::size_t i) {
                   const Case& c = cases[i];
                   return convexDistance({c.a.part, c.X_WA}, {c.b.part, c.X_WB}).distance;
                 }});
  all.push_back({"ours to 1e-6", [&](std::size_t i) {
                   const Case& c = cases[i];
                   return convexDistance({c.a.part, c.X_WA}, {c.b.part, c.X_WB}, 0, 1e-6).distance;
                 }});
#ifdef CORRIDOR_WITH_FCL
  std::vector<FclCase> theirs;
  for (const Case& c : cases)
    theirs.push_back(
        {fclShape(sa, c.a.part), fclShape(sb, c.b.part), fclPose(c.X_WA), fclPose(c.X_WB)});
  all.push_back({"FCL libccd", [&](std::size_t i) { return theirs[i].distance(fcl::GST_LIBCCD); }});
  all.push_back({"FCL indep", [&](std::size_t i) { return theirs[i].distance(fcl::GST_INDEP); }});
#endif
  race(all, [&](Competitor& who, double d) {
    who.worst = d > 0 ? std::max(who.worst, std::abs(d - gap)) : HUGE_VAL;
  });
  std::printf("| %s, %s | %.0e |", kNames[int(sa)], kNames[int(sb)], gap);
  for (Competitor& who : all) {
    if (std::isinf(who.worst))
      std::printf(" %.0f, - |", medianOf(who.ns));
    else
      std::printf(" %.0f, %.0e |", medianOf(who.ns), who.worst);
  }
  std::printf("\n");
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  using namespace corridor;
  const std::uint64_t seed = argc > 1 ? std::strtoull(argv[1], nullptr, 10) : 1;
  std::printf("seed %llu; ns, largest error\n\n| pair | gap | ours | ours to 1e-6 |",
              static_cast<unsigned long long>(seed));
#ifdef CORRIDOR_WITH_FCL
  std::printf(" FCL libccd | FCL indep |");
#endif
  std::printf("\n");
  test::Touching make(seed);
  const auto eachPair = [](const auto& run) {
    for (const test::Shape sa : test::kShapes)
      for (const test::Shape sb : test::kShapes)
        if (sa <= sb && sb != test::Shape::triangle) run(sa, sb);
  };
  for (const double gap : {1.0, 1e-3})
    eachPair([&](test::Shape sa, test::Shape sb) { measure(make, sa, sb, gap); });
  std::printf("\nns, wrong verdicts\n\n| pair | gap | ours |");
#ifdef CORRIDOR_WITH_FCL
  std::printf(" FCL libccd | FCL indep |");
#endif
  std::printf("\n");
  for (const double gap : {1.0, 1e-3, -1e-3, -0.02})
    eachPair([&](test::Shape sa, test::Shape sb) { measureContact(make, sa, sb, gap); });
}
