/// Measures how queries on convex polytopes grow with the number of vertices:
/// `polytope_benchmark [--most N] [--queries N] [--cpu N]`.
///
/// The polytopes are hulls of n random points on a sphere, n = 10, 100, … up to N (default 10^5).
/// Each query runs with three ways to find the vertex that is farthest along a direction: every
/// vertex, hill climbing from vertex 0 (cold), and the hierarchy of Dobkin and Kirkpatrick. Prints
/// three tables in CSV: medians over the queries, then the times that 90 % of them don't exceed,
/// both in microseconds; each time is the least of three runs, or that of one, if the queries of a
/// cell take more than two seconds. The third table has what is built, and numbers of steps.
///
/// * `extreme`: the farthest vertex along a random direction.
/// * `plane`: on which side of a plane a polytope lies, or whether the plane cuts it. The planes
///   are random; they cut the polytope or miss it, by up to half of its size.
/// * `separation`: the signed separation of a polytope from a random plane, with its witness.
///   `side`: only the side of the plane on which the polytope lies.
/// * `contact`: whether two polytopes of n vertices touch. Pairs of one kind are never mixed: the
///   gap between them, or their overlap, along a random direction, is given in parts of the size.
/// * `distance`: the distance of disjoint pairs. `depth`, `depth along`: the penetration depth of
///   overlapping pairs, least or along a given direction.
/// * Contact also by Barba and Langerman's algorithm with inner and outer hierarchies, by V-Clip,
/// by
///   separating axes (up to 1000 vertices) and by linear programming (up to 10^4). The distance
///   also by V-Clip, distance and depth along a direction also by Dobkin and Kirkpatrick's descent.
/// * `contact of polygons`: whether two convex polygons of n vertices touch.
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_contact.h"
#include "collision/convex/convex_distance.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/hierarchy_descent.h"
#include "collision/course/outer_hierarchy.h"
#include "collision/course/penetration.h"
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

/// A kind of pairs: the gap, or minus the overlap, in parts of the radius.
struct Kind {
  const char* name;
  double gap;
};
constexpr Kind kKinds[] = {{"apart by 1", 1},
                           {"apart by 0.05", 0.05},
                           {"apart by 1e-12", 1e-12},
                           {"overlap of 1e-12", -1e-12},
                           {"overlap of 0.05", -0.05}};

/// The rows of a table in the order in which they were first added, with a column for each n.
class Table {
 public:
  void add(const std::string& row, std::size_t n, double value) {
    if (rows_.insert({row, {}}).second) order_.push_back(row);
    rows_[row][n] = value;
    columns_[n] = true;
  }
  void print(const std::string& head) const {
    std::cout << head;
    for (const auto& [n, used] : columns_) std::cout << ",10^" << std::log10(n);
    std::cout << '\n';
    for (const std::string& row : order_) {
      std::cout << row;
      for (const auto& [n, used] : columns_) {
        const auto value = rows_.at(row).find(n);
        std::cout << ',';
        if (value != rows_.at(row).end()) std::cout << value->second;
      }
      std::cout << '\n';
    }
    std::cout << std::endl;
  }

 private:
  std::map<std::string, std::map<std::size_t, double>> rows_;
  std::vector<std::string> order_;
  std::map<std::size_t, bool> columns_;
};

struct Tables {
  Table medians, ninety, figures;
};

class Measurement {
 public:
  Measurement(std::size_t n, std::size_t queries, Tables& tables)
      : n_(n), queries_(queries), tables_(tables), random_(n) {}

