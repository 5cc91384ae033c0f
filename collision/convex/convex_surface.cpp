#include "collision/convex/convex_surface.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "collision/convex/rational-inl.h"
#include "collision/predicates/orientation.h"

namespace corridor {
namespace {

/// Returns the indices of the first four points that are not on one plane, by elimination in
/// rationals; nothing if all points are on one plane.
std::optional<std::array<std::uint32_t, 4>> independentPoints(std::span<const Vec3> points) {
  using seidel::rational;
  std::array<std::uint32_t, 4> found{};
  seidel::Echelon<3> differences;
  for (std::uint32_t i = 1; i < points.size() && differences.rank() < 3; ++i) {
    std::array<seidel::Rational, 3> row;
    for (int k = 0; k < 3; ++k) row[k] = rational(points[i][k]) - rational(points[0][k]);
    if (differences.add(row)) found[differences.rank()] = i;
  }
  if (differences.rank() < 3) return std::nullopt;
  return found;
}

}  // namespace

std::optional<std::array<std::uint32_t, 4>> findTetrahedron(std::span<const Vec3> points) {
  if (points.size() < 4) return std::nullopt;
  const auto farthest = [&](const auto& measure) {
    std::uint32_t best = 0;
    double most = -1;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      const double value = measure(points[i]);
      if (value > most) most = value, best = i;
    }
    return best;
  };
  const Vec3 first = points[0];
  const std::uint32_t a = farthest([&](const Vec3& p) { return (p - first).norm(); });
  const Vec3 pa = points[a];
  const std::uint32_t b = farthest([&](const Vec3& p) { return (p - pa).norm(); });
  const Vec3 ab = points[b] - pa;
  const std::uint32_t c = farthest([&](const Vec3& p) { return ab.cross(p - pa).norm(); });
  const Vec3 normal = ab.cross(points[c] - pa);
  const std::uint32_t d = farthest([&](const Vec3& p) { return std::abs(normal.dot(p - pa)); });
  if (planeSide(pa, points[b], points[c], points[d]) != 0) return std::array{a, b, c, d};
  return independentPoints(points);
}

bool ConvexSurface::sees(std::span<const Vec3> points, const Face& face, const Vec3& p) {
  return planeSide(points[face.corner[0]], points[face.corner[1]], points[face.corner[2]], p) > 0;
}

std::uint32_t ConvexSurface::newFace(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  auto f = static_cast<std::uint32_t>(faces_.size());
  if (free_.empty()) {
    faces_.emplace_back();
  } else {
    f = free_.back();
    free_.pop_back();
  }
  faces_[f] = {{a, b, c}, {kNone, kNone, kNone}};
  return f;
}

void ConvexSurface::begin(std::span<const Vec3> points, std::array<std::uint32_t, 4> tetrahedron) {
  faces_.clear();
  free_.clear();
  seen_.clear();
  auto [a, b, c, d] = tetrahedron;
  if (planeSide(points[a], points[b], points[c], points[d]) > 0) std::swap(b, c);
  // d is below the plane of a, b, c, so a, b, c are counterclockwise as seen from outside.
  fan_ = {newFace(a, b, c), newFace(b, a, d), newFace(c, b, d), newFace(a, c, d)};
  faces_[fan_[0]].across = {fan_[1], fan_[2], fan_[3]};
  for (std::size_t k = 0; k < 3; ++k)
    faces_[fan_[k + 1]].across = {fan_[0], fan_[1 + (k + 2) % 3], fan_[1 + (k + 1) % 3]};
}

void ConvexSurface::add(std::span<const Vec3> points, std::uint32_t f, std::uint32_t p) {
  free_.insert(free_.end(), seen_.begin(), seen_.end());  // removed by the previous `add`
  findHorizon(points, f, points[p]);
  fan_.clear();
  for (const auto& [from, to, outer] : horizon_) {
    const std::uint32_t n = newFace(from, to, p);
    Face& beyond = faces_[outer];
    faces_[n].across[0] = outer;
    for (int k = 0; k < 3; ++k)
      if (beyond.corner[k] == to && beyond.corner[(k + 1) % 3] == from) beyond.across[k] = n;
    fan_.push_back(n);
  }
  // The edges of the horizon are in order and form a closed walk. So each new face is between the
  // new faces before and after it.
  const std::size_t count = fan_.size();
  for (std::size_t i = 0; i < count; ++i) {
    faces_[fan_[i]].across[1] = fan_[(i + 1) % count];
    faces_[fan_[i]].across[2] = fan_[(i + count - 1) % count];
  }
}

/// Walks over all faces that see p, depth first and around each face in order, so that the edges
/// of the horizon are found in order, too.
void ConvexSurface::findHorizon(std::span<const Vec3> points, std::uint32_t f, const Vec3& p) {
  seen_.clear();
  horizon_.clear();
  std::vector<Step>& stack = steps_;
  stack.clear();
  faces_[f].alive = false;
  seen_.push_back(f);
  stack.push_back({f, 0, 3});
  while (!stack.empty()) {
    Step& step = stack.back();
    if (step.left == 0) {
      stack.pop_back();
      continue;
    }
    const int k = step.edge;
    step.edge = (k + 1) % 3;
    --step.left;
    const Face& face = faces_[step.face];
    const std::uint32_t other = face.across[k];
    if (!faces_[other].alive) continue;
    if (!sees(points, faces_[other], p)) {
      horizon_.push_back({face.corner[k], face.corner[(k + 1) % 3], other});
      continue;
    }
    int back = 0;
    while (faces_[other].across[back] != step.face) ++back;
    faces_[other].alive = false;
    seen_.push_back(other);
    stack.push_back({other, (back + 1) % 3, 2});
  }
}

}  // namespace corridor
