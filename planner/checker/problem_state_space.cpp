#include "planner/checker/problem_state_space.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <new>
#include <numbers>
#include <stdexcept>
#include <string>

#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/spaces/RealVectorStateSpace.h>
#include <ompl/base/spaces/SO2StateSpace.h>
#include <ompl/base/spaces/SO3StateSpace.h>
#include <ompl/tools/config/MagicConstants.h>

namespace corridor {

namespace ob = ompl::base;

namespace {

using Kind = Coordinate::Kind;
using Lines = ob::RealVectorStateSpace::StateType;
using Circle = ob::SO2StateSpace::StateType;
using Rotation = ob::SO3StateSpace::StateType;
static_assert(alignof(Lines) <= alignof(double) && alignof(Circle) <= alignof(double) &&
              alignof(Rotation) <= alignof(double) && sizeof(Lines) % alignof(double) == 0 &&
              sizeof(Circle) % alignof(double) == 0 && sizeof(Rotation) % alignof(double) == 0);
using Group = CoordinateGroup::Kind;

/// Returns the index of each coordinate's group.
std::vector<std::size_t> groupsOfCoordinates(const ConfigurationSpace& space) {
  std::vector<std::size_t> owner(space.coordinates().size(), 0);
  for (std::size_t g = 0; g < space.groups().size(); ++g)
    for (const std::size_t c : space.groups()[g].coordinates) owner[c] = g;
  return owner;
}

/// Returns the largest difference of two values of a coordinate, without its weight.
double rangeOf(const Coordinate& c) {
  // The largest distance of two rotations is an angle between quaternions, as in `distance`.
  return c.kind == Kind::line     ? c.upper - c.lower
         : c.kind == Kind::circle ? std::numbers::pi
                                  : std::numbers::pi / 2;
}

/// The projection onto some numbers of a configuration.
class NumberProjection : public ob::ProjectionEvaluator {
 public:
  NumberProjection(const ProblemStateSpace& space, std::vector<const Coordinate*> coordinates)
      : ProjectionEvaluator(&space), space_(space), coordinates_(std::move(coordinates)) {}

  unsigned getDimension() const override { return static_cast<unsigned>(coordinates_.size()); }
  void defaultCellSizes() override {
    bounds_.resize(getDimension());
    cellSizes_.resize(getDimension());
    for (unsigned i = 0; i < getDimension(); ++i) {
      const Coordinate& c = *coordinates_[i];
      const double low = c.kind == Kind::line ? c.lower : -std::numbers::pi,
                   high = c.kind == Kind::line ? c.upper : std::numbers::pi;
      bounds_.setLow(i, low);
      bounds_.setHigh(i, high);
      cellSizes_[i] = (high - low) / ompl::magic::PROJECTION_DIMENSION_SPLITS;
    }
  }
  void project(const ob::State* state, Eigen::Ref<Eigen::VectorXd> projection) const override {
    const Configuration q = space_.read(state);
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      projection[static_cast<Eigen::Index>(i)] =
          q[static_cast<Eigen::Index>(coordinates_[i]->first)];
  }

