#include "planner/solve/why_not_free.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include "collision/core/floating_point.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/world/body_queries.h"
#include "planner/model/held_joints.h"
#include "planner/problem/state_text.h"
#include "planner/robot/angles.h"

namespace corridor {
namespace {

/// Returns the only group of the space if it is planar or floating, else null. A configuration is
/// then the pose of one body.
const CoordinateGroup* onlyPose(const ConfigurationSpace& space) {
  const bool one =
      space.groups().size() == 1 && space.groups()[0].kind != CoordinateGroup::Kind::joints;
  return one ? &space.groups()[0] : nullptr;
}

std::string position(const Configuration& q, const CoordinateGroup& pose, int digits = 4) {
  std::string text = "[";
  for (std::size_t k = 0; k + 1 < pose.coordinates.size(); ++k)
    text += (k ? ", " : "") + withDigits(q[static_cast<Eigen::Index>(k)], digits);
  return text + "]";
}

/// Returns for example `"shelf" (shape 2, triangle 12)`. The shape number is left out for a body of
/// one shape, and the triangle for a single convex part.
std::string described(const Checker& checker, std::size_t shape, std::uint32_t triangle) {
  const std::size_t owner = checker.bodyOf(shape);
  const ModelBody& body = checker.model().bodies[owner];
  std::string details;
  if (body.shapes.size() > 1) {
    std::size_t first = shape;
    while (first > 0 && checker.bodyOf(first - 1) == owner) --first;
    details = "shape " + std::to_string(shape - first + 1);
  }
  const Body& own = checker.scene().bodies()[shape].body;
  if (own.isMesh() || own.parts().size() > 1)
    details += (details.empty() ? "" : ", ") +
               ((own.isMesh() ? "triangle " : "part ") + std::to_string(triangle));
  return quotedWord(body.name) + (details.empty() ? "" : " (" + details + ")");
}

std::string described(const Checker& checker, const Contact& pair) {
  const std::string a = described(checker, pair.bodyA, pair.primitiveA),
                    b = described(checker, pair.bodyB, pair.primitiveB);
  // The order of the bodies in the problem: links come before obstacles.
  return checker.bodyOf(pair.bodyA) < checker.bodyOf(pair.bodyB) ? a + " and " + b
                                                                 : b + " and " + a;
}

/// Returns an upper bound, metres, of how much the tube can reduce the gap between two shapes: each
/// joint between the two shapes adds its tube times its lever, and times the multiplier of a mimic.
/// The lever of a rotation reaches from the joint to the farthest point of the shape. The lever of
/// a translation is 1 for a prismatic joint, and √n for n coordinates of a planar or floating
/// joint.
double tubeOf(const Checker& checker, const Configuration& q, const Contact& pair) {
  const std::vector<Frame>& frames = checker.model().tree.frames;
  const std::vector<Transform> poses = framePoses(checker.model().tree, q);
  const auto& placed = checker.scene().bodies();
  std::size_t at[2] = {placed[pair.bodyA].frame, placed[pair.bodyB].frame};
  double sum = 0;
  while (at[0] != at[1]) {
    const int side = at[0] > at[1] ? 0 : 1;  // parents come first
    const Scene::Placed& shape = placed[side == 0 ? pair.bodyA : pair.bodyB];
    const Frame& frame = frames[at[side]];
    const double lever = (poses[at[side]].t - poses[shape.frame].t).norm() + shape.body.radius();
    const double tube = frame.variable == Frame::noVariable
                            ? 0
                            : checker.tube()[static_cast<Eigen::Index>(frame.variable)];
    switch (frame.joint) {
      case Frame::Joint::none:
        break;
      case Frame::Joint::revolute:
        sum += std::abs(frame.multiplier) * tube * lever;
        break;
      case Frame::Joint::prismatic:
        sum += std::abs(frame.multiplier) * tube;
        break;
      case Frame::Joint::translation:
        sum += std::sqrt(static_cast<double>(frame.count)) * tube;
        break;
      case Frame::Joint::rotation:
        sum += tube * lever;
        break;
    }
    at[side] = frame.parent;
  }
  return sum;
}

/// Returns directions in which to search for a free configuration, as steps of its numbers. For a
/// pose the directions are evenly spread positions (a circle, or a Fibonacci spiral on the sphere)
/// with the orientation kept. Otherwise a direction changes one coordinate alone, or is a random
/// mixture of all coordinates; rotations (quaternions) are kept. Directions of this second
/// kind are scaled so that the largest change of a coordinate is 1 (rad or m).
std::vector<Configuration> directions(const ConfigurationSpace& space) {
  constexpr int count = 64;
  const auto size = static_cast<Eigen::Index>(space.size());
  std::vector<Configuration> all;
  if (const CoordinateGroup* pose = onlyPose(space)) {
    const bool spatial = pose->kind == CoordinateGroup::Kind::floating;
    for (int i = 0; i < count; ++i) {
      const double z = spatial ? 1 - (2 * i + 1.0) / count : 0;
      const double angle =
          spatial ? i * std::numbers::pi * (3 - std::sqrt(5.0)) : 2 * std::numbers::pi * i / count;
      const double r = std::sqrt(1 - z * z);
      all.push_back(Configuration::Zero(size));
      all.back()[0] = r * std::cos(angle);
      all.back()[1] = r * std::sin(angle);
      if (spatial) all.back()[2] = z;
    }
    return all;
  }
  std::mt19937_64 random(1);
  std::vector<Configuration> mixed(count, Configuration::Zero(size));
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind == Coordinate::Kind::rotation) continue;
    const auto i = static_cast<Eigen::Index>(c.first);
    for (const double sign : {1.0, -1.0}) {
      all.push_back(Configuration::Zero(size));
      all.back()[i] = sign;
    }
    for (Configuration& d : mixed) d[i] = static_cast<double>(random() >> 11) * 0x1p-52 - 1;
  }
  for (Configuration& d : mixed) all.push_back(d / std::max(d.cwiseAbs().maxCoeff(), 0x1p-10));
  return all;
}

