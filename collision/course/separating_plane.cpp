#include "collision/course/separating_plane.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "collision/core/rounding.h"
#include "collision/course/exact_program-inl.h"

/// The variables are (n, c, s): a plane n·x = c with a gap of s on each side, where |n_i|, |c|, s ≤
/// 1. The rows are n·p − c + s ≤ 0 for the first set, and −n·q + c + s ≤ 0 for the second. The
/// hulls are disjoint if and only if the largest s is above 0. Otherwise duality gives weights of
/// the points. The weights of each set sum up to 1/2, and the weighted means of both sets are the
/// same point.
///
/// Touching hulls have a plane (n ≠ 0) with s = 0; overlapping hulls have none. Let R be D + 1
/// linearly independent rows (p, −1) and (−q, 1). On the cone of all (n, c) that satisfy all rows,
/// the sum of the rows in R is at most 0. It is 0 only where all rows of R are 0, which is at the
/// origin only. So a plane exists if and only if the least sum of R over the cone is below 0. If
/// there are no D + 1 independent rows, all points are on one plane, which counts as having one
/// hull on each side.
namespace corridor {
namespace {

using seidel::Point;
using seidel::Rational;
using seidel::Row;

template <int D>
class Hulls {
 public:
  static constexpr std::size_t kD = D, kPlane = D + 1, kGap = D + 2;

  Hulls(std::span<const Eigen::Vector<double, D>> first,
        std::span<const Eigen::Vector<double, D>> second, std::uint64_t seed)
      : first_(first), second_(second), count_(first.size() + second.size()), seed_(seed) {
    if (first.empty() || second.empty())
      throw std::invalid_argument("each set of points must have a point");
    for (std::size_t i = 0; i < count_; ++i)
      if (!at(i).allFinite()) throw std::invalid_argument("the coordinates must be finite");
  }

  SeparatingPlane<D> solve() {
    Point<double, kGap> wide{};
    wide[kD + 1] = 1;
    const auto rows = [this](std::uint32_t i) { return gapRow(i); };
    const auto found = seidel::candidate<kGap>(count_, rows, wide, 1, seed_);
    if (provedApart(found.x) || provedOverlap(found.tight)) return answer_;
    answer_.exact = true;
    Point<Rational, kGap> exactWide{};
    exactWide[kD + 1] = 1;
    const auto best = seidel::exactOptimum<kGap>(count_, rows, exactWide, 1, found.tight);
    if (best.value > 0) {
      answer_.relation = HullRelation::disjoint;
      takePlane(best.x);
      for (const auto& [i, weight] : best.weights) name(i);
      return answer_;
    }
    takePoint(best.weights);
    answer_.relation = findTouchingPlane() ? HullRelation::touching : HullRelation::overlapping;
    return answer_;
  }

 private:
  bool isFirst(std::size_t i) const { return i < first_.size(); }
  const Eigen::Vector<double, D>& at(std::size_t i) const {
    return isFirst(i) ? first_[i] : second_[i - first_.size()];
  }
  void name(std::size_t i) {
    if (isFirst(i))
      answer_.first.push_back(i);
    else
      answer_.second.push_back(i - first_.size());
  }

  Row<kPlane> planeRow(std::uint32_t i) const {
    Row<kPlane> row{{}, 0, i};
    // The coordinates are negated, not multiplied by −1, because a product would flush subnormal
    // numbers.
    for (std::size_t k = 0; k < kD; ++k) row.normal[k] = isFirst(i) ? at(i)[k] : -at(i)[k];
    row.normal[kD] = isFirst(i) ? -1 : 1;
    return row;
  }
  Row<kGap> gapRow(std::uint32_t i) const {
    const Row<kPlane> plane = planeRow(i);
    Row<kGap> row{{}, 0, i};
    std::copy(plane.normal.begin(), plane.normal.end(), row.normal.begin());
    row.normal[kD + 1] = 1;
    return row;
  }

  /// Proves by the two extreme points along the candidate's normal that the hulls are disjoint.
  bool provedApart(const Point<double, kGap>& found) {
    Eigen::Vector<double, D> n;
    for (std::size_t k = 0; k < kD; ++k) n[k] = found[k];
    double below = -HUGE_VAL, above = HUGE_VAL, size = 0, largest = 0;
    std::size_t p = 0, q = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double along = n.dot(at(i));
      size = std::max(size, n.cwiseAbs().dot(at(i).cwiseAbs()));
      largest = std::max(largest, at(i).cwiseAbs().maxCoeff());
      if (isFirst(i) && along > below) below = along, p = i;
      if (!isFirst(i) && along < above) above = along, q = i;
    }
    // Each projection has D roundings of products and D − 1 of sums, together at most D·u of the
    // sum of magnitudes. The computed `size` has as many roundings. Underflow adds at most 2^-1022
    // times the larger of 1 and the largest factor, for each operation; |n_i| ≤ 1.
    const double error = 2 * 4 * kUnit * size + 0x1p-1016 * std::max(1.0, largest);
    if (!(above - below > 2 * error)) return false;  // also if a number is not finite
    answer_.relation = HullRelation::disjoint;
    answer_.normal = n;
    answer_.offset = below + (above - below) / 2;
    name(p);
    name(q);
    return true;
  }

