// Compares the checker and the verifier, on random pieces of curves, with an oracle that minimises
// the distance of the bodies in long double. The oracle shares only plain data with them.
// ../README.md describes this test.
#include <algorithm>
#include <cstdlib>
#include <iostream>

#include <gtest/gtest.h>

#include "tests/stress/audit/audit.h"
#include "tests/stress/audit/pieces.h"
#include "tests/support/support.h"

namespace corridor::audit {
namespace {

using Real = long double;
using Point = Vec<Real>;

/// A triangle, swept by a sphere. Equal corners make it a segment or a point.
struct Swept {
  std::array<Point, 3> corners;
  Real radius = 0;
};

Real clamped(Real x) {
  return std::clamp<Real>(x, 0, 1);
}

Real distanceOfSegments(const Point& p, const Point& q, const Point& r, const Point& s) {
  const Point d = q - p, e = s - r, y = p - r;
  const Real dd = dot(d, d), ee = dot(e, e), de = dot(d, e), determinant = dd * ee - de * de;
  const auto onFirst = [&](Real v) { return dd > 0 ? clamped(dot(r + e * v - p, d) / dd) : 0; };
  const auto onSecond = [&](Real u) { return ee > 0 ? clamped(dot(p + d * u - r, e) / ee) : 0; };
  Real least = HUGE_VALL;
  const auto consider = [&](Real u, Real v) { least = std::min(least, length(y + d * u - e * v)); };
  // The closest points are inside both segments, or one of them is an end of a segment.
  if (determinant > 0) {
    const Real u = clamped((de * dot(e, y) - ee * dot(d, y)) / determinant), v = onSecond(u);
    consider(onFirst(v), v);
  }
  for (const Real end : {Real(0), Real(1)}) {
    consider(end, onSecond(end));
    consider(onFirst(end), end);
  }
  return least;
}

/// Returns the distance of a point from the plane of a triangle, if the projection of the point to
/// the plane is inside the triangle; otherwise infinity.
Real distanceAlongNormal(const Point& x, const std::array<Point, 3>& t) {
  const Point n = unit(cross(t[1] - t[0], t[2] - t[0]));
  for (std::size_t i = 0; i < 3; ++i)
    if (!(dot(cross(t[(i + 1) % 3] - t[i], x - t[i]), n) > 0)) return HUGE_VALL;
  return magnitude(dot(n, x - t[0]));
}

bool crosses(const Point& p, const Point& q, const std::array<Point, 3>& t) {
  const Point n = unit(cross(t[1] - t[0], t[2] - t[0]));
  const Real a = dot(n, p - t[0]), b = dot(n, q - t[0]);
  if (!((a > 0 && b < 0) || (a < 0 && b > 0))) return false;
  return distanceAlongNormal(p + (q - p) * (a / (a - b)), t) < HUGE_VALL;
}

Real distanceOf(const Swept& a, const Swept& b) {
  Real least = HUGE_VALL;
  for (std::size_t i = 0; i < 3; ++i) {
    const Point &p = a.corners[i], &q = a.corners[(i + 1) % 3];
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &r = b.corners[k], &s = b.corners[(k + 1) % 3];
      least = std::min(least, distanceOfSegments(p, q, r, s));
      if (i == 0) least = std::min(least, distanceAlongNormal(r, a.corners));
      if (i == 0 && crosses(r, s, a.corners)) least = 0;
    }
    least = std::min(least, distanceAlongNormal(p, b.corners));
    if (crosses(p, q, b.corners)) least = 0;
  }
  return least - a.radius - b.radius;
}

/// A body: a mesh of some triangles, or one to three convex parts.
struct TestBody {
  TriangleMesh mesh;
  std::vector<ConvexPart> parts;
  std::vector<Swept> all;

  TestBody(Dice& dice, const Vec3& at) {
    const std::size_t count = dice.oneIn(2) ? 0 : 1 + dice.index(3);
    for (std::size_t n = 0; n < (count ? count : 6); ++n) {
      const Vec3 middle = at + 0.3 * dice.vector();
      Vec3 corners[3] = {middle, middle, middle};
      const std::size_t points = count ? 1 + dice.index(3) : 3;
      for (std::size_t k = 1; k < points; ++k) corners[k] += 0.3 * dice.vector();
      Swept swept{{Point(corners[0]), Point(corners[1]), Point(corners[2])}, 0};
      if (count == 0) {
        const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
        mesh.vertices.insert(mesh.vertices.end(), corners, corners + 3);
        mesh.triangles.push_back({first, first + 1, first + 2});
      } else {
        const double radius = dice.real(0.01, 0.2);
        parts.push_back({{corners, corners + points}, radius, false});
        swept.radius = radius;
      }
      all.push_back(swept);
    }
  }
  void addTo(std::vector<Scene::Placed>& bodies, std::size_t frame) const {
    if (parts.empty()) bodies.push_back({Body("mesh", mesh), frame});
    for (const ConvexPart& part : parts) bodies.push_back({Body("part", part), frame});
  }
  VerifyBody plain(std::size_t frame) const {
    return {"body", parts.empty() ? &mesh : nullptr, parts, false, frame};
  }
};

/// The distance of two bodies as a function of time, along a curve that maps the second body's
/// frame to the first body's frame.
struct Distance {
  const Curve<Real>& curve;
  const TestBody &first, &second;