 private:
  const ProblemStateSpace& space_;
  std::vector<const Coordinate*> coordinates_;
};

}  // namespace

ProblemStateSpace::ProblemStateSpace(const ConfigurationSpace& space) : space_(space) {
  setName("Problem" + getName());
  const std::vector<Coordinate>& coordinates = space.coordinates();
  const std::vector<std::size_t> groups = groupsOfCoordinates(space);
  for (std::size_t i = 0; i < coordinates.size();) {
    const Coordinate& first = coordinates[i];
    if (first.kind != Kind::line) {
      parts_.push_back({first.kind, first.first, first.size()});
      if (first.kind == Kind::circle)
        addSubspace(std::make_shared<ob::SO2StateSpace>(), first.weight);
      else
        addSubspace(std::make_shared<ob::SO3StateSpace>(), first.weight);
      ++i;
      continue;
    }
    std::size_t end = i;
    double weight = 0;  // scales the distances at which samplers choose near states in a subspace
    while (end < coordinates.size() && coordinates[end].kind == Kind::line &&
           groups[end] == groups[i])
      weight = std::max(weight, coordinates[end++].weight);
    const auto lines = std::make_shared<ob::RealVectorStateSpace>(static_cast<unsigned>(end - i));
    ob::RealVectorBounds bounds(static_cast<unsigned>(end - i));
    for (unsigned k = 0; i + k < end; ++k) {
      bounds.setLow(k, coordinates[i + k].lower);
      bounds.setHigh(k, coordinates[i + k].upper);
    }
    lines->setBounds(bounds);
    addSubspace(lines, weight);
    parts_.push_back({Kind::line, first.first, end - i});
    i = end;
  }
  // OMPL's informed samplers accept no compound spaces except those of the types SE2 and SE3.
  const bool alone =
      space.groups().size() == 1 && parts_.size() == 2 && coordinates.front().weight == 1;
  if (alone && space.groups()[0].kind == Group::planar) type_ = ob::STATE_SPACE_SE2;
  if (alone && space.groups()[0].kind == Group::floating) type_ = ob::STATE_SPACE_SE3;
  lock();
  // The memory of a state has three parts: the compound state, the pointers to the states of its
  // subspaces, and these states, each followed by its numbers. All three have the alignment of a
  // pointer.
  bytes_ = sizeof(StateType) + parts_.size() * sizeof(ob::State*);
  for (Part& part : parts_) {
    part.offset = bytes_;
    bytes_ += part.kind == Kind::line     ? sizeof(Lines) + part.count * sizeof(double)
              : part.kind == Kind::circle ? sizeof(Circle)
                                          : sizeof(Rotation);
  }
}

ob::State* ProblemStateSpace::allocState() const {
  auto* const memory = static_cast<std::byte*>(::operator new(bytes_));
  auto* const state = new (memory) StateType;
  state->components = new (memory + sizeof(StateType)) ob::State*[parts_.size()];
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    std::byte* const at = memory + part.offset;
    if (part.kind == Kind::line) {
      auto* const lines = new (at) Lines;
      lines->values = new (at + sizeof(Lines)) double[part.count];
      state->components[i] = lines;
    } else if (part.kind == Kind::circle) {
      state->components[i] = new (at) Circle;
    } else {
      state->components[i] = new (at) Rotation;
    }
  }
  return state;
}

void ProblemStateSpace::freeState(ob::State* state) const {
  ::operator delete(state->as<StateType>());  // destructors of states do nothing
}

void ProblemStateSpace::read(const ob::State* state, double* q) const {
  const auto* compound = state->as<ob::CompoundState>();
  for (unsigned i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    double* numbers = q + part.first;
    if (part.kind == Kind::line) {
      const double* values = compound->as<Lines>(i)->values;
      // Most parts have two or three numbers. For three numbers, assignments cost less than the
      // call of a copy function.
      if (part.count == 3) {
        numbers[0] = values[0], numbers[1] = values[1], numbers[2] = values[2];
      } else {
        std::copy(values, values + part.count, numbers);
      }
    } else if (part.kind == Kind::circle) {
      *numbers = compound->as<Circle>(i)->value;
    } else {
      const auto& r = *compound->as<Rotation>(i);
      numbers[0] = r.x, numbers[1] = r.y, numbers[2] = r.z, numbers[3] = r.w;
    }
  }
}

Configuration ProblemStateSpace::read(const ob::State* state) const {
  Configuration q(static_cast<Eigen::Index>(space_.size()));
  read(state, q.data());
  return q;
}

