#include "tests/stress/audit/shapes.h"

#include <algorithm>

namespace corridor::audit {
namespace {

/// A factor that is less than 1, by more than the rounding of 128 bits in any formula of this file.
const Quad kInside = 1 - Quad(0x1p-90);

/// Adds triangles above the plane that the body touches, so that its tree has several levels.
void addTrianglesAbove(Dice& dice, ExactBody& plan, const Vec<Quad>& q, const Vec<Quad>& up,
                       const Vec<Quad>& along, double size) {
  const Vec<Quad> across = cross(up, along);
  for (int i = 0; i < 24; ++i) {
    const Vec<Quad> c =
        q + (along * dice.real(-2, 2) + across * dice.real(-2, 2) + up * dice.real(0.8, 2)) * size;
    const auto n = static_cast<std::uint32_t>(plan.points.size());
    for (int k = 0; k < 3; ++k) plan.points.push_back(c + Vec<Quad>(dice.vector()) * (0.2 * size));
    plan.triangles.push_back({n, n + 1, n + 2});
  }
}

/// Adds the faces of a parallelepiped. Bit i of a corner's index selects the end of edge i.
void addBoxFaces(ExactBody& plan) {
  plan.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
}

}  // namespace

ExactBody randomExactBody(Dice& dice, Feature feature, const Vec<Quad>& q, const Vec<Quad>& up,
                          const Vec<Quad>& along, double size) {
  ExactBody plan;
  plan.feature = feature;
  const Vec<Quad> across = cross(up, along);
  const auto at = [&](double x, double y, double z) {
    return q + (along * x + across * y + up * z) * size;
  };
  const auto height = [&] { return dice.real(0.3, 1); };
  const auto aside = [&] { return dice.real(-0.6, 0.6); };
  enum Kind { triangles, meshBox, box, hull, ball, capsule, cylinder };
  const Kind kinds[] = {triangles, triangles, meshBox, box, hull, ball, capsule, cylinder};
  Kind kind = kinds[dice.index(8)];
  if (feature == Feature::face && (kind == ball || kind == capsule)) kind = triangles;
  if (feature == Feature::edge && kind == ball) kind = capsule;
  if (feature == Feature::edge && kind == cylinder) kind = hull;
  plan.mesh = kind == triangles || kind == meshBox;
  const double spread = dice.real(0, 6.28);
  const auto around = [&](int i, double r, double z) {
    return at(r * std::cos(2.1 * i + spread), r * std::sin(2.1 * i + spread), z);
  };

  if (kind == triangles || kind == hull) {
    if (feature == Feature::corner) {
      plan.points = {q, around(0, dice.real(0.2, 0.8), height()),
                     around(1, dice.real(0.2, 0.8), height())};
    } else if (feature == Feature::edge) {
      plan.points = {at(-dice.real(0.3, 1), 0, 0), at(dice.real(0.3, 1), 0, 0),
                     at(aside(), aside(), height())};
    } else {
      for (int i = 0; i < 3; ++i) plan.points.push_back(around(i, dice.real(0.3, 1), 0));
    }
    if (kind == triangles) {
      plan.triangles = {{0, 1, 2}};
      if (dice.oneIn(2)) addTrianglesAbove(dice, plan, q, up, along, size);
    } else {
      for (std::size_t n = 1 + dice.index(5); n-- > 0;)
        plan.points.push_back(at(aside(), aside(), height()));
    }
    return plan;
  }
  if (kind == meshBox || kind == box) {
    // The edges from corner 0 of the box: orthogonal, and all above the plane.
    Vec<Quad> a = unit(along * dice.real() + across * dice.real() + up * dice.real(0.4, 1.5));
    Vec<Quad> b = unit(cross(a, unit(along * dice.real() + across * dice.real())));
    Vec<Quad> from = q;
    if (feature == Feature::edge) {
      a = along;
      b = unit(across * dice.real() + up * dice.real(0.4, 1.5));
    } else if (feature == Feature::face) {
      a = along, b = across;
    }
    Vec<Quad> c = cross(a, b);
    for (Vec<Quad>* edge : {&a, &b, &c})
      if (dot(*edge, up) < 0) *edge = -*edge;
    a = a * (size * height()), b = b * (size * height()), c = c * (size * height());
    if (feature == Feature::edge) from = q - a * dice.real(0.2, 0.8);
    if (feature == Feature::face) from = q - a * dice.real(0.2, 0.45) - b * dice.real(0.2, 0.45);
    for (int i = 0; i < 8; ++i)
      plan.points.push_back(from + a * (i & 1 ? 1 : 0) + b * (i & 2 ? 1 : 0) + c * (i & 4 ? 1 : 0));
    if (kind == meshBox) addBoxFaces(plan);
    return plan;
  }
  plan.radius = size * height();
  if (kind == cylinder) {
    plan.flatEnds = true;
    if (feature == Feature::face) {
      plan.points = {q, q + up * (size * height())};
    } else {  // the rim, whose lowest point is q
      const Vec<Quad> axis = unit(up * dice.real(0.3, 0.9) + along * dice.real() + across * 0.3);
      const Vec<Quad> inward = unit(up - axis * dot(axis, up));
      plan.points.push_back(q + inward * plan.radius);
      plan.points.push_back(plan.points[0] + axis * (size * height()));
    }
    return plan;
  }
  const Vec<Quad> centre = q + up * plan.radius;
  plan.points = {centre};
  if (feature == Feature::edge)
    plan.points = {centre - along * (size * height()), centre + along * (size * height())};
  else if (kind == capsule)
    plan.points.push_back(centre + (along * aside() + up * height()) * size);
  return plan;
}

Shape stored(const ExactBody& plan, const Pose<Quad>& X, const Vec<Quad>& shift,
             const Vec<Quad>& up, double* error) {
  Shape shape;
  shape.feature = plan.feature;
  shape.isMesh = plan.mesh;
  std::vector<Vec3>& points = plan.mesh ? shape.mesh.vertices : shape.part.points;
  Quad off = 0;
  for (const Vec<Quad>& p : plan.points) {
    const Vec<Quad> exact = X * (p + shift);
    points.push_back(exact.rounded());
    off = std::max(off, length(Vec<Quad>(points.back()) - exact));
  }
  shape.mesh.triangles = plan.triangles;
  shape.part.radius = plan.radius;
  shape.part.flatEnds = plan.flatEnds;
  for (const Vec3& p : points) shape.reach = std::max(shape.reach, p.norm());
  shape.reach = (shape.reach + plan.radius) * (1 + 1e-12);
  for (std::size_t i = 0; i < 3; ++i)
    shape.core[i] = Vec<Quad>(points[std::min(i, points.size() - 1)]);
  shape.coreRadius = plan.radius;
  if (plan.flatEnds) {
    shape.coreRadius = 0;
    const Vec<Quad> end(points[0]), other(points[1]), axis = unit(other - end), n = X.R * up;
    const Quad r = plan.radius * kInside;
    if (plan.feature == Feature::face) {
      const Vec<Quad> x = unit(cross(axis, Vec<Quad>(axis.rounded().unitOrthogonal()))),
                      y = cross(axis, x);
      const Vec<Quad> in = (other - end) * (1 - kInside);  // a shift into the cylinder
      shape.core = {end + in + x * r, end + in - x * (r / 2) + y * (r * 0.8),
                    end + in - x * (r / 2) - y * (r * 0.8)};
    } else {
      const Vec<Quad> outward = unit(axis * dot(axis, n) - n);
      shape.core = {end + outward * r + (other - end) * (1 - kInside), end, other};
    }
    // Rounding the two ends tilts the axis, which moves the rim of a cap by radius/length times as
    // much.
    off *= 1 + 4 * plan.radius / static_cast<double>(length(other - end));
  }
  if (error) *error = static_cast<double>(off) * (1 + 1e-12);
  return shape;
}

}  // namespace corridor::audit
