#include "collision/world/rigid_scene.h"

#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace corridor {
namespace {

Scene sceneOf(std::vector<Body> moving, std::vector<Body> fixed) {
  if (moving.empty()) throw std::invalid_argument("a rigid scene needs at least one moving body");
  std::vector<Scene::Placed> bodies;
  for (Body& body : fixed) bodies.push_back({std::move(body), 0});
  for (Body& body : moving) bodies.push_back({std::move(body), 1});
  std::vector<Scene::Pair> pairs;
  for (std::size_t b = fixed.size(); b < bodies.size(); ++b)
    for (std::size_t a = 0; a < fixed.size(); ++a) pairs.push_back({a, b});
  return {std::move(bodies), std::move(pairs)};
}

void require(const RigidPose& pose) {
  if (!pose.p.allFinite() || !pose.q.coeffs().allFinite() || pose.q.coeffs().isZero(0))
    throw std::invalid_argument("a pose must be finite, and its quaternion not zero");
}

void require(const Vec3& xyYaw) {
  if (!xyYaw.allFinite()) throw std::invalid_argument("a pose must be finite");
}

void require(const Tube& tube) {
  for (const double x : {tube.position, tube.rotation})
    if (!(x >= 0 && std::isfinite(x)))
      throw std::invalid_argument("a tube must be finite and not negative");
}

}  // namespace

RigidScene::RigidScene(std::vector<Body> moving, std::vector<Body> fixed)
    : scene_(sceneOf(std::move(moving), std::move(fixed))) {
  fixedCount_ = 0;
  for (const Scene::Placed& placed : scene_.bodies()) fixedCount_ += placed.frame == 0;
}

std::optional<Contact> RigidScene::interference(const Transform& X_WB,
                                                QueryContext& context) const {
  return scene_.interference(std::array{Transform(), X_WB}, context);
}

MotionResult RigidScene::certifyEdge(const RigidPose& from, const RigidPose& to,
                                     const MotionOptions& options, QueryContext& context,
                                     const Tube& tube) const {
  require(from), require(to), require(tube);
  RigidEdge edge(RigidMotion::spatial(from, to, tube));
  return scene_.certify(edge, options, context);
}

MotionResult RigidScene::certifyEdgePlanar(const Vec3& from, const Vec3& to,
                                           const MotionOptions& options, QueryContext& context,
                                           const Tube& tube) const {
  require(from), require(to), require(tube);
  RigidEdge edge(RigidMotion::planar(from, to, tube));
  return scene_.certify(edge, options, context);
}

MotionResult RigidScene::certifyState(const RigidPose& pose, const MotionOptions& options,
                                      QueryContext& context, const Tube& tube) const {
  return certifyEdge(pose, pose, options, context, tube);
}

MotionResult RigidScene::certifyStatePlanar(const Vec3& xyYaw, const MotionOptions& options,
                                            QueryContext& context, const Tube& tube) const {
  return certifyEdgePlanar(xyYaw, xyYaw, options, context, tube);
}

}  // namespace corridor
