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
#include "collision/convex/seidel-inl.h"
#include "collision/core/rounding.h"
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
  const Vec3& at(std::uint32_t v) const { return of.polytope().vertices()[v]; }
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
template <class Answer, class Evaluate>
Answer descendBoth(const Side& a, const Side& b, const Evaluate& evaluate) {
  const auto withPart = [&](const ConvexPart& partA) {
    Answer best = evaluate(partA, b.simplex());
    descend(b, -1, best, [&](const ConvexPart& partB) { return evaluate(partA, partB); });
    return best;
  };
  Answer best = withPart(a.simplex());
  descend(a, 1, best, withPart);
  return best;
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
    // Variables u, w, h1, h2: n·a ≤ h1 for all points a, −n·b ≤ h2 for all points b.
    for (const auto& [points, sign] : {std::pair(&a, 1.0), std::pair(&b, -1.0)})
      for (const Vec3& point : *points) {
        const Vec3 p = sign * (point - origin);
        size = std::max(size, p.cwiseAbs().maxCoeff());
        list_.push_back({{e1_.dot(p), e2_.dot(p), sign > 0 ? -1.0 : 0.0, sign > 0 ? 0.0 : -1.0},
                         -d_.dot(p),
                         static_cast<std::uint32_t>(list_.size())});
      }
    for (std::size_t i = list_.size(); i > 1; --i) {  // Seidel's order must be random
      random_ = random_ * 6364136223846793005U + 1442695040888963407U;
      std::swap(list_[i - 1], list_[(random_ >> 33) % i]);
    }
    constexpr double kSteepest = 0x1p20;
    const double most = 8 * kSteepest * (size + 0x1p-900);
    const Bounds<double, 4> bounds{{kSteepest, kSteepest, most, most}, {100, 101, 102, 103}};
    Point<double, 4> x{};
    Tight<4> tight;
    solve<double, 4>(bounds, std::span<const HalfSpace<double, 4>>(list_), {0, 0, -1, -1}, x, tight,
                     memory_);
    PartsDepth result;
    result.normal = d_ + x[0] * e1_ + x[1] * e2_;
    result.heightA = -HUGE_VAL, result.heightB = HUGE_VAL;
    for (const Vec3& p : a) result.heightA = std::max(result.heightA, result.normal.dot(p));
    for (const Vec3& p : b) result.heightB = std::min(result.heightB, result.normal.dot(p));
    result.depth = result.heightA - result.heightB;
    return result;
  }

 private:
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
  if (!(overlap > error)) return result;  // apart, or touching up to rounding
  result.found = best.depth;
  result.normal_W = n;
  // The product rounds by 3u of the sum of its terms, which is at most 2.
  result.upper = roundedUp((overlap + error) / (rate - 8 * kUnit));
  return result;
}

}  // namespace corridor
