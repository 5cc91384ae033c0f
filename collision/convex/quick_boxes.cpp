#include "collision/convex/quick_boxes.h"

/// Derivation of the margins. u = 2^-53. The half edges of box a have the lengths a_k, those of b
/// the lengths b_k. R has the cosines of the angles between edges of a and edges of b. T has the
/// coordinates along a's edges of `between`, the vector from the centre of a to the centre of b. τ
/// is the largest cosine of two edges of one box. S = `size` of both sets; every length here is
/// below S, and |T| + Σ_k a_k + Σ_k b_k < 4S.
///
/// * Directions of edges have length 1 up to 8u, if the squares of lengths are far above underflow,
///   which `Edges::usable` tests. (With flush-to-zero a square may lose all components below
///   2^-1022.)
/// * Exact boxes A' and B' exist whose edge directions differ from the computed ones by 3τ + 8u. So
///   all entries of R, and of T/S, are off by less than 3τ_A + 3τ_B + 30u.
/// * If an edge of A' and one of B' are parallel up to 2^-46, B' is turned until they are parallel.
///   At most three pairs of edges are parallel, and the turns add up to less than 2^-44. The cross
///   product of parallel edges is no axis, and is skipped.
/// * A gap is a sum of products of T, a and b with at most two entries of R. So these changes and
///   the rounding of the gap alter the gap by less than (12τ_A + 12τ_B + 2^-43)·4S.
/// * If all gaps are below −δ after these changes, the origin is deeper than δ in the Minkowski
///   difference of A' and B', because no axis is longer than 1. The sets differ from A' and B' by
///   at most `boxError` + (3τ + 8u + 2^-44)·2S each.
///
/// The sum of all these errors is below (54τ_A + 54τ_B + 2^-40)·S + the errors of both boxes, and
/// so below `margin`.
namespace corridor {
namespace {

/// The unit directions of the edges of a box in the world, half the lengths of the edges, and τ
/// (`tilt`).
struct Edges {
  explicit Edges(const QuickSet& set) {
    for (std::size_t k = 0; k < 3; ++k) {
      unit[k] = set.M * set.edge[k];
      const double square = unit[k].squaredNorm(), length = std::sqrt(square);
      usable = usable && square > 0x1p-900;  // NaN makes `usable` false
      half[k] = 0.5 * length;
      unit[k] *= 1 / length;
    }
    tilt = std::max({std::abs(unit[0].dot(unit[1])), std::abs(unit[1].dot(unit[2])),
                     std::abs(unit[2].dot(unit[0]))});
  }
  std::array<Vec3, 3> unit;
  double half[3], tilt;
  bool usable = true;
};

/// Returns whether the vector n between the centres of the boxes proves that they are apart: the
/// gap along n/|n| must exceed `slack`.
bool centresApart(const QuickSet& a, const QuickSet& b, const Vec3& n, double slack) {
  const Vec3 m = a.local(n), k = b.local(n);
  const double square = n.squaredNorm();
  double along = square;
  for (std::size_t i = 0; i < 3; ++i)
    along -= 0.5 * (std::abs(m.dot(a.edge[i])) + std::abs(k.dot(b.edge[i])));
  return along > 0 && along * along > slack * slack * square;
}

}  // namespace

std::optional<bool> quickBoxes(const QuickSet& setA, const QuickSet& setB) {
  const double size = setA.size + setB.size, errors = 2 * (setA.boxError + setB.boxError);
  const Vec3 between = setB.image(setB.middle) - setA.image(setA.middle);
  if (centresApart(setA, setB, between, 0x1p-44 * size + errors)) return false;

  const Edges a(setA), b(setB);
  if (!a.usable || !b.usable) return std::nullopt;
  const double tilt = 64 * (a.tilt + b.tilt);
  const double clear = (0x1p-42 + tilt) * size + errors, margin = (0x1p-38 + tilt) * size + errors;
  bool deep = true;
  double R[3][3], absR[3][3], T[3];
  for (std::size_t i = 0; i < 3; ++i) {
    T[i] = a.unit[i].dot(between);
    for (std::size_t j = 0; j < 3; ++j) {
      R[i][j] = a.unit[i].dot(b.unit[j]);
      absR[i][j] = std::abs(R[i][j]);
    }
    const double gap = std::abs(T[i]) - a.half[i] - b.half[0] * absR[i][0] -
                       b.half[1] * absR[i][1] - b.half[2] * absR[i][2];
    if (gap > clear) return false;
    deep = deep && gap < -margin;
  }
  for (std::size_t j = 0; j < 3; ++j) {
    const double gap = std::abs(T[0] * R[0][j] + T[1] * R[1][j] + T[2] * R[2][j]) - b.half[j] -
                       a.half[0] * absR[0][j] - a.half[1] * absR[1][j] - a.half[2] * absR[2][j];
    if (gap > clear) return false;
    deep = deep && gap < -margin;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t k = (i + 1) % 3, l = (i + 2) % 3;
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t p = (j + 1) % 3, q = (j + 2) % 3;
      const double gap = std::abs(T[l] * R[k][j] - T[k] * R[l][j]) - a.half[k] * absR[l][j] -
                         a.half[l] * absR[k][j] - b.half[p] * absR[i][q] - b.half[q] * absR[i][p];
      if (gap > clear) return false;
      if (absR[k][j] + absR[l][j] > 0x1p-46) deep = deep && gap < -margin;
    }
  }
  return deep ? std::optional(true) : std::nullopt;
}

}  // namespace corridor
