#include "planner/solve/sliding_connect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <ompl/base/PlannerData.h>
#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/goals/GoalSampleableRegion.h>
#include <ompl/datastructures/NearestNeighborsGNAT.h>
#include <ompl/geometric/PathGeometric.h>

#include "planner/checker/problem_state_space.h"
#include "planner/solve/contact_step.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

/// The trees, and how they grow.
class SlidingConnect::Search {
 public:
  /// @param range 0: a fifth of the extent, times rangeFactor
  Search(ob::SpaceInformationPtr si, const Checker* checker, double range, double rangeFactor,
         double turnWeight, unsigned slides)
      : si_(std::move(si)),
        state_(*si_->getStateSpace()->as<ProblemStateSpace>()),
        space_(state_.configurations()),
        checker_(checker),
        slides_(slides),
        weights_(tangentWeights(space_)),
        from_(si_),
        to_(si_),
        sample_(si_),
        sampler_(si_->allocStateSampler()) {
    if (checker_ && turnWeight > 0) weighTurns(turnWeight);
    range_ = range > 0 ? range : rangeFactor * kRangeOfExtent * extent();
    if (checker_) setNear();
    for (Tree& tree : trees_)
      tree.nearest.setDistanceFunction([this](std::size_t i, std::size_t j) {
        return weightedLength(space_, at(i), at(j), weights_);
      });
  }

  bool hasRoot(std::size_t tree) const { return !trees_[tree].nodes.empty(); }
  void addRoot(std::size_t tree, const ob::State* state) {
    growing_ = &trees_[tree];
    add(state_.read(state), growing_->nodes.size());
  }

  /// Grows one tree towards a random state, and the other tree towards the new state; the next
  /// round changes the roles. Returns whether the trees met.
  bool round() {
    sampler_->sampleUniform(sample_.get());
    const Configuration random = state_.read(sample_.get());
    const std::size_t first = round_++ % 2;
    growing_ = &trees_[first];
    const std::optional<std::size_t> added = extend(nearestTo(random), random);
    if (!added) return false;
    const Configuration target = growing_->nodes[*added].q;
    growing_ = &trees_[1 - first];
    std::size_t node = nearestTo(target);
    while (growing_->nodes[node].q != target) {
      const double before = distance(growing_->nodes[node].q, target);
      const std::optional<std::size_t> next = extend(node, target);
      if (!next) return false;
      node = *next;
      if (distance(growing_->nodes[node].q, target) > before - kLeastProgress * range_)
        return false;  // it slides sideways
    }
    meeting_[first] = *added;
    meeting_[1 - first] = node;
    return true;
  }

  /// Returns the path from the root of the first tree to that of the second. @pre the trees met
  std::shared_ptr<og::PathGeometric> path() const {
    std::vector<const Configuration*> states = branch(0);
    std::reverse(states.begin(), states.end());
    const std::vector<const Configuration*> second = branch(1);
    states.insert(states.end(), second.begin() + 1, second.end());
    const auto path = std::make_shared<og::PathGeometric>(si_);
    ob::ScopedState<> state(si_);
    for (const Configuration* q : states) {
      state_.write(*q, state.get());
      path->append(state.get());
    }
    return path;
  }

  /// Adds vertices and edges. The states belong to `kept`, which must live as long as the data.
  void addTo(ob::PlannerData& data, std::vector<ob::ScopedState<>>& kept) const {
    for (std::size_t t = 0; t < 2; ++t)
      for (std::size_t i = 0; i < trees_[t].nodes.size(); ++i) {
        state_.write(trees_[t].nodes[i].q, kept.emplace_back(si_).get());
        const ob::PlannerDataVertex vertex(kept.back().get());
        const std::size_t parent = trees_[t].nodes[i].parent, first = kept.size() - 1 - i;
        if (parent != i) {
          data.addEdge(ob::PlannerDataVertex(kept[first + parent].get()), vertex);
        } else if (t == 0) {
          data.addStartVertex(vertex);
        } else {
          data.addGoalVertex(vertex);
        }
      }
  }
  std::size_t nodes() const { return trees_[0].nodes.size() + trees_[1].nodes.size(); }

 private:
  struct Node {
    Configuration q;
    std::size_t parent = 0;  // a root is its own parent
  };
  struct Tree {
    std::vector<Node> nodes;
    ompl::NearestNeighborsGNAT<std::size_t> nearest;  // indices of nodes
  };
  static constexpr std::size_t kQuery = static_cast<std::size_t>(-1);

