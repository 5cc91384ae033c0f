#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "collision/motion/certify_motion.h"

namespace corridor {

/// How a motion is proved. All answer the same question with the same promises (`certifyMotion`);
/// they differ in what they cost, and so in what they leave undecided for want of work.
enum class EdgeMethod {
  certified,  ///< trees over space and time, travel along directions: certify_motion.h, the default
  adaptive,   ///< bisection on distances (Schwarzer et al. 2005): adaptive_motion.h
  advancement,  ///< conservative advancement on distances: conservative_advancement.h
};

/// The names of all, in the order of the enumeration: what users write.
const std::vector<std::string>& edgeMethodNames();
/// By its name; nothing where there is no such method.
std::optional<EdgeMethod> edgeMethodNamed(std::string_view name);

MotionResult certifyMotionBy(EdgeMethod method, MotionSource& motion,
                             std::span<const MotionPair> pairs, const MotionOptions& options,
                             QueryContext& context);

}  // namespace corridor
