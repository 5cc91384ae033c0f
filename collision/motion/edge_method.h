#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "collision/core/query_context.h"
#include "collision/motion/motion_query.h"

namespace corridor {

/// How a motion is tested. All methods but the last prove it: they answer the same query with the
/// same promises (`certifyMotion`). They differ in cost, and therefore in the motions that stay
/// undecided because of the work limit.
enum class EdgeMethod {
  certified,    ///< trees over space and time, with directional motion bounds: certify_motion.h
  adaptive,     ///< bisection on distances (Schwarzer et al. 2005): adaptive_motion.h
  advancement,  ///< conservative advancement on distances: conservative_advancement.h
  /// Samples, which prove nothing, as a baseline for planners (planner/checker). No query of this
  /// library uses it.
  discrete,
};

/// Returns whether a method proves motions.
constexpr bool proves(EdgeMethod method) {
  return method != EdgeMethod::discrete;
}

/// Returns the names of all methods as users write them, in the order of the enumeration.
const std::vector<std::string>& edgeMethodNames();
/// Returns the names of the methods that prove motions.
std::vector<std::string> provingMethodNames();
/// Returns the method with this name, or nothing if there is none.
std::optional<EdgeMethod> edgeMethodNamed(std::string_view name);

/// Answers the query of `certifyMotion` by the given method. The context's counters count the query
/// as an edge, or as a state if nothing moves.
/// @pre The method proves motions.
MotionResult certifyMotionBy(EdgeMethod method, MotionSource& motion,
                             std::span<const MotionPair> pairs, const MotionOptions& options,
                             QueryContext& context);
/// Answers the same query without counting it, for callers that count edges themselves.
MotionResult certifyMotionUncounted(EdgeMethod method, MotionSource& motion,
                                    std::span<const MotionPair> pairs, const MotionOptions& options,
                                    QueryContext& context);

}  // namespace corridor