  static constexpr double kRangeOfExtent = 0.2;
  /// Pairs of bodies whose distance is at most this fraction of the range, as metres, limit a step.
  static constexpr double kNear = 0.05;
  /// An edge that meets an obstacle is searched for its free part by this number of halvings.
  static constexpr int kHalvings = 4;
  /// Steps below this fraction of the range are not taken.
  static constexpr double kLeastStep = 1e-3;
  /// A step along obstacles is given up if less than this fraction of the wanted step is left.
  static constexpr double kLeastLeft = 0.05;
  /// If a step along obstacles is not free, half of it is tried, down to this fraction.
  static constexpr double kLeastScale = 1.0 / 16;
  /// A step may use this fraction of the distance of a pair, to first order.
  static constexpr double kUsed = 0.7;
  /// If a pair would come closer by d without the obstacle, it may come closer by this multiple.
  static constexpr double kApproach = 0.05;
  static constexpr std::size_t kContacts = 12;
  /// Growing towards the other tree ends if it comes closer by less than this fraction of the
  /// range.
  static constexpr double kLeastProgress = 0.02;

  const Configuration& at(std::size_t i) const {
    return i == kQuery ? query_ : growing_->nodes[i].q;
  }
  double distance(const Configuration& a, const Configuration& b) const {
    return weightedLength(space_, a, b, weights_);
  }

  /// Sets the weights of the rotations of planar and floating joints.
  void weighTurns(double turnWeight) {
    double radius = 0;
    for (const auto& placed : checker_->scene().bodies())
      if (placed.frame != 0) radius = std::max(radius, placed.body.radius());
    const std::vector<Eigen::Index> firsts = firstsInStep(space_);
    for (const CoordinateGroup& group : space_.groups())
      if (group.kind != CoordinateGroup::Kind::joints) {
        const std::size_t turn = group.coordinates.back();
        weights_.segment(firsts[turn], stepSize(space_.coordinates()[turn]))
            .setConstant(turnWeight * radius);
      }
  }

  double extent() const {
    const std::vector<Eigen::Index> firsts = firstsInStep(space_);
    double squares = 0;
    for (std::size_t i = 0; i < firsts.size(); ++i) {
      const Coordinate& c = space_.coordinates()[i];
      const bool line = c.kind == Coordinate::Kind::line;
      squares += std::pow(weights_[firsts[i]] * (line ? c.upper - c.lower : std::numbers::pi), 2);
    }
    return std::sqrt(squares);
  }

  void setNear() {
    std::vector<double> near;
    for (const auto& pair : checker_->scene().motionPairs()) {
      margins_.push_back(
          checker_->marginOf(checker_->bodyOf(pair.bodyA), checker_->bodyOf(pair.bodyB)));
      near.push_back(margins_.back() + kNear * range_);
    }
    near_.emplace(std::move(near));
  }

  std::size_t add(const Configuration& q, std::size_t parent) {
    growing_->nodes.push_back({q, parent});
    growing_->nearest.add(growing_->nodes.size() - 1);
    return growing_->nodes.size() - 1;
  }
  std::size_t nearestTo(const Configuration& q) {
    query_ = q;
    return growing_->nearest.nearest(kQuery);
  }

  bool isFree(const Configuration& from, const Configuration& to) {
    state_.write(from, from_.get());
    state_.write(to, to_.get());
    return si_->checkMotion(from_.get(), to_.get());
  }

  /// Grows the tree from a node towards a target, and then along obstacles. Returns the last node
  /// that was added, if any.
  std::optional<std::size_t> extend(std::size_t node, const Configuration& target) {
    const Configuration from = growing_->nodes[node].q;
    const double length = distance(from, target);
    const Configuration to =
        length <= range_ ? target : space_.interpolate(from, target, range_ / length);
    if (isFree(from, to)) return add(to, node);
    if (!checker_ || slides_ == 0) return std::nullopt;
    std::size_t last = node;
    double t = 0, step = 0.5;
    Configuration until;
    for (int n = 0; n < kHalvings; ++n, step /= 2)
      if (const Configuration q = space_.interpolate(from, to, t + step); isFree(from, q)) {
        until = q;
        t += step;
      }
    if (t > 0) last = add(until, node);
    last = slide(last, target);
    if (last == node) return std::nullopt;
    return last;
  }

  /// Grows the tree along obstacles, from a node that is close to one, towards a target. Returns
  /// the last node.
  std::size_t slide(std::size_t node, const Configuration& target) {
    std::vector<DistanceConstraint> contacts;
    double scale = 1;
    bool isNew = true;
    for (unsigned n = 0; n < slides_ && scale >= kLeastScale; ++n) {
      const Configuration from = growing_->nodes[node].q;
      TangentStep wanted = stepBetween(space_, from, target);
      double length = wanted.cwiseProduct(weights_).norm();
      if (length <= kLeastStep * range_) break;
      wanted *= std::min(1.0, range_ / length) * scale;
      length = wanted.cwiseProduct(weights_).norm();
      if (isNew) addContactsAt(from, contacts);
      for (DistanceConstraint& c : contacts) {
        const double change = c.gradient.dot(wanted);
        c.need = std::max(-kUsed * (c.distance - margins_[c.pair]), -kApproach * change) - change;
      }
      const std::optional<TangentStep> away = shortestStep(contacts, wanted.size());
      if (!away) break;
      const TangentStep step = wanted + *away;
      if (step.cwiseProduct(weights_).norm() < kLeastLeft * length) break;
      const Configuration to = displaced(space_, from, step);
      if (distance(from, to) < kLeastStep * range_) break;
      isNew = isFree(from, to);
      if (isNew) node = add(to, node);
      scale = isNew ? std::min(1.0, 2 * scale) : scale / 2;
    }
    return node;
  }

