#include "collision/convex/simple_polygon.h"

#include <iostream>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/planar.h"
#include "tests/support/support.h"

namespace corridor {
namespace {

using test::contains;
using test::exactly;
using test::Fraction;
using test::Point2;
using FaultKind = PolygonFault::Kind;
using PolygonPoints = test::Polygons::Points;

/// The boundary of polygons as a formal sum of directed segments, which are divided at the points
/// of `corners`. Opposite segments cancel.
class Chain {
 public:
  explicit Chain(const std::vector<Point2>& corners) : corners_(corners) {}
  void add(const std::vector<Point2>& polygon, int sign) {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Point2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      std::vector<Point2> on;
      for (const Point2& p : corners_)
        if (test::isOn(p, a, b)) on.push_back(p);
      std::sort(on.begin(), on.end());
      const int along = a < b ? sign : -sign;
      for (std::size_t k = 1; k < on.size(); ++k) {
        const auto segment = sum_.try_emplace({on[k - 1], on[k]}, 0).first;
        segment->second += along;
        if (segment->second == 0) sum_.erase(segment);
      }
    }
  }
  bool isZero() const { return sum_.empty(); }

 private:
  std::vector<Point2> corners_;
  std::map<std::pair<Point2, Point2>, int> sum_;
};

std::vector<Point2> cornersOf(const std::vector<Point2>& corners,
                              const std::vector<std::uint32_t>& piece) {
  std::vector<Point2> points;
  for (const std::uint32_t i : piece) points.push_back(corners.at(i));
  return points;
}

bool isStrictlyConvex(const std::vector<Point2>& p) {
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t k = 0; k < p.size(); ++k)
      if (k != i && k != (i + 1) % p.size() && turn(p[i], p[(i + 1) % p.size()], p[k]) <= 0)
        return false;
  return p.size() >= 3;
}

/// Expects that the boundaries of the convex pieces add up to the boundary of the polygon. Then,
/// for any point off the boundaries, the number of pieces that contain the point is the winding
/// number of the polygon around it: 1 or 0.
void expectTiling(const PolygonPoints& points, const std::string& name) {
  const std::vector<Point2> corners = exactly(points);
  const Fraction area = test::twiceArea(corners);
  Fraction sum = 0;
  Chain boundary(corners);
  boundary.add(corners, area > 0 ? -1 : 1);
  for (const auto& piece : convexPieces(points)) {
    const std::vector<Point2> p = cornersOf(corners, piece);
    ASSERT_TRUE(isStrictlyConvex(p)) << name;
    sum += test::twiceArea(p);
    boundary.add(p, 1);
  }
  EXPECT_EQ(sum, abs(area)) << name;
  EXPECT_TRUE(boundary.isZero()) << name;
}

