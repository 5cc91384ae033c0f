#include "collision/course/hierarchy_descent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "collision/convex/convex_set.h"
#include "collision/core/rounding.h"
#include "collision/course/exact_program-inl.h"
#include "collision/course/polytope_shadow.h"

namespace corridor {
namespace {

/// Finds the farthest vertices of the polytopes of a hierarchy along one direction after another.
class FarthestVertex {
 public:
  FarthestVertex(const DobkinKirkpatrick& of, const Transform& X) : of_(of), X_(X) {}

  void aim(const Vec3& direction_W) {
    const Vec3 local = X_.m.transpose() * direction_W;
    const double largest = local.cwiseAbs().maxCoeff();
    shadow_.reset();
    if (largest > 0x1p-1000 && largest < HUGE_VAL) shadow_.emplace(of_, Vec3(local / largest));
  }
  /// Returns the farthest vertex of P_level, if it is not a vertex of P_{level+1}. Levels must not
  /// increase between two calls of `aim`.
  std::optional<std::uint32_t> newAt(std::size_t level) {
    if (!shadow_) return std::nullopt;
    while (shadow_->level() > level) shadow_->refine();
    const std::uint32_t v = shadow_->top();
    return of_.lastLevel(v) == level ? std::optional(v) : std::nullopt;
  }

 private:
  const DobkinKirkpatrick& of_;
  const Transform& X_;
  std::optional<PolytopeShadow> shadow_;
};

/// A polytope under its map, in one of the two descents.
struct Side {
  const DobkinKirkpatrick& of;
  const Transform& X;

  ConvexPart simplex() const {
    ConvexPart part;
    for (const std::uint32_t v : of.simplex()) part.points.push_back(at(v));
    return part;
  }
  /// The pyramid of a removed vertex: its apex and its neighbours.
  ConvexPart pyramid(std::uint32_t apex) const {
    ConvexPart part;
    part.points.push_back(at(apex));
    for (const std::uint32_t v : of.ringOf(apex)) part.points.push_back(at(v));
    return part;
  }
  ConvexPart whole() const {
    ConvexPart part;
    const auto& points = of.polytope().vertices();
    part.points.assign(points.begin(), points.end());
    return part;
  }
  const Vec3& at(std::uint32_t v) const { return of.polytope().vertices()[v]; }
  /// Returns how far the polytope reaches along a normal; NaN if the numbers overflow.
  double highest(const Vec3& n) const {
    const Vec3 local = (X.m.transpose() * n).stableNormalized();
    return local.allFinite() ? n.dot(X * at(of.extreme(local))) : NAN;
  }
};

/// Descends in the hierarchy of one side: improves `best` by the pyramids beyond the plane of the
/// best answer. `sign` is 1 if the plane's normal leads out of this side, else −1.
/// @param evaluate returns the answer for a pyramid of this side.
template <class Answer, class Evaluate>
void descend(const Side& side, double sign, Answer& best, const Evaluate& evaluate) {
  FarthestVertex farthest(side.of, side.X);
  farthest.aim(sign * best.normal);
  for (std::size_t level = side.of.levels() - 1; level-- > 0 && !best.isFinal();) {
    const auto apex = farthest.newAt(level);
    if (!apex) continue;
    const double height = sign * best.normal.dot(side.X * side.at(*apex));
    if (!(height > sign * (sign > 0 ? best.heightA : best.heightB))) continue;
    const Answer answer = evaluate(side.pyramid(*apex));
    if (!answer.isBetterThan(best)) continue;
    best = answer;
    farthest.aim(sign * best.normal);
  }
}

/// Returns the best answer over both hierarchies. @param evaluate returns the answer for a part of
/// a and a part of b.
///
/// The plane of the best answer must support both polytopes. If it does not, a pyramid is lost.
/// That happens if rounding hides its apex (a normal is often that of a face, so that three
/// vertices are farthest), or if the best plane of the parts is not unique and that of the last
/// answer is another one than that of the whole. Then the answer for the whole polytopes is
/// computed. 2^-48 of the size is above the rounding of heights, a few units in the last place;
/// the proved bounds don't depend on it.
template <class Answer, class Evaluate>
Answer descendBoth(const Side& a, const Side& b, const Evaluate& evaluate) {
  const auto withPart = [&](const ConvexPart& partA) {
    Answer best = evaluate(partA, b.simplex());
    descend(b, -1, best, [&](const ConvexPart& partB) { return evaluate(partA, partB); });
    return best;
  };
  Answer best = withPart(a.simplex());
  descend(a, 1, best, withPart);
  if (best.isFinal()) return best;
  const double slack =
      0x1p-48 * best.normal.norm() *
      (PosedSet(a.of, a.X).reach() + a.X.t.norm() + PosedSet(b.of, b.X).reach() + b.X.t.norm());
  if (a.highest(best.normal) <= best.heightA + slack &&
      -b.highest(-best.normal) >= best.heightB - slack)
    return best;
  return evaluate(a.whole(), b.whole());
}

/// An answer for a part of a and a part of b: the plane that proves it is at `heightA` along the
/// normal for a, at `heightB` for b.
struct PartsDistance {
  ConvexDistance distance;
  Vec3 normal = Vec3::Zero();
  double heightA = 0, heightB = 0;

