#include "collision/hierarchy/tree_primitives.h"

#include <numeric>
#include <stdexcept>
#include <utility>

#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/check_part.h"
#include "collision/volumes/part_obb.h"

namespace corridor {

TreePrimitives::TreePrimitives(const TriangleMesh& mesh) : numbers(mesh.triangles.size()) {
  if (const auto complaint = checkMesh(mesh)) throw std::invalid_argument(*complaint);
  triangles.reserve(mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    triangles.push_back({mesh.corner(i, 0), mesh.corner(i, 1), mesh.corner(i, 2)});
  std::iota(numbers.begin(), numbers.end(), 0U);
}

TreePrimitives::TreePrimitives(std::vector<ConvexPart> convexParts)
    : parts(std::move(convexParts)), numbers(parts.size()) {
  for (const ConvexPart& part : parts) requireValid(part, "a part of a tree");
  std::iota(numbers.begin(), numbers.end(), 0U);
}

void TreePrimitives::swap(std::uint32_t i, std::uint32_t k) {
  if (parts.empty())
    std::swap(triangles[i], triangles[k]);
  else
    std::swap(parts[i], parts[k]);
  std::swap(numbers[i], numbers[k]);
}

void TreePrimitives::reorder(std::span<const std::uint32_t> order) {
  const auto apply = [&](auto& items) {
    auto moved = items;
    for (std::size_t i = 0; i < items.size(); ++i) moved[i] = std::move(items[order[i]]);
    items = std::move(moved);
  };
  apply(triangles);
  apply(parts);
  apply(numbers);
}

double TreePrimitives::side(std::uint32_t i, const Vec3& mean, const Vec3& normal) const {
  // The mean is subtracted before the corners are summed. Far from the origin, the sum of three
  // corners would lose the digits that decide.
  if (parts.empty()) {
    const Triangle& t = triangles[i];
    return normal.dot((t[0] - mean) + (t[1] - mean) + (t[2] - mean));
  }
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : parts[i].points) sum += p - mean;
  return 3 * normal.dot(sum) / static_cast<double>(parts[i].points.size());
}

std::vector<Ball> TreePrimitives::ballsOfParts(std::uint32_t first, std::uint32_t count) const {
  std::vector<Ball> balls;
  balls.reserve(count);
  for (std::uint32_t i = first; i < first + count; ++i) addBallsOf(parts[i], balls);
  return balls;
}

}  // namespace corridor
