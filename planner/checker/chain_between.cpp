#include "planner/checker/chain_between.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace corridor {
namespace {

using VariableRange = ChainBetween::Range;

/// The next double above π: [−kPi, kPi] covers the whole circle in real arithmetic.
constexpr double kPi = 0x1.921fb54442d19p1;

/// Returns the frames from `f` upwards to its ancestor `top`. The result excludes `top`.
std::vector<std::size_t> upTo(const KinematicTree& tree, std::size_t f, std::size_t top) {
  std::vector<std::size_t> frames;
  for (; f != top; f = tree.frames[f].parent) frames.push_back(f);
  return frames;
}

/// Returns the values of a variable that a proof must cover, or nullopt if they are not bounded.
/// @param wholeTurns whether every joint that the variable moves returns to the same pose after a
/// full turn of the variable.
/// @param beyond how far the proof must reach beyond each limit, rad or m.
std::optional<VariableRange> rangeOf(const ConfigurationSpace& space, std::size_t variable,
                                     bool wholeTurns, double beyond) {
  const auto found =
      std::find_if(space.coordinates().begin(), space.coordinates().end(),
                   [&](const Coordinate& c) { return c.first == variable && c.size() == 1; });
  if (found == space.coordinates().end()) return std::nullopt;
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const bool circle = found->kind == Coordinate::Kind::circle;
  if (wholeTurns && (circle || !(found->upper - found->lower < 2 * kPi)))
    return VariableRange{-kPi, kPi};
  if (circle || !(std::isfinite(found->lower) && std::isfinite(found->upper))) return std::nullopt;
  if (beyond == 0) return VariableRange{found->lower, found->upper};
  return VariableRange{std::nextafter(found->lower - beyond, -infinity),
                       std::nextafter(found->upper + beyond, infinity)};
}

}  // namespace

std::optional<ChainBetween> chainBetween(const Model& model, std::size_t a, std::size_t b,
                                         double beyond) {
  ChainBetween between;
  const std::vector<Frame>& frames = model.tree.frames;
  const std::size_t top = model.tree.commonAncestor(a, b);
  const std::vector<std::size_t> toA = upTo(model.tree, a, top), toB = upTo(model.tree, b, top);
  std::vector<std::size_t> given;  // for each variable of the chain: the same variable in the model
  // Adds the frames of a path, which is given from its lowest frame upwards. Returns the new index
  // of the lowest frame.
  const auto add = [&](const std::vector<std::size_t>& path) {
    std::size_t last = 0;
    for (auto f = path.rbegin(); f != path.rend(); ++f) {
      Frame frame = frames[*f];
      frame.parent = last;
      if (frame.moves()) {
        auto known = std::find(given.begin(), given.end(), frame.variable);
        if (known == given.end()) known = given.insert(known, frame.variable);
        frame.variable = static_cast<std::size_t>(known - given.begin());
      }
      last = between.tree.add(std::move(frame));
    }
    return last;
  };
  between.pair.a = add(toA);
  const std::size_t branch = between.tree.frames.size();
  between.pair.b = add(toB);
  if (given.empty()) return std::nullopt;
  std::vector<char> wholeTurns(given.size(), true);
  for (const Frame& frame : between.tree.frames) {
    if (!frame.moves()) continue;
    if (frame.joint != Frame::Joint::revolute && frame.joint != Frame::Joint::prismatic)
      return std::nullopt;
    if (frame.joint == Frame::Joint::prismatic || frame.multiplier != std::trunc(frame.multiplier))
      wholeTurns[frame.variable] = false;
  }
  for (std::size_t v = 0; v < given.size(); ++v) {
    const auto range = rangeOf(model.space, given[v], wholeTurns[v], beyond);
    if (!range) return std::nullopt;
    between.box.push_back(*range);
    between.isTurn.push_back(wholeTurns[v] && range->lower == -kPi && range->upper == kPi);
    between.space.add({Coordinate::Kind::line, "", 0, range->lower, range->upper, false, 1});
  }
  // In the new tree, the frames of the first branch are in order from the root to a. So the path
  // from a upwards is this branch in reverse.
  for (std::size_t f = branch; f-- > 1;)
    if (between.tree.frames[f].moves())
      between.variables.push_back(between.tree.frames[f].variable);
  for (std::size_t f = branch; f < between.tree.frames.size(); ++f)
    if (between.tree.frames[f].moves())
      between.variables.push_back(between.tree.frames[f].variable);
  between.numbers = std::move(given);
  return between;
}

}  // namespace corridor
