#include "planner/solve/endpoint_help.h"

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace corridor {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

std::string coordinates(RigidSpace space, const Vec3& p) {
  std::string text = "[" + number(p.x()) + ", " + number(p.y());
  if (space == RigidSpace::SE3) text += ", " + number(p.z());
  return text + "]";
}

/// Evenly spread unit vectors: a Fibonacci spiral, or a circle.
std::vector<Vec3> directions(RigidSpace space) {
  constexpr int count = 64;
  std::vector<Vec3> all;
  for (int i = 0; i < count; ++i) {
    const double z = space == RigidSpace::SE3 ? 1 - (2 * i + 1.0) / count : 0;
    const double angle = space == RigidSpace::SE3 ? i * std::numbers::pi * (3 - std::sqrt(5.0))
                                                  : 2 * std::numbers::pi * i / count;
    const double r = std::sqrt(1 - z * z);
    all.push_back({r * std::cos(angle), r * std::sin(angle), z});
  }
  return all;
}

/// The nearest position found that is free with the orientation kept: shells that grow by a tenth,
/// then halving along the ray.
std::optional<Vec3> nearestFree(const RigidState& state, const RigidChecker& checker) {
  const auto freeAt = [&](const Vec3& p) {
    RigidState moved = state;
    moved.pose.p = p;
    return checker.certifiedState(moved);
  };
  const double size = checker.scene().movingRadius();
  for (double r = 1e-4 * size; r < 10 * size; r *= 1.1) {
    for (const Vec3& d : directions(checker.space())) {
      if (!freeAt(state.pose.p + r * d)) continue;
      double inside = r / 1.1, outside = r;
      for (int i = 0; i < 10; ++i) {
        const double middle = (inside + outside) / 2;
        (freeAt(state.pose.p + middle * d) ? outside : inside) = middle;
      }
      return state.pose.p + outside * d;
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> whyNotFree(const std::string& name, const RigidState& state,
                                      const RigidChecker& checker) {
  if (!checker.inBounds(state))
    return name + ": " + coordinates(checker.space(), state.pose.p) + " is outside of the bounds";
  const MotionResult result = checker.state(state);
  if (result.verdict == MotionVerdict::free) return std::nullopt;

  std::string pair = "the robot";
  if (result.pair) {
    pair = "\"" + checker.scene().moving()[result.pair->movingBody].name() + "\" (triangle " +
           std::to_string(result.pair->movingTriangle) + ") and \"" +
           checker.scene().fixed()[result.pair->fixedBody].name() + "\" (triangle " +
           std::to_string(result.pair->fixedTriangle) + ")";
  }
  if (result.verdict == MotionVerdict::undecided && result.reason == UndecidedReason::clearance) {
    const Tube& tube = checker.options().tube;
    const double needed =
        std::sqrt(3.0) * tube.position +
        tube.rotation * checker.scene().movingRadius();  // reserve aside: the tolerance has it
    if (result.gap <= needed) {
      return name + ": the gap between " + pair + " is " + number(result.gap) +
             " m, and the tube needs " + number(needed) + " m; move it away, or set a smaller tube";
    }
    return name + ": the gap between " + pair + " is " + number(result.gap) + " m" +
           (checker.options().margin > 0 ? " beyond the margin" : "") +
           ", too small to prove at a tolerance of " + number(checker.options().tolerance) +
           " m; move it away, or set checker: {tolerance: " + number(result.gap / 4) + "}";
  }
  if (result.verdict == MotionVerdict::undecided)
    return name + ": the check of it took too much work";
  std::string text = name + " is in contact: " + pair +
                     (checker.interference(state) ? " touch"
                                                  : " are closer than the margin of " +
                                                        number(checker.options().margin) + " m");
  if (const auto free = nearestFree(state, checker)) {
    return text + "; the nearest free position found is " + number((*free - state.pose.p).norm()) +
           " m away: at: " + coordinates(checker.space(), *free);
  }
  return text + "; no free position was found nearby with this orientation";
}

}  // namespace corridor
