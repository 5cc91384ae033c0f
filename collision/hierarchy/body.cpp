#include "collision/hierarchy/body.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "collision/convex/enclosing_hull.h"
#include "collision/core/rounding.h"
#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/cached_tree.h"
#include "collision/hierarchy/check_part.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// A tree that is built at its first use.
template <class Tree>
struct LazyTree {
  std::once_flag once;
  std::unique_ptr<const Tree> tree;
};

struct Body::Impl {
  /// The mesh. A model's shapes and several bodies may share it.
  std::shared_ptr<const TriangleMesh> mesh = noMesh();
  /// The parts. The body shares them with the 4-wide tree, which refers to them by number.
  std::shared_ptr<const std::vector<ConvexPart>> parts = noParts();
  bool solid = false;
  TreeParams params;
  std::shared_ptr<FileCache> cache;
  mutable std::once_flag once, componentsOnce, boxesOnce;
  mutable std::atomic<bool> built = false;
  mutable std::shared_ptr<const Obb4Tree> tree;
#define CORRIDOR_LAZY_TREE(Volume) LazyTree<VolumeTree<Volume>>,
  mutable std::tuple<CORRIDOR_EACH_VOLUME(CORRIDOR_LAZY_TREE) std::monostate> volumeTrees;
#undef CORRIDOR_LAZY_TREE
  mutable MeshComponents components;
  mutable std::optional<BoxTree> partBoxes;
  mutable std::once_flag hullOnce;
  mutable std::optional<EnclosingHull> enclosing;  // of the mesh
  mutable std::optional<ConvexSet> hull;           // a view of `enclosing`, or of the only part

  static std::shared_ptr<const TriangleMesh> noMesh() {
    return std::make_shared<const TriangleMesh>();
  }
  static std::shared_ptr<const std::vector<ConvexPart>> noParts() {
    return std::make_shared<const std::vector<ConvexPart>>();
  }
};

namespace {

/// Returns how far a part extends beyond its points along each coordinate axis, rounded up.
Vec3 reachOf(const ConvexPart& part) {
  Vec3 reach = Vec3::Constant(part.radius);
  const auto& points = part.points;
  const Vec3 a = part.flatEnds ? (points[1] - points[0]).stableNormalized() : Vec3(Vec3::Zero());
  // Along coordinate axis i, a disc of normal a reaches √(1 − a_i²) times its radius. If rounding
  // leaves no usable normal, the whole radius is used (as in `ConvexSet`).
  if (std::abs(a.norm() - 1) < 0x1p-20) {
    for (int i = 0; i < 3; ++i)
      reach[i] *= std::min(1.0, std::hypot(a[(i + 1) % 3], a[(i + 2) % 3]) + 16 * kUnit);
  }
  double largest = part.radius;
  for (const Vec3& q : points) largest = std::max(largest, q.cwiseAbs().maxCoeff());
  if (part.radius > 0)
    reach.array() += 4 * kUnit * largest;  // rounding of the sums and differences
  return reach;
}

void extend(BoundingBox& box, const Vec3& point, const Vec3& reach) {
  box.lower = box.lower.cwiseMin(point - reach);
  box.upper = box.upper.cwiseMax(point + reach);
}

void setTerms(BoundingBox& box) {
  box.terms = box.lower.cwiseAbs().sum() + box.upper.cwiseAbs().sum();
}

}  // namespace

/// Computes the bounds of the points that `each` gives.
///
/// Rounding of the radii. The unit of length is a power of two near the largest coordinate, so no
/// square overflows. Every computed length has fewer than 16 roundings, and differs from the real
/// length by less than `roundedUp` adds. The same holds for the largest one. Squares below 2^-1022
/// vanish, and with them lengths below 2^-510: `kLeast` covers them.
/// @param each a function that calls its argument once for each point, with three values: the
/// point, the radius of the sphere about it, and the lengths by which the box extends beyond it.
template <class Each>
void Body::Bounds::around(const Each& each) {
  each([&](const Vec3& p, double, const Vec3& reach) { extend(box, p, reach); });
  center = box.lower + 0.5 * (box.upper - box.lower);
  const double largest = std::max(box.lower.cwiseAbs().maxCoeff(), box.upper.cwiseAbs().maxCoeff());
  const double scale = largest > 0 ? 1 / powerOfTwo(largest) : 1;
  each([&](const Vec3& p, double grow, const Vec3&) {
    radius = std::max(radius, (p * scale).norm() + grow * scale);
    sphereRadius = std::max(sphereRadius, ((p - center) * scale).norm() + grow * scale);
  });
  constexpr double kLeast = 0x1p-500;
  radius = roundedUp(radius + kLeast) / scale + kTiny;  // the quotient may be subnormal
  sphereRadius = roundedUp(sphereRadius + kLeast) / scale + kTiny;
  setTerms(box);
}

Body::Body(std::string name, TriangleMesh mesh, bool solid, const TreeParams& params)
    : Body(std::move(name), std::make_shared<const TriangleMesh>(std::move(mesh)), solid, params) {}

