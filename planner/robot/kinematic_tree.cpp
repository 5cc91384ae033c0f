#include "planner/robot/kinematic_tree.h"

#include "planner/robot/angles.h"

namespace corridor {
namespace {

Transform jointPose(const Frame& frame, const Configuration& q) {
  const bool held = frame.variable == Frame::noVariable;
  const auto first = static_cast<Eigen::Index>(held ? 0 : frame.variable);
  const double value = held ? frame.offset : frame.multiplier * q[first] + frame.offset;
  Transform X;
  switch (frame.joint) {
    case Frame::Joint::none:
      break;
    case Frame::Joint::revolute:
      X.m = Eigen::AngleAxisd(value, frame.axis.stableNormalized()).toRotationMatrix();
      break;
    case Frame::Joint::prismatic:
      X.t = value * frame.axis.stableNormalized();
      break;
    case Frame::Joint::translation:
      if (!held) {
        const auto count = static_cast<Eigen::Index>(frame.count);
        X.t.head(count) = q.segment(first, count);
      }
      break;
    case Frame::Joint::rotation:
      if (!held) X.m = unitQuaternion(Eigen::Quaterniond(q.data() + first)).toRotationMatrix();
      break;
  }
  return X;
}

Transform framePose(const Frame& frame, const Configuration& q, const Transform& X_WParent) {
  const Transform fixed{rotationMatrix(unitQuaternion(frame.fixed.q)), frame.fixed.p};
  return X_WParent * (fixed * jointPose(frame, q));
}

}  // namespace

std::vector<Transform> framePoses(const KinematicTree& tree, const Configuration& q) {
  std::vector<Transform> poses(tree.frames.size());
  for (std::size_t i = 1; i < tree.frames.size(); ++i)
    poses[i] = framePose(tree.frames[i], q, poses[tree.frames[i].parent]);
  return poses;
}

void setFramePoses(const KinematicTree& tree, const Configuration& q,
                   std::span<const std::size_t> frames, std::vector<Transform>& X_WF) {
  for (const std::size_t i : frames)
    X_WF[i] = framePose(tree.frames[i], q, X_WF[tree.frames[i].parent]);
}

}  // namespace corridor
