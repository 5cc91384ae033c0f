#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "collision/hierarchy/node_pair4.h"
#include "collision/motion/moving_hulls.h"

namespace corridor {

/// The node pairs that time intervals leave to their halves, grouped by pair of bodies. The list is
/// a stack: each interval appends the node pairs that it leaves. Before the next interval is
/// tested, `cut` discards the node pairs that are no longer needed.
struct WorkList {
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// The node pairs of one pair of bodies: a range of `nodePairs`.
  struct Group {
    std::uint32_t bodies;  ///< the number of the pair of bodies in the query
    std::size_t begin, end;
    /// Some node pairs of these bodies may have been separated already, in longer intervals that
    /// contain the group's interval. `clearance` is a lower bound of the clearance of these
    /// separated node pairs, metres; infinite if there are none. It has a meaning only if the query
    /// records a certificate.
    double clearance = HUGE_VAL;
    /// The index of what the query knows about the hulls of these bodies; `kNone`: nothing yet.
    std::uint32_t hulls = kNone;
  };
  /// The lengths of `nodePairs` and `groups` at some time.
  struct Mark {
    std::size_t nodePairs = 0, groups = 0;
  };

  std::vector<NodePair4> nodePairs;
  std::vector<Group> groups;
  std::vector<HullGuess> hulls;

  /// Replaces the content of the list by one group for each of these pairs of bodies: the pair of
  /// the roots of both trees. Group k is for the pair of bodies number pairs[k].
  void begin(std::span<const std::uint32_t> pairs) {
    nodePairs.assign(pairs.size(), kWholeTrees[0]);
    groups.clear();
    hulls.clear();
    for (std::size_t k = 0; k < pairs.size(); ++k) groups.push_back({pairs[k], k, k + 1});
  }
  Mark mark() const { return {nodePairs.size(), groups.size()}; }
  void cut(const Mark& mark) {
    nodePairs.resize(mark.nodePairs);
    groups.resize(mark.groups);
  }
  /// Returns the node pairs of a group. Valid until `nodePairs` grows.
  std::span<const NodePair4> nodePairsOf(const Group& group) const {
    return std::span(nodePairs).subspan(group.begin, group.end - group.begin);
  }
  /// Returns what the query knows about the hulls of group number g. Valid until the next call.
  HullGuess& hullsOf(std::size_t g) {
    if (groups[g].hulls == kNone) {
      groups[g].hulls = static_cast<std::uint32_t>(hulls.size());
      hulls.emplace_back();
    }
    return hulls[groups[g].hulls];
  }
  /// Reports whether the group consists of the pair of both roots, so that the trees of these
  /// bodies have not been walked yet.
  bool isNotWalkedYet(const Group& group) const {
    const NodePair4& pair = nodePairs[group.begin];
    return group.end - group.begin == 1 && pair.a == 0 && pair.b == 0 &&
           pair.pairs == kWholeTrees[0].pairs;
  }
};

}  // namespace corridor