Body::Body(std::string name, std::shared_ptr<const TriangleMesh> mesh, bool solid,
           const TreeParams& params, std::shared_ptr<FileCache> cache)
    : name_(std::move(name)), impl_(std::make_shared<Impl>()) {
  requireStandardFloatingPoint();
  if (mesh->triangles.empty()) throw std::invalid_argument("body " + name_ + " has no triangle");
  if (const auto complaint = checkMesh(*mesh))
    throw std::invalid_argument("body " + name_ + ": " + *complaint);
  impl_->mesh = std::move(mesh);
  impl_->solid = solid;
  if (solid)
    for (const MeshComponents::Component& component : components().components)
      if (!component.watertight)
        throw std::invalid_argument("body " + name_ + " is not watertight; a solid must be");
  impl_->params = params;
  impl_->cache = std::move(cache);
  // Each vertex that a triangle uses, once.
  std::vector<std::uint8_t> isUsed(impl_->mesh->vertices.size());
  for (const auto& triangle : impl_->mesh->triangles)
    for (const std::uint32_t corner : triangle) isUsed[corner] = 1;
  bounds_.around([&](auto take) {
    for (std::size_t v = 0; v < isUsed.size(); ++v)
      if (isUsed[v]) take(impl_->mesh->vertices[v], 0, Vec3::Zero());
  });
}

Body::Body(std::string name, ConvexPart part)
    : Body(std::move(name), std::vector<ConvexPart>{std::move(part)}) {}

Body::Body(std::string name, std::vector<ConvexPart> parts)
    : name_(std::move(name)), impl_(std::make_shared<Impl>()) {
  requireStandardFloatingPoint();
  if (parts.empty()) throw std::invalid_argument("body " + name_ + " has no parts");
  for (const ConvexPart& part : parts) requireValid(part, "body " + name_);
  impl_->solid = true;
  impl_->parts = std::make_shared<const std::vector<ConvexPart>>(std::move(parts));
  bounds_.around([&](auto take) {
    for (const ConvexPart& part : *impl_->parts) {
      const Vec3 reach = reachOf(part);
      for (const Vec3& q : part.points) take(q, part.radius, reach);
    }
  });
}

Body::Body(std::string name, const Bounds& bounds, std::shared_ptr<Impl> impl)
    : name_(std::move(name)), bounds_(bounds), impl_(std::move(impl)) {}

Body::~Body() = default;
Body::Body(Body&&) noexcept = default;
Body& Body::operator=(Body&&) noexcept = default;

Body Body::renamed(std::string name) const {
  return {std::move(name), bounds_, impl_};
}

const TriangleMesh& Body::mesh() const {
  return *impl_->mesh;
}
const std::vector<ConvexPart>& Body::parts() const {
  return *impl_->parts;
}
bool Body::solid() const {
  return impl_->solid;
}
bool Body::treeBuilt() const {
  return impl_->built;
}

const MeshComponents& Body::components() const {
  std::call_once(impl_->componentsOnce,
                 [this] { impl_->components = findComponents(*impl_->mesh); });
  return impl_->components;
}

const BoxTree& Body::partBoxes() const {
  std::call_once(impl_->boxesOnce, [this] {
    std::vector<BoundingBox> boxes;
    boxes.reserve(parts().size());
    for (const ConvexPart& part : parts()) {
      const Vec3 reach = reachOf(part);
      BoundingBox& box = boxes.emplace_back();
      for (const Vec3& q : part.points) extend(box, q, reach);
      setTerms(box);
    }
    impl_->partBoxes.emplace(boxes);
  });
  return *impl_->partBoxes;
}

const Obb4Tree& Body::tree() const {
  std::call_once(impl_->once, [this] {
    impl_->tree = isMesh() ? cachedTree(*impl_->mesh, impl_->params.fit, impl_->cache.get())
                           : std::make_shared<const Obb4Tree>(impl_->parts);
    impl_->built = true;
  });
  return *impl_->tree;
}

const ConvexSet* Body::hull() const {
  std::call_once(impl_->hullOnce, [this] {
    if (parts().size() == 1) impl_->hull.emplace(parts().front());
    if (isMesh()) impl_->enclosing = cachedHull(mesh(), impl_->cache.get());
    if (impl_->enclosing) {
      impl_->hull.emplace(impl_->enclosing->points);
      impl_->hull->ball = impl_->enclosing->radius;
    }
  });
  return impl_->hull ? &*impl_->hull : nullptr;
}

template <BoundingVolume Volume>
const VolumeTree<Volume>& Body::volumeTree() const {
  using Tree = VolumeTree<Volume>;
  auto& lazy = std::get<LazyTree<Tree>>(impl_->volumeTrees);
  std::call_once(lazy.once, [&] {
    lazy.tree = isMesh() ? std::make_unique<const Tree>(*impl_->mesh, impl_->params)
                         : std::make_unique<const Tree>(*impl_->parts, impl_->params);
    impl_->built = true;
  });
  return *lazy.tree;
}

#define CORRIDOR_VOLUME_TREE(Volume) \
  template const VolumeTree<Volume>& Body::volumeTree<Volume>() const;
CORRIDOR_EACH_VOLUME(CORRIDOR_VOLUME_TREE)
#undef CORRIDOR_VOLUME_TREE

}  // namespace corridor