struct NearestFree {
  Configuration q;
  int digits = 17;  ///< if `q` is printed with so many digits and read back, it is still free
  /// How far `q` is from the given configuration. For a pose: the distance of the positions,
  /// metres. Otherwise: the largest difference of a number, rad or m.
  double away = 0;
};

/// Rounds the numbers that the message prints to 4, 6, 9 or 12 digits: the fewest with which
/// `exact` remains free. If it remains free with none of them, nothing is rounded. For a pose, the
/// numbers of the position are rounded; otherwise, the numbers that differ from `from`.
NearestFree withFewDigits(const Configuration& exact, const Configuration& from, double away,
                          const Checker& checker) {
  const CoordinateGroup* const pose = onlyPose(checker.space());
  const auto isRounded = [&](Eigen::Index i) {
    return pose ? i + 1 < static_cast<Eigen::Index>(pose->coordinates.size()) : exact[i] != from[i];
  };
  for (const int digits : {4, 6, 9, 12}) {
    Configuration q = exact;
    for (Eigen::Index i = 0; i < q.size(); ++i)
      if (isRounded(i)) q[i] = std::strtod(withDigits(q[i], digits).c_str(), nullptr);
    if (checker.isProvedFree(q)) return {q, digits, pose ? away : (q - from).cwiseAbs().maxCoeff()};
  }
  return {exact, 17, away};
}

/// Searches for a free configuration near q: on shells about q, each larger by a tenth than the
/// shell before, and then by bisection along the first direction that is free. Returns nullopt if
/// no free configuration was found on any shell.
std::optional<NearestFree> nearestFree(const Configuration& q, const Checker& checker) {
  const auto freeAt = [&](const Configuration& step) { return checker.isProvedFree(q + step); };
  double size = 1, farthest = std::numbers::pi;  // for joints: rad or m
  if (onlyPose(checker.space())) {
    size = 0;
    for (const Scene::Placed& placed : checker.scene().bodies())
      if (placed.frame != 0 && !placed.restX_WF) size = std::max(size, placed.body.radius());
    farthest = 10 * size;
  }
  const std::vector<Configuration> rays = directions(checker.space());
  for (double r = 1e-4 * size; r < farthest; r *= 1.1) {
    for (const Configuration& d : rays) {
      if (!freeAt(r * d)) continue;
      double inside = r / 1.1, outside = r;
      for (int i = 0; i < 10; ++i) {
        const double middle = (inside + outside) / 2;
        (freeAt(middle * d) ? outside : inside) = middle;
      }
      return withFewDigits(q + outside * d, q, outside, checker);
    }
  }
  return std::nullopt;
}

/// Describes the free configuration that was found, or says that none was. The text has the
/// values of all joints, so that a user can copy them into the problem, or the position of a pose.
std::string describedFree(const std::optional<NearestFree>& free, const Configuration& q,
                          const Model& model) {
  if (const CoordinateGroup* pose = onlyPose(model.space)) {
    if (!free) return "no free position was found nearby with this orientation";
    return "the nearest free position found is " + withDigits(free->away) +
           " m away: at: " + position(free->q, *pose, free->digits);
  }
  if (!free) return "no free values were found nearby";
  const auto number = [&](Eigen::Index i) {
    return free->q[i] == q[i] ? shortest(q[i]) : withDigits(free->q[i], free->digits);
  };
  return "the nearest free values found are at most " + withDigits(free->away) +
         " rad or m away: " + stateText(model, free->q, number);
}