  /// Proves by the signs of the weights that the hulls of the tight points overlap. If the D + 2
  /// points x_j are in general position, Σ w_j x_j = 0 with Σ w_j = 0 has one solution w up to a
  /// factor. The rows of `gapRow` contain the signs of the two sets, so all D + 2 weights of these
  /// rows must be above 0 (Radon's partition).
  bool provedOverlap(const seidel::Tight<kGap>& tight) {
    std::array<Point<double, kGap>, kGap> normals;
    if (tight.count != kGap) return false;
    for (std::size_t i = 0; i < kGap; ++i) {
      if (tight.name[i] >= count_) return false;
      normals[i] = gapRow(tight.name[i]).normal;
    }
    Point<double, kGap> wide{};
    wide[kD + 1] = 1;
    const auto weights = seidel::provedWeights<kGap>(normals, wide);
    if (!weights) return false;
    answer_.relation = HullRelation::overlapping;
    double sum = 0;
    for (std::size_t i = 0; i < kGap; ++i) {
      name(tight.name[i]);
      if (!isFirst(tight.name[i])) continue;
      answer_.point += (*weights)[i] * at(tight.name[i]);
      sum += (*weights)[i];
    }
    answer_.point /= sum;
    return true;
  }

  /// Stores the plane (n, c) of a rational solution in the answer, scaled so that the largest |n_i|
  /// is 1.
  template <std::size_t M>
  void takePlane(const Point<Rational, M>& x) {
    Rational largest = 0;
    for (std::size_t k = 0; k < kD; ++k) largest = std::max<Rational>(largest, abs(x[k]));
    for (std::size_t k = 0; k < kD; ++k)
      answer_.normal[k] = static_cast<double>(Rational(x[k] / largest));
    answer_.offset = static_cast<double>(Rational(x[kD] / largest));
  }

  /// Stores the common point that these weights prove, and the points that have weights, in the
  /// answer.
  void takePoint(const std::vector<std::pair<std::uint32_t, Rational>>& weights) {
    Point<Rational, kD> point{};
    Rational sum = 0;
    for (const auto& [i, weight] : weights) {
      name(i);
      if (!isFirst(i)) continue;
      sum += weight;
      for (std::size_t k = 0; k < kD; ++k) point[k] += weight * seidel::rational(at(i)[k]);
    }
    for (std::size_t k = 0; k < kD; ++k)
      answer_.point[k] = static_cast<double>(Rational(point[k] / sum));
  }

  /// If there is a plane with the first hull on one side and the second hull on the other, stores
  /// this plane in the answer and returns true.
  /// @pre the hulls share a point.
  bool findTouchingPlane() {
    // Takes the first D + 1 independent rows. The objective is minus their sum.
    seidel::Echelon<kPlane> independent;
    Point<Rational, kPlane> goal{};
    for (std::uint32_t i = 0; i < count_ && independent.rank() < kPlane; ++i) {
      Point<Rational, kPlane> row;
      const Row<kPlane> rounded = planeRow(i);
      for (std::size_t k = 0; k < kPlane; ++k) row[k] = seidel::rational(rounded.normal[k]);
      if (!independent.add(row)) continue;
      for (std::size_t k = 0; k < kPlane; ++k) goal[k] -= row[k];
    }
    if (independent.rank() < kPlane) {
      takePlane(independent.kernel());
      return true;
    }
    const auto best = seidel::exactOptimum<kPlane>(
        count_, [this](std::uint32_t i) { return planeRow(i); }, goal, 1, {});
    if (!(best.value > 0)) return false;
    takePlane(best.x);
    return true;
  }

  std::span<const Eigen::Vector<double, D>> first_, second_;
  std::size_t count_;
  std::uint64_t seed_;
  SeparatingPlane<D> answer_;
};

}  // namespace

template <int D>
SeparatingPlane<D> separatingPlane(std::span<const Eigen::Vector<double, D>> first,
                                   std::span<const Eigen::Vector<double, D>> second,
                                   std::uint64_t seed) {
  return Hulls<D>(first, second, seed).solve();
}

template SeparatingPlane<2> separatingPlane(std::span<const Eigen::Vector2d>,
                                            std::span<const Eigen::Vector2d>, std::uint64_t);
template SeparatingPlane<3> separatingPlane(std::span<const Vec3>, std::span<const Vec3>,
                                            std::uint64_t);

}  // namespace corridor
