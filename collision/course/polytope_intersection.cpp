#include "collision/course/polytope_intersection.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "collision/convex/convex_set.h"
#include "collision/core/rounding.h"
#include "collision/course/exact_contact.h"
#include "collision/course/matrix_game.h"
#include "collision/course/polytope_shadow.h"

namespace corridor {
namespace {

/// The plane n·x = c. The call operator returns n·x − c, which is above 0 beyond the plane.
struct Plane {
  Vec3 n = Vec3::Zero();
  double c = 0;
  double operator()(const Vec3& x) const { return n.dot(x) - c; }
};

/// The search. Its frame has the axes of Q's frame, and its origin is the center of Q
/// (`OuterHierarchy::center`).
class PolytopeSearch {
 public:
  PolytopeSearch(const DobkinKirkpatrick& p, const Transform& X_WP, const OuterHierarchy& q,
                 const Transform& X_WQ, std::vector<PolytopePruning>* trace)
      : p_(p),
        q_(q),
        X_WP_(X_WP),
        X_WQ_(X_WQ),
        trace_(trace),
        levelP_(p.levels() - 1),
        levelQ_(q.polar() ? q.polar()->levels() - 1 : 0) {}

  PolytopeIntersection run() {
    // Each step refines P or Q, so this number of steps is enough.
    const std::size_t most = q_.polar() ? levelP_ + levelQ_ + 2 : 0;
    if (!placeP()) return decidedByAll();
    for (std::size_t k = 0; k < most; ++k) {
      ++result_.steps;
      takeParts();
      game_.solve();
      const bool apart = findSeparation();
      const Step step = apart ? refineP() : refineQ();
      if (step == Step::stuck) break;
      if (step == Step::decided) {
        if (apart ? provedApart() : provedMeeting()) return result_;
        break;
      }
    }
    return decidedByAll();
  }

 private:
  enum class Step { refined, decided, stuck };

  /// Computes the map from P's frame to the frame of the search. Returns false if this map is not
  /// finite.
  bool placeP() {
    const Mat3 inverse = X_WQ_.m.inverse();
    X_QP_.m = inverse * X_WP_.m;
    X_QP_.t = inverse * (X_WP_.t - X_WQ_.t) - q_.center();
    return X_QP_.isFinite();
  }
  Vec3 pointP(std::uint32_t v) const { return X_QP_ * p_.polytope().vertices()[v]; }
  const Vec3& polarQ(std::uint32_t k) const { return q_.polar()->polytope().vertices()[k]; }

  /// Prepares T_P (`points_`) and T_Q (`planes_`), and the game whose entries say how far each
  /// point of T_P is outside each half-space of T_Q.
  void takeParts() {
    namesP_.clear();
    if (v_) {
      namesP_.push_back(*v_);
      for (const std::uint32_t w : p_.ringOf(*v_)) namesP_.push_back(w);
    } else {
      namesP_.assign(p_.simplex().begin(), p_.simplex().end());
    }
    points_.clear();
    for (const std::uint32_t v : namesP_) points_.push_back(pointP(v));
    if (half_) points_.push_back(x_);
    planes_.clear();
    const auto take = [&](std::uint32_t k) {
      const double size = polarQ(k).norm();
      planes_.push_back({polarQ(k) / size, 1 / size});
    };
    if (half_) {
      take(*half_);
      for (const std::uint32_t k : q_.polar()->ringOf(*half_)) take(k);
    } else {
      for (const std::uint32_t k : q_.polar()->simplex()) take(k);
    }
    if (v_) planes_.push_back({-h_.n, -h_.c});
    game_.rows = planes_.size();
    game_.columns = points_.size();
    for (std::size_t i = 0; i < planes_.size(); ++i)
      for (std::size_t j = 0; j < points_.size(); ++j) game_.entry[i][j] = planes_[i](points_[j]);
  }

