#include "collision/world/scene.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/geometry/mesh_health.h"
#include "collision/queries/interference.h"

namespace corridor {

struct Body::Impl {
  std::string name;
  TriangleMesh mesh;
  ObbTreeParams params;
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower,
       center = Vec3::Zero();
  double radius = 0, sphereRadius = 0;
  mutable std::once_flag once;
  mutable std::atomic<bool> built = false;
  mutable std::optional<ObbTree> tree;
};

Body::Body(std::string name, TriangleMesh mesh, const ObbTreeParams& params)
    : impl_(std::make_unique<Impl>()) {
  if (mesh.triangles.empty()) throw std::invalid_argument("body " + name + " has no triangle");
  if (const auto complaint = checkMesh(mesh))
    throw std::invalid_argument("body " + name + ": " + *complaint);
  impl_->name = std::move(name);
  impl_->mesh = std::move(mesh);
  impl_->params = params;
  const auto corners = [&](auto take) {
    for (std::size_t t = 0; t < impl_->mesh.triangles.size(); ++t)
      for (int i = 0; i < 3; ++i) take(impl_->mesh.corner(t, i));
  };
  corners([&](const Vec3& p) {
    impl_->lower = impl_->lower.cwiseMin(p);
    impl_->upper = impl_->upper.cwiseMax(p);
  });
  impl_->center = impl_->lower + 0.5 * (impl_->upper - impl_->lower);
  corners([&](const Vec3& p) {
    impl_->radius = std::max(impl_->radius, roundedUp(p.stableNorm()));
    impl_->sphereRadius =
        std::max(impl_->sphereRadius, roundedUp((p - impl_->center).stableNorm()));
  });
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
bool Body::treeBuilt() const {
  return impl_->built;
}
double Body::radius() const {
  return impl_->radius;
}
const Vec3& Body::sphereCenter() const {
  return impl_->center;
}
double Body::sphereRadius() const {
  return impl_->sphereRadius;
}
const Vec3& Body::lower() const {
  return impl_->lower;
}
const Vec3& Body::upper() const {
  return impl_->upper;
}

const ObbTree& Body::tree() const {
  std::call_once(impl_->once, [this] {
    impl_->tree.emplace(impl_->mesh, impl_->params);
    impl_->built = true;
  });
  return *impl_->tree;
}

namespace {

/// Can the moving body's sphere, over the whole window and with all pads, meet the fixed body's
/// axis-aligned box? No tree is needed for this, so that bodies which nothing comes near never get
/// one.
bool mayMeet(const Body& moving, const Body& fixed, const MotionWindow& window, double margin) {
  const Vec3 y = window.X_WB.m * moving.sphereCenter();
  const Vec3 c = y + window.X_WB.t;
  const Vec3 outside = (fixed.lower() - c).cwiseMax(c - fixed.upper()).cwiseMax(Vec3::Zero());
  // stableNorm: an overflow of `outside` would separate.
  const double reach = y.stableNorm() + moving.sphereRadius();
  const double travel = window.speed + window.angular.cross(y).stableNorm() +
                        window.angle * (moving.sphereRadius() + 16 * kUnit * reach);
  const double pad = margin + window.fixedError + window.reachError * reach;
  // c is off by less than 8u of its terms a coordinate, the differences by u of both of theirs:
  // √3·(8 + 2)·u.
  const double size = reach + window.X_WB.t.cwiseAbs().sum() + fixed.lower().cwiseAbs().sum() +
                      fixed.upper().cwiseAbs().sum();
  return !(roundedDown(outside.stableNorm()) >
           roundedUp(moving.sphereRadius() + travel + pad + 32 * kUnit * size));
}

/// The one door for numbers of motion queries: a negative margin, say, would prove too much.
void require(const MotionOptions& options) {
  const auto finite = [](double x, bool zeroToo) {
    return std::isfinite(x) && (zeroToo ? x >= 0 : x > 0);
  };
  if (!finite(options.tolerance, false))
    throw std::invalid_argument("the tolerance of a motion query is to be positive and finite");
  if (!finite(options.margin, true) || !finite(options.reserve, true) ||
      !finite(options.tube.position, true) || !finite(options.tube.rotation, true))
    throw std::invalid_argument("margin, reserve and tube are to be finite and not negative");
  if (!finite(options.timeTolerance, false))
    throw std::invalid_argument("the time tolerance is to be positive and finite");
}

void require(const RigidPose& pose) {
  if (!pose.p.allFinite() || !pose.q.coeffs().allFinite() || pose.q.coeffs().isZero(0))
    throw std::invalid_argument("a pose is to be finite, its quaternion not zero");
}

void require(const Vec3& xyYaw) {
  if (!xyYaw.allFinite()) throw std::invalid_argument("a pose is to be finite");
}

double sideRadius(const std::vector<Body>& bodies) {
  Vec3 lower = bodies[0].lower(), upper = bodies[0].upper();
  for (const Body& body : bodies) {
    lower = lower.cwiseMin(body.lower());
    upper = upper.cwiseMax(body.upper());
  }
  return 0.5 * (upper - lower).norm();
}

}  // namespace

Scene::Scene(std::vector<Body> moving, std::vector<Body> fixed)
    : moving_(std::move(moving)), fixed_(std::move(fixed)) {
  if (moving_.empty()) throw std::invalid_argument("a scene needs a moving body");
  for (const Body& body : moving_) movingRadius_ = std::max(movingRadius_, body.radius());
}

double Scene::defaultTolerance() const {
  const double moving = sideRadius(moving_);
  const double radius = fixed_.empty() ? moving : std::min(moving, sideRadius(fixed_));
  // A single point has no radius; any positive number will do.
  return 1e-7 * std::max(radius, std::numeric_limits<double>::min() * 1e8);
}

std::optional<Contact> Scene::interference(const Transform& X_WB, QueryContext& context) const {
  if (!X_WB.isFinite()) throw std::invalid_argument("a pose is to be finite");
  MotionWindow still;
  still.X_WB = X_WB;
  // No matrix of doubles is a rotation: |Mx| ≤ (1 + 3η)|x|, which `reachError` holds. Far from
  // rigid, M·centre may cancel and be small beside its rounding: nothing is skipped then.
  const double defect = orthonormalityDefect(X_WB.m);
  const bool nearRigid = defect < 0x1p-10;
  still.reachError = 3 * defect;
  for (std::size_t i = 0; i < moving_.size(); ++i)
    for (std::size_t k = 0; k < fixed_.size(); ++k) {
      if (nearRigid && !mayMeet(moving_[i], fixed_[k], still, 0)) continue;
      if (const auto hit =
              corridor::interference(fixed_[k].tree(), {}, moving_[i].tree(), X_WB, context))
        return Contact{i, k, hit->b, hit->a};
    }
  return std::nullopt;
}

MotionResult Scene::certify(const RigidMotion& motion, const MotionOptions& options,
                            QueryContext& context) const {
  const MotionWindow whole = motion.window(0.5, 0.5);
  std::vector<TreePair> pairs;
  for (std::size_t i = 0; i < moving_.size(); ++i)
    for (std::size_t k = 0; k < fixed_.size(); ++k)
      if (mayMeet(moving_[i], fixed_[k], whole, options.margin + options.reserve))
        pairs.push_back({&moving_[i].tree(), &fixed_[k].tree(), i, k});
  return certifyMotion(motion, pairs, options, context);
}

MotionResult Scene::certifyEdge(const RigidPose& from, const RigidPose& to,
                                const MotionOptions& options, QueryContext& context) const {
  require(options), require(from), require(to);
  return certify(RigidMotion::spatial(from, to, options.tube), options, context);
}

MotionResult Scene::certifyEdgePlanar(const Vec3& from, const Vec3& to,
                                      const MotionOptions& options, QueryContext& context) const {
  require(options), require(from), require(to);
  return certify(RigidMotion::planar(from, to, options.tube), options, context);
}

MotionResult Scene::certifyState(const RigidPose& pose, const MotionOptions& options,
                                 QueryContext& context) const {
  const MotionResult result = certifyEdge(pose, pose, options, context);
  --context.counters.edges;
  ++context.counters.states;
  return result;
}

MotionResult Scene::certifyStatePlanar(const Vec3& xyYaw, const MotionOptions& options,
                                       QueryContext& context) const {
  const MotionResult result = certifyEdgePlanar(xyYaw, xyYaw, options, context);
  --context.counters.edges;
  ++context.counters.states;
  return result;
}

}  // namespace corridor
