#include "collision/volumes/moments.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/quickhull.h"
#include "collision/core/rounding.h"

namespace corridor {
namespace {

/// Maps points to coordinates about a local origin, in a unit that is a power of two near the
/// mesh's size. Then large offsets (10^6, say) don't cancel, and squares neither overflow nor
/// underflow. Scaling by the unit is exact.
struct LocalCoordinates {
  Vec3 origin;
  double unit = 1;

  explicit LocalCoordinates(std::span<const Triangle> triangles) {
    Vec3 low = triangles[0][0], high = low;
    for (const Triangle& t : triangles)
      for (const Vec3& p : t) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    origin = low + 0.5 * (high - low);
    const double size = (high - low).maxCoeff();
    if (size > 0 && std::isfinite(size)) unit = powerOfTwo(size);
  }
  Vec3 operator()(const Vec3& p) const { return (p - origin) / unit; }
  Moments global(Moments local) const {
    local.mean =
        origin + unit * local.mean;  // the covariance keeps the local unit: only its axes are used
    return local;
  }
};

}  // namespace

Moments vertexMoments(std::span<const Triangle> triangles) {
  const LocalCoordinates local(triangles);
  Moments m;
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : triangles)
    for (const Vec3& corner : t) {
      const Vec3 p = local(corner);
      m.mean += p;
      second += p * p.transpose();
    }
  m.weight = 3.0 * static_cast<double>(triangles.size());
  m.mean /= m.weight;
  m.covariance = second / m.weight - m.mean * m.mean.transpose();
  return local.global(m);
}

Moments surfaceMoments(std::span<const Triangle> triangles) {
  const LocalCoordinates local(triangles);
  Moments m;
  Mat3 second = Mat3::Zero();
  for (const Triangle& t : triangles) {
    const Vec3 p = local(t[0]), q = local(t[1]), r = local(t[2]);
    const double area = 0.5 * (q - p).cross(r - p).norm();
    const Vec3 c = (p + q + r) / 3;
    m.weight += area;
    m.mean += area * c;
    second += area / 12 *
              (9 * c * c.transpose() + p * p.transpose() + q * q.transpose() + r * r.transpose());
  }
  if (!(m.weight > 0)) return {};
  m.mean /= m.weight;
  m.covariance = second / m.weight - m.mean * m.mean.transpose();
  return local.global(m);
}

Moments hullMoments(std::span<const Triangle> triangles) {
  if (triangles.size() > (1U << 28) / 3) return {};  // the most points that `quickhull` takes
  std::vector<Vec3> points;
  points.reserve(3 * triangles.size());
  for (const Triangle& t : triangles) points.insert(points.end(), t.begin(), t.end());
  const auto key = [](const Vec3& p) { return std::tuple(p[0], p[1], p[2]); };
  std::sort(points.begin(), points.end(),
            [&](const Vec3& p, const Vec3& q) { return key(p) < key(q); });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::vector<Triangle> facets;
  for (const auto& [a, b, c] : quickhull(points))
    facets.push_back({points[a], points[b], points[c]});
  return facets.empty() ? Moments{} : surfaceMoments(facets);
}

}  // namespace corridor