/// Returns the distance of two shapes.
double gapOf(const Checker& checker, const Configuration& q, const Contact& pair) {
  const std::vector<Transform> poses = framePoses(checker.model().tree, q);
  const auto posed = [&](std::size_t shape) {
    const Scene::Placed& placed = checker.scene().bodies()[shape];
    return Posed<Body>(placed.body, placed.restX_WF.value_or(poses[placed.frame]));
  };
  QueryContext context;
  return distance(posed(pair.bodyA), posed(pair.bodyB), {}, context).distance;
}

/// Returns the smallest distance of the shapes of two bodies; 0 if they touch.
double gapOf(const Checker& checker, const Configuration& q, const HeldPair& pair) {
  double gap = HUGE_VAL;
  for (const Scene::Pair& shapes : checker.scene().pairs())
    if (const auto [a, b] = std::minmax({checker.bodyOf(shapes.a), checker.bodyOf(shapes.b)});
        a == pair.a && b == pair.b)
      gap = std::min(gap, gapOf(checker, q, Contact{.bodyA = shapes.a, .bodyB = shapes.b}));
  return gap;
}

/// Returns `; not proved free either: "hand" and "table", "arm" and "wall"`: the pairs of bodies
/// for which the configuration is not proved free, except for bodies a and b. Returns "" if there
/// are none.
std::string otherPairs(const Checker& checker, const Configuration& q, std::size_t a,
                       std::size_t b) {
  constexpr std::size_t most = 5;
  const std::vector<ModelBody>& bodies = checker.model().bodies;
  std::string text;
  std::size_t count = 0;
  for (const Checker::PairNotFree& pair : checker.pairsNotFree(q)) {
    if (pair.a == std::min(a, b) && pair.b == std::max(a, b)) continue;
    if (++count > most) continue;
    text += (text.empty() ? "; not proved free either: " : ", ") + quotedWord(bodies[pair.a].name) +
            " and " + quotedWord(bodies[pair.b].name);
  }
  if (count > most) text += ", and " + std::to_string(count - most) + " more";
  return text;
}

std::string otherPairs(const Checker& checker, const Configuration& q, const Contact& named) {
  return otherPairs(checker, q, checker.bodyOf(named.bodyA), checker.bodyOf(named.bodyB));
}

/// Explains why no state is free (`Checker::notFreeAtRest`). Names a pair that touches, if there is
/// one.
std::string whyNeverFree(const Configuration& q, const Checker& checker) {
  const std::vector<HeldPair>& pairs = checker.notFreeAtRest();
  std::vector<double> gaps;
  for (const HeldPair& pair : pairs) gaps.push_back(gapOf(checker, q, pair));
  const auto least = std::min_element(gaps.begin(), gaps.end());
  const HeldPair& pair = pairs[static_cast<std::size_t>(least - gaps.begin())];
  const std::vector<ModelBody>& bodies = checker.model().bodies;
  const double margin = checker.marginOf(pair.a, pair.b);
  const std::string kept = margin > checker.options().margin ? "margin and padding" : "margin";
  const std::string names =
      quotedWord(bodies[pair.a].name) + " and " + quotedWord(bodies[pair.b].name);
  std::string text;
  if (*least == 0) {
    text = "in contact in every state: " + names + " touch";
  } else if (*least <= margin) {
    const auto [gap, needed] = orderedTexts(*least, margin);
    text = "too close in every state: " + names + " are " + gap + " m apart, and more than the " +
           kept + " of " + needed + " m is needed";
  } else {
    text = "the gap between " + names + " is " + withDigits(*least - margin) + " m" +
           (margin > 0 ? " beyond the " + kept : "") +
           " in every state, too small to prove at a tolerance of " +
           withDigits(checker.options().tolerance) + " m";
  }
  return text + ", and " + adviceAtRest(checker.model(), pair.a, pair.b) +
         otherPairs(checker, q, pair.a, pair.b);
}

/// Explains the reasons that do not depend on the gap between two bodies.
std::string whyUndecided(UndecidedReason reason) {
  switch (reason) {
    case UndecidedReason::floatingPoint:
      return std::string("nothing can be proved with these floating-point settings: ") +
             described(floatingPoint()) + "; restore them";
    case UndecidedReason::ambiguous:
      return "a value is so large that the pose overflows; reduce it";
    case UndecidedReason::beyondProofs:
      return "never_in_contact proves nothing so far beyond the limits of the joints";
    default:
      return "the test reached its work limit";
  }
}

