#pragma once

#include "collision/volumes/overlap_obb_obb.h"

/// Box against box by what the separating-axis theorem replaced (Gottschalk, Lin, Manocha 1996,
/// section 5): for comparison. Each is as conservative as `obbsSeparated`: `true` is a proof that
/// the boxes, as sets in real arithmetic, are apart by more than the margin asked for; `false` says
/// nothing. Told are, as far as tests of millions of pairs show, all that are farther apart than
/// 4·(margins.absolute + pad) + 32·margins.relative·(their sizes and distance); √3 of it is that a
/// is grown along its axes.
namespace corridor {

/// Closest features: the algorithm of Gilbert, Johnson, Keerthi (1988) looks for a direction along
/// which the projections are apart, and stops at the first.
struct Gjk {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB,
                        const BoxPairMargins& margins, double pad);
};

/// Linear programming: is there a point in all of the twelve half-spaces of the two boxes? Seidel's
/// incremental algorithm (1991) in three variables.
struct LinearProgram {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB,
                        const BoxPairMargins& margins, double pad);
};

/// Each edge of one box against each face of the other, 144 tests, and either centre in the other.
struct EdgeFace {
  static bool separated(const Obb& a, const Obb& b, const Transform& X_AB,
                        const BoxPairMargins& margins, double pad);
};

/// `PairTest<Obb>` with one of these.
template <class Overlap>
class PairTest<Obb, Overlap> : public PairTest<Obb> {
 public:
  using PairTest<Obb>::PairTest;
  bool separated(const Obb& a, const Obb& b, double pad) const {
    return Overlap::separated(a, b, X_AB_, margins_, pad);
  }
};

}  // namespace corridor
