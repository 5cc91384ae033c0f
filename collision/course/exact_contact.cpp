#include "collision/course/exact_contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_contact.h"
#include "collision/convex/polytope.h"
#include "collision/convex/rational-inl.h"
#include "collision/convex/seidel-inl.h"
#include "collision/core/rounding.h"

/// The linear program has the variables (n, s) with |n_i|, s ≤ 1. A corner of the Minkowski
/// difference, q − p with p in a and q in b, gives the row −n·(q − p) + s ≤ 0. The objective is to
/// maximise s. For any subset of the corners:
/// * If the largest s is 0, the weights of the tight rows make 0 a convex combination of the
///   subset. So the hulls share a point.
/// * Otherwise the corner that is lowest along n decides. If n·(q − p) > 0 at this corner, n
///   separates the hulls. If n·(q − p) ≤ 0, this corner is not in the subset, because n·(q − p) ≥ s
///   > 0 at the corners of the subset. So each round adds another corner, and the search ends.
namespace corridor {
namespace {

using seidel::Rational;
using seidel::rational;
using Direction = std::array<Rational, 3>;
using ExactRow = seidel::HalfSpace<Rational, 4>;

/// The points of a set under its map, in rationals.
class ExactPoints {
 public:
  explicit ExactPoints(const PosedSet& set) : set_(set.set()) {
    for (int i = 0; i < 3; ++i) {
      t_[i] = rational(set.pose().t[i]);
      for (int k = 0; k < 3; ++k) m_[i][k] = rational(set.pose().m(i, k));
    }
  }

  Direction operator[](std::uint32_t number) const {
    const Vec3& p = set_.points[number];
    Direction x = t_;
    for (int k = 0; k < 3; ++k) {
      const Rational at = rational(p[k]);
      for (int i = 0; i < 3; ++i) x[i] += m_[i][k] * at;
    }
    return x;
  }

  /// Returns the index of a point that is farthest along n, exactly.
  std::uint32_t farthest(const Direction& n, std::uint32_t start) const {
    Direction m{};  // Mᵀn
    Vec3 rough;
    for (int k = 0; k < 3; ++k) {
      for (int i = 0; i < 3; ++i) m[k] += m_[i][k] * n[i];
      rough[k] = static_cast<double>(m[k]);
    }
    std::uint32_t best = set_.farthest(rough, start);
    const auto takeHigher = [&](std::uint32_t other) {
      const bool higher = isHigher(m, rough, best, other);
      if (higher) best = other;
      return higher;
    };
    if (!set_.polytope) {
      for (std::uint32_t i = 0; i < set_.points.size(); ++i) takeHigher(i);
      return best;
    }
    for (bool again = true; again;) {
      const auto around = set_.polytope->neighbours(best);
      again = std::any_of(around.begin(), around.end(), takeHigher);
    }
    return best;
  }

 private:
  /// Reports whether m·(q − p) > 0 for p = point `from` and q = point `to`. Exact.
  ///
  /// In double, entries of `rough` are off by at most 2u of themselves, differences and products by
  /// 1u each, and two sums by 2u of all terms. 8u of the sum of magnitudes covers all of this.
  /// Underflow adds at most 2^-1022 times the larger of 1 and the largest factor, for each of these
  /// operations.
  bool isHigher(const Direction& m, const Vec3& rough, std::uint32_t from, std::uint32_t to) const {
    const Vec3 &p = set_.points[from], &q = set_.points[to], d = q - p;
    const double along = rough.dot(d), size = rough.cwiseAbs().dot(d.cwiseAbs());
    const double largest = std::max({1.0, rough.cwiseAbs().maxCoeff(), d.cwiseAbs().maxCoeff()});
    if (std::abs(along) > 8 * kUnit * size + 0x1p-1016 * largest) return along > 0;
    Rational sum = 0;
    for (int k = 0; k < 3; ++k) sum += m[k] * (rational(q[k]) - rational(p[k]));
    return sum > 0;
  }

