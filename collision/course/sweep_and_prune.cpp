#include "collision/course/sweep_and_prune.h"

#include <algorithm>
#include <stdexcept>

namespace corridor {
namespace {

void requireBox(const BoundingBox& box) {
  if (!((box.lower.array() <= box.upper.array()).all()))
    throw std::invalid_argument("a box must have numbers as bounds, the lower ones first");
}

}  // namespace

SweepAndPrune::SweepAndPrune(std::span<const BoundingBox> boxes) {
  if (boxes.size() >= (std::size_t{1} << 31))
    throw std::invalid_argument("SweepAndPrune takes fewer than 2^31 boxes");
  for (const BoundingBox& box : boxes) {
    requireBox(box);
    boxes_.push_back({box.lower, box.upper});
  }
  const auto count = static_cast<std::uint32_t>(boxes.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    std::vector<End>& ends = ends_[axis];
    for (std::uint32_t i = 0; i < count; ++i) {
      ends.push_back({boxes_[i].lower[k], 2 * i});
      ends.push_back({boxes_[i].upper[k], 2 * i + 1});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return a < b || (!(b < a) && a.id < b.id);  // the same order on every library
    });
    places_[axis].resize(ends.size());
    for (std::uint32_t place = 0; place < ends.size(); ++place)
      places_[axis][ends[place].id] = place;
  }
  // Sweeps along the first axis. A box is open from its lower end to its upper end. At the lower
  // end of a box, the boxes that are open overlap this box along the axis.
  std::vector<std::uint32_t> open, placeInOpen(boxes_.size());
  for (const End& end : ends_[0]) {
    const std::uint32_t item = end.item();
    if (end.isUpper()) {
      placeInOpen[open.back()] = placeInOpen[item];
      std::swap(open[placeInOpen[item]], open.back());
      open.pop_back();
      continue;
    }
    for (const std::uint32_t other : open)
      if (boxesOverlap(item, other)) pairs_.insert(keyOf(item, other));
    placeInOpen[item] = static_cast<std::uint32_t>(open.size());
    open.push_back(item);
  }
}

bool SweepAndPrune::boxesOverlap(std::uint32_t a, std::uint32_t b) const {
  const Box &x = boxes_[a], &y = boxes_[b];
  return (x.lower.array() <= y.upper.array()).all() && (y.lower.array() <= x.upper.array()).all();
}

std::uint64_t SweepAndPrune::keyOf(std::uint32_t a, std::uint32_t b) {
  return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
}

bool SweepAndPrune::overlaps(std::size_t a, std::size_t b) const {
  return pairs_.contains(keyOf(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b)));
}

void SweepAndPrune::move(std::size_t item, const BoundingBox& box) {
  if (item >= boxes_.size())
    throw std::invalid_argument("SweepAndPrune: item " + std::to_string(item) + " does not exist");
  requireBox(box);
  boxes_[item] = {box.lower, box.upper};
  const auto lower = static_cast<std::uint32_t>(2 * item), upper = lower + 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const std::uint32_t place = places_[axis][upper];
    // The end that is in front, as seen in the direction of motion, moves first. The two ends of
    // the box therefore never pass each other.
    if (box.upper[k] > ends_[axis][place].value) {
      moveEnd(axis, upper, box.upper[k]);
      moveEnd(axis, lower, box.lower[k]);
    } else {
      moveEnd(axis, lower, box.lower[k]);
      moveEnd(axis, upper, box.upper[k]);
    }
  }
}

/// Moves an end to its new place. Two boxes begin to overlap along the axis if a lower end passes
/// an upper end downwards, or an upper end passes a lower end upwards. They cease to overlap if
/// such ends pass each other in the opposite direction. `boxes_` already has the new boxes. A pair
/// that overlaps along all axes is therefore found at the last axis along which it begins to
/// overlap.
void SweepAndPrune::moveEnd(std::size_t axis, std::uint32_t id, double value) {
  std::vector<End>& ends = ends_[axis];
  std::vector<std::uint32_t>& places = places_[axis];
  std::uint32_t place = places[id];
  const End end{value, id};
  const auto pass = [&](std::uint32_t neighbour, bool down) {
    const End& other = ends[neighbour];
    const std::uint32_t a = end.item(), b = other.item();
    if (end.isUpper() != other.isUpper() && a != b) {
      if (end.isUpper() == down)
        pairs_.erase(keyOf(a, b));
      else if (boxesOverlap(a, b))
        pairs_.insert(keyOf(a, b));
    }
    ++swaps_;
    places[other.id] = place;
    ends[place] = other;
    place = neighbour;
  };
  while (place > 0 && end < ends[place - 1]) pass(place - 1, true);
  while (place + 1 < ends.size() && ends[place + 1] < end) pass(place + 1, false);
  ends[place] = end;
  places[id] = place;
}

}  // namespace corridor
