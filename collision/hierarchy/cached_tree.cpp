#include "collision/hierarchy/cached_tree.h"

#include <array>
#include <utility>
#include <vector>

#include "collision/hierarchy/obb4_build.h"

namespace corridor {
namespace {

/// Below this number of triangles, finding a tree takes as long as building it (measured: 0.03 ms).
constexpr std::size_t kLeastTriangles = 100;

bool isKept(const TriangleMesh& mesh, const FileCache* cache) {
  return cache && mesh.triangles.size() >= kLeastTriangles;
}

}  // namespace

std::shared_ptr<const Obb4Tree> cachedTree(const TriangleMesh& mesh, ObbFit fit, FileCache* cache) {
  if (!isKept(mesh, cache)) return std::make_shared<const Obb4Tree>(mesh, fit);
  const std::array<Bytes, 3> inputs = {bytesOf(mesh.vertices), bytesOf(mesh.triangles),
                                       bytesOf(fit)};
  const Digest key = cache->key("Obb4Tree", inputs);
  Obb4Layout layout;
  const bool found = cache->find(key, [&](CacheFileReader& reader) {
    reader.take(layout.root);
    reader.take(layout.nodes);
    reader.take(layout.order);
    reader.take(layout.frame.origin);
    reader.take(layout.frame.length);
    reader.take(layout.frame.radius);
  });
  if (found) return std::make_shared<const Obb4Tree>(mesh, std::move(layout));
  auto tree = std::make_shared<const Obb4Tree>(mesh, fit);
  cache->offer(key, [tree](CacheFileWriter& writer) {
    const Obb4Layout built = tree->layout();
    writer.put(built.root);
    writer.put(built.nodes);
    writer.put(built.order);
    writer.put(built.frame.origin);
    writer.put(built.frame.length);
    writer.put(built.frame.radius);
  });
  return tree;
}

std::optional<EnclosingHull> cachedHull(const TriangleMesh& mesh, FileCache* cache) {
  if (!isKept(mesh, cache)) return enclosingHull(mesh);
  const std::array<Bytes, 2> inputs = {bytesOf(mesh.vertices), bytesOf(mesh.triangles)};
  const Digest key = cache->key("EnclosingHull", inputs);
  std::vector<Vec3> points;  // none: there is no such hull
  double radius = 0;
  const bool found = cache->find(key, [&](CacheFileReader& reader) {
    reader.take(points);
    reader.take(radius);
  });
  if (found)
    return points.empty() ? std::nullopt
                          : std::optional(EnclosingHull{PointColumns(std::move(points)), radius});
  std::optional<EnclosingHull> hull = enclosingHull(mesh);
  cache->offer(key, [hull](CacheFileWriter& writer) {
    std::vector<Vec3> kept;
    double swept = 0;
    if (hull) {
      const EnclosingHull thin = thinned(*hull);  // later programs have the time for this
      kept.assign(thin.points.points().begin(), thin.points.points().end());
      swept = thin.radius;
    }
    writer.put(kept);
    writer.put(swept);
  });
  return hull;
}

}  // namespace corridor