  Real at(Real t) const {
    const Pose<Real> X = curve.at(t);
    Real least = HUGE_VALL;
    for (const Swept& b : second.all) {
      Swept moved = b;
      for (Point& p : moved.corners) p = X * p;
      for (const Swept& a : first.all) {
        // No two corners of a body are farther apart than 1.1 m: 2·0.3·√3, rounded up.
        const Real apart = length(moved.corners[0] - a.corners[0]) - a.radius - b.radius;
        if (apart - 2.2L < least) least = std::min(least, distanceOf(a, moved));
      }
    }
    return least;
  }
  /// Returns the time of the least distance that is found, and this distance. The search is by
  /// golden section around each of the eight smallest of 81 samples.
  std::pair<Real, Real> least() const {
    constexpr int samples = 80;
    std::vector<std::pair<Real, int>> found;
    for (int i = 0; i <= samples; ++i) found.emplace_back(at(Real(i) / samples), i);
    std::sort(found.begin(), found.end());
    std::pair<Real, Real> best{Real(found[0].second) / samples, found[0].first};
    for (int k = 0; k < 8; ++k) {
      const Real step = Real(1) / samples;
      Real low = std::max<Real>(0, found[std::size_t(k)].second * step - step);
      Real high = std::min<Real>(1, found[std::size_t(k)].second * step + step);
      const Real golden = (std::sqrt(Real(5)) - 1) / 2;
      Real a = high - golden * (high - low), b = low + golden * (high - low);
      Real fa = at(a), fb = at(b);
      for (int i = 0; i < 40 && best.second > 0; ++i) {
        if (fa < best.second) best = {a, fa};
        if (fb < best.second) best = {b, fb};
        // The remaining bracket is so narrow that it can't contain a smaller distance than the best
        // one.
        if (curve.speed(1) * (high - low) < best.second * 1e-3 && fa > best.second) break;
        if (fa < fb)
          high = b, b = a, fb = fa, a = high - golden * (high - low), fa = at(a);
        else
          low = a, a = b, fa = fb, b = low + golden * (high - low), fb = at(b);
      }
    }
    return best;
  }
};

/// Among the perturbations that the tube and the errors allow, returns the one that brings the two
/// bodies closest at t, to first order.
Perturbation worstPerturbation(const Edge& edge, const TestBody& first, const TestBody& second,
                               Real t) {
  Perturbation worst(static_cast<std::size_t>(edge.tube.size()), 0);
  const auto slope = [&](std::size_t number) {
    Real values[2];
    for (int k = 0; k < 2; ++k) {
      Perturbation one(worst.size(), 0);
      one[number] = k ? 1e-6 : -1e-6;
      const Curve<Real> moved(Curve<Quad>(edge, edge.first, edge.second, one));
      values[k] = Distance{moved, first, second}.at(t);
    }
    return values[1] - values[0];
  };
  for (const Coordinate& c : edge.space.coordinates()) {
    const Quad most = edge.strayOf(c.first);
    if (most == 0) continue;
    if (c.kind != Coordinate::Kind::rotation) {
      worst[c.first] = slope(c.first) > 0 ? -most : most;
      continue;
    }
    const Point up = unit(Point(slope(c.first), slope(c.first + 1), slope(c.first + 2)));
    for (std::size_t i = 0; i < 3; ++i) worst[c.first + i] = -up[i] * most * (1 - Quad(0x1p-60));
  }
  return worst;
}

constexpr Family kUsual[] = {Family::planarBody, Family::spatialBody, Family::chain,
                             Family::branches,   Family::movingBase,  Family::mimics};

struct Counts {
  long cases = 0, free = 0, contact = 0, undecided = 0, inTube = 0, proved = 0, verified = 0;
};

void setTube(Dice& dice, Edge& edge) {
  for (const Coordinate& c : edge.space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    (dice.oneIn(2) ? edge.tube : edge.piece->error)[i] = dice.oneIn(3) ? 0 : dice.power(-8, -2);
  }
}

void runCase(long number, std::uint64_t seed, Counts& counts) {
  Dice dice = diceOf(seed, number);
  double size = 1;
  Edge edge = randomEdge(dice, dice.of(std::span<const Family>(kUsual)), false, size);
  bendEdge(dice, edge, 1);
  const bool tubed = dice.oneIn(4);
  if (tubed) setTube(dice, edge);
  const Curve<Quad> exact(edge, edge.first, edge.second);
  const Curve<Real> curve(exact);
  const Vec3 origin = curve.at(dice.real(0, 1)).p.rounded();
  const TestBody first(dice, origin + dice.vector().normalized() * dice.real(0, 1.6)),
      second(dice, Vec3::Zero());
  MotionOptions options;
  options.tolerance = 1e-7;
  options.earliest = dice.oneIn(2);
  if (dice.oneIn(3)) options.margin = dice.power(-4, -1);

  std::vector<Scene::Placed> bodies;
  first.addTo(bodies, edge.first);
  const std::size_t split = bodies.size();
  second.addTo(bodies, edge.second);
  std::vector<Scene::Pair> pairs;
  for (std::size_t a = 0; a < split; ++a)
    for (std::size_t b = split; b < bodies.size(); ++b) pairs.push_back({a, b});
  const Scene scene(std::move(bodies), pairs);
  EdgeMotion motion(edge.tree, edge.space, scene.framePairs(), edge.tube);
  motion.set(*edge.piece);
  QueryContext context;
  const MotionResult r = scene.certify(motion, options, context);
  const std::string name =
      "CORRIDOR_SEED=" + std::to_string(seed) + " CORRIDOR_AUDIT_CASE=" + std::to_string(number);
  // The rounding of poses (Graze::rounding) and that of the oracle, which is far smaller.
  const double lengths = exact.length() + 6;
  const double rounding =
      lengths * (static_cast<double>(exact.joints() + 2) * 0x1p-43 + 0x1p-48 * exact.largest());
  const Distance distance{curve, first, second};
  ++counts.cases;
  if (r.verdict == MotionVerdict::contact) {
    ++counts.contact;
    EXPECT_LE(distance.at(r.time), options.margin + rounding) << name;
  } else {
    const auto [t, nominal] = distance.least();
    Real least = nominal;
    if (tubed) {
      const Curve<Real> moved(
          Curve<Quad>(edge, edge.first, edge.second, worstPerturbation(edge, first, second, t)));
      least = std::min(least, Distance{moved, first, second}.at(t));
    }
    if (r.verdict == MotionVerdict::free) {
      ++counts.free;
      EXPECT_GT(least, options.margin) << "FALSE FREE, at t = " << t << ": " << name;
    } else if (tubed && least <= options.margin + 2e-7L) {
      // The edge can't be proved, because the tube comes too close. If the curve itself touches,
      // `undecided` is right, too: just before its first contact the curve is free, but its tube is
      // not.
      ++counts.inTube;
    } else {
      ++counts.undecided;
      std::cout << "undecided (reason " << static_cast<int>(r.reason) << ") at a clearance of "
                << nominal - options.margin << " m at t = " << t << (tubed ? ", tube" : "") << ": "
                << name << "\n";
    }
  }
  if (!dice.oneIn(20)) return;
  PathProblem problem;
  problem.tree = &edge.tree;
  problem.space = &edge.space;
  problem.bodies = {first.plain(edge.first), second.plain(edge.second)};
  problem.pairs = {{0, 1}};
  problem.margin = options.margin;
  problem.tube = edge.tube;
  problem.tolerance = options.tolerance;
  problem.workLimit = 20'000;
  const PathVerdict verdict = verifyCurve(problem, {&*edge.piece, 1}).verdict;
  ++counts.verified;
  counts.proved += verdict == PathVerdict::proved;
  if (r.verdict == MotionVerdict::contact) {
    EXPECT_NE(verdict, PathVerdict::proved) << name;
  }
  if (r.verdict == MotionVerdict::free) {
    EXPECT_NE(verdict, PathVerdict::refuted) << name;
  }
}

/// Random pieces with all kinds of joints, degrees 1 to 9, margins, tubes and errors must not get a
/// wrong verdict, and few of them may stay undecided.
TEST(Audit, RandomCurves) {
  const std::uint64_t seed = test::testSeed(14);
  const char* only = std::getenv("CORRIDOR_AUDIT_CASE");
  const long first = only ? std::stol(only) : 0, count = only ? 1 : countOf(70, 100'000);
  Counts n;
  for (long number = first; number < first + count; ++number) runCase(number, seed, n);
  std::cout << n.cases << " pieces: " << n.free << " free, " << n.contact << " contact, "
            << n.undecided << " undecided, " << n.inTube
            << " not provable, because a curve in the tube comes too close; verified " << n.verified
            << ", of which " << n.proved << " proved\n";
  if (only) return;
  EXPECT_GT(n.free, count / 4);
  EXPECT_GT(n.contact, count / 8);
  EXPECT_LE(n.undecided, 1 + count / 1000);
}

}  // namespace
}  // namespace corridor::audit