  void run() {
    const std::vector<Vec3> pointsA = onSphere(random_, n_), pointsB = onSphere(random_, n_);
    std::optional<Polytope> hull;
    figure("build hull (ms),quickhull", milliseconds([&] { hull.emplace(pointsA); }));
    Polytope copy = *hull;
    std::optional<DobkinKirkpatrick> a;
    figure("build hierarchy (ms),Dobkin-Kirkpatrick",
           milliseconds([&] { a.emplace(std::move(copy)); }));
    const DobkinKirkpatrick b{Polytope(pointsB)};
    std::optional<OuterHierarchy> outerB;
    figure("build outer hierarchy (ms),Barba-Langerman", milliseconds([&] { outerB.emplace(b); }));
    figure("levels,Dobkin-Kirkpatrick", static_cast<double>(a->levels()));
    figure("levels,outer hierarchy", static_cast<double>(outerB->polar()->levels()));
    const auto perVertex = [&](std::size_t bytes) {
      return static_cast<double>(bytes) / static_cast<double>(n_);
    };
    figure("bytes per vertex,Dobkin-Kirkpatrick", perVertex(a->bytes()));
    figure("bytes per vertex,outer hierarchy", perVertex(outerB->bytes()));
    const ConvexPart partA{{hull->vertices().begin(), hull->vertices().end()}, 0, false},
        partB{{b.polytope().vertices().begin(), b.polytope().vertices().end()}, 0, false};
    ways_ = {{"every vertex", partA, partB},
             {"hill climbing", *hull, b.polytope()},
             {"hierarchy", *a, b}};
    ofOne(*a);
    for (const Kind& kind : kKinds) {
      std::vector<Pair> pairs;
      for (std::size_t i = 0; i < queries_; ++i)
        pairs.push_back(pairWith(random_, *a, b, kind.gap));
      ofPairs(kind, pairs, *a, b, *outerB);
    }
    ofPolygons();
    if (sink_ == 1) std::cerr << ' ';  // so that the compiler can't remove the queries
  }

 private:
  struct Way {
    std::string name;
    ConvexSet a, b;
  };

  void figure(const std::string& row, double value) { tables_.figures.add(row, n_, value); }
  void time(const std::string& query, const std::string& pairs, const std::string& by,
            const auto& call) {
    const std::vector<double> times = leastMicroseconds(queries_, call);
    const std::string row = query + ',' + pairs + ',' + by;
    tables_.medians.add(row, n_, medianOf(times));
    tables_.ninety.add(row, n_, quantileOf(times, 0.9));
  }

  /// Queries of one polytope.
  void ofOne(const DobkinKirkpatrick& a) {
    std::vector<Vec3> directions(queries_);
    std::vector<double> offsets(queries_);
    for (Vec3& d : directions) d = random_.direction();
    for (double& c : offsets) c = 1.5 * random_.real();
    for (const Way& way : ways_)
      time("extreme", "", way.name, [&](std::size_t i) { sink_ += way.a.farthest(directions[i]); });
    for (const Way& way : ways_) {
      const PosedSet set(way.a, {});
      time("plane", "", way.name, [&](std::size_t i) {
        sink_ += set.highest(directions[i]) < offsets[i];
        sink_ += -set.highest(-directions[i]) > offsets[i];
      });
    }
    time("separation", "", "hierarchy", [&](std::size_t i) {
      sink_ += planeSeparation(a, {directions[i], offsets[i]}).lower > 0;
    });
    time("side", "", "hierarchy", [&](std::size_t i) {
      sink_ += sideOfPlane(a, {directions[i], offsets[i]}) > 0;
    });
  }

