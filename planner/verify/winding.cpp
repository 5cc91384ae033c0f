#include "planner/verify/winding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace corridor::verify {

std::vector<std::vector<std::uint32_t>> componentsOf(const TriangleMesh& mesh) {
  std::map<std::array<double, 3>, std::uint32_t> places;
  const auto placeOf = [&](const Vec3& p) {
    return places
        .try_emplace({p.x() + 0.0, p.y() + 0.0, p.z() + 0.0},
                     static_cast<std::uint32_t>(places.size()))
        .first->second;
  };
  std::vector<std::uint32_t> root(mesh.triangles.size());
  std::iota(root.begin(), root.end(), 0u);
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  // For each edge of the mesh, the key is the pair of indices of its two ends, and the value is one
  // triangle that has this edge.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> edges;
  for (std::uint32_t t = 0; t < root.size(); ++t) {
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t p = placeOf(mesh.corner(t, i)), q = placeOf(mesh.corner(t, (i + 1) % 3));
      if (p == q) continue;
      const auto [at, fresh] = edges.try_emplace(std::minmax(p, q), t);
      if (!fresh) root[find(t)] = find(at->second);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> byRoot;
  for (std::uint32_t t = 0; t < root.size(); ++t) byRoot[find(t)].push_back(t);
  std::vector<std::vector<std::uint32_t>> components;
  for (auto& [unused, triangles] : byRoot) components.push_back(std::move(triangles));
  return components;
}

bool insideAny(const TriangleMesh& mesh, const std::vector<std::vector<std::uint32_t>>& components,
               const RealVec& point) {
  for (const auto& component : components) {
    Real sum = 0;  // half of the solid angles
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