  /// If a plane separates T_P from T_Q, sets g_ to the plane in the middle between them and returns
  /// true. g_ is above 0 on T_P, and below 0 on T_Q. If no plane separates them, returns false.
  bool findSeparation() {
    g_ = {};
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      g_.n += game_.rowWeight[i] * planes_[i].n;
      g_.c += game_.rowWeight[i] * planes_[i].c;
    }
    double least = HUGE_VAL;
    for (const Vec3& x : points_) least = std::min(least, g_(x));
    g_.c += 0.5 * least;
    return least > 0;
  }

  /// For the case that T_P and T_Q are apart: moves the plane h, and goes down to the first
  /// polytope of P that has a vertex beyond h.
  Step refineP() {
    Plane next{-g_.n, -g_.c};
    if (v_) {
      const double share = h_(points_[0]) / g_(points_[0]);
      next = {h_.n + share * next.n, h_.c + share * next.c};
    }
    const double size = next.n.norm();
    if (!(size > 0x1p-400)) return Step::stuck;
    h_ = {next.n / size, next.c / size};
    const std::optional<Vec3> d = scaled(X_QP_.m.transpose() * h_.n);
    if (!d) return Step::stuck;
    PolytopeShadow shadow = v_ ? PolytopeShadow(p_, *d, *v_) : PolytopeShadow(p_, *d);
    bool beyond = false;
    while (!beyond && shadow.level() > 0) beyond = shadow.refine() && h_(pointP(shadow.top())) > 0;
    if (trace_)
      trace_->push_back({shadow.level() + beyond, levelQ_, true, h_.n, h_.c + h_.n.dot(q_.center()),
                         Vec3::Zero()});
    levelP_ = shadow.level();
    v_ = shadow.top();
    return beyond ? Step::refined : Step::decided;
  }

  /// For the case that T_P and T_Q share a point: moves x, and goes down to the first polyhedron of
  /// Q that excludes x.
  Step refineQ() {
    Vec3 next = Vec3::Zero();
    for (std::size_t j = 0; j < points_.size(); ++j) {
      if (!(game_.columnWeight[j] > 0)) continue;
      next += game_.columnWeight[j] * points_[j];
      if (j < namesP_.size()) result_.verticesP.push_back(namesP_[j]);
    }
    if (half_) {
      const double before = polarQ(*half_).dot(x_) - 1, after = polarQ(*half_).dot(next) - 1;
      const double share = before > after ? std::min(1.0, before / (before - after)) : 1;
      next = x_ + share * (next - x_);
    }
    x_ = next;
    // At the center, which is inside all half-spaces, any direction will do.
    const std::optional<Vec3> d = scaled(x_.isZero(0) ? Vec3(Vec3::UnitX()) : x_);
    if (!d) return Step::stuck;
    PolytopeShadow shadow =
        half_ ? PolytopeShadow(*q_.polar(), *d, *half_) : PolytopeShadow(*q_.polar(), *d);
    bool outside = false;
    while (!outside && shadow.level() > 0)
      outside = shadow.refine() && polarQ(shadow.top()).dot(x_) > 1;
    if (trace_)
      trace_->push_back(
          {levelP_, shadow.level() + outside, false, Vec3::Zero(), 0, Vec3(x_ + q_.center())});
    levelQ_ = shadow.level();
    half_ = shadow.top();
    return outside ? Step::refined : Step::decided;
  }

  /// Returns d, scaled by a power of two, as the direction of a walk. Returns nullopt if d is too
  /// small, too large or not finite.
  static std::optional<Vec3> scaled(const Vec3& d) {
    const double largest = d.cwiseAbs().maxCoeff();
    if (!(largest > 0x1p-900 && largest < 0x1p900)) return std::nullopt;
    return d / powerOfTwo(largest);
  }

  /// Proves by certified projections that the polytopes are apart along the normal of h.
  bool provedApart() {
    Vec3 n = X_WQ_.m.inverse().transpose() * h_.n;
    n /= n.cwiseAbs().maxCoeff();
    n.normalize();
    if (!n.allFinite()) return false;
    const PosedSet a(p_, X_WP_), b(q_.inner(), X_WQ_);
    // Each projection is off by the `error` of its set, and the sum of both by 1u of two numbers
    // below `size` (as in convexSetsTouch).
    const double size = a.reach() + X_WP_.t.norm() + b.reach() + X_WQ_.t.norm();
    const double slack = roundedUp(a.error() + b.error() + 2 * kUnit * size);
    if (!(-b.highest(-n) - a.highest(n, *v_) > slack)) return false;
    result_.direction_W = n;
    return true;
  }