void ProblemStateSpace::write(const Configuration& q, ob::State* state) const {
  auto* compound = state->as<ob::CompoundState>();
  for (unsigned i = 0; i < parts_.size(); ++i) {
    const Part& part = parts_[i];
    const double* numbers = q.data() + part.first;
    if (part.kind == Kind::line) {
      std::copy(numbers, numbers + part.count, compound->as<Lines>(i)->values);
    } else if (part.kind == Kind::circle) {
      // OMPL's angles are in [−π, π). OMPL refuses a start or goal at π, so −π is written, which is
      // the same angle.
      compound->as<Circle>(i)->value = *numbers == std::numbers::pi ? -std::numbers::pi : *numbers;
    } else {
      auto& r = *compound->as<Rotation>(i);
      r.x = numbers[0];
      r.y = numbers[1];
      r.z = numbers[2];
      r.w = numbers[3];
    }
  }
}

void ProblemStateSpace::interpolate(const ob::State* from, const ob::State* to, double t,
                                    ob::State* state) const {
  write(space_.interpolate(read(from), read(to), t), state);
}

double ProblemStateSpace::distance(const ob::State* a, const ob::State* b) const {
  // Planners compute distances more often than anything else. So nothing is copied in spaces of
  // one part, and the numbers of other small spaces are kept on the stack.
  if (parts_.size() == 1 && parts_.front().kind == Kind::line)
    return space_.distance(a->as<ob::CompoundState>()->as<Lines>(0)->values,
                           b->as<ob::CompoundState>()->as<Lines>(0)->values);
  constexpr std::size_t kFew = 32;
  if (space_.size() > kFew) return space_.distance(read(a), read(b));
  double numbersA[kFew], numbersB[kFew];
  read(a, numbersA);
  read(b, numbersB);
  return space_.distance(numbersA, numbersB);
}

bool ProblemStateSpace::equalStates(const ob::State* a, const ob::State* b) const {
  return space_.equal(read(a), read(b));
}

double ProblemStateSpace::getMaximumExtent() const {
  double sum = 0;
  for (const CoordinateGroup& group : space_.groups()) {
    const bool joints = group.kind == Group::joints;
    double squares = 0;
    for (const std::size_t i : group.coordinates) {
      const Coordinate& c = space_.coordinates()[i];
      if (!joints && i == group.coordinates.back())
        sum += c.weight * rangeOf(c);
      else
        squares += std::pow(c.weight * rangeOf(c), 2);
    }
    sum += std::sqrt(squares);
  }
  return sum;
}

void ProblemStateSpace::registerProjections() {
  const std::vector<Coordinate>& all = space_.coordinates();
  std::vector<const Coordinate*> chosen;
  for (const CoordinateGroup& group : space_.groups())
    if (chosen.empty() && group.kind != Group::joints)
      for (std::size_t k = 0; k + 1 < group.coordinates.size(); ++k)
        chosen.push_back(&all[group.coordinates[k]]);
  if (chosen.empty())
    for (std::size_t i = 0; i < std::min<std::size_t>(all.size(), 3); ++i)
      chosen.push_back(&all[i]);
  registerDefaultProjection(std::make_shared<NumberProjection>(*this, std::move(chosen)));
}

void requireProblemStateSpace(const ob::SpaceInformation& si,
                              const ConfigurationSpace& configurations) {
  const auto* const space = dynamic_cast<const ProblemStateSpace*>(si.getStateSpace().get());
  if (!space)
    throw std::invalid_argument(
        "the state space of OMPL must be a ProblemStateSpace, made of the model's space");
  if (space->configurations().size() != configurations.size())
    throw std::invalid_argument(
        "the ProblemStateSpace has " + std::to_string(space->configurations().size()) +
        " numbers, but the checker's model has " + std::to_string(configurations.size()) +
        "; make it of the space of the checker's model");
}

Configuration configurationOf(const ob::SpaceInformation& si, const ob::State* state) {
  return si.getStateSpace()->as<ProblemStateSpace>()->read(state);
}

}  // namespace corridor
