/// Measures how queries on convex polytopes grow with the number of vertices:
/// `polytope_benchmark [--most N] [--queries N] [--cpu N]`.
///
/// The polytopes are hulls of n random points on a sphere, n = 10, 100, … up to N (default 10^6).
/// Each query runs with three ways to find the vertex that is farthest along a direction: every
/// vertex, hill climbing from vertex 0 (cold), and the hierarchy of Dobkin and Kirkpatrick. Prints
/// CSV; times are medians over the queries, in microseconds, each the least of three runs.
///
/// * `extreme`: the farthest vertex along a random direction.
/// * `plane`: on which side of a plane a polytope lies, or whether the plane cuts it. The planes
///   are random; they cut the polytope or miss it, by up to half of its size.
/// * `interference`: whether two polytopes of n vertices touch. Half of the pairs have a gap of 5 %
///   of the size, the others overlap by 5 %, along random directions.
/// * `touching`: like `interference`, with a gap or depth of 1e-12 of the size.
/// * `distance`: the distance of the disjoint pairs. `depth`, `depth along`: the penetration depth
///   of the overlapping pairs, least or along a given direction.
/// * `separation`: the signed separation of a polytope from a random plane, with its witness.
///   `side`: only the side of the plane on which the polytope lies.
/// * The contact queries also run by Barba and Langerman's algorithm with inner and outer
///   hierarchies, by V-Clip, by separating axes (up to 1000 vertices) and by linear programming (up
///   to 10^4). The distance also runs by V-Clip.
/// * `polygon interference`: whether two convex polygons of n vertices touch. The pairs are made
///   like those of `interference`.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/convex/dobkin_kirkpatrick.h"
#include "collision/convex/penetration.h"
#include "collision/course/outer_hierarchy.h"
#include "collision/course/plane_separation.h"
#include "collision/course/polygon_intersection.h"
#include "collision/course/polytope_intersection.h"
#include "collision/course/separating_axes.h"
#include "collision/course/separating_plane.h"
#include "collision/course/vclip.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/median_time.h"

