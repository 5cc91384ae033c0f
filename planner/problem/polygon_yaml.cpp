#include "planner/problem/polygon_yaml.h"

#include <algorithm>
#include <cstdio>

#include "collision/convex/simple_polygon.h"

namespace corridor {
namespace {

std::string edgeText(std::size_t i, std::size_t count) {
  return "edge " + std::to_string(i) + " (from point " + std::to_string(i) + " to point " +
         std::to_string((i + 1) % count) + ")";
}

std::string textOf(const PolygonFault& fault, std::size_t count) {
  using Kind = PolygonFault::Kind;
  switch (fault.kind) {
    case Kind::tooFewPoints:
      return "at least 3 points [x, y] are needed, not " + std::to_string(count);
    case Kind::notFinite:
      return "point " + std::to_string(fault.first) + " (counted from 0) is not finite";
    case Kind::repeatedPoint:
      if (fault.first == 0 && fault.second + 1 == count)
        return "the last point is the first one again; leave it out, since the last point is "
               "joined to the first";
      return "points " + std::to_string(fault.first) + " and " + std::to_string(fault.second) +
             " (counted from 0) are equal; each point may be given once";
    case Kind::noArea:
      return "all points are on one line; the polygon needs an area";
    case Kind::edgesMeet:
      break;
  }
  return edgeText(fault.first, count) + " meets " + edgeText(fault.second, count) +
         ", counted from 0; edges may share only the point where one follows the other";
}

/// Returns the message for a polygon that is no longer simple because moving it rounded its corners
/// to doubles.
/// @param advice  what to do about rounding.
std::string textOfMoved(const PolygonFault& fault, const std::vector<Vec2>& moved,
                        const std::string& advice) {
  using Kind = PolygonFault::Kind;
  if (fault.kind == Kind::notFinite)
    return "point " + std::to_string(fault.first) +
           " (counted from 0) is moved out of the range of doubles";
  double largest = 0;
  for (const Vec2& p : moved) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  char metres[32];
  std::snprintf(metres, sizeof metres, "%.3g m", largest);
  const std::size_t count = moved.size();
  const std::string cause =
      fault.kind == Kind::repeatedPoint
          ? "points " + std::to_string(fault.first) + " and " + std::to_string(fault.second) +
                " (counted from 0) become equal"
      : fault.kind == Kind::noArea ? std::string("all points come to be on one line")
                                   : edgeText(fault.first, count) + " comes to meet " +
                                         edgeText(fault.second, count) + ", counted from 0";
  return "at coordinates of up to " + std::string(metres) +
         ", doubles are too coarse for this polygon: " + cause + "; " + advice;
}

/// Sets `shape.parts` to the convex parts of `shape.polygon` (collision/convex/simple_polygon.h).
void cut(PlacedShape& shape) {
  shape.parts.clear();
  for (const std::vector<std::uint32_t>& piece : convexPieces(shape.polygon)) {
    ConvexPart& part = shape.parts.emplace_back();
    for (const std::uint32_t i : piece)
      part.points.emplace_back(shape.polygon[i].x(), shape.polygon[i].y(), 0);
  }
}

/// Returns whether X maps the plane z = 0 to itself, without turning it over.
bool keepsPlane(const Transform& X) {
  return X.t.z() == 0 && X.m(2, 0) == 0 && X.m(2, 1) == 0 && X.m(2, 2) > 0;
}

}  // namespace

bool readPolygon(const YamlMap& map, const Transform& X, PlacedShape& shape) {
  const YamlValue& value = *map.find("polygon");
  if (value.kind != YamlValue::Kind::List) {
    map.fault("polygon", "a list of points [[x, y], …] is needed, not " + described(value));
    return false;
  }
  std::vector<Vec2> points;
  for (const YamlValue& item : value.items) {
    const auto p = readNumbers(item, 2, map.pathOf("polygon"), map.source());
    if (!p) return false;
    points.emplace_back((*p)[0], (*p)[1]);
  }
  const auto report = [&](const PolygonFault& fault, const std::string& text) {
    const std::size_t at = std::max(fault.first, fault.second);
    const int line = at < value.items.size() && at > 0 ? value.items[at].line : value.line;
    map.source().fault(line, map.pathOf("polygon") + ": " + text);
    return false;
  };
  if (const auto fault = checkSimple(points)) return report(*fault, textOf(*fault, points.size()));
  if (!keepsPlane(X)) {
    map.fault("polygon",
              "lies in the plane z = 0, but at or the rotation moves it out of this plane or turns "
              "it over; write at: [x, y, 0], and rotate about z only, such as rpy_deg: [0, 0, 90]");
    return false;
  }
  for (const Vec2& p : points) shape.polygon.emplace_back((X * Vec3(p.x(), p.y(), 0)).head<2>());
  if (shape.polygon != points)
    if (const auto fault = checkSimple(shape.polygon))
      return report(*fault, textOfMoved(*fault, shape.polygon, "move it nearer to the origin"));
  cut(shape);
  return true;
}

std::string shiftPolygon(PlacedShape& shape, const Vec3& by) {
  if (by.z() != 0) return "moves a polygon out of the plane z = 0; write [x, y]";
  for (Vec2& p : shape.polygon) p += by.head<2>();
  if (const auto fault = checkSimple(shape.polygon))
    return textOfMoved(*fault, shape.polygon, "choose a point nearer to the polygon");
  cut(shape);
  return "";
}

}  // namespace corridor
