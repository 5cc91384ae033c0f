#pragma once

#ifdef CORRIDOR_WITH_FCL

#include <memory>
#include <stdexcept>
#include <vector>

#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/geometry/shape/capsule.h>
#include <fcl/geometry/shape/cylinder.h>
#include <fcl/geometry/shape/sphere.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/collision_object.h>

#include "planner/checker/checker.h"

/// A problem's scene in FCL, set up as FCL's users do: a BVHModel<OBBRSS> per mesh, and FCL's own
/// primitives. A query compares the AABBs of a pair first, and ends at the first contact. Poses
/// come from Corridor's kinematics.
namespace corridor::bench {

using FclGeometry = std::shared_ptr<fcl::CollisionGeometryd>;

template <class Volume = fcl::OBBRSS<double>>
std::shared_ptr<fcl::BVHModel<Volume>> fclMesh(const TriangleMesh& mesh) {
  auto model = std::make_shared<fcl::BVHModel<Volume>>();
  std::vector<fcl::Triangle> triangles;
  for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  model->beginModel();
  model->addSubModel(mesh.vertices, triangles);
  model->endModel();
  return model;
}

/// A shape of FCL, the index of the frame of its body, and the pose `at` of the shape in this
/// frame.
struct FclShape {
  FclGeometry geometry;
  std::size_t frame = 0;
  fcl::Transform3d at = fcl::Transform3d::Identity();
};

/// Converts a shape. @throws std::runtime_error for convex hulls, polygons, point clouds and
/// octrees: they are not converted, since no problem of Corridor's own comparisons has one.
inline FclShape fclShape(const PlacedShape& shape, std::size_t frame) {
  FclShape made{nullptr, frame};
  if (shape.mesh) {
    made.geometry = fclMesh(shape.mesh->mesh);
    return made;
  }
  if (!shape.primitive)
    throw std::runtime_error("polygons, point clouds and octrees are not run with FCL");
  made.at.linear() = shape.at.q.normalized().toRotationMatrix();
  made.at.translation() = shape.at.p;
  if (const auto* box = std::get_if<Box>(&*shape.primitive))
    made.geometry = std::make_shared<fcl::Boxd>(box->size);
  else if (const auto* sphere = std::get_if<Sphere>(&*shape.primitive))
    made.geometry = std::make_shared<fcl::Sphered>(sphere->radius);
  else if (const auto* capsule = std::get_if<Capsule>(&*shape.primitive))
    made.geometry = std::make_shared<fcl::Capsuled>(capsule->radius, capsule->length);
  else if (const auto* cylinder = std::get_if<Cylinder>(&*shape.primitive))
    made.geometry = std::make_shared<fcl::Cylinderd>(cylinder->radius, cylinder->length);
  else
    throw std::runtime_error("convex hulls are not supported with FCL");
  return made;
}

/// A problem's shapes in FCL. The tested pairs are the same as Corridor's.
class FclScene {
 public:
  explicit FclScene(const Checker& checker) : pairs_(checker.scene().pairs()) {
    for (const ModelBody& body : checker.model().bodies)
      for (const PlacedShape& shape : body.shapes) shapes_.push_back(fclShape(shape, body.frame));
  }
  /// @pre all bodies of the scene are meshes.
  explicit FclScene(const Scene& scene) : pairs_(scene.pairs()) {
    for (const Scene::Placed& placed : scene.bodies())
      shapes_.push_back({fclMesh(placed.body.mesh()), placed.frame});
  }
  bool touches(const std::vector<Transform>& X_WF) {
    for (std::size_t i = 0; i < shapes_.size(); ++i) {
      fcl::Transform3d pose = fcl::Transform3d::Identity();
      pose.linear() = X_WF[shapes_[i].frame].m;
      pose.translation() = X_WF[shapes_[i].frame].t;
      objects_.resize(shapes_.size(), nullptr);
      if (!objects_[i]) objects_[i] = std::make_shared<fcl::CollisionObjectd>(shapes_[i].geometry);
      objects_[i]->setTransform(pose * shapes_[i].at);
      objects_[i]->computeAABB();
    }
    const fcl::CollisionRequestd request;
    fcl::CollisionResultd result;
    for (const Scene::Pair& pair : pairs_) {
      if (!objects_[pair.a]->getAABB().overlap(objects_[pair.b]->getAABB())) continue;
      result.clear();
      if (fcl::collide(objects_[pair.a].get(), objects_[pair.b].get(), request, result) > 0)
        return true;
    }
    return false;
  }

 private:
  std::vector<Scene::Pair> pairs_;
  std::vector<FclShape> shapes_;
  std::vector<std::shared_ptr<fcl::CollisionObjectd>> objects_;
};

}  // namespace corridor::bench

#endif  // CORRIDOR_WITH_FCL
