// Tests of simplifying among discs in the plane, where edge tests and shortest paths have closed
// forms.
#include "planner/solve/simplify_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/support.h"

namespace corridor {
namespace {

using std::numbers::pi;

ConfigurationSpace plane() {
  ConfigurationSpace space;
  CoordinateGroup group;
  for (const char* const name : {"x", "y"}) {
    Coordinate line;
    line.name = name;
    line.lower = -100;
    line.upper = 100;
    group.coordinates.push_back(space.add(line));
  }
  space.addGroup(group);
  return space;
}

Configuration at(double x, double y) {
  Configuration q(2);
  q << x, y;
  return q;
}

struct Disc {
  Configuration centre;
  double radius;
};

/// Returns the distance of a point from a segment.
double distanceFromSegment(const Configuration& p, const Configuration& a, const Configuration& b) {
  const Eigen::VectorXd d = b - a;
  const double length2 = d.squaredNorm();
  const double t = length2 > 0 ? std::clamp(d.dot(p - a) / length2, 0.0, 1.0) : 0;
  return (a + t * d - p).norm();
}

/// Discs in the plane. Records each edge that is tested.
struct World {
  std::vector<Disc> discs;
  std::vector<std::pair<std::vector<double>, std::vector<double>>> tested;

  /// Returns whether an edge is free. @param slack the depth to which a free edge may be inside a
  /// disc.
  bool isFree(const Configuration& a, const Configuration& b, double slack = 0) const {
    return std::ranges::all_of(discs, [&](const Disc& disc) {
      return distanceFromSegment(disc.centre, a, b) > disc.radius - slack;
    });
  }
  EdgeTest edgeTest() {
    return [this](const Configuration& a, const Configuration& b) {
      tested.push_back({{a.data(), a.data() + a.size()}, {b.data(), b.data() + b.size()}});
      return isFree(a, b);
    };
  }
};

bool doNotStop() {
  return false;
}

double length(const Path& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

/// Returns a path from (−3, 0) to (3, 0) around the unit disc at the origin: a polygon with
/// corners at radius 2, and repeated states.
Path detour() {
  Path path{at(-3, 0)};
  for (int i = 0; i <= 8; ++i) {
    const double angle = pi - i * pi / 8;
    path.insert(path.end(), i % 3 == 1 ? 2 : 1, at(2 * std::cos(angle), 2 * std::sin(angle)));
  }
  path.push_back(at(3, 0));
  path.push_back(at(3, 0));
  return path;
}

TEST(SimplifyPath, FreeWorldTakesOneEdgeTest) {
  World world;
  const std::vector<Path> versions =
      simplifiedVersions(plane(), detour(), world.edgeTest(), doNotStop);
  EXPECT_EQ(versions.front(), detour());
  EXPECT_EQ(versions.back(), (Path{at(-3, 0), at(3, 0)}));
  EXPECT_EQ(world.tested.size(), 1U);
}

TEST(SimplifyPath, ShortPathsTakeNoEdgeTest) {
  for (const Path& path : {Path{at(1, 2)}, Path{at(1, 2), at(3, 4)}, Path{at(1, 2), at(1, 2)}}) {
    World world;
    EXPECT_EQ(simplifiedVersions(plane(), path, world.edgeTest(), doNotStop),
              std::vector<Path>{path});
    EXPECT_EQ(world.tested.size(), 0U);
  }
}

TEST(SimplifyPath, ComesNearTheShortestPathAroundADisc) {
  World world{{{at(0, 0), 1}}, {}};
  const Path path = simplifiedVersions(plane(), detour(), world.edgeTest(), doNotStop).back();
  // Two tangents, and the arc between them.
  const double shortest = 2 * std::sqrt(8.0) + pi - 2 * std::acos(1.0 / 3);
  EXPECT_GE(length(path), shortest);
  EXPECT_LE(length(path), shortest * 1.02);
  EXPECT_LE(path.size(), 8U);
  EXPECT_LE(world.tested.size(), 60U);
}

TEST(SimplifyPath, StopEndsTheTests) {
  World world{{{at(0, 0), 1}}, {}};
  const auto stop = [&] { return world.tested.size() >= 5; };
  const std::vector<Path> versions = simplifiedVersions(plane(), detour(), world.edgeTest(), stop);
  EXPECT_EQ(world.tested.size(), 5U);
  EXPECT_LE(length(versions.back()), length(detour()));

  World untouched{{{at(0, 0), 1}}, {}};
  const Path path =
      simplifiedVersions(plane(), detour(), untouched.edgeTest(), [] { return true; }).back();
  EXPECT_EQ(untouched.tested.size(), 0U);
  EXPECT_DOUBLE_EQ(length(path), length(detour()));
}

/// Returns a path from (0, 0) to (10, 10): a random walk whose edges are all free.
Path randomWalk(const World& world, std::mt19937_64& random) {
  std::uniform_real_distribution<double> place(0, 10);
  Path path{at(0, 0)};
  for (int tries = 0; tries < 2000; ++tries) {
    const Configuration goal = at(10, 10);
    if (path.size() > 6 && world.isFree(path.back(), goal)) {
      path.push_back(goal);
      return path;
    }
    const Configuration next = at(place(random), place(random));
    if (world.isFree(path.back(), next)) path.push_back(next);
  }
  return {};
}

TEST(SimplifyPath, KeepsItsPromisesAmongRandomDiscs) {
  std::mt19937_64 random(test::testSeed(251));
  const ConfigurationSpace space = plane();
  std::uniform_real_distribution<double> place(1, 9), radius(0.1, 1);
  int paths = 0, shorter = 0;
  for (int i = 0; i < 200; ++i) {
    World world;
    while (world.discs.size() < 12)
      world.discs.push_back({at(place(random), place(random)), radius(random)});
    const Path path = randomWalk(world, random);
    if (path.empty()) continue;
    ++paths;
    const std::vector<Path> versions = simplifiedVersions(space, path, world.edgeTest(), doNotStop);
    EXPECT_EQ(versions.front(), path);
    const std::set<std::pair<std::vector<double>, std::vector<double>>> different(
        world.tested.begin(), world.tested.end());
    EXPECT_EQ(different.size(), world.tested.size()) << "an edge was tested twice";
    for (std::size_t v = 1; v < versions.size(); ++v) {
      EXPECT_EQ(versions[v].front(), path.front());
      EXPECT_EQ(versions[v].back(), path.back());
      // Rounding of the sums: fewer than 2^12 additions of 2^-53 each.
      EXPECT_LE(length(versions[v]), length(versions[v - 1]) * (1 + 1e-12));
      for (std::size_t s = 1; s < versions[v].size(); ++s)
        // A part of a free edge may start at a rounded point of this edge, so a small slack is
        // needed.
        EXPECT_TRUE(world.isFree(versions[v][s - 1], versions[v][s], 1e-12));
    }
    shorter += length(versions.back()) < length(path) * 0.9 ? 1 : 0;
    const std::size_t tests = std::exchange(world.tested, {}).size();
    EXPECT_EQ(simplifiedVersions(space, path, world.edgeTest(), doNotStop), versions);
    EXPECT_EQ(world.tested.size(), tests);
    // No state can be left out.
    for (std::size_t s = 2; s < versions.back().size(); ++s)
      EXPECT_FALSE(world.isFree(versions.back()[s - 2], versions.back()[s], -1e-12));
  }
  EXPECT_GT(paths, 100);
  EXPECT_GT(shorter, paths * 9 / 10);
}

/// Returns a space of two continuous joints and a floating base.
ConfigurationSpace circlesAndRotation() {
  ConfigurationSpace space;
  CoordinateGroup joints, base;
  for (const char* const name : {"pan", "roll"}) {
    Coordinate circle;
    circle.kind = Coordinate::Kind::circle;
    circle.name = name;
    joints.coordinates.push_back(space.add(circle));
  }
  base.kind = CoordinateGroup::Kind::floating;
  for (const char* const name : {"x", "y", "z", "rotation"}) {
    Coordinate coordinate;
    coordinate.name = name;
    if (base.coordinates.size() == 3) coordinate.kind = Coordinate::Kind::rotation;
    coordinate.lower = -10, coordinate.upper = 10;
    base.coordinates.push_back(space.add(coordinate));
  }
  space.addGroup(joints);
  space.addGroup(base);
  return space;
}

/// Edges are free if they are short. So each part of a free edge is free, over the seam of circles
/// and along slerps, too.
TEST(SimplifyPath, KeepsItsPromisesOnCirclesAndRotations) {
  constexpr double kLongest = 0.8;
  std::mt19937_64 random(test::testSeed(252));
  std::normal_distribution<double> step(0, 0.15);
  const ConfigurationSpace space = circlesAndRotation();
  const EdgeTest isFree = [&](const Configuration& a, const Configuration& b) {
    return space.distance(a, b) <= kLongest;
  };
  const auto lengthOf = [&](const Path& path) {
    double sum = 0;
    for (std::size_t i = 1; i < path.size(); ++i) sum += space.distance(path[i - 1], path[i]);
    return sum;
  };
  int shorter = 0;
  for (int i = 0; i < 50; ++i) {
    Configuration q = Configuration::Zero(9);
    q << 3, -3, 0, 0, 0, 0, 0, 0, 1;
    Path path{q};
    while (path.size() < 40) {
      Configuration next = path.back();
      for (double& number : next) number += step(random);
      space.normalise(next);
      if (isFree(path.back(), next)) path.push_back(next);
    }
    if (i % 5 == 0)
      path.push_back(path.front());  // makes the path closed, unless its last edge is not free
    if (!isFree(path[path.size() - 2], path.back())) path.pop_back();
    const std::vector<Path> versions = simplifiedVersions(space, path, isFree, doNotStop);
    for (std::size_t v = 1; v < versions.size(); ++v) {
      EXPECT_EQ(versions[v].front(), path.front());
      EXPECT_EQ(versions[v].back(), path.back());
      EXPECT_LE(lengthOf(versions[v]), lengthOf(versions[v - 1]) * (1 + 1e-9));
      for (std::size_t s = 1; s < versions[v].size(); ++s)
        EXPECT_LE(space.distance(versions[v][s - 1], versions[v][s]), kLongest * (1 + 1e-9));
    }
    shorter += lengthOf(versions.back()) < 0.8 * lengthOf(path);
  }
  EXPECT_GT(shorter, 40);
}

}  // namespace
}  // namespace corridor
