#include "planner/model/model.h"

#include <algorithm>
#include <stdexcept>

#include "collision/core/rounding.h"
#include "collision/core/spelling.h"

namespace corridor {
namespace {

/// Returns whether a proof covers the requirements, for a pair with this padding.
bool covers(const PairProof& proof, const Required& need, double padding) {
  // The sum is rounded up, because the proof must cover the exact sum.
  const double margin = sumRoundedUp(need.margin, padding);
  // Numbers that are no lengths, such as NaN, are not covered: the tests refuse them.
  if (!(need.margin >= 0 && padding >= 0)) return false;
  if (!(margin <= proof.margin)) return false;
  return std::all_of(proof.ranges.begin(), proof.ranges.end(), [&](const PairProof::Range& range) {
    const auto i = static_cast<Eigen::Index>(range.number);
    return i < need.tube.size() && need.tube[i] >= 0 && need.tube[i] <= proof.beyondLimits;
  });
}

}  // namespace

void PairFilter::skip(std::size_t a, std::size_t b, std::string reason) {
  reasons_.insert_or_assign(std::minmax(a, b), std::move(reason));
}

void PairFilter::skipProved(std::size_t a, std::size_t b, PairProof proof) {
  proofs_.insert_or_assign(std::minmax(a, b), std::move(proof));
}

PairFilter PairFilter::renumbered(const std::vector<std::optional<std::size_t>>& places) const {
  PairFilter filter;
  const auto move = [&](const auto& from, auto& to) {
    for (const auto& [pair, value] : from)
      if (pair.second < places.size() && places[pair.first] && places[pair.second])
        to.emplace(std::minmax(*places[pair.first], *places[pair.second]), value);
  };
  move(reasons_, filter.reasons_);
  move(proofs_, filter.proofs_);
  return filter;
}

std::string_view PairFilter::whyNotTested(std::size_t a, std::size_t b,
                                          const Required& need) const {
  const auto found = reasons_.find(std::minmax(a, b));
  if (found != reasons_.end()) return found->second;
  const auto proof = proofs_.find(std::minmax(a, b));
  if (proof != proofs_.end() && covers(proof->second, need, need.padding.of(a, b, true)))
    return kNeverInContact;
  const auto isSame = [&](const std::vector<std::size_t>& ofBodies) {
    return std::max(a, b) < ofBodies.size() && ofBodies[a] == ofBodies[b];
  };
  if (!isSame(movers_)) return {};
  return parts_.empty() || isSame(parts_) ? kNeverMove : kTestedAtRest;
}

void requireObstaclesAtRest(const Model& model) {
  const std::vector<std::size_t> movers = moversOf(model.tree);
  for (const ModelBody& body : model.bodies) {
    if (body.frame >= movers.size())
      throw std::invalid_argument("Model: the frame of the body " + quotedWord(body.name) +
                                  " does not exist");
    if (!body.robot && movers[body.frame] != 0)
      throw std::invalid_argument("Model: the frame of the body " + quotedWord(body.name) +
                                  " moves, but the body has no robot; set ModelBody::robot, or "
                                  "choose a frame that is fixed to the world");
  }
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