  const ConvexSet& set_;
  std::array<Direction, 3> m_;
  Direction t_;
};

bool touchInRationals(const PosedSet& a, const PosedSet& b, const ConvexCache& found) {
  const ExactPoints pointsA(a), pointsB(b);
  std::vector<ExactRow> rows;
  const auto difference = [&](std::uint32_t pointA, std::uint32_t pointB) {
    Direction w = pointsB[pointB];
    const Direction p = pointsA[pointA];
    for (int i = 0; i < 3; ++i) w[i] -= p[i];
    return w;
  };
  const auto add = [&](const Direction& w) {
    rows.push_back({{-w[0], -w[1], -w[2], 1}, 0, static_cast<std::uint32_t>(rows.size())});
  };
  std::uint32_t pointA = 0, pointB = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(found.count); ++i) {
    const ConvexCache::Corner& c = found.corner[i];
    if (c.pointA >= a.set().points.size() || c.pointB >= b.set().points.size()) continue;
    pointA = c.pointA;
    pointB = c.pointB;
    add(difference(pointA, pointB));
  }
  seidel::Bounds<Rational, 4> bounds;
  bounds.reach.fill(1);
  bounds.name.fill(~std::uint32_t{0});
  const seidel::Point<Rational, 4> wide{0, 0, 0, 1};
  seidel::HeapMemory<Rational, 3> memory;
  for (;;) {
    seidel::Point<Rational, 4> x;
    seidel::Tight<4> tight;
    seidel::solve<Rational, 4>(bounds, std::span<const ExactRow>(rows), wide, x, tight, memory);
    if (!(x[3] > 0)) return true;
    const Direction n{x[0], x[1], x[2]}, back{-x[0], -x[1], -x[2]};
    pointA = pointsA.farthest(n, pointA);
    pointB = pointsB.farthest(back, pointB);
    const Direction w = difference(pointA, pointB);
    if (n[0] * w[0] + n[1] * w[1] + n[2] * w[2] > 0) return false;
    add(w);
  }
}

}  // namespace

bool convexHullsTouch(const PosedSet& a, const PosedSet& b, ConvexCache* cache) {
  ConvexCache own;
  ConvexCache* const kept = cache ? cache : &own;
  return convexSetsTouch(a, b, kept) && confirmContact(a, b, *kept);
}

bool confirmContact(const PosedSet& a, const PosedSet& b, const ConvexCache& found) {
  for (const PosedSet* each : {&a, &b}) {
    if (each->set().ball > 0 || each->set().disc > 0)
      throw std::invalid_argument("an exact contact query takes hulls of points only");
    if (!each->pose().m.allFinite() || !each->pose().t.allFinite())
      throw std::invalid_argument("an exact contact query takes finite maps only");
  }
  return provedCommonPoint(a, b, found) || touchInRationals(a, b, found);
}

/// The origin is within the tetrahedron of four corners w_i of the Minkowski difference, if the
/// weights λ_i of Σ λ_i w_i = 0 are above 0. λ_i has the sign of (−1)^i times the determinant of
/// the other three corners.
///
/// Rounding: a mapped point is a sum of three products and a translation, with four roundings on
/// its longest path. With entries below D that are off by at most e, a determinant is off by at
/// most (18e + 40uD)D², as in predicates/orientation.cpp.
std::optional<Vec3> provedCommonPoint(const PosedSet& a, const PosedSet& b,
                                      const ConvexCache& corners) {
  if (corners.count != 4) return std::nullopt;
  const auto error = [](const PosedSet& set, const Vec3& p) {
    const auto& [m, t] = set.pose();
    return 4.1 * kUnit *
           (m.cwiseAbs().rowwise().sum().maxCoeff() * p.cwiseAbs().maxCoeff() +
            t.cwiseAbs().maxCoeff());
  };
  std::array<Vec3, 4> w, inA;
  double e = 0, d = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const ConvexCache::Corner& c = corners.corner[i];
    if (c.pointA >= a.set().points.size() || c.pointB >= b.set().points.size()) return std::nullopt;
    const Vec3 &p = a.set().points[c.pointA], &q = b.set().points[c.pointB];
    inA[i] = a.pose() * p;
    w[i] = b.pose() * q - inA[i];
    d = std::max(d, w[i].cwiseAbs().maxCoeff());
    e = std::max(e, error(a, p) + error(b, q));
  }
  e = roundedUp(e + kUnit * d);
  const double D = d + e;
  if (!(D > 0x1p-250 && D < 0x1p250)) return std::nullopt;
  const double bound = roundedUp((18 * e + 40 * kUnit * D) * D * D);
  const std::array<double, 4> weight = {w[1].dot(w[2].cross(w[3])), w[0].dot(w[3].cross(w[2])),
                                        w[0].dot(w[1].cross(w[3])), w[0].dot(w[2].cross(w[1]))};
  const double sign = weight[0] > 0 ? 1 : -1;
  Vec3 point = Vec3::Zero(), left = Vec3::Zero();
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (!(sign * weight[i] > bound)) return std::nullopt;
    point += weight[i] * inA[i];
    left += weight[i] * w[i];
    sum += weight[i];
  }
  point /= sum;
  left /= sum;
  // The weighted mean `point` of the corners' points of a is in a, and `point` + `left` is in b.
  if (!(left.cwiseAbs().maxCoeff() <= 0x1p-47 * D)) return std::nullopt;
  return point + left / 2;
}

}  // namespace corridor