TEST(SimplePolygon, AgreesWithRationals) {
  test::Polygons random(test::testSeed(51));
  const int count = test::casesOf(120, 20'000);
  int simple = 0, pieces = 0;
  for (int n = 0; n < count; ++n) {
    const PolygonPoints p = random.varied(
        random.polygon(3 + random.below(n % 10 ? 12 : 60), n % test::Polygons::kinds));
    const std::string name = "polygon " + std::to_string(n);
    const std::vector<Point2> e = exactly(p);
    const auto fault = checkSimple(p);
    ASSERT_EQ(!fault, test::isSimple(e)) << name;
    if (fault && fault->kind == FaultKind::repeatedPoint) {
      ASSERT_LT(fault->first, fault->second) << name;
      EXPECT_EQ(e[fault->first], e[fault->second]) << name;
    }
    if (fault && fault->kind == FaultKind::edgesMeet) {
      ASSERT_LT(fault->first, fault->second) << name;
      EXPECT_TRUE(test::edgesMeet(e, fault->first, fault->second)) << name;
    }
    if (fault) continue;
    ++simple;
    pieces += static_cast<int>(convexPieces(p).size());
    expectTiling(p, name);
  }
  std::cout << simple << " of " << count << " are simple, with " << pieces << " pieces\n";
  EXPECT_GT(simple, count / 3);
  EXPECT_GT(count - simple, count / 10);
}

/// A point is in the polygon if and only if it is in a piece of the polygon.
TEST(SimplePolygon, PiecesContainWhatThePolygonContains) {
  test::Polygons random(test::testSeed(52));
  int inside = 0, tested = 0;
  for (int n = 0; n < 300 / test::kSlowdown; ++n) {
    const PolygonPoints p = random.polygon(3 + random.below(25), n % test::Polygons::kinds);
    if (checkSimple(p)) continue;
    const std::vector<Point2> corners = exactly(p);
    std::vector<std::vector<Point2>> pieces;
    for (const auto& piece : convexPieces(p)) pieces.push_back(cornersOf(corners, piece));
    for (int k = 0; k < 20; ++k) {
      // The tested points are corners, middles of chords, and points near corners.
      const Eigen::Vector2d &a = p[random.below(p.size())], &b = p[random.below(p.size())];
      const Eigen::Vector2d q = k % 3 == 0 ? a
                                : k % 3 == 1
                                    ? (0.5 * (a + b)).eval()
                                    : a + 1e-3 * Eigen::Vector2d(random.real(), random.real());
      const Point2 at(q);
      const bool found = std::any_of(pieces.begin(), pieces.end(),
                                     [&](const auto& piece) { return contains(piece, at); });
      EXPECT_EQ(found, contains(corners, at)) << "polygon " << n;
      inside += found;
      ++tested;
    }
  }
  EXPECT_GT(inside, tested / 4);
  EXPECT_LT(inside, tested);
}

TEST(SimplePolygon, NumbersOfPieces) {
  const auto count = [](const PolygonPoints& p) { return convexPieces(p).size(); };
  EXPECT_EQ(count({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), 1u);
  EXPECT_EQ(count({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}), 2u) << "an L";
  EXPECT_EQ(count({{0, 0}, {0.5, 0}, {1, 0}, {1, 1}, {0, 1}}), 1u) << "a point on an edge";
  PolygonPoints circle;
  for (int i = 0; i < 100; ++i) circle.emplace_back(std::cos(0.06 * i), std::sin(0.06 * i));
  EXPECT_EQ(count(circle), 1u);
  EXPECT_EQ(convexPieces(circle).front().size(), 100u);
}

TEST(SimplePolygon, Faults) {
  const auto fault = [](const PolygonPoints& p) {
    const auto found = checkSimple(p);
    return found ? std::tuple(static_cast<int>(found->kind), found->first, found->second)
                 : std::tuple(-1, std::size_t{0}, std::size_t{0});
  };
  const auto as = [](FaultKind kind, std::size_t first = 0, std::size_t second = 0) {
    return std::tuple(static_cast<int>(kind), first, second);
  };
  EXPECT_EQ(fault({}), as(FaultKind::tooFewPoints));
  EXPECT_EQ(fault({{0, 0}, {1, 0}}), as(FaultKind::tooFewPoints));
  EXPECT_EQ(fault({{0, 0}, {1, 0}, {1, std::numeric_limits<double>::infinity()}}),
            as(FaultKind::notFinite, 2));
  EXPECT_EQ(fault({{0, 0}, {1, 0}, {1, 1}, {0, 0}}), as(FaultKind::repeatedPoint, 0, 3));
  EXPECT_EQ(fault({{0, 0}, {1, 2}, {3, 6}}), as(FaultKind::noArea));
  EXPECT_EQ(fault({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), as(FaultKind::edgesMeet, 0, 2)) << "a bow tie";
  EXPECT_EQ(fault({{0, 0}, {4, 0}, {4, 2}, {2, 0}, {0, 2}}), as(FaultKind::edgesMeet, 0, 3))
      << "a corner touches an edge";
  EXPECT_EQ(fault({{0, 0}, {2, 0}, {1, 0}, {1, 1}}), as(FaultKind::edgesMeet, 0, 1)) << "a spike";
  EXPECT_EQ(std::get<0>(fault({{0, 0}, {1, 0}, {0.5, 1}})), -1);
}

/// A corner touches an edge. The polygon is also tested mirrored, with exchanged axes, with its
/// boundary reversed, and with each corner as the first.
TEST(SimplePolygon, CornersThatTouchEdges) {
  const PolygonPoints touching{{0, 0}, {4, 1}, {4, 3}, {2, 0.5}, {0, 2}};
  for (int n = 0; n < 80; ++n) {
    PolygonPoints p = touching, apart = touching;
    apart[3].y() += 0x1p-40;
    for (PolygonPoints* each : {&p, &apart}) {
      for (Vec2& v : *each) {
        if (n & 1) v.x() = -v.x();
        if (n & 2) v.y() = -v.y();
        if (n & 4) std::swap(v.x(), v.y());
      }
      if (n & 8) std::reverse(each->begin(), each->end());
      std::rotate(each->begin(), each->begin() + n / 16, each->end());
    }
    ASSERT_TRUE(checkSimple(p)) << n;
    EXPECT_EQ(checkSimple(p)->kind, FaultKind::edgesMeet) << n;
    EXPECT_FALSE(checkSimple(apart)) << n;
  }
}

/// 10^5 points: a comb whose teeth are long and slanted, so that the boxes of all edges overlap.
TEST(SimplePolygon, LargePolygons) {
  PolygonPoints comb{{-1e5, -1e5}};
  for (int k = 0; k < 50'000 / test::kSlowdown; ++k) {
    comb.emplace_back(2 * k, -2 * k);
    comb.emplace_back(100'000 + 2 * k + 1, 100'000 - 2 * k - 1);
  }
  comb.pop_back();
  EXPECT_FALSE(checkSimple(comb));
  std::vector<std::uint32_t> used(comb.size());
  double area = 0, sum = 0;  // exact: sums of integers
  for (std::size_t i = 0; i < comb.size(); ++i) {
    const auto &a = comb[i], &b = comb[(i + 1) % comb.size()];
    area += a.x() * b.y() - a.y() * b.x();
  }
  const auto pieces = convexPieces(comb);
  for (const auto& piece : pieces)
    for (std::size_t k = 0; k < piece.size(); ++k) {
      const auto &a = comb[piece[k]], &b = comb[piece[(k + 1) % piece.size()]];
      sum += a.x() * b.y() - a.y() * b.x();
      used[piece[k]] = 1;
    }
  EXPECT_EQ(sum, std::abs(area));
  EXPECT_EQ(std::count(used.begin(), used.end(), 1u), static_cast<std::ptrdiff_t>(comb.size()));
  std::swap(comb[comb.size() / 2], comb[comb.size() / 2 + 2]);
  ASSERT_TRUE(checkSimple(comb));
  EXPECT_EQ(checkSimple(comb)->kind, FaultKind::edgesMeet);
}

}  // namespace
}  // namespace corridor