  void ofPairs(const Kind& kind, const std::vector<Pair>& pairs, const DobkinKirkpatrick& a,
               const DobkinKirkpatrick& b, const OuterHierarchy& outerB) {
    for (const Way& way : ways_) {
      const auto byWay = [&](const std::string& query, const auto& call) {
        time(query, kind.name, way.name, [&](std::size_t i) {
          sink_ += call(PosedSet(way.a, pairs[i].X_WA), PosedSet(way.b, pairs[i].X_WB));
        });
      };
      byWay("contact", [](const PosedSet& x, const PosedSet& y) { return convexSetsTouch(x, y); });
      if (kind.gap > 0) {
        byWay("distance", [](const PosedSet& x, const PosedSet& y) {
          return convexDistance(x, y).distance > 1;
        });
      } else {
        byWay("depth",
              [](const PosedSet& x, const PosedSet& y) { return penetration(x, y).upper > 1; });
        byWay("depth along", [](const PosedSet& x, const PosedSet& y) {
          return penetrationAlong(x, y, {1, 2, 3}).upper > 1;
        });
      }
    }
    const PolytopeFeatures featuresA(a), featuresB(b);
    const auto closest = [&](std::size_t i) {
      FeaturePair cold;
      sink_ += closestFeatures(featuresA, pairs[i].X_WA, featuresB, pairs[i].X_WB, cold)
                   .distance.distance > 1;
    };
    time("contact", kind.name, "V-Clip", closest);
    if (kind.gap > 0) {
      time("distance", kind.name, "V-Clip", closest);
      time("distance", kind.name, "descent", [&](std::size_t i) {
        sink_ += distanceByDescent(a, pairs[i].X_WA, b, pairs[i].X_WB).distance > 1;
      });
    } else {
      time("depth along", kind.name, "descent", [&](std::size_t i) {
        sink_ += depthByDescent(a, pairs[i].X_WA, b, pairs[i].X_WB, {1, 2, 3}).upper > 1;
      });
    }
    time("contact", kind.name, "Barba-Langerman", [&](std::size_t i) {
      sink_ += intersection(a, pairs[i].X_WA, outerB, pairs[i].X_WB).intersects;
    });
    countSteps(kind, pairs, a, outerB);
    if (n_ <= kMostForAxes)
      time("contact", kind.name, "separating axes", [&](std::size_t i) {
        sink_ += separatingAxis(featuresA, pairs[i].X_WA, featuresB, pairs[i].X_WB).separated;
      });
    if (n_ <= kMostForPrograms)
      time("contact", kind.name, "linear programming", [&](std::size_t i) {
        std::vector<Vec3> x, y;
        for (const Vec3& p : a.polytope().vertices()) x.push_back(pairs[i].X_WA * p);
        for (const Vec3& p : b.polytope().vertices()) y.push_back(pairs[i].X_WB * p);
        sink_ += separatingPlane<3>(std::span<const Vec3>(x), std::span<const Vec3>(y)).relation ==
                 HullRelation::disjoint;
      });
  }

  void countSteps(const Kind& kind, const std::vector<Pair>& pairs, const DobkinKirkpatrick& a,
                  const OuterHierarchy& outerB) {
    std::vector<double> steps;
    double exact = 0;
    for (const Pair& pair : pairs) {
      const auto found = intersection(a, pair.X_WA, outerB, pair.X_WB);
      steps.push_back(found.steps);
      exact += found.exact;
    }
    const std::string by = std::string(",Barba-Langerman; ") + kind.name;
    figure("steps: median" + by, medianOf(steps));
    figure("steps: 90 %" + by, quantileOf(steps, 0.9));
    figure("steps: most" + by, quantileOf(steps, 1));
    figure("pairs decided by all vertices" + by, exact);
  }

  /// Convex polygons of n vertices.
  void ofPolygons() {
    std::vector<Vec2> circle(n_);
    for (std::size_t i = 0; i < n_; ++i) {
      const double angle = 2 * M_PI * static_cast<double>(i) / static_cast<double>(n_);
      circle[i] = {std::cos(angle), std::sin(angle)};
    }
    const ConvexPolygon p(circle);
    for (const Kind& kind : kKinds) {
      std::vector<ConvexPolygon> others;
      for (std::size_t k = 0; k < queries_; ++k) {
        const double angle = M_PI * random_.real();
        std::vector<Vec2> moved = circle;
        for (Vec2& x : moved) x += (2 + kind.gap) * Vec2(std::cos(angle), std::sin(angle));
        others.emplace_back(moved);
      }
      time("contact of polygons", kind.name, "Barba-Langerman",
           [&](std::size_t i) { sink_ += intersection(p, others[i]).intersects; });
    }
  }

  const std::size_t n_, queries_;
  Tables& tables_;
  Random random_;
  std::vector<Way> ways_;
  std::size_t sink_ = 0;
};

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  using namespace corridor;
  return bench::runWith(
      argc, argv, {"--most", "--queries", "--cpu"}, [](const bench::Arguments& a) {
        std::cerr << "pinned to CPU " << bench::pin(a) << "\n";
        std::cout << std::setprecision(4);
        const double most = a.number("--most", 1e5);
        Tables tables;
        for (std::size_t n = 10; static_cast<double>(n) <= most; n *= 10)
          Measurement(n, static_cast<std::size_t>(a.number("--queries", 100)), tables).run();
        tables.medians.print("query,pairs,by");
        tables.ninety.print("query,pairs,by");
        tables.figures.print("figure,of");
      });
}
