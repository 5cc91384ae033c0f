#include "collision/course/polygon_intersection.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <span>

#include "collision/convex/seidel-inl.h"
#include "collision/course/separating_plane.h"
#include "collision/predicates/along.h"

namespace corridor {
namespace {

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The points left of the line from a to b, or on it.
struct HalfPlane {
  Vec2 a, b;
  /// Returns twice the signed area of the triangle a, b, x: above 0 inside.
  double signedArea(const Vec2& x) const { return cross(b - a, x - a); }
};

/// Returns the part of a convex polygon (or segment, or point) in a half-plane.
std::vector<Vec2> clipped(const std::vector<Vec2>& polygon, const HalfPlane& half) {
  std::vector<Vec2> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &x = polygon[i], &y = polygon[(i + 1) % polygon.size()];
    const double dx = half.signedArea(x), dy = half.signedArea(y);
    if (dx >= 0) result.push_back(x);
    if ((dx > 0 && dy < 0) || (dx < 0 && dy > 0)) result.push_back(x + dx / (dx - dy) * (y - x));
  }
  return result;
}

class PolygonSearch {
 public:
  PolygonSearch(const ConvexPolygon& p, const ConvexPolygon& q, std::vector<PolygonPruning>* trace)
      : p_(p), q_(q), trace_(trace), chainP_{0, p.size()}, chainQ_{0, q.size()} {
    for (std::size_t k = 0; k < 3; ++k) triangle_.push_back(k * p.size() / 3);
    // T_Q begins with the two edges at each of the four extreme vertices along the coordinate axes.
    // So along each chain between two edges of T_Q the boundary turns by less than a quarter turn.
    for (const Vec2& axis : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
      const std::size_t v = q.extreme(axis);
      edges_.push_back((v + q.size() - 1) % q.size());
      edges_.push_back(v);
    }
    std::sort(edges_.begin(), edges_.end());
    edges_.erase(std::unique(edges_.begin(), edges_.end()), edges_.end());
  }

  PolygonIntersection run() {
    PolygonIntersection result;
    // Each step halves a chain. The limit of steps is needed because rounding may spoil a step.
    const std::size_t bits = std::bit_width(p_.size()) + std::bit_width(q_.size());
    for (std::size_t most = 4 * bits + 16; result.steps < static_cast<int>(most); ++result.steps) {
      const Step step = next();
      if (step == Step::apart || step == Step::meets) {
        if (step == Step::apart ? provedApart(result) : provedMeeting(result)) return result;
        break;
      }
      if (trace_) trace_->push_back({chainP_, chainQ_});
    }
    return decidedByAll(result);
  }

 private:
  enum class Step { pruned, apart, meets };

  HalfPlane halfPlane(std::size_t edge) const { return {q_[edge], q_[edge + 1]}; }

  Step next() {
    for (const std::size_t v : triangle_) usedP_.push_back(v % p_.size());
    for (const std::size_t e : edges_)
      usedQ_.insert(usedQ_.end(), {e % q_.size(), (e + 1) % q_.size()});
    std::vector<Vec2> common;
    for (const std::size_t v : triangle_) common.push_back(p_[v]);
    for (const std::size_t e : edges_) common = clipped(common, halfPlane(e));
    return common.empty() ? pruneP() : pruneQ(common);
  }

  /// For the case that T_P and T_Q share the polygon `common`: keeps the chain of Q whose chord has
  /// all of `common` beyond it. Returns `meets` if there is no such chain.
  Step pruneQ(const std::vector<Vec2>& common) {
    for (std::size_t k = 0; k < edges_.size(); ++k) {
      const bool last = k + 1 == edges_.size();
      if (last && !wholeQ_) break;  // no edges are left between the last edge and the first
      const std::size_t from = edges_[k], to = last ? edges_[0] + q_.size() : edges_[k + 1];
      if (to == from + 1) continue;
      const HalfPlane chord{q_[from + 1], q_[to]};
      if (!std::all_of(common.begin(), common.end(),
                       [&](const Vec2& x) { return chord.signedArea(x) < 0; }))
        continue;
      chainQ_ = {from, to};
      wholeQ_ = false;
      edges_ = {from, (from + to) / 2, to};
      return Step::pruned;
    }
    return Step::meets;
  }

  /// For the case that T_P and T_Q are apart: finds a line that separates them, and keeps the chain
  /// of P that reaches beyond the line. Returns `apart` if there is no such chain.
  Step pruneP() {
    // Tries the line along each edge of T_Q. If all of T_P is beyond the line, the line is moved to
    // the closest vertex of T_P.
    for (const std::size_t e : edges_) {
      const HalfPlane half = halfPlane(e);
      std::size_t closest = 0;
      double most = -HUGE_VAL;
      for (std::size_t k = 0; k < triangle_.size(); ++k) {
        const double inside = half.signedArea(p_[triangle_[k]]);
        if (inside > most) most = inside, closest = k;
      }
      if (most >= 0) continue;
      const Vec2 d = half.b - half.a;
      direction_ = {-d.y(), d.x()};  // towards Q
      return keepBeyond(closest);
    }
    // Tries the line along each edge of T_P, and uses the first such line that has all of T_Q
    // beyond it.
    for (std::size_t k = 0; k < triangle_.size(); ++k) {
      const Vec2 &v = p_[triangle_[k]], &w = p_[triangle_[(k + 1) % triangle_.size()]];
      const Vec2 out(w.y() - v.y(), v.x() - w.x());
      if (!isBeyond(out, v, std::max(std::abs(out.x()), std::abs(out.y())))) continue;
      direction_ = out;
      return keepBetween(k);
    }
    // Because of rounding, no line was found. The proof will fail, and then all vertices decide.
    return Step::apart;
  }

