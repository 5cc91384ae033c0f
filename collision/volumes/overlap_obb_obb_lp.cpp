#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include "collision/convex/seidel-inl.h"
#include "collision/volumes/overlap_obb_obb_direction.h"
#include "collision/volumes/overlap_obb_obb_variants.h"

namespace corridor {
/// The linear program: the variables are bounded by the six half-spaces of box a, and the other
/// half-spaces are those of box b. The `name` of a half-space is the index of its axis: 0 to 2 for
/// box a, 3 to 5 for box b.
///
/// If the boxes share no point, then by Helly's theorem four of the half-spaces have no common
/// point. By Farkas' lemma their normals have weights ≥ 0 that sum up to zero, while the weighted
/// offsets sum up to less than zero. The weighted sum of one box's normals is then a direction
/// along which the boxes are apart. If only one of the four normals belongs to box a, or only one
/// to box b, the direction is that normal. If two normals belong to each box, e_i, e_j and R_k,
/// R_l, the direction is in the plane of e_i and e_j and in that of R_k and R_l: it is (e_i × e_j)
/// × (R_k × R_l). So the direction is one of the 15 axes, and is proved in the same way.
///
/// The linear program is that of box a grown by `margin` + `slack`, and of box b grown by `slack`.
/// The two `slack` are for the rounding of the proof. The algorithm's own rounding needs no bound.
/// For some in 10,000 pairs with edges that are parallel up to rounding, the algorithm finds a
/// wrong axis; then all 15 axes are tested.
bool LinearProgram::separated(const Obb& boxA, const Obb& boxB, const Transform& X_AB,
                              const BoxPairMargins& margins, double pad) {
  const internal::DirectedBoxes pair(boxA, boxB, X_AB, margins, pad);
  const Mat3& R = pair.R;
  seidel::Bounds<double, 3> bounds;
  std::array<seidel::HalfSpace<double, 3>, 6> faces;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = R.col(static_cast<Eigen::Index>(i));
    const double grown = pair.margin + pair.slack, along = axis.dot(pair.T);
    bounds.reach[i] = pair.a[static_cast<Eigen::Index>(i)] + grown;
    bounds.name[i] = static_cast<std::uint32_t>(i);
    // Seidel's algorithm adds half-spaces in random order, which pays only if there are many
    // half-spaces. Here the half-spaces that face box a come first, because they are the most
    // likely to exclude all points of box a.
    const double half = pair.b[static_cast<Eigen::Index>(i)] + pair.slack, toA = along > 0 ? -1 : 1;
    for (const std::size_t far : {std::size_t{0}, std::size_t{3}}) {
      const double s = far ? -toA : toA;
      faces[i + far] = {{s * axis[0], s * axis[1], s * axis[2]},
                        half + s * along,
                        static_cast<std::uint32_t>(3 + i)};
    }
  }
  seidel::Point<double, 3> x;
  seidel::Tight<3> conflict;
  seidel::StackMemory<double, 2, 6> memory;
  if (seidel::solve<double, 3>(bounds, std::span<const seidel::HalfSpace<double, 3>>(faces),
                               {pair.T[0], pair.T[1], pair.T[2]}, x, conflict, memory))
    return false;
  unsigned axes = 0;
  for (std::size_t i = 0; i < conflict.count; ++i) axes |= 1U << conflict.name[i];
  const unsigned ofA = axes & 7, ofB = axes >> 3;
  const auto one = [](unsigned bits) { return std::has_single_bit(bits); };
  const auto first = [](unsigned bits) { return std::countr_zero(bits); };
  const bool apart =
      one(ofA)   ? pair.apartAlong(Vec3::Unit(first(ofA)))
      : one(ofB) ? pair.apartAlong(R.col(first(ofB)))
      : one(7 & ~ofA) && one(7 & ~ofB)
          ? pair.apartAlong(Vec3::Unit(first(7 & ~ofA)).cross(R.col(first(7 & ~ofB))))
          : false;
  return apart || pair.apartAlongAny();
}

}  // namespace corridor
