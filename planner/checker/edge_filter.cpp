#include "planner/checker/edge_filter.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "collision/convex/convex_contact.h"
#include "planner/robot/angles.h"

namespace corridor {
namespace {

/// The joints of a model, and for each frame the joint that moves it and its pose there.
struct Joints {
  std::vector<ChainScene::Joint> constants;
  std::vector<MovingJoint> moving;
  std::vector<std::uint32_t> of;
  std::vector<LongPose> fixed;
};

std::optional<Joints> jointsOf(const Model& model, const Configuration& tube) {
  const KinematicTree& tree = model.tree;
  Joints joints;
  joints.of.assign(tree.frames.size(), ChainScene::kNone);
  joints.fixed.resize(tree.frames.size());
  for (std::size_t f = 1; f < tree.frames.size(); ++f) {
    const Frame& frame = tree.frames[f];
    joints.of[f] = joints.of[frame.parent];
    joints.fixed[f] = joints.fixed[frame.parent].then(frame);
    if (!frame.moves()) continue;
    const bool slides = frame.joint == Frame::Joint::prismatic;
    if (!slides && frame.joint != Frame::Joint::revolute) return std::nullopt;
    const MovingJoint joint(frame, joints.fixed[f], model.space.kindOfNumber(frame.variable), tube);
    joints.constants.push_back({joints.of[frame.parent], slides, joint.fixed(), joint.sine(),
                                joint.versine(), joint.fixed() * joint.axis()});
    joints.of[f] = static_cast<std::uint32_t>(joints.moving.size());
    joints.fixed[f] = LongPose();
    joints.moving.push_back(joint);
  }
  return joints;
}

/// Sets the obstacle's box or cylinder to the shape's primitive, if it is one and the shape's parts
/// are in it, up to less than the error that `ChainFilter` allows for.
bool setPrimitive(const PlacedShape& shape, const Transform& X_WF, ChainScene::Obstacle& obstacle) {
  if (!shape.primitive || shape.parts.size() != 1) return false;
  const ConvexPart& part = shape.parts.front();
  const Transform X_FO = {rotationMatrix(unitQuaternion(shape.at.q)), shape.at.p};
  double radius = 0;
  if (const auto* box = std::get_if<Box>(&*shape.primitive)) {
    obstacle.half = box->size / 2;
    if (part.radius != 0) return false;
  } else if (const auto* cylinder = std::get_if<Cylinder>(&*shape.primitive)) {
    obstacle.isCylinder = true;
    radius = cylinder->radius;
    obstacle.half = {radius, radius, cylinder->length / 2};
    if (!part.flatEnds || part.radius > radius) return false;
  } else {
    return false;
  }
  obstacle.X_WO = X_WF * X_FO;
  const Vec3 free = obstacle.half - Vec3(radius, radius, 0);
  const double rounding = 0x1p-30 * (obstacle.half.lpNorm<1>() + X_FO.t.lpNorm<1>());
  return std::ranges::all_of(part.points, [&](const Vec3& p) {
    const Vec3 local = X_FO.m.transpose() * (p - X_FO.t);
    return (local.cwiseAbs().array() <= free.array() + rounding).all();
  });
}

ChainScene::Obstacle obstacleOf(const PlacedShape& shape, const Body& body, const Transform& X_WF) {
  ChainScene::Obstacle obstacle;
  if (!setPrimitive(shape, X_WF, obstacle)) {
    obstacle.isCylinder = false;
    obstacle.half = (body.upper() - body.lower()) / 2;
    obstacle.X_WO = {X_WF.m, X_WF * Vec3(body.lower() + obstacle.half)};
  }
  obstacle.X_WB = X_WF;
  obstacle.hull = body.hull();
  return obstacle;
}

/// Returns whether the hulls of two links meet in each of a few configurations. Then they nearly
/// always do, because of dents, and the filter does not test them.
class HullsMeet {
 public:
  explicit HullsMeet(const Model& model) {
    for (const double part : {0.5, 0.31, 0.73, 0.12}) {
      Configuration q(static_cast<Eigen::Index>(model.space.size()));
      double each = part;
      for (const Coordinate& c : model.space.coordinates()) {
        const bool isLimited = c.kind == Coordinate::Kind::line && std::isfinite(c.upper - c.lower);
        const double low = isLimited ? c.lower : -3, high = isLimited ? c.upper : 3;
        q[static_cast<Eigen::Index>(c.first)] = low + each * (high - low);
        each = std::fmod(each + 0.618, 1.0);
      }
      poses_.push_back(framePoses(model.tree, q));
    }
  }
  bool operator()(const Scene::Placed& a, const Scene::Placed& b) const {
    const ConvexSet *hullA = a.body.hull(), *hullB = b.body.hull();
    return hullA && hullB && std::ranges::all_of(poses_, [&](const auto& X_WF) {
             return convexSetsTouch({*hullA, X_WF[a.frame]}, {*hullB, X_WF[b.frame]});
           });
  }

