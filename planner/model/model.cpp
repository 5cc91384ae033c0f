#include "planner/model/model.h"

#include <algorithm>

namespace corridor {

void PairFilter::skip(std::size_t a, std::size_t b, std::string reason) {
  reasons_.insert_or_assign(std::minmax(a, b), std::move(reason));
}

std::string_view PairFilter::whyNotTested(std::size_t a, std::size_t b) const {
  const auto found = reasons_.find(std::minmax(a, b));
  if (found != reasons_.end()) return found->second;
  const bool still = !movers_.empty() && movers_[a] == movers_[b];
  return still ? kNeverMove : std::string_view();
}

double pairCount(const Model& model) {
  const auto bodies = static_cast<double>(model.bodies.size());
  const auto still = static_cast<double>(
      std::count_if(model.bodies.begin(), model.bodies.end(),
                    [](const ModelBody& body) { return !body.robot.has_value(); }));
  return (bodies * (bodies - 1) - still * (still - 1)) / 2;
}

std::vector<std::size_t> moversOf(const KinematicTree& tree) {
  std::vector<std::size_t> mover(tree.frames.size(), 0);
  for (std::size_t i = 1; i < tree.frames.size(); ++i)
    mover[i] =
        tree.frames[i].joint != Frame::Joint::none && tree.frames[i].variable != Frame::noVariable
            ? i
            : mover[tree.frames[i].parent];
  return mover;
}

std::vector<Transform> staticFramePoses(const Model& model) {
  const auto size = static_cast<Eigen::Index>(model.space.size());
  return framePoses(model.tree, Configuration::Zero(size));
}

FramePoses::FramePoses(const Model& model) : tree_(model.tree), X_WF_(staticFramePoses(model)) {
  const std::vector<std::size_t> movers = moversOf(tree_);
  for (std::size_t frame = 0; frame < movers.size(); ++frame)
    if (movers[frame] != 0) moving_.push_back(frame);
}

const std::vector<Transform>& FramePoses::at(const Configuration& q) {
  setFramePoses(tree_, q, moving_, X_WF_);
  return X_WF_;
}

bool hasPoseJoints(const ConfigurationSpace& space) {
  const auto& groups = space.groups();
  return std::any_of(groups.begin(), groups.end(), [](const CoordinateGroup& group) {
    return group.kind != CoordinateGroup::Kind::joints;
  });
}

bool hasSingleJoints(const ConfigurationSpace& space) {
  const auto& groups = space.groups();
  return std::any_of(groups.begin(), groups.end(), [](const CoordinateGroup& group) {
    return group.kind == CoordinateGroup::Kind::joints;
  });
}

}  // namespace corridor
