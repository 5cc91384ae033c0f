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

#include "collision/core/rounding.h"
#include "collision/geometry/mesh_health.h"
#include "collision/volumes/pair_tests.h"

namespace corridor {

/// A tree that is built at its first use.
template <class Tree>
struct LazyTree {
  std::once_flag once;
  std::unique_ptr<const Tree> tree;
};

struct Body::Impl {
  std::string name;
  TriangleMesh mesh;
  std::optional<ConvexPart> part;
  bool solid = false;
  TreeParams params;
  mutable std::once_flag once, componentsOnce;
  mutable std::atomic<bool> built = false;
  mutable std::optional<Obb4Tree> tree;
#define CORRIDOR_LAZY_TREE(Volume) LazyTree<VolumeTree<Volume>>,
  mutable std::tuple<CORRIDOR_EACH_VOLUME(CORRIDOR_LAZY_TREE) std::monostate> volumeTrees;
#undef CORRIDOR_LAZY_TREE
  mutable MeshComponents components;
};

/// Extends the bounds so that they contain spheres of radius `grow` about the points that `each`
/// visits. The axis-aligned bounds extend `reach` beyond the points instead.
template <class Each>
void Body::Bounds::around(const Each& each, double grow, const Vec3& reach) {
  each([&](const Vec3& p) {
    box.lower = box.lower.cwiseMin(p - reach);
    box.upper = box.upper.cwiseMax(p + reach);
  });
  center = box.lower + 0.5 * (box.upper - box.lower);
  each([&](const Vec3& p) {
    radius = std::max(radius, roundedUp(p.stableNorm() + grow));
    sphereRadius = std::max(sphereRadius, roundedUp((p - center).stableNorm() + grow));
  });
  box.terms = box.lower.cwiseAbs().sum() + box.upper.cwiseAbs().sum();
}

Body::Body(std::string name, TriangleMesh mesh, bool solid, const TreeParams& params)
    : impl_(std::make_unique<Impl>()) {
  requireStandardFloatingPoint();
  if (mesh.triangles.empty()) throw std::invalid_argument("body " + name + " has no triangle");
  if (const auto complaint = checkMesh(mesh))
    throw std::invalid_argument("body " + name + ": " + *complaint);
  impl_->name = std::move(name);
  impl_->mesh = std::move(mesh);
  impl_->solid = solid;
  if (solid)
    for (const MeshComponents::Component& component : components().components)
      if (!component.watertight)
        throw std::invalid_argument("body " + impl_->name + " is not watertight; a solid must be");
  impl_->params = params;
  bounds_.around(
      [&](auto take) {
        for (std::size_t t = 0; t < impl_->mesh.triangles.size(); ++t)
          for (int i = 0; i < 3; ++i) take(impl_->mesh.corner(t, i));
      },
      0, Vec3::Zero());
}

Body::Body(std::string name, ConvexPart part) : impl_(std::make_unique<Impl>()) {
  requireStandardFloatingPoint();
  if (part.points.empty()) throw std::invalid_argument("body " + name + " has no points");
  if (part.flatEnds && part.points.size() != 2)
    throw std::invalid_argument("body " + name + " is a cylinder without two ends");
  if (!(std::isfinite(part.radius) && part.radius >= 0))
    throw std::invalid_argument("body " + name + ": the radius must be finite and not negative");
  for (const Vec3& q : part.points)
    if (!q.allFinite())
      throw std::invalid_argument("body " + name + " has a point that is not finite");
  impl_->name = std::move(name);
  impl_->solid = true;
  impl_->part = std::move(part);
  const ConvexPart& p = *impl_->part;
  Vec3 reach = Vec3::Constant(p.radius);
  const Vec3 a = p.flatEnds ? (p.points[1] - p.points[0]).stableNormalized() : Vec3(Vec3::Zero());
  // Along coordinate axis i, a disc of normal a reaches √(1 − a_i²) times its radius. If rounding
  // leaves no usable normal, the whole radius is taken (as in `ConvexSet`).
  if (std::abs(a.norm() - 1) < 0x1p-20) {
    for (int i = 0; i < 3; ++i)
      reach[i] *= std::min(1.0, std::hypot(a[(i + 1) % 3], a[(i + 2) % 3]) + 16 * kUnit);
  }
  double largest = p.radius;
  for (const Vec3& q : p.points) largest = std::max(largest, q.cwiseAbs().maxCoeff());
  if (p.radius > 0) reach.array() += 4 * kUnit * largest;  // rounding of the sums and differences
  bounds_.around(
      [&](auto take) {
        for (const Vec3& q : p.points) take(q);
      },
      p.radius, reach);
}

Body::~Body() = default;
Body::Body(Body&&) noexcept = default;
Body& Body::operator=(Body&&) noexcept = default;

const std::string& Body::name() const {
  return impl_->name;
}
const TriangleMesh& Body::mesh() const {
  return impl_->mesh;
}
const ConvexPart* Body::part() const {
  return impl_->part ? &*impl_->part : nullptr;
}
bool Body::solid() const {
  return impl_->solid;
}
bool Body::treeBuilt() const {
  return impl_->built;
}

const MeshComponents& Body::components() const {
  std::call_once(impl_->componentsOnce,
                 [this] { impl_->components = findComponents(impl_->mesh); });
  return impl_->components;
}

const Obb4Tree& Body::tree() const {
  std::call_once(impl_->once, [this] {
    if (impl_->part) {
      impl_->tree.emplace(*impl_->part);
    } else {
      impl_->tree.emplace(impl_->mesh, impl_->params.fit);
    }
    impl_->built = true;
  });
  return *impl_->tree;
}

template <BoundingVolume Volume>
const VolumeTree<Volume>& Body::volumeTree() const {
  using Tree = VolumeTree<Volume>;
  auto& lazy = std::get<LazyTree<Tree>>(impl_->volumeTrees);
  std::call_once(lazy.once, [&] {
    lazy.tree = impl_->part ? std::make_unique<const Tree>(*impl_->part)
                            : std::make_unique<const Tree>(impl_->mesh, impl_->params);
    impl_->built = true;
  });
  return *lazy.tree;
}

#define CORRIDOR_VOLUME_TREE(Volume) \
  template const VolumeTree<Volume>& Body::volumeTree<Volume>() const;
CORRIDOR_EACH_VOLUME(CORRIDOR_VOLUME_TREE)
#undef CORRIDOR_VOLUME_TREE

}  // namespace corridor
