#include "collision/course/polytope_shadow.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "collision/convex/rational-inl.h"
#include "collision/core/rounding.h"
#include "collision/predicates/along.h"

namespace corridor {
namespace {

using seidel::Rational;
using seidel::rational;

/// Returns a second direction e for the shadow along d. Any direction that is not parallel to d is
/// legal. The two factors make it unlikely that the shadow of an edge is a single point, even for
/// polytopes with edges along the coordinate axes.
Vec3 across(const Vec3& d) {
  const Vec3 u = d.unitOrthogonal();
  return 0.7548776662466927 * u + 0.5698402909980532 * d.cross(u);
}

}  // namespace

PolytopeShadow::PolytopeShadow(const DobkinKirkpatrick& hierarchy, const Vec3& d)
    : of_(hierarchy), d_(d), e_(across(d)), level_(hierarchy.levels() - 1) {
  for (const std::uint32_t v : of_.simplex_) {
    cost_.products += 2;
    if (v == of_.simplex_[0] || d_.dot(at(v)) > d_.dot(at(top_))) top_ = v;
  }
  std::array<std::uint32_t, 3> others{};
  std::size_t count = 0;
  for (const std::uint32_t v : of_.simplex_)
    if (v != top_) others[count++] = v;
  // The edge from the topmost vertex to another vertex belongs to the two faces that are opposite
  // to the remaining two vertices.
  chooseEdges(others, [&](std::size_t i) {
    std::array<std::uint32_t, 2> faces{};
    std::size_t to = 0;
    for (std::size_t k = 0; k < 4; ++k)
      if (of_.simplex_[k] != top_ && of_.simplex_[k] != others[i])
        faces[to++] = of_.simplexFaces_[k];
    return faces;
  });
}

PolytopeShadow::PolytopeShadow(const DobkinKirkpatrick& hierarchy, const Vec3& d,
                               std::uint32_t vertex)
    : of_(hierarchy), d_(d), e_(across(d)), level_(hierarchy.lastLevel(vertex)) {
  takeTop(vertex);
}

template <class FacesOf>
void PolytopeShadow::chooseEdges(std::span<const std::uint32_t> neighbours,
                                 const FacesOf& facesOf) {
  std::size_t leftmost = 0, rightmost = 0;
  Point l = projected(neighbours[0]), r = l;
  for (std::size_t i = 1; i < neighbours.size(); ++i) {
    const Point p = projected(neighbours[i]);
    // All neighbours are below the topmost vertex, so the directions to them span at most a half
    // turn, counterclockwise from left to right.
    if (turn(p, l) > 0) l = p, leftmost = i;
    if (turn(r, p) > 0) r = p, rightmost = i;
  }
  left_ = {neighbours[leftmost], facesOf(leftmost)};
  right_ = {neighbours[rightmost], facesOf(rightmost)};
}

void PolytopeShadow::takeTop(std::uint32_t v) {
  top_ = v;
  const auto ring = of_.ringOf(v), star = of_.starOf(v);
  chooseEdges(ring, [&](std::size_t j) {
    return std::array{star[(j + star.size() - 1) % star.size()], star[j]};
  });
}

bool PolytopeShadow::refine() {
  std::array<std::uint32_t, 4> added{};
  std::size_t count = 0;
  for (const Edge* edge : {&left_, &right_})
    for (const std::uint32_t f : edge->faces) {
      const auto& face = of_.faces_[f];
      if (face.born != level_) continue;
      if (std::find(added.begin(), added.begin() + count, face.opposite) == added.begin() + count)
        added[count++] = face.opposite;
    }
  double highest = 0;
  std::uint32_t best = kNone;
  for (std::size_t i = 0; i < count; ++i) {
    ++cost_.products;
    const double along = d_.dot(at(added[i]) - at(top_));
    if (along > highest) highest = along, best = added[i];
  }
  if (best != kNone) {
    takeTop(best);
  } else if (count > 0) {
    refineEdge(left_, true);
    refineEdge(right_, false);
  }
  --level_;
  return best != kNone;
}

void PolytopeShadow::refineEdge(Edge& edge, bool isLeft) {
  const Edge old = edge;
  bool kept = true, changed = false;
  std::array<std::uint32_t, 2> faces = old.faces;
  for (std::uint32_t& f : faces) {
    if (of_.faces_[f].born != level_) continue;
    changed = true;
    const std::uint32_t u = of_.faces_[f].opposite;
    const auto ring = of_.ringOf(u), star = of_.starOf(u);
    const std::size_t n = ring.size();
    const std::size_t j = std::find(ring.begin(), ring.end(), top_) - ring.begin();
    if (ring[(j + 1) % n] == old.to)
      f = star[j];
    else if (ring[(j + n - 1) % n] == old.to)
      f = star[(j + n - 1) % n];
    else
      kept = false;  // a diagonal of the hole
  }
  if (!changed) return;
  Point best{};
  bool found = kept;
  if (kept) edge.faces = faces, best = projected(old.to);
  for (const std::uint32_t f : old.faces) {
    if (of_.faces_[f].born != level_) continue;
    const std::uint32_t u = of_.faces_[f].opposite;
    const Point p = projected(u);
    if (found && !((isLeft ? turn(p, best) : turn(best, p)) > 0)) continue;
    const auto ring = of_.ringOf(u), star = of_.starOf(u);
    const std::size_t j = std::find(ring.begin(), ring.end(), top_) - ring.begin();
    edge = {u, {star[(j + star.size() - 1) % star.size()], star[j]}};
    best = p;
    found = true;
  }
}

int PolytopeShadow::exactTurn(std::uint32_t p, std::uint32_t q) const {
  // Each projected coordinate is off by at most 4u of the sum of its terms' magnitudes
  // (`alongSign`). So a product of two coordinates is off by at most 9u of the product of these
  // sums, and the difference of two products by 10u of both. 2^-900 covers underflow of values
  // below 2^50.
  const Vec3 x = at(p) - at(top_), y = at(q) - at(top_);
  const auto size = [](const Vec3& n, const Vec3& v) { return n.cwiseAbs().dot(v.cwiseAbs()); };
  const double value = e_.dot(x) * d_.dot(y) - d_.dot(x) * e_.dot(y);
  const double scale = size(e_, x) * size(d_, y) + size(d_, x) * size(e_, y);
  if (std::abs(value) > 16 * kUnit * scale + 0x1p-900 && scale < 0x1p100 &&
      std::max({d_.cwiseAbs().maxCoeff(), x.cwiseAbs().maxCoeff(), y.cwiseAbs().maxCoeff()}) <
          0x1p50)
    return value > 0 ? 1 : -1;
  std::array<Rational, 4> c;
  for (int k = 0; k < 3; ++k) {
    const Rational origin = rational(at(top_)[k]);
    const Rational px = rational(at(p)[k]) - origin, qx = rational(at(q)[k]) - origin;
    c[0] += rational(e_[k]) * px;
    c[1] += rational(d_[k]) * px;
    c[2] += rational(e_[k]) * qx;
    c[3] += rational(d_[k]) * qx;
  }
  return Rational(c[0] * c[3] - c[1] * c[2]).sign();
}

bool PolytopeShadow::isProved() const {
  const int upLeft = alongSign(d_, at(top_), at(left_.to)),
            upRight = alongSign(d_, at(top_), at(right_.to));
  if (upLeft > 0 || upRight > 0) return false;
  const auto beside = [&](const Edge& edge, int side) {
    for (const std::uint32_t f : edge.faces)
      for (const std::uint32_t v : of_.faces_[f].corner)
        if (v != top_ && v != edge.to && exactTurn(edge.to, v) * side < 0) return false;
    return true;
  };
  const bool halfTurn = upLeft == 0 && upRight == 0 && alongSign(e_, at(top_), at(left_.to)) < 0 &&
                        alongSign(e_, at(top_), at(right_.to)) > 0;
  return (halfTurn || exactTurn(left_.to, right_.to) > 0) && beside(left_, 1) && beside(right_, -1);
}

}  // namespace corridor