namespace corridor {
namespace {

using namespace bench;

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  Vec3 direction() {
    return Vec3(normal_(engine_), normal_(engine_), normal_(engine_)).normalized();
  }
  Mat3 rotation() {
    return Eigen::Quaterniond(normal_(engine_), normal_(engine_), normal_(engine_),
                              normal_(engine_))
        .normalized()
        .toRotationMatrix();
  }
  double real() { return std::uniform_real_distribution(-1.0, 1.0)(engine_); }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

std::vector<Vec3> onSphere(Random& random, std::size_t count) {
  std::vector<Vec3> points(count);
  for (Vec3& p : points) p = random.direction();
  return points;
}

double milliseconds(const auto& call) {
  const auto before = std::chrono::steady_clock::now();
  call();
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - before;
  return time.count();
}

struct Pair {
  Transform X_WA, X_WB;
};

/// Moves b along the line through the centres until the gap is `gap` (negative: the depth).
Pair pairWith(Random& random, const DobkinKirkpatrick& a, const DobkinKirkpatrick& b, double gap) {
  Pair pair{{random.rotation(), 0.1 * random.direction()}, {random.rotation(), Vec3::Zero()}};
  const Vec3 d = random.direction();
  pair.X_WB.t = pair.X_WA.t + 4 * d;
  const double apart = convexDistance({a, pair.X_WA}, {b, pair.X_WB}).distance;
  Transform X = pair.X_WB;
  // b advances along the line until the polytopes touch; each step is as long as the distance that
  // is left. For polytopes that are nearly spheres, one step is enough.
  X.t -= d * apart;
  for (int i = 0; i < 50; ++i) {
    const double left = convexDistance({a, pair.X_WA}, {b, X}).distance;
    if (left < 1e-15) break;
    X.t -= d * left;
  }
  X.t += d * gap;
  pair.X_WB = X;
  return pair;
}

/// The largest numbers of vertices for which separating axes and linear programming are measured.
/// For more vertices, separating axes take seconds, because their number is O(n²); linear programs
/// take long, too, although their time is O(n).
constexpr std::size_t kMostForAxes = 1000, kMostForPrograms = 10'000;

void measure(std::size_t n, std::size_t queries) {
  Random random(n);
  const std::vector<Vec3> pointsA = onSphere(random, n), pointsB = onSphere(random, n);
  std::optional<Polytope> hull;
  const double hullMs = milliseconds([&] { hull.emplace(pointsA); });
  Polytope copy = *hull;
  std::optional<DobkinKirkpatrick> fastA;
  const double hierarchyMs = milliseconds([&] { fastA.emplace(std::move(copy)); });
  const DobkinKirkpatrick fastB{Polytope(pointsB)};
  const Polytope &a = *hull, &b = fastB.polytope();
  const ConvexPart partA{{a.vertices().begin(), a.vertices().end()}, 0, false},
      partB{{b.vertices().begin(), b.vertices().end()}, 0, false};
  const auto row = [&](const std::string& query, const std::string& by, double value) {
    std::cout << n << ',' << query << ',' << by << ',' << value << std::endl;
  };
  row("build hull (ms)", "quickhull", hullMs);
  row("build hierarchy (ms)", "Dobkin-Kirkpatrick", hierarchyMs);
  row("levels", "Dobkin-Kirkpatrick", static_cast<double>(fastA->levels()));
  row("bytes per vertex", "Dobkin-Kirkpatrick",
      static_cast<double>(fastA->bytes()) / static_cast<double>(n));
  std::optional<OuterHierarchy> outerB;
  const double outerMs = milliseconds([&] { outerB.emplace(fastB); });
  row("build outer hierarchy (ms)", "Barba-Langerman", outerMs);
  row("levels", "outer hierarchy", static_cast<double>(outerB->polar()->levels()));
  row("bytes per vertex", "outer hierarchy",
      static_cast<double>(outerB->bytes()) / static_cast<double>(n));

  std::vector<Vec3> directions(queries);
  std::vector<double> offsets(queries);
  for (Vec3& d : directions) d = random.direction();
  for (double& c : offsets) c = 1.5 * random.real();
  struct Way {
    std::string name;
    ConvexSet a, b;
  };
  const std::vector<Way> ways = {
      {"every vertex", partA, partB}, {"hill climbing", a, b}, {"hierarchy", *fastA, fastB}};
  std::size_t sink = 0;
  for (const Way& way : ways) {
    row("extreme", way.name,
        medianMicroseconds(queries, [&](std::size_t i) { sink += way.a.farthest(directions[i]); }));
    const PosedSet set(way.a, {});
    row("plane", way.name, medianMicroseconds(queries, [&](std::size_t i) {
          sink += set.highest(directions[i]) < offsets[i];
          sink += -set.highest(-directions[i]) > offsets[i];
        }));
  }
  row("separation", "hierarchy", medianMicroseconds(queries, [&](std::size_t i) {
        sink += planeSeparation(*fastA, {directions[i], offsets[i]}).lower > 0;
      }));
  row("side", "hierarchy", medianMicroseconds(queries, [&](std::size_t i) {
        sink += sideOfPlane(*fastA, {directions[i], offsets[i]}) > 0;
      }));
  const auto pairsWith = [&](const std::vector<double>& gaps, std::size_t count) {
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < count; ++i)
      pairs.push_back(pairWith(random, *fastA, fastB, gaps[i % gaps.size()]));
    return pairs;
  };
  const std::size_t few = std::max<std::size_t>(10, queries / 10);
  const auto clear = pairsWith({0.05, -0.05}, few), touching = pairsWith({1e-12, -1e-12}, few),
             apart = pairsWith({0.05}, few), deep = pairsWith({-0.05}, few);
  for (const Way& way : ways) {
    const auto time = [&](const std::string& query, const std::vector<Pair>& pairs,
                          const auto& call) {
      row(query, way.name, medianMicroseconds(pairs.size(), [&](std::size_t i) {
            call(PosedSet(way.a, pairs[i].X_WA), PosedSet(way.b, pairs[i].X_WB));
          }));
    };
    const auto touch = [&](const PosedSet& x, const PosedSet& y) { sink += convexSetsTouch(x, y); };
    time("interference", clear, touch);
    time("touching", touching, touch);
    time("distance", apart,
         [&](const PosedSet& x, const PosedSet& y) { sink += convexDistance(x, y).distance > 1; });
    time("depth", deep,
         [&](const PosedSet& x, const PosedSet& y) { sink += penetration(x, y).upper > 1; });
    time("depth along", deep, [&](const PosedSet& x, const PosedSet& y) {
      sink += penetrationAlong(x, y, {1, 2, 3}).upper > 1;
    });
  }
  const PolytopeFeatures featuresA(*fastA), featuresB(fastB);
  const auto other = [&](const std::string& query, const std::string& by,
                         const std::vector<Pair>& pairs, const auto& call) {
    row(query, by, medianMicroseconds(pairs.size(), [&](std::size_t i) { call(pairs[i]); }));
  };
  const auto closest = [&](const Pair& pair) {
    FeaturePair cold;
    sink += closestFeatures(featuresA, pair.X_WA, featuresB, pair.X_WB, cold).distance.distance > 1;
  };
  other("distance", "V-Clip", apart, closest);
  for (const auto& [query, pairs] :
       {std::pair("interference", &clear), std::pair("touching", &touching)}) {
    int most = 0;
    std::size_t steps = 0, exact = 0;
    for (const Pair& pair : *pairs) {
      const auto found = intersection(*fastA, pair.X_WA, *outerB, pair.X_WB);
      steps += static_cast<std::size_t>(found.steps);
      exact += found.exact;
      most = std::max(most, found.steps);
    }
    other(query, "Barba-Langerman", *pairs, [&](const Pair& pair) {
      sink += intersection(*fastA, pair.X_WA, *outerB, pair.X_WB).intersects;
    });
    row(std::string(query) + " (mean steps)", "Barba-Langerman",
        static_cast<double>(steps) / static_cast<double>(pairs->size()));
    row(std::string(query) + " (most steps)", "Barba-Langerman", most);
    row(std::string(query) + " (decided by all)", "Barba-Langerman",
        static_cast<double>(exact) / static_cast<double>(pairs->size()));
    other(query, "V-Clip", *pairs, closest);
    if (n <= kMostForAxes)
      other(query, "separating axes", *pairs, [&](const Pair& pair) {
        sink += separatingAxis(featuresA, pair.X_WA, featuresB, pair.X_WB).separated;
      });
    if (n <= kMostForPrograms)
      other(query, "linear programming", *pairs, [&](const Pair& pair) {
        std::vector<Vec3> x, y;
        for (const Vec3& p : a.vertices()) x.push_back(pair.X_WA * p);
        for (const Vec3& p : b.vertices()) y.push_back(pair.X_WB * p);
        sink += separatingPlane<3>(std::span<const Vec3>(x), std::span<const Vec3>(y)).relation ==
                HullRelation::disjoint;
      });
  }
  // Convex polygons of n vertices, disjoint or overlapping by 5 % of the size.
  std::vector<Vec2> circle(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n);
    circle[i] = {std::cos(angle), std::sin(angle)};
  }
  const ConvexPolygon p(circle);
  std::vector<ConvexPolygon> others;
  for (std::size_t k = 0; k < few; ++k) {
    const double angle = M_PI * random.real();
    std::vector<Vec2> moved = circle;
    for (Vec2& x : moved) x += (k % 2 ? 2.05 : 1.95) * Vec2(std::cos(angle), std::sin(angle));
    others.emplace_back(moved);
  }
  row("polygon interference", "Barba-Langerman", medianMicroseconds(few, [&](std::size_t i) {
        sink += intersection(p, others[i]).intersects;
      }));
  if (sink == 1) std::cerr << ' ';  // so that the compiler can't remove the queries
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  using namespace corridor;
  return bench::runWith(argc, argv, {"--most", "--queries", "--cpu"},
                        [](const bench::Arguments& a) {
                          std::cerr << "pinned to CPU " << bench::pin(a) << "\n";
                          std::cout << "vertices,query,by,value\n" << std::setprecision(4);
                          const double most = a.number("--most", 1e6);
                          for (std::size_t n = 10; static_cast<double>(n) <= most; n *= 10)
                            measure(n, static_cast<std::size_t>(a.number("--queries", 200)));
                        });
}