  bool isFinal() const { return distance.distance == 0; }
  bool isBetterThan(const PartsDistance& other) const {
    return distance.distance < other.distance.distance;
  }
};
struct PartsDepth {
  double depth = 0;  ///< of the line along the direction in A − B; below 0 far beside it
  Vec3 normal = Vec3::Zero();
  double heightA = 0, heightB = 0;

  bool isFinal() const { return false; }
  bool isBetterThan(const PartsDepth& other) const { return depth > other.depth; }
};

/// Computes the least max n·a − min n·b over all normals n = d + u·e1 + w·e2 with |u|, |w| ≤ 2^20,
/// where d, e1 and e2 are orthonormal. It is the largest s for which the parts share a point after
/// b has moved by s along d. If the line along d misses A − B, the bound 2^20 gives a value that
/// falls with the distance of the line, so that better parts still have larger values.
class DepthOfParts {
 public:
  explicit DepthOfParts(const Vec3& d) : d_(d), e1_(d.unitOrthogonal()), e2_(d.cross(e1_)) {}

  PartsDepth operator()(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    using namespace seidel;
    list_.clear();
    const Vec3 origin = a.front();
    double size = 0;
    for (const auto* points : {&a, &b})
      for (const Vec3& point : *points)
        size = std::max(size, (point - origin).cwiseAbs().maxCoeff());
    // Scaled, so that all rows of the program have coefficients of one size.
    const double scale = size > 0 && size < HUGE_VAL ? 1 / powerOfTwo(size) : 1;
    // Variables u, w, h1, h2: n·a ≤ h1 for all points a, −n·b ≤ h2 for all points b.
    for (const auto& [points, sign] : {std::pair(&a, 1.0), std::pair(&b, -1.0)})
      for (const Vec3& point : *points) {
        const Vec3 p = sign * scale * (point - origin);
        list_.push_back({{e1_.dot(p), e2_.dot(p), sign > 0 ? -1.0 : 0.0, sign > 0 ? 0.0 : -1.0},
                         -d_.dot(p),
                         0});
      }
    constexpr double kSteepest = 0x1p20;
    for (const double sign : {1.0, -1.0})
      for (std::size_t k = 0; k < 2; ++k) {
        list_.push_back({{}, kSteepest, 0});
        list_.back().normal[k] = sign;
      }
    for (std::size_t i = list_.size(); i > 1; --i) {  // Seidel's order must be random
      random_ = random_ * 6364136223846793005U + 1442695040888963407U;
      std::swap(list_[i - 1], list_[(random_ >> 33) % i]);
    }
    const auto count = static_cast<std::uint32_t>(list_.size());
    for (std::uint32_t i = 0; i < count; ++i) list_[i].name = i;
    const double most = 32 * kSteepest;  // the coordinates of p are at most 2
    const Bounds<double, 4> bounds{{most, most, most, most},
                                   {count, count + 1, count + 2, count + 3}};
    const Point<double, 4> goal{0, 0, -1, -1};
    Point<double, 4> x{};
    Tight<4> tight;
    if (!solve<double, 4>(bounds, std::span<const HalfSpace<double, 4>>(list_), goal, x, tight,
                          memory_) ||
        !isOptimal(tight, goal, 1 + std::abs(x[0]) + std::abs(x[1]))) {
      const auto row = [this](std::uint32_t i) { return list_[i]; };
      const Point<Rational, 4> exactGoal{0, 0, -1, -1};
      const auto best = exactOptimum<4>(count, row, exactGoal, rational(most), Tight<4>{});
      for (std::size_t k = 0; k < 4; ++k) x[k] = static_cast<double>(best.x[k]);
    }
    PartsDepth result;
    result.normal = d_ + x[0] * e1_ + x[1] * e2_;
    result.heightA = -HUGE_VAL, result.heightB = HUGE_VAL;
    for (const Vec3& p : a) result.heightA = std::max(result.heightA, result.normal.dot(p));
    for (const Vec3& p : b) result.heightB = std::min(result.heightB, result.normal.dot(p));
    result.depth = result.heightA - result.heightB;
    return result;
  }

