#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "collision/core/posed.h"
#include "collision/core/query_context.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/triangle_pair.h"

namespace corridor {

/// What interference queries of two trees keep while one body moves in small steps: the front of
/// the last traversal, which is the set of node pairs at which it stopped (generalised front
/// tracking: Ehmann, Lin, "Accurate and fast proximity queries between polyhedra using convex
/// surface decomposition", 2001). Every pair keeps its gap, a proved lower bound of the distance.
/// The pair is not tested again until the body may have moved by as much as the gap.
///
/// The caller owns the front. A front belongs to two trees: call `clear` before the front is used
/// with other trees, and after one of its trees was refitted. Copies are independent.
class Front {
 public:
  void clear() { *this = {}; }
  /// The number of node pairs.
  std::size_t size() const { return pairs_.size(); }

 private:
  /// Two nodes, and the value of `moved_` at which their gap may be used up.
  struct Pair {
    std::uint32_t a, b;
    double until;
    friend bool operator<(const Pair& x, const Pair& y) { return x.until > y.until; }
  };
  template <BoundingVolume Volume>
  friend class FrontQuery;

  std::vector<Pair> pairs_;         ///< a heap: its first element is the pair that is due first
  std::optional<Transform> X_AB_;   ///< the map of the last query; empty if there was no query
  double moved_ = 0;                ///< metres: sum of the bounds of all motions; rounded up
  std::size_t sizeAfterStart_ = 0;  ///< number of pairs after the last start from the roots
};

/// Returns a pair of triangles that touch, or nullopt, as `interference` (interference.h): the
/// verdict is exact for the map with precisely the stored numbers, for any finite map. Which
/// touching pair is reported may differ. If b moves by small steps, most pairs of the front are not
/// tested. If b moves far, the query costs somewhat more than `interference`.
///
/// Each motion is bounded by |Δt| + ‖ΔM‖_F·reach, where `reach` is that of b's tree. The bounds of
/// all motions are added up. So the length of b's path uses up the gaps, even if b comes back.
/// @param b  the tree that moves, under the map from its frame to a's.
/// @pre Both are trees of triangles. The map is finite. Instantiated for `Obb` and `Rss`.
template <BoundingVolume Volume>
std::optional<PrimitivePair> interference(const VolumeTree<Volume>& a,
                                          const Posed<VolumeTree<Volume>>& b, Front& front,
                                          QueryContext& context);

}  // namespace corridor
