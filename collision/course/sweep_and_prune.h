#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_set>
#include <utility>
#include <vector>

#include "collision/hierarchy/box_tree.h"

namespace corridor {

/// All pairs of boxes that overlap, kept up to date while boxes move: sweep and prune. Touching
/// boxes overlap. The pairs are exact for the stored bounds.
///
/// The ends of all boxes are sorted along each axis. If a box moves, its ends are moved to their
/// new places, and only the boxes whose ends they pass are tested. The cost of a step is therefore
/// proportional to the number of boxes that move plus the number of ends that they pass. It is
/// small if bodies move little (D. Baraff, Dynamic simulation of non-penetrating rigid bodies,
/// 1992; J. D. Cohen, M. C. Lin, D. Manocha, M. K. Ponamgi, I-COLLIDE, 1995). A box that moves far
/// may pass the ends of all other boxes.
class SweepAndPrune {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;  ///< the smaller number first

  /// Box number k is item k. Takes time O(n log n), plus a constant time for each pair that
  /// overlaps along the first axis.
  /// @throws std::invalid_argument if a bound is not a number, if an upper bound is below the lower
  /// bound of the same box and axis, or if there are 2^31 boxes or more.
  explicit SweepAndPrune(std::span<const BoundingBox> boxes);

  std::size_t size() const { return boxes_.size(); }
  /// Replaces the box of an item. @throws std::invalid_argument if the box has one of the faults
  /// named above, or if the item does not exist.
  void move(std::size_t item, const BoundingBox& box);

  std::size_t pairCount() const { return pairs_.size(); }
  bool overlaps(std::size_t a, std::size_t b) const;
  /// Calls visit(a, b) for each pair, in no particular order; a < b.
  template <class Visit>
  void forEachPair(const Visit& visit) const {
    for (const std::uint64_t key : pairs_)
      visit(static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key));
  }
  /// The number of times that an end has passed another end since construction.
  std::uint64_t swaps() const { return swaps_; }

 private:
  /// One end of a box along an axis. Ends are sorted by value. If values are equal, lower ends come
  /// first, so that touching boxes overlap.
  struct End {
    double value;
    std::uint32_t id;  ///< twice the item, plus one for the upper end
    bool isUpper() const { return id & 1; }
    std::uint32_t item() const { return id >> 1; }
    bool operator<(const End& other) const {
      return value < other.value || (value == other.value && !isUpper() && other.isUpper());
    }
  };
  struct Box {
    Vec3 lower, upper;
  };

  bool boxesOverlap(std::uint32_t a, std::uint32_t b) const;
  static std::uint64_t keyOf(std::uint32_t a, std::uint32_t b);
  void moveEnd(std::size_t axis, std::uint32_t id, double value);

  std::vector<Box> boxes_;
  std::array<std::vector<End>, 3> ends_;
  std::array<std::vector<std::uint32_t>, 3> places_;  ///< for each end id: its index in `ends_`
  std::unordered_set<std::uint64_t> pairs_;
  std::uint64_t swaps_ = 0;
};

}  // namespace corridor
