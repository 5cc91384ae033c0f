// Fuzz target: a polygon that moves in the plane among polygons. The areas of a polygon's convex
// pieces must add up to the polygon's area, and the checker and the verifier must not contradict
// each other.
#include <algorithm>

#include "collision/convex/simple_polygon.h"
#include "tests/stress/fuzz/small_robot.h"

namespace corridor::fuzz {
namespace {

using Points = std::vector<Vec2>;

/// Returns a polygon of 3 to 11 corners. In 1 of 4 cases their order is arbitrary; otherwise they
/// are sorted by their angle about their mean, and the polygon is nearly always simple.
Points decodePoints(Decoder& in) {
  Points points(3 + in.below(9));
  for (Vec2& p : points) p = in.vector().head<2>();
  if (in.oneIn(4)) return points;
  Vec2 mean = Vec2::Zero();
  for (const Vec2& p : points) mean += p / static_cast<double>(points.size());
  std::sort(points.begin(), points.end(), [&](const Vec2& p, const Vec2& q) {
    return std::atan2(p.y() - mean.y(), p.x() - mean.x()) <
           std::atan2(q.y() - mean.y(), q.x() - mean.x());
  });
  return points;
}

/// Returns the signed area of the polygon. Adds the absolute values of the terms of the area's sum
/// to `terms`.
double areaOf(const Points& points, double& terms) {
  double area = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec2 &p = points[i], &q = points[(i + 1) % points.size()];
    area += (p.x() * q.y() - p.y() * q.x()) / 2;
    terms += std::abs(p.x() * q.y()) + std::abs(p.y() * q.x());
  }
  return area;
}

/// Returns the polygon's convex pieces, or an empty list if the polygon is not simple. Reports a
/// finding if the pieces do not have the polygon's area.
std::vector<ConvexPart> piecesOf(const Points& points) {
  std::vector<ConvexPart> parts;
  if (checkSimple(points)) return parts;
  double terms = 0;
  const double whole = std::abs(areaOf(points, terms));
  double sum = 0;
  for (const auto& piece : convexPieces(points)) {
    Points corners;
    ConvexPart& part = parts.emplace_back();
    for (const std::uint32_t i : piece) {
      corners.push_back(points.at(i));
      part.points.emplace_back(points[i].x(), points[i].y(), 0);
    }
    const double area = areaOf(corners, terms);
    // A polygon has at most 11 corners, and each term and each sum is rounded by a factor of 2^-53.
    // 2^-48 allows for all of them.
    if (area < -0x1p-48 * terms) fail("a piece of area " + number(area));
    sum += area;
  }
  if (std::abs(sum - whole) > 0x1p-46 * terms)
    fail("pieces of area " + number(sum) + ", the polygon has " + number(whole));
  return parts;
}

/// Returns a robot with one planar joint, or nullopt if a polygon is not simple.
std::optional<Robot> decodePolygons(Decoder& in) {
  Robot robot;
  Frame shift;
  shift.joint = Frame::Joint::translation;
  shift.count = 2;
  shift.variable = robot.variable(Coordinate::Kind::line);
  robot.variable(Coordinate::Kind::line);
  Frame turn;
  turn.parent = robot.tree.add(shift);
  turn.joint = Frame::Joint::revolute;
  turn.variable = robot.variable(Coordinate::Kind::circle);
  const std::size_t moving = robot.tree.add(turn);
  decodeEdge(in, robot);
  for (std::size_t n = 2 + in.below(2); n > 0; --n) {
    Shape shape;
    shape.frame = robot.shapes.empty() ? moving : 0;
    shape.parts = piecesOf(decodePoints(in));
    if (shape.parts.empty()) return std::nullopt;
    robot.shapes.push_back(std::move(shape));
  }
  setSize(robot);
  if (!std::isfinite(robot.size)) return std::nullopt;
  return robot;
}

}  // namespace
}  // namespace corridor::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  fuzz::Decoder in(data, size);
  static constexpr double limits[] = {10, 100, 1e3, 1e6};
  in.limit(limits[in.below(4)]);
  if (const auto robot = fuzz::decodePolygons(in)) fuzz::compareEdge(*robot, in);
  return 0;
}