/// Returns advice on a margin that two links of one robot do not keep, or "".
std::string adviceOnLinks(const Checker& checker, const Contact& pair) {
  const std::vector<ModelBody>& bodies = checker.model().bodies;
  const ModelBody &a = bodies[checker.bodyOf(pair.bodyA)], &b = bodies[checker.bodyOf(pair.bodyB)];
  const bool isSet = checker.required().padding.beyond.largest() > 0;
  if (!a.robot || a.robot != b.robot || isSet) return "";
  return "margin: {self: …, world: …} sets another one for a robot's own links, and padding: "
         "{bodies: …} one for links and obstacles only; ";
}

}  // namespace

std::string whyOutOfBounds(const Configuration& q, const ConfigurationSpace& space) {
  if (const CoordinateGroup* pose = onlyPose(space))
    return position(q, *pose) + " is outside of the bounds";
  std::string text;
  bool areDegrees = false;
  for (const Coordinate& c : space.coordinates()) {
    const double value = q[static_cast<Eigen::Index>(c.first)];
    if (c.kind != Coordinate::Kind::line || (c.lower <= value && value <= c.upper)) continue;
    areDegrees |= c.angular && fitsAsDegrees(value, c.lower, c.upper);
    text += (text.empty() ? "" : ", ") + c.name + " = " + shortest(value) + " is not in [" +
            shortest(c.lower) + ", " + shortest(c.upper) + "]";
  }
  if (areDegrees) text += "; is it in degrees? Radians are needed";
  return text;
}

std::optional<std::string> whyNotFree(const Configuration& q, const Checker& checker) {
  if (!checker.inBounds(q)) return whyOutOfBounds(q, checker.space());
  const MotionResult result = checker.certifyState(q);
  if (result.verdict == MotionVerdict::free) return std::nullopt;
  if (!checker.notFreeAtRest().empty() && standardFloatingPoint()) return whyNeverFree(q, checker);

  const bool undecided = result.verdict == MotionVerdict::undecided;
  const std::string pair = result.pair ? described(checker, *result.pair) : "two bodies";
  const MotionOptions& options = checker.options();
  if (undecided && result.reason == UndecidedReason::rounding)
    return "a value is so large that the rounding of the pose exceeds the gap between " + pair +
           ", or the tolerance of " + withDigits(options.tolerance) +
           " m; reduce the value (an angle by whole turns), or set a larger checker: {tolerance: "
           "…}";
  if (undecided && result.reason != UndecidedReason::clearance) return whyUndecided(result.reason);

  // A pair that touches is named before a pair that is only too close.
  const std::optional<Contact> contact = checker.interference(q);
  if (contact || !result.pair)
    return "in contact: " + (contact ? described(checker, *contact) : pair) + " touch" +
           (contact ? otherPairs(checker, q, *contact) : "") + "; " +
           describedFree(nearestFree(q, checker), q, checker.model());
  const double margin =
      checker.marginOf(checker.bodyOf(result.pair->bodyA), checker.bodyOf(result.pair->bodyB));
  const std::string kept = margin > options.margin ? "margin and padding" : "margin";
  const double gap = gapOf(checker, q, *result.pair);
  const std::string others = otherPairs(checker, q, *result.pair);
  if (!undecided || gap <= margin) {
    const auto [gapText, marginText] = orderedTexts(std::min(gap, margin), margin);
    return "too close: " + pair + " are " + gapText + " m apart; more than the " + kept + " of " +
           marginText + " m is needed" + others + "; " + adviceOnLinks(checker, *result.pair) +
           describedFree(nearestFree(q, checker), q, checker.model());
  }
  // `needed` does not include the clearance that the tolerance requires: another message, on the
  // tolerance, covers that.
  const double needed = tubeOf(checker, q, *result.pair), clear = gap - margin;
  const std::string text = "the gap between " + pair + " is " + withDigits(clear) + " m" +
                           (margin > 0 ? " beyond the " + kept : "");
  if (clear <= needed)
    return text + ", and the tube needs " + withDigits(needed) +
           " m; move the two bodies apart, or reduce the " +
           (margin > 0 ? kept + " or the tube" : "tube") + others;
  return text + ", too small to prove at a tolerance of " + withDigits(options.tolerance) +
         " m; move the two bodies apart, or set checker: {tolerance: " + withDigits(clear / 4) +
         "}" + others;
}

}  // namespace corridor
