#include "planner/verify/winding.h"

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>

namespace corridor::verify {

std::vector<std::vector<std::uint32_t>> componentsOf(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> places;
  std::vector<std::uint32_t> root;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  const auto placeOf = [&](const Vec3& p) {
    const auto [at, fresh] = places.try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0},
                                                static_cast<std::uint32_t>(root.size()));
    if (fresh) root.push_back(at->second);
    return at->second;
  };
  std::vector<std::uint32_t> placeOfTriangle;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const std::uint32_t first = placeOf(mesh.corner(t, 0));
    for (int i = 1; i < 3; ++i) root[find(placeOf(mesh.corner(t, i)))] = find(first);
    placeOfTriangle.push_back(first);
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> byRoot;
  for (std::uint32_t t = 0; t < placeOfTriangle.size(); ++t)
    byRoot[find(placeOfTriangle[t])].push_back(t);
  std::vector<std::vector<std::uint32_t>> components;
  for (auto& [unused, triangles] : byRoot) components.push_back(std::move(triangles));
  return components;
}

bool insideAny(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& components,
               const RealVec& point) {
  for (const auto& component : components) {
    Real sum = 0;  // of half the solid angles
    for (const std::uint32_t t : component) {
      const RealVec a = mesh.corner(t, 0).cast<Real>() - point,
                    b = mesh.corner(t, 1).cast<Real>() - point,
                    c = mesh.corner(t, 2).cast<Real>() - point;
      const Real la = a.norm(), lb = b.norm(), lc = c.norm();
      sum += std::atan2(a.dot(b.cross(c)),
                        la * lb * lc + a.dot(b) * lc + a.dot(c) * lb + b.dot(c) * la);
    }
    if (std::lround(sum / (2 * std::numbers::pi_v<Real>)) % 2 != 0) return true;
  }
  return false;
}

}  // namespace corridor::verify
