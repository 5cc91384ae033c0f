#pragma once

#include "collision/volumes/overlap_obb_obb.h"

/// For comparison: older overlap tests of boxes, which the separating-axis theorem replaced
/// (Gottschalk, Lin, Manocha 1996, section 5). Each is as conservative as `obbsSeparated`: the
/// result `true` is a proof that the boxes, as sets in real arithmetic, are apart by more than the
/// requested margin. The result `false` proves nothing.
///
/// In tests of millions of pairs, every test reported "separated" for all pairs that are farther
/// apart than 4·(margins.absolute + pad) + 32·margins.relative·L, where L is the sum of all half
/// extents and of the distances of both centres from the origin. The tests enlarge box a along
/// its axes, so its corners move by up to √3 times the margin; the factors include this √3.
namespace corridor {

/// Closest features: the algorithm of Gilbert, Johnson, Keerthi (1988) searches for a direction
/// along which the projections are apart, and stops at the first such direction.
struct Gjk {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB,
                        const BoxPairMargins& margins, double pad);
};

/// Linear programming: searches for a point in all twelve half-spaces of the two boxes, by the
/// incremental algorithm of Seidel (1991) in three variables.
struct LinearProgram {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB,
                        const BoxPairMargins& margins, double pad);
};

/// Edges and faces: tests each edge of one box against each face of the other, in 144 tests, and
/// whether the centre of each box is inside the other box.
struct EdgeFace {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB,
                        const BoxPairMargins& margins, double pad);
};

/// `PairTest<Obb>` with one of these tests as `separated`.
template <class Overlap>
class PairTest<Obb, Overlap> : public PairTest<Obb> {
 public:
  using PairTest<Obb>::PairTest;
  bool separated(const Obb& a, const Obb& b, double pad) const {
    return Overlap::separated(a, b, X_AB_, margins_, pad);
  }
};

}  // namespace corridor
