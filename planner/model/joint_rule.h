#pragma once

#include <cstddef>

#include "planner/model/model.h"

namespace corridor {

/// The value of a joint that is not planned for: constant, or a linear function of a coordinate.
struct JointRule {
  /// The index into a configuration of the joint that a mimic joint follows; -1 if it is held.
  Eigen::Index leader = -1;
  double multiplier = 0, constant = 0;

  double at(const Configuration& q) const {
    return leader < 0 ? constant : multiplier * q[leader] + constant;
  }
};

/// Returns the rule of a held joint, or of a mimic joint. Other joints, such as fixed ones, have
/// the constant 0. @pre The joint is not planned for.
JointRule ruleOf(const Model& model, std::size_t robot, std::size_t joint);

}  // namespace corridor
