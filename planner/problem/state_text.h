#pragma once

#include <functional>
#include <string>

#include "planner/model/model.h"

namespace corridor {

/// Returns a configuration as a problem file writes it: `{pan: 0.5, drive: {at: [1, 2], yaw: 0}}`,
/// the pose of a rigid robot `{at: [0, 0, 1]}`, or a map of these by the names of several robots.
/// The rotation of a floating joint is left out if it is the identity.
/// @param number  returns the text of a number of the configuration, by its index; default: with
/// all digits.
std::string stateText(const Model& model, const Configuration& q,
                      const std::function<std::string(Eigen::Index)>& number = {});

}  // namespace corridor