  /// Returns whether T_Q is beyond the line through v with the normal `out`, which means that the
  /// least value of out·(x − v) over T_Q is above 0.
  bool isBeyond(const Vec2& out, const Vec2& v, double size) const {
    if (!(size > 0)) return false;
    using Row = seidel::HalfSpace<double, 2>;
    std::vector<Row> list;
    double reach = 1;
    for (const std::size_t e : edges_) {
      const HalfPlane half = halfPlane(e);
      const Vec2 d = half.b - half.a, a = half.a - v;
      // cross(d, x − a) ≥ 0
      list.push_back({{d.y(), -d.x()}, d.y() * a.x() - d.x() * a.y(), 0});
      reach = std::max(reach, a.cwiseAbs().maxCoeff());
    }
    seidel::Bounds<double, 2> bounds{{1e6 * reach, 1e6 * reach}, {0, 0}};
    seidel::Point<double, 2> x{};
    seidel::Tight<2> tight;
    seidel::HeapMemory<double, 1> memory;
    if (!seidel::solve<double, 2>(bounds, std::span<const Row>(list), {-out.x(), -out.y()}, x,
                                  tight, memory))
      return false;
    return out.x() * x[0] + out.y() * x[1] > 0;
  }

  /// Keeps the chain next to vertex k of T_P that goes beyond the line through this vertex. Returns
  /// `apart` if no chain does.
  Step keepBeyond(std::size_t k) {
    const std::size_t v = triangle_[k], n = triangle_.size();
    const auto rises = [&](std::size_t w) { return direction_.dot(p_[w] - p_[v]) > 0; };
    const bool first = !wholeP_ && k == 0, last = !wholeP_ && k + 1 == n;
    if (!last && rises(v + 1)) return keepBetween(k);
    if (!first && rises(v + p_.size() - 1)) return keepBetween((k + n - 1) % n);
    return Step::apart;
  }

  /// Keeps the chain from vertex k of T_P to the next vertex of T_P. Returns `apart` if this chain
  /// has no vertices left to examine.
  Step keepBetween(std::size_t k) {
    const std::size_t n = triangle_.size();
    if (!wholeP_ && k + 1 == n) return Step::apart;  // the chord: no vertices are left beyond it
    const std::size_t from = triangle_[k],
                      to = k + 1 == n ? triangle_[0] + p_.size() : triangle_[k + 1];
    chainP_ = {from, to};
    wholeP_ = false;
    if (to - from < 2) {
      triangle_ = {from, to};
      if (n == 2) return Step::apart;
    } else {
      triangle_ = {from, (from + to) / 2, to};
    }
    return Step::pruned;
  }

  bool provedApart(PolygonIntersection& result) const {
    if (!direction_.allFinite() || direction_.isZero(0)) return false;
    result.direction = direction_;
    result.p = p_.extreme(direction_);
    result.q = q_.extreme(-direction_);
    const Vec2 &p = p_[result.p], &q = q_[result.q];
    return alongSign({direction_.x(), direction_.y(), 0}, {p.x(), p.y(), 0}, {q.x(), q.y(), 0}) > 0;
  }

  /// Proves with the vertices used that the polygons share a point. (If a step has found that some
  /// points of P are beyond a chain of Q, one of the triangles used contains such a point. The
  /// segment from this point to a common point of T_P and T_Q enters Q through the chord of the
  /// chain, whose ends are vertices used.)
  bool provedMeeting(PolygonIntersection& result) {
    const auto unique = [](std::vector<std::size_t>& list) {
      std::sort(list.begin(), list.end());
      list.erase(std::unique(list.begin(), list.end()), list.end());
    };
    unique(usedP_);
    unique(usedQ_);
    std::vector<Vec2> p, q;
    for (const std::size_t i : usedP_) p.push_back(p_[i]);
    for (const std::size_t i : usedQ_) q.push_back(q_[i]);
    const auto found = separatingPlane<2>(std::span<const Vec2>(p), std::span<const Vec2>(q));
    if (found.relation == HullRelation::disjoint) return false;
    result.intersects = true;
    result.verticesP = usedP_;
    result.verticesQ = usedQ_;
    return true;
  }

  PolygonIntersection decidedByAll(PolygonIntersection result) const {
    const auto found = separatingPlane<2>(p_.vertices(), q_.vertices());
    result.exact = true;
    result.intersects = found.relation != HullRelation::disjoint;
    if (result.intersects) {
      result.verticesP = found.first;
      result.verticesQ = found.second;
    } else {
      result.direction = found.normal;
      result.p = p_.extreme(found.normal);
      result.q = q_.extreme(-found.normal);
    }
    return result;
  }

  const ConvexPolygon &p_, &q_;
  std::vector<PolygonPruning>* trace_;
  std::array<std::size_t, 2> chainP_, chainQ_;
  bool wholeP_ = true, wholeQ_ = true;
  std::vector<std::size_t> triangle_, edges_;  ///< T_P and T_Q
  std::vector<std::size_t> usedP_, usedQ_;
  Vec2 direction_ = Vec2::Zero();  ///< normal, towards Q, of the latest line between T_P and T_Q
};

}  // namespace

PolygonIntersection intersection(const ConvexPolygon& p, const ConvexPolygon& q,
                                 std::vector<PolygonPruning>* trace) {
  return PolygonSearch(p, q, trace).run();
}

}  // namespace corridor
