#include "planner/view/display_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string_view>

#include <Eigen/Geometry>

#include "planner/view/tessellate.h"
#include "planner/view/tip_frames.h"

namespace corridor::view {
namespace {

struct Bounds {
  Vec3 lower = Vec3::Constant(std::numeric_limits<double>::infinity()), upper = -lower;

  void include(const Vec3& p) {
    lower = lower.cwiseMin(p);
    upper = upper.cwiseMax(p);
  }
  Vec3 middle() const { return lower + (upper - lower) / 2; }
};

DisplayMesh displayMesh(const ModelBody& body) {
  std::vector<TriangleMesh> parts;
  std::vector<const TriangleMesh*> all;
  parts.reserve(body.shapes.size());
  for (const PlacedShape& shape : body.shapes)
    all.push_back(shape.mesh ? &shape.mesh->mesh : &parts.emplace_back(partsSurface(shape)));
  Bounds bounds;
  for (const TriangleMesh* mesh : all)
    for (const Vec3& p : mesh->vertices) bounds.include(p);
  DisplayMesh display;
  display.origin = bounds.middle();
  for (const TriangleMesh* mesh : all) {
    const auto first = static_cast<std::uint32_t>(display.positions.size() / 3);
    for (const Vec3& p : mesh->vertices)
      for (int i = 0; i < 3; ++i)
        display.positions.push_back(static_cast<float>(p[i] - display.origin[i]));
    for (const auto& triangle : mesh->triangles)
      for (const std::uint32_t vertex : triangle) display.indices.push_back(first + vertex);
  }
  return display;
}

/// A list of meshes without duplicates. Equal meshes occur, for example, if there are two arms of
/// one kind.
class MeshList {
 public:
  std::size_t add(DisplayMesh mesh) {
    const auto bytes = [](const auto& values) {
      return std::string_view(reinterpret_cast<const char*>(values.data()),
                              values.size() * sizeof values[0]);
    };
    const std::hash<std::string_view> hash;
    const std::size_t key = hash(bytes(mesh.positions)) ^ 31 * hash(bytes(mesh.indices));
    const auto [begin, end] = known_.equal_range(key);
    for (auto at = begin; at != end; ++at)
      if (meshes_[at->second] == mesh) return at->second;
    known_.emplace(key, meshes_.size());
    meshes_.push_back(std::move(mesh));
    return meshes_.size() - 1;
  }
  std::vector<DisplayMesh> take() { return std::move(meshes_); }

 private:
  std::vector<DisplayMesh> meshes_;
  std::multimap<std::size_t, std::size_t> known_;
};

/// Returns whether a joint moves, and all that move rotate about vertical axes or translate
/// horizontally. Testing the start pose is enough: such joints keep all axes vertical or
/// horizontal.
bool isPlanar(const Problem& problem) {
  constexpr double kUpright = 1e-9;  // tolerance for components of unit vectors: above rounding,
                                     // and far below visible tilts
  const std::vector<Transform> poses = framePoses(problem.model.tree, problem.task.start);
  bool moves = false;
  for (std::size_t i = 1; i < problem.model.tree.frames.size(); ++i) {
    const Frame& frame = problem.model.tree.frames[i];
    if (frame.joint == Frame::Joint::none || frame.variable == Frame::noVariable) continue;
    moves = true;
    const Mat3& m = poses[i].m;  // a joint's own motion does not change its axis
    const Vec3 axis =
        frame.joint == Frame::Joint::revolute || frame.joint == Frame::Joint::prismatic
            ? Vec3(m * frame.axis.normalized())
            : Vec3(m.col(2));
    const bool upright = axis.head<2>().norm() < kUpright, level = std::abs(axis.z()) < kUpright;
    switch (frame.joint) {
      case Frame::Joint::revolute:
        if (!upright) return false;
        break;
      case Frame::Joint::prismatic:
        if (!level) return false;
        break;
      case Frame::Joint::translation:
        if (frame.count != 2 || !upright) return false;
        break;
      default:
        return false;
    }
  }
  return moves;
}

}  // namespace

DisplayScene displayScene(const Problem& problem) {
  DisplayScene scene;
  MeshList meshes;
  const std::vector<Transform> poses = framePoses(problem.model.tree, problem.task.start);
  Bounds bounds;
  for (const ModelBody& body : problem.model.bodies) {
    DisplayMesh mesh = displayMesh(body);
    bounds.include(poses[body.frame] * mesh.origin);
    DisplayBody shown{body.name, 0, body.robot, {}, meshes.add(std::move(mesh))};
    if (body.robot && body.frame != 0)
      scene.frames.push_back(shown.frame = body.frame);
    else if (body.frame != 0)
      shown.X_WB = poses[body.frame];
    scene.bodies.push_back(std::move(shown));
  }
  scene.meshes = meshes.take();
  if (!scene.bodies.empty()) scene.origin = bounds.middle();
  std::sort(scene.frames.begin(), scene.frames.end());
  scene.frames.erase(std::unique(scene.frames.begin(), scene.frames.end()), scene.frames.end());
  scene.tips = tipFrames(problem.model);
  scene.planar = isPlanar(problem);
  return scene;
}

std::vector<float> displayPoses(const DisplayScene& scene, const std::vector<Transform>& X_WF) {
  std::vector<float> numbers;
  for (const std::size_t frame : scene.frames)
    for (const float number : displayPose(scene, X_WF[frame])) numbers.push_back(number);
  return numbers;
}

std::array<float, 7> displayPose(const DisplayScene& scene, const Transform& X_WF) {
  const Vec3 t = X_WF.t - scene.origin;
  const Eigen::Quaterniond q(X_WF.m);
  const auto rounded = [](double x) { return static_cast<float>(x); };
  return {rounded(t.x()), rounded(t.y()), rounded(t.z()), rounded(q.x()),
          rounded(q.y()), rounded(q.z()), rounded(q.w())};
}

}  // namespace corridor::view
