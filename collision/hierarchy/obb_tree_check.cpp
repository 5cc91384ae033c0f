#include <vector>

#include <boost/multiprecision/cpp_int.hpp>

#include "collision/hierarchy/obb_tree.h"

namespace corridor {
namespace {

using Rational = boost::multiprecision::cpp_rational;

/// {c + U x : |x_i| ≤ e_i} as rationals: p is inside if and only if |det(U with column i replaced
/// by p − c)| ≤ e_i·|det U| (Cramer).
class ExactBox {
 public:
  explicit ExactBox(const Obb& box) {
    for (int i = 0; i < 3; ++i) {
      center_[i] = Rational(box.center[i]);
      half_[i] = Rational(box.half[i]);
      for (int k = 0; k < 3; ++k) u_[k][i] = Rational(box.axes(i, k));
    }
    for (int k = 0; k < 3; ++k) crosses_[k] = cross(u_[(k + 1) % 3], u_[(k + 2) % 3]);
    volume_ = abs(dot(u_[0], crosses_[0]));
  }
  bool contains(const Vec3& p) const {
    Row d;
    for (int i = 0; i < 3; ++i) d[i] = Rational(p[i]) - center_[i];
    for (int k = 0; k < 3; ++k)
      if (abs(dot(d, crosses_[k])) > half_[k] * volume_) return false;
    return volume_ > 0;
  }
  /// With a ball of radius r about p, or a disc of radius r at a right angle to d. They reach
  /// r|g_i|, or r|g_i × d|/|d|, farther, g_i = crosses_i/volume the i-th row of U⁻¹: squared, that
  /// is rational.
  bool contains(const Vec3& p, double radius, const Vec3* from, const Vec3* to) const {
    if (!contains(p)) return false;
    Row d, axis;
    for (int i = 0; i < 3; ++i) {
      d[i] = Rational(p[i]) - center_[i];
      if (from) axis[i] = Rational((*to)[i]) - Rational((*from)[i]);
    }
    const Rational square = from ? dot(axis, axis) : Rational(0), r = Rational(radius) * radius;
    for (int k = 0; k < 3; ++k) {
      const Rational left = half_[k] * volume_ - abs(dot(d, crosses_[k]));
      const Row across = cross(crosses_[k], axis);
      const bool holds = square > 0 ? left * left * square >= r * dot(across, across)
                                    : left * left >= r * dot(crosses_[k], crosses_[k]);
      if (!holds) return false;
    }
    return true;
  }

 private:
  using Row = std::array<Rational, 3>;
  static Rational dot(const Row& a, const Row& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static Row cross(const Row& a, const Row& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  }
  Row center_, half_;
  std::array<Row, 3> u_, crosses_;
  Rational volume_;
};

}  // namespace

std::optional<std::string> ObbTree::check() const {
  const auto named = [](const char* what, std::size_t i) {
    return std::string(what) + " " + std::to_string(i);
  };
  if (part_) {
    const ExactBox box(nodes_[0].box);
    const auto& points = part_->points;
    const bool discs = part_->flatEnds;
    for (std::size_t i = 0; i < points.size(); ++i)
      if (!box.contains(points[i], part_->radius, discs ? &points[0] : nullptr,
                        discs ? &points[1] : nullptr))
        return named("the box does not contain what is around point", i);
    return std::nullopt;
  }
  std::vector<int> seen(triangles_.size(), 0);
  if (nodes_[0].first != 0 || nodes_[0].count != triangles_.size())
    return "the root does not hold all triangles";
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    const ExactBox box(node.box);
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t)
      for (const Vec3& p : triangles_[t])
        if (!box.contains(p))
          return named("the box of node", i) + " does not contain " +
                 named("triangle", meshTriangle_[t]);
    if (orthonormalityDefect(node.box.axes) > axisDefect_)
      return named("the axes of node", i) + " exceed axisDefect";
    if (node.isLeaf()) {
      for (std::uint32_t t = node.first; t < node.first + node.count; ++t) ++seen[t];
      continue;
    }
    if (i + 1 >= nodes_.size() || node.right >= nodes_.size())
      return named("node", i) + " has a child that does not exist";
    const Node &left = nodes_[i + 1], &right = nodes_[node.right];
    if (left.count == 0 || right.count == 0 || left.first != node.first ||
        right.first != node.first + left.count || left.count + right.count != node.count)
      return named("node", i) + " is not partitioned by its children";
  }
  std::vector<int> ids(triangles_.size(), 0);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    if (seen[t] != 1) return named("triangle", meshTriangle_[t]) + " is not in exactly one leaf";
    if (meshTriangle_[t] >= ids.size() || ids[meshTriangle_[t]]++)
      return "triangle numbers are not a permutation";
  }
  return std::nullopt;
}

}  // namespace corridor
