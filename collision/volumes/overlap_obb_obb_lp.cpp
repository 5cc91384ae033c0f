#include <array>
#include <bit>
#include <cstddef>

#include "collision/volumes/overlap_obb_obb_direction.h"
#include "collision/volumes/overlap_obb_obb_variants.h"

/// R. Seidel, Small-dimensional linear programming and convex hulls made easy, Discrete &
/// Computational Geometry 6 (1991). Half-spaces are added one by one. If the best point so far is
/// outside the new half-space, the next best point is on the plane of that half-space. That point
/// is found by the same algorithm with one variable less.
///
/// Here the variables are bounded: |x_i| ≤ reach_i. These bounds are the six half-spaces of box a,
/// and the first best point is a corner of box a.
namespace corridor {
namespace {

template <std::size_t D>
using Point = std::array<double, D>;

/// normal·x ≤ offset.
template <std::size_t D>
struct HalfSpace {
  Point<D> normal;
  double offset;
  int face;  ///< the box axis that is its normal: 0 to 2 for a, 3 to 5 for b
};

/// |x_i| ≤ reach_i.
template <std::size_t D>
struct Bounds {
  Point<D> reach;
  std::array<int, D> face;
};

/// The axes whose faces leave no common point, as bits.
struct Conflict {
  unsigned faces = 0;
  void add(int face) { faces |= 1U << face; }
};

template <std::size_t D>
double dot(const Point<D>& a, const Point<D>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < D; ++i) sum += a[i] * b[i];
  return sum;
}

/// Returns the array without its k-th entry.
template <class T, std::size_t D>
std::array<T, D - 1> without(const std::array<T, D>& all, std::size_t k) {
  std::array<T, D - 1> rest;
  for (std::size_t i = 0, to = 0; i < D; ++i)
    if (i != k) rest[to++] = all[i];
  return rest;
}

/// Sets x to the point within the bounds and half-spaces that is farthest along `goal`. Returns
/// false if there is no such point; then `conflict` gets the faces that prove this.
bool solve(const Bounds<1>& bounds, const HalfSpace<1>* list, std::size_t count,
           const Point<1>& goal, Point<1>& x, Conflict& conflict) {
  double low = -bounds.reach[0], high = bounds.reach[0];
  int lowFace = bounds.face[0], highFace = bounds.face[0];
  for (std::size_t i = 0; i < count; ++i) {
    const double n = list[i].normal[0], offset = list[i].offset;
    if (n > 0 && offset < high * n) high = offset / n, highFace = list[i].face;
    if (n < 0 && offset < low * n) low = offset / n, lowFace = list[i].face;
    if (n == 0 && offset < 0) {
      conflict.add(list[i].face);
      return false;
    }
  }
  if (low > high) {
    conflict.add(lowFace);
    conflict.add(highFace);
    return false;
  }
  x[0] = goal[0] > 0 ? high : low;
  return true;
}

template <std::size_t D>
bool solve(const Bounds<D>& bounds, const HalfSpace<D>* list, std::size_t count,
           const Point<D>& goal, Point<D>& x, Conflict& conflict) {
  for (std::size_t i = 0; i < D; ++i) x[i] = goal[i] > 0 ? bounds.reach[i] : -bounds.reach[i];
  for (std::size_t i = 0; i < count; ++i) {
    const HalfSpace<D>& plane = list[i];
    if (!(dot(plane.normal, x) > plane.offset)) continue;
    // On the plane, x_k = share − Σ slope_j x_j, where k is the index of the normal's largest
    // entry.
    std::size_t k = 0;
    for (std::size_t j = 1; j < D; ++j)
      if (std::abs(plane.normal[j]) > std::abs(plane.normal[k])) k = j;
    if (plane.normal[k] == 0) {
      conflict.add(plane.face);
      return false;
    }
    const double share = plane.offset / plane.normal[k];
    Point<D - 1> slope = without(plane.normal, k);
    for (double& s : slope) s /= plane.normal[k];
    std::array<HalfSpace<D - 1>, 8>
        // Six half-spaces in three variables become at most seven in two, and eight in one.
        rest;
    for (std::size_t j = 0; j < i; ++j) {
      const double n = list[j].normal[k];
      rest[j] = {without(list[j].normal, k), list[j].offset - n * share, list[j].face};
      for (std::size_t m = 0; m < D - 1; ++m) rest[j].normal[m] -= n * slope[m];
    }
    rest[i] = rest[i + 1] = {slope, bounds.reach[k] + share, bounds.face[k]};
    for (double& s : rest[i].normal) s = -s;
    rest[i].offset = bounds.reach[k] - share;
    rest[i + 1].offset = bounds.reach[k] + share;
    Point<D - 1> toward = without(goal, k), y;
    for (std::size_t m = 0; m < D - 1; ++m) toward[m] -= goal[k] * slope[m];
    const Bounds<D - 1> fewer{without(bounds.reach, k), without(bounds.face, k)};
    if (!solve(fewer, rest.data(), i + 2, toward, y, conflict)) {
      conflict.add(plane.face);
      return false;
    }
    for (std::size_t j = 0, from = 0; j < D; ++j)
      if (j != k) x[j] = y[from++];
    x[k] = share - dot(slope, y);
  }
  return true;
}

}  // namespace

/// If the boxes share no point, then by Helly's theorem four of the half-spaces have no common
/// point. By Farkas' lemma their normals have weights ≥ 0 that sum up to zero, while the weighted
/// offsets sum up to less than zero. The weighted sum of one box's normals is then a direction
/// along which the boxes are apart. If only one of the four normals belongs to box a, or only one
/// to box b, the direction is that normal. If two normals belong to each box, e_i, e_j and R_k,
/// R_l, the direction is in the span of both pairs: (e_i × e_j) × (R_k × R_l). So the direction is
/// one of the 15 axes, and is proved like them.
///
/// The linear program separates the boxes after box a has grown by `margin`, and both by another
/// `slack` for the rounding of the proof. The algorithm's own rounding needs no bound. If edges are
/// parallel up to rounding, it finds a wrong axis for some in 10,000 of such pairs; then all 15
/// axes are tried.
bool LinearProgram::separated(const Obb& boxA, const Obb& boxB, const Transform& X_AB,
                              const BoxPairMargins& margins, double pad) {
  const internal::DirectedBoxes pair(boxA, boxB, X_AB, margins, pad);
  const Mat3& R = pair.R;
  Bounds<3> bounds;
  std::array<HalfSpace<3>, 6> faces;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto axis = R.col(static_cast<Eigen::Index>(i));
    const double grown = pair.margin + pair.slack, along = axis.dot(pair.T);
    bounds.reach[i] = pair.a[static_cast<Eigen::Index>(i)] + grown;
    bounds.face[i] = static_cast<int>(i);
    // Seidel adds half-spaces in random order, which is worth while for large numbers of them. Here
    // the half-spaces that face box a come first, because these are the ones that may leave no
    // point.
    const double half = pair.b[static_cast<Eigen::Index>(i)] + pair.slack, toA = along > 0 ? -1 : 1;
    for (const std::size_t far : {std::size_t{0}, std::size_t{3}}) {
      const double s = far ? -toA : toA;
      faces[i + far] = {
          {s * axis[0], s * axis[1], s * axis[2]}, half + s * along, 3 + static_cast<int>(i)};
    }
  }
  Point<3> x;
  Conflict conflict;
  if (solve(bounds, faces.data(), faces.size(), {pair.T[0], pair.T[1], pair.T[2]}, x, conflict))
    return false;
  const unsigned ofA = conflict.faces & 7, ofB = conflict.faces >> 3;
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
