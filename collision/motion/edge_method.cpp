#include "collision/motion/edge_method.h"

#include <algorithm>

#include "collision/motion/adaptive_motion.h"
#include "collision/motion/conservative_advancement.h"
#include "collision/motion/motion_answer.h"

namespace corridor {

const std::vector<std::string>& edgeMethodNames() {
  static const std::vector<std::string> names{"certified", "adaptive", "advancement", "discrete"};
  return names;
}

std::vector<std::string> provingMethodNames() {
  std::vector<std::string> names;
  for (const std::string& name : edgeMethodNames())
    if (proves(*edgeMethodNamed(name))) names.push_back(name);
  return names;
}

std::optional<EdgeMethod> edgeMethodNamed(std::string_view name) {
  const auto& names = edgeMethodNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<EdgeMethod>(found - names.begin());
}

MotionResult certifyMotionBy(EdgeMethod method, MotionSource& motion,
                             std::span<const MotionPair> pairs, const MotionOptions& options,
                             QueryContext& context) {
  const MotionResult result = certifyMotionUncounted(method, motion, pairs, options, context);
  count(motion, result, context.counters);
  return result;
}

MotionResult certifyMotionUncounted(EdgeMethod method, MotionSource& motion,
                                    std::span<const MotionPair> pairs, const MotionOptions& options,
                                    QueryContext& context) {
  switch (method) {
    case EdgeMethod::certified:
    case EdgeMethod::discrete:
      break;
    case EdgeMethod::adaptive:
      return certifyAdaptively(motion, pairs, options, context);
    case EdgeMethod::advancement:
      return certifyByAdvancement(motion, pairs, options, context);
  }
  return certifyMotion(motion, pairs, options, context);
}

}  // namespace corridor