  /// Proves with the vertices used that the polytopes share a point. The hull of the vertices of P
  /// that were used contains x. Let f be the face of Q that the ray from the center through x
  /// meets. The hull of the core of Q and of f contains x, too.
  bool provedMeeting() {
    const auto core = q_.core();
    result_.verticesQ.assign(core.begin(), core.end());
    const auto corners = cornersAt(q_.face(*half_));
    result_.verticesQ.insert(result_.verticesQ.end(), corners.begin(), corners.end());
    for (std::vector<std::uint32_t>* list : {&result_.verticesP, &result_.verticesQ}) {
      std::sort(list->begin(), list->end());
      list->erase(std::unique(list->begin(), list->end()), list->end());
    }
    ConvexPart a, b;
    for (const std::uint32_t v : result_.verticesP) a.points.push_back(p_.polytope().vertices()[v]);
    for (const std::uint32_t v : result_.verticesQ)
      b.points.push_back(q_.inner().polytope().vertices()[v]);
    result_.intersects = convexHullsTouch(PosedSet(a, X_WP_), PosedSet(b, X_WQ_));
    return result_.intersects;
  }

  /// Returns the first vertex of a face and two other vertices of the face, such that the ray from
  /// the center through x meets the triangle of these three vertices.
  std::array<std::uint32_t, 3> cornersAt(std::span<const std::uint32_t> face) const {
    const auto at = [&](std::size_t i) {
      return Vec3(q_.inner().polytope().vertices()[face[i]] - q_.center());
    };
    const Vec3 across =
        at(0).cross(x_);  // above 0 on one side of the plane of the ray and vertex 0
    std::size_t low = 1, high = face.size() - 1;
    while (high - low > 1) {
      const std::size_t middle = (low + high) / 2;
      (across.dot(at(middle)) > 0 ? high : low) = middle;
    }
    return {face[0], face[low], face[high]};
  }

  PolytopeIntersection decidedByAll() {
    result_.exact = true;
    result_.verticesP.clear();
    result_.verticesQ.clear();
    result_.intersects = convexHullsTouch(PosedSet(p_, X_WP_), PosedSet(q_.inner(), X_WQ_));
    return result_;
  }

  const DobkinKirkpatrick& p_;
  const OuterHierarchy& q_;
  Transform X_WP_, X_WQ_, X_QP_;
  std::vector<PolytopePruning>* trace_;
  std::size_t levelP_, levelQ_;     ///< levels of `v_` and of `half_`
  std::optional<std::uint32_t> v_;  ///< vertex of P beyond h; none: T_P is the simplex
  /// Half-space of Q that excludes x; none: T_Q is the coarsest Q_j.
  std::optional<std::uint32_t> half_;
  Plane h_;                ///< the separating plane, P_i at h ≤ 0; valid if `v_` has a value
  Vec3 x_ = Vec3::Zero();  ///< the common point; valid if `half_` has a value
  std::vector<std::uint32_t> namesP_;
  std::vector<Vec3> points_;   ///< T_P
  std::vector<Plane> planes_;  ///< T_Q: each function is ≤ 0 inside T_Q
  Plane g_;
  MatrixGame game_;
  PolytopeIntersection result_;
};

}  // namespace

PolytopeIntersection intersection(const DobkinKirkpatrick& p, const Transform& X_WP,
                                  const OuterHierarchy& q, const Transform& X_WQ,
                                  std::vector<PolytopePruning>* trace) {
  if (!X_WP.isFinite() || !X_WQ.isFinite())
    throw std::invalid_argument("the maps of polytopes must be finite");
  return PolytopeSearch(p, X_WP, q, X_WQ, trace).run();
}

}  // namespace corridor