 private:
  /// Returns whether the goal is a sum of the normals of the tight rows with weights of at least 0:
  /// then no point is better. Rounding hides the best point if more than four planes meet in it.
  /// @param steep at least the length of n.
  bool isOptimal(const seidel::Tight<4>& tight, const seidel::Point<double, 4>& goal,
                 double steep) const {
    Eigen::Matrix4d normals;
    for (int i = 0; i < 4; ++i) {
      const std::uint32_t name = tight.name[static_cast<std::size_t>(i)];
      if (name >= list_.size()) return false;
      normals.col(i) = Eigen::Vector4d(list_[name].normal.data());
    }
    const Eigen::Vector4d weights = normals.fullPivLu().solve(Eigen::Vector4d(goal.data()));
    // A weight below 0 raises the depth by its size times how far the row may be from tight: for a
    // point, at most 8|n|; for a limit of the slopes, which is tight only if |n| ≥ 2^20, at most
    // 2^21. So each of the four raises the depth by less than 2^-37 of the size.
    return weights.minCoeff() > -0x1p-40 / steep;
  }

  Vec3 d_, e1_, e2_;
  std::vector<seidel::HalfSpace<double, 4>> list_;
  seidel::HeapMemory<double, 3> memory_;
  std::uint64_t random_ = 1;
};

std::vector<Vec3> inWorld(const ConvexPart& part, const Transform& X) {
  std::vector<Vec3> points;
  for (const Vec3& p : part.points) points.push_back(X * p);
  return points;
}

/// The sum of the farthest projections of a along n and of b against n, with the bound of its
/// error. @pre |n| is 1 up to 5u.
std::pair<double, double> overlapAlong(const PosedSet& a, const PosedSet& b, const Vec3& n) {
  const double heightA = a.highest(n), heightB = b.highest(-n);
  const double error =
      roundedUp(a.error() + b.error() + 2 * kUnit * (std::abs(heightA) + std::abs(heightB)));
  return {heightA + heightB, error};
}

}  // namespace

ConvexDistance distanceByDescent(const DobkinKirkpatrick& a, const Transform& X_WA,
                                 const DobkinKirkpatrick& b, const Transform& X_WB, int* pieces) {
  int count = 0;
  const auto evaluate = [&](const ConvexPart& partA, const ConvexPart& partB) {
    ++count;
    PartsDistance result;
    result.distance = convexDistance(PosedSet(partA, X_WA), PosedSet(partB, X_WB));
    result.normal = result.distance.normal_W;
    result.heightA = result.normal.dot(result.distance.p_WA);
    result.heightB = result.normal.dot(result.distance.p_WB);
    return result;
  };
  ConvexDistance best = descendBoth<PartsDistance>({a, X_WA}, {b, X_WB}, evaluate).distance;
  if (pieces) *pieces = count;
  best.lower = 0;
  if (best.distance > 0) {
    const auto [overlap, error] = overlapAlong(PosedSet(a, X_WA), PosedSet(b, X_WB), best.normal_W);
    // The rounded normal may be longer than 1 by 5u.
    best.lower = std::max(0.0, roundedDown(roundedDown(-overlap - error)));
  }
  return best;
}

DepthByDescent depthByDescent(const DobkinKirkpatrick& a, const Transform& X_WA,
                              const DobkinKirkpatrick& b, const Transform& X_WB,
                              const Vec3& direction, int* pieces) {
  const Vec3 d = direction.stableNormalized();
  if (!direction.allFinite() || !(d.squaredNorm() > 0.5))
    throw std::invalid_argument("depthByDescent: the direction is 0 or not finite");
  for (const Transform* X : {&X_WA, &X_WB})
    if (!X->m.allFinite() || !X->t.allFinite())
      throw std::invalid_argument("depthByDescent: a map is not finite");
  int count = 0;
  DepthOfParts depthOf(d);
  const auto evaluate = [&](const ConvexPart& partA, const ConvexPart& partB) {
    ++count;
    return depthOf(inWorld(partA, X_WA), inWorld(partB, X_WB));
  };
  const PartsDepth best = descendBoth<PartsDepth>({a, X_WA}, {b, X_WB}, evaluate);
  if (pieces) *pieces = count;
  DepthByDescent result;
  const Vec3 n = best.normal.stableNormalized();
  const double rate = n.dot(d);  // at least 2^-21
  const auto [overlap, error] = overlapAlong(PosedSet(a, X_WA), PosedSet(b, X_WB), n);
  if (overlap < -error && rate > 8 * kUnit)
    return result;  // the plane separates them, and b moves away from it
  result.found = best.depth;
  result.normal_W = n;
  // The product rounds by 3u of the sum of its terms' magnitudes, which is at most 1; d itself is
  // off by at most 4u.
  const double upper = roundedUp(roundedUp(overlap + error) / (rate - 8 * kUnit));
  result.upper = rate > 0x1p-22 && upper < HUGE_VAL ? std::max(upper, 0.0) : HUGE_VAL;
  return result;
}

}  // namespace corridor