  /// Adds the pairs that are close at q. Only the latest contacts are kept.
  void addContactsAt(const Configuration& q, std::vector<DistanceConstraint>& contacts) const {
    for (DistanceConstraint& c :
         constraintsOf(*checker_, checker_->pairsWithin(q, *near_), q, weights_))
      contacts.push_back(std::move(c));
    if (contacts.size() > kContacts)
      contacts.erase(contacts.begin(), contacts.end() - static_cast<std::ptrdiff_t>(kContacts));
  }

  /// Returns the states from the meeting of the trees to the root.
  std::vector<const Configuration*> branch(std::size_t tree) const {
    const std::vector<Node>& nodes = trees_[tree].nodes;
    std::vector<const Configuration*> states{&nodes[meeting_[tree]].q};
    for (std::size_t i = meeting_[tree]; nodes[i].parent != i; i = nodes[i].parent)
      states.push_back(&nodes[nodes[i].parent].q);
    return states;
  }

  ob::SpaceInformationPtr si_;
  const ProblemStateSpace& state_;
  const ConfigurationSpace& space_;
  const Checker* checker_;  // null: nothing slides
  double range_ = 0;
  unsigned slides_;
  TangentStep weights_;
  std::vector<double> margins_;      // of the scene's pairs
  std::optional<PairMargins> near_;  // pairs that are closer limit a step
  ob::ScopedState<> from_, to_, sample_;
  ob::StateSamplerPtr sampler_;
  std::array<Tree, 2> trees_;
  Tree* growing_ = trees_.data();
  Configuration query_;  // the state whose nearest node is searched
  std::array<std::size_t, 2> meeting_{};
  std::size_t round_ = 0;
};

SlidingConnect::SlidingConnect(const ob::SpaceInformationPtr& si, const Checker* checker)
    : ob::Planner(si, "SlidingConnect"), checker_(checker) {
  if (!dynamic_cast<const ProblemStateSpace*>(si->getStateSpace().get()))
    throw std::invalid_argument("SlidingConnect: the space is no ProblemStateSpace");
  specs_.recognizedGoal = ob::GOAL_SAMPLEABLE_REGION;
  declareParam<double>("range", this, &SlidingConnect::setRange, &SlidingConnect::getRange,
                       "0.:1.:10000.");
  declareParam<unsigned>("slides", this, &SlidingConnect::setSlides, &SlidingConnect::getSlides,
                         "0:1:100");
  declareParam<double>("turn_weight", this, &SlidingConnect::setTurnWeight,
                       &SlidingConnect::getTurnWeight, "0.:0.1:10.");
}

SlidingConnect::~SlidingConnect() = default;

void SlidingConnect::clear() {
  Planner::clear();
  search_.reset();
}

ob::PlannerStatus SlidingConnect::solve(const ob::PlannerTerminationCondition& stop) {
  checkValidity();
  if (!pdef_->getGoal()->hasType(ob::GOAL_SAMPLEABLE_REGION))
    return ob::PlannerStatus::UNRECOGNIZED_GOAL_TYPE;
  if (!search_)
    search_ = std::make_unique<Search>(si_, checker_, range_, rangeFactor_, turnWeight_, slides_);
  while (const ob::State* start = pis_.nextStart()) search_->addRoot(0, start);
  if (!search_->hasRoot(0)) return ob::PlannerStatus::INVALID_START;
  while (!stop.eval()) {
    if (const ob::State* goal = search_->hasRoot(1) ? pis_.nextGoal() : pis_.nextGoal(stop))
      search_->addRoot(1, goal);
    if (!search_->hasRoot(1)) return ob::PlannerStatus::INVALID_GOAL;
    if (!search_->round()) continue;
    pdef_->addSolutionPath(search_->path(), false, 0, getName());
    return ob::PlannerStatus::EXACT_SOLUTION;
  }
  return ob::PlannerStatus::TIMEOUT;
}

void SlidingConnect::getPlannerData(ob::PlannerData& data) const {
  Planner::getPlannerData(data);
  if (!search_) return;
  std::vector<ob::ScopedState<>> states;
  states.reserve(search_->nodes());
  search_->addTo(data, states);
  data.decoupleFromPlanner();  // copies the states
}

}  // namespace corridor