 private:
  std::vector<std::vector<Transform>> poses_;
};

}  // namespace

std::unique_ptr<const EdgeFilter> EdgeFilter::make(const Model& model, const Scene& scene,
                                                   const Configuration& tube) {
  std::size_t obstacles = 0;
  for (const ModelBody& body : model.bodies) obstacles += body.robot ? 0 : body.shapes.size();
  if (obstacles > ChainScene::kMostObstacles) return nullptr;  // not usable: nothing is prepared
  std::optional<Joints> joints = jointsOf(model, tube);
  if (!joints || joints->moving.empty()) return nullptr;
  ChainScene filter;
  filter.joints = joints->constants;
  const std::vector<Transform> X_WF = staticFramePoses(model);
  std::vector<std::uint32_t> number;  // of each body of the scene: link or obstacle
  std::vector<char> isObstacle;
  std::size_t placed = 0;
  for (const ModelBody& body : model.bodies)
    for (const PlacedShape& shape : body.shapes) {
      const Body& own = scene.bodies()[placed++].body;
      isObstacle.push_back(!body.robot);
      if (!body.robot) {
        number.push_back(static_cast<std::uint32_t>(filter.obstacles.size()));
        filter.obstacles.push_back(obstacleOf(shape, own, X_WF[body.frame]));
        continue;
      }
      number.push_back(static_cast<std::uint32_t>(filter.links.size()));
      const LongPose& fixed = joints->fixed[body.frame];
      const Transform X_JF{fixed.m.cast<double>(), fixed.t.cast<double>()};
      filter.links.push_back(
          {joints->of[body.frame], X_JF, own.sphereCenter(), own.sphereRadius(), own.hull()});
    }
  const HullsMeet meet(model);
  const std::span<const MotionPair> pairs = scene.motionPairs();
  for (std::uint32_t k = 0; k < pairs.size(); ++k) {
    const std::size_t a = pairs[k].bodyA, b = pairs[k].bodyB;
    if (isObstacle[b]) return nullptr;  // two bodies at rest
    const bool inVain = !isObstacle[a] && meet(scene.bodies()[a], scene.bodies()[b]);
    filter.pairs.push_back({isObstacle[a] != 0, number[a], number[b], k, !inVain});
  }
  if (!ChainFilter::isUsable(filter)) return nullptr;
  return std::unique_ptr<const EdgeFilter>(new EdgeFilter(
      std::move(joints->moving), PairGrids(model, scene, tube), ChainFilter(std::move(filter))));
}

EdgeFilter::Workspace::Workspace(const EdgeFilter* filter) {
  if (filter) joints_ = filter->joints_;
  motions_.resize(joints_.size());
}

bool EdgeFilter::prove(const Configuration& from, const Configuration& to,
                       const MotionOptions& options, Workspace& workspace, TouchTest* test) const {
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    MovingJoint& joint = workspace.joints_[j];
    joint.set(from, to);
    if (joint.ambiguous()) return false;
    const bool slides = joint.joint() == Frame::Joint::prismatic;
    JointMotion& m = workspace.motions_[j];
    m.shift = joint.shiftAtZero();
    m.slide = slides ? joint.shiftRate() : Vec3(Vec3::Zero());
    m.angle = joint.angleAtZero();
    m.rate = joint.rate();
    m.largestRate = joint.largestRate();
    m.tube = joint.tube();
    m.length = joint.length();
    m.rotationError = joint.rotationError();
    m.shiftError = joint.shiftError();
  }
  // A pair has the same number in the scene and in the filter.
  if (!grids_.empty()) grids_.prove(from, to, options, workspace.proved_);
  filter_.pairsLeft(workspace.motions_, options, workspace.scratch_, workspace.left, test,
                    workspace.proved_);
  return true;
}

}  // namespace corridor
