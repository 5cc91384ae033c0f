#include "planner/model/task.h"

#include <algorithm>
#include <limits>
#include <numbers>

#include "collision/core/rounding.h"

namespace corridor {

double MarginsBeyond::of(std::size_t a, std::size_t b, bool sameRobot) const {
  if (const auto pair = pairs.find(std::minmax(a, b)); pair != pairs.end()) return pair->second;
  return sameRobot ? self : world;
}

double MarginsBeyond::largest() const {
  double most = std::max(self, world);
  for (const auto& [both, metres] : pairs) most = std::max(most, metres);
  return most;
}

double Padding::of(std::size_t a, std::size_t b, bool sameRobot) const {
  const double more = beyond.of(a, b, sameRobot);
  if (const auto pair = pairs.find(std::minmax(a, b)); pair != pairs.end())
    return sumRoundedUp(pair->second, more);
  if (sameRobot) return more;
  const auto own = [&](std::size_t body) {
    const auto found = bodies.find(body);
    return found == bodies.end() ? 0 : found->second;
  };
  return sumRoundedUp(sumRoundedUp(own(a), own(b)), more);  // NaN stays NaN, and is refused
}

double Padding::largest() const {
  double first = 0, second = 0, pair = 0;
  for (const auto& [body, metres] : bodies) {
    second = std::max(second, std::min(first, metres));
    first = std::max(first, metres);
  }
  for (const auto& [both, metres] : pairs) pair = std::max(pair, metres);
  return sumRoundedUp(std::max(sumRoundedUp(first, second), pair), beyond.largest());
}

Required Required::beyondProofs() {
  return {std::numeric_limits<double>::infinity(), {}, {}};
}

Required requiredBy(const Task& task) {
  return {task.margin, task.padding, task.tube};
}

Configuration tubeOf(const ConfigurationSpace& space, const TubeSpec& asked) {
  using Kind = Coordinate::Kind;
  constexpr double rounding = 0x1p-40;
  Configuration tube = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  for (const CoordinateGroup& group : space.groups()) {
    double longest = 0;
    for (const std::size_t i : group.coordinates) {
      const Coordinate& c = space.coordinates()[i];
      if (c.kind == Kind::line) longest = std::max(longest, c.upper - c.lower);
    }
    const bool isPose = group.kind != CoordinateGroup::Kind::joints;
    for (const std::size_t i : group.coordinates) {
      const Coordinate& c = space.coordinates()[i];
      const bool line = c.kind == Kind::line;
      const double range = !line ? 2 * std::numbers::pi : isPose ? longest : c.upper - c.lower;
      std::optional<double> wanted = line ? asked.position : asked.rotation;
      if (!isPose) {
        const auto named = asked.named.find(c.name);
        const bool slides = line && !c.angular;
        wanted = named != asked.named.end()           ? std::optional(named->second)
                 : slides && asked.slides.has_value() ? asked.slides
                                                      : asked.joints;
      }
      tube[static_cast<Eigen::Index>(c.first)] = std::max(wanted.value_or(0), rounding * range);
    }
  }
  return tube;
}

}  // namespace corridor
