#include "tests/stress/audit/graze.h"

#include <algorithm>
#include <vector>

namespace corridor::audit {
namespace {

/// The largest numbers of poses that are evaluated in long double and in 128 bits. If a case needs
/// more, no lower bound of the distance is proved. Most cases need about a hundred in long double,
/// and about fifty in 128 bits.
constexpr int kMostSamples = 4000, kQuadLooks = 250;
/// Intervals shorter than this are evaluated in 128 bits.
constexpr long double kShort = 0x1p-14L;

Vec<Quad> randomUnit(Dice& dice) {
  return unit(Vec<Quad>(dice.vector()));
}

/// Returns the parameter s of the point p + s·d that is closest to x.
Quad closestOn(const Vec<Quad>& p, const Vec<Quad>& d, const Vec<Quad>& x) {
  return dot(x - p, d) / dot(d, d);
}

/// Returns whether the segment certainly crosses the triangle: by more than the rounding of 128
/// bits.
bool crossesTriangle(const Vec<Quad>& from, const Vec<Quad>& to, const std::array<Vec<Quad>, 3>& t,
                     double scale) {
  const Vec<Quad> n = unit(cross(t[1] - t[0], t[2] - t[0]));
  const Quad a = dot(n, from - t[0]), b = dot(n, to - t[0]), least = 1e-28L * Quad(scale);
  if (!((a > least && b < -least) || (a < -least && b > least))) return false;
  const Vec<Quad> x = from + (to - from) * (a / (a - b));
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec<Quad>&p = t[i], &q = t[(i + 1) % 3];
    if (!(dot(cross(q - p, x - p), n) > 1e-24L * dot(q - p, q - p))) return false;
  }
  return true;
}

}  // namespace

template <class S>
Graze::Look<S> Graze::look(const Curve<S>& curve, const Shape& rest, S t) const {
  Look<S> l;
  l.t = t;
  l.X = curve.at(t);
  const Vec<S> n(normal_);
  const Mat<S> back = l.X.R.transposed();
  const auto apart = [&](const Vec<S>& m) {
    return dot(m, l.X.p) - tip_.support(-(back * m)) - rest.support(m);
  };
  l.flat = apart(n);
  l.normal = n;
  if (rest.feature == Feature::face) {
    l.along = l.features = l.flat;
    return l;
  }
  const auto tipCore = [&](std::size_t i) { return l.X * Vec<S>(tip_.core[i]); };
  const auto restCore = [&](std::size_t i) { return Vec<S>(rest.core[i]); };
  const bool tipEdge = tip_.feature == Feature::edge, restEdge = rest.feature == Feature::edge;
  Vec<S> y = tipCore(0) - restCore(0), m = y;
  if (tipEdge && restEdge) {
    const Vec<S> a = unit(restCore(1) - restCore(0)), b = unit(tipCore(1) - tipCore(0));
    m = cross(a, b);
    l.sine = length(m);
    if (dot(m, n) < 0) m = -m;
  } else if (tipEdge || restEdge) {
    const Vec<S> d = tipEdge ? unit(tipCore(1) - tipCore(0)) : unit(restCore(1) - restCore(0));
    m = y - d * dot(d, y);
  }
  m = unit(m);
  if (!(dot(m, n) >= S(0.5L))) {
    l.along = l.flat;
    l.features = S(HUGE_VAL);
    return l;
  }
  l.normal = m;
  l.along = apart(m);
  l.features = dot(m, y) - tip_.coreRadius - rest.coreRadius;
  return l;
}

/// Returns a lower bound of the bodies' distance between two times that differ by w: the smaller of
/// the distances at these times, minus b·w²/8, where b bounds the second derivative f'' of the
/// distance f. (Ω, A and bend are those of curve.h.) There are three kinds of f:
/// - height of a point along a fixed direction: f'' ≤ bend;
/// - distance |y| of two points, or of a point from a line, y being the vector between them: f'' ≤
///   bend + |y'|²/|y|;
/// - distance n·y of two lines: n = u/|u|, u the cross product of their unit vectors, |u'| ≤ Ω,
///   |u''| ≤ Ω² + A. With s = |u|, it follows that |n'| ≤ Ω/s and |n''| ≤ (Ω² + A)/s + 3Ω²/s².
template <class S>
S Graze::boundOf(const Curve<S>& curve, const Look<S>& a, const Look<S>& b) const {
  const S w = b.t - a.t;
  const double reach = std::max(tip_.reach, base_.reach);
  const S bend = curve.bend(reach);
  S flatBend = bend;
  if (curve.hasOneRotation())
    flatBend = (bend - curve.slideBend()) * length(cross(Vec<S>(normal_), curve.axisAt(a.t))) +
               curve.slideBend();
  S bound = std::min(a.flat, b.flat) - flatBend * w * w / 8;
  if (base_.feature == Feature::face) return bound;
  const S turned = curve.turned(), speed = curve.speed(reach);
  if (speed * w > 0.05L * S(size_) || turned * w > 0.1L) return bound;
  const S slack = 1e-14L * S(curve.length() + reach);
  if (a.features - a.along > slack || b.features - b.along > slack) return bound;
  S second = bend;
  const S radii = S(tip_.coreRadius) + S(base_.coreRadius);
  if (tip_.feature == Feature::edge && base_.feature == Feature::edge) {
    const S s = std::min(a.sine, b.sine) - turned * w;
    if (s < S(0.1L)) return bound;
    const S y = std::max(magnitude(a.features), magnitude(b.features)) + radii + speed * w;
    second += 2 * turned / s * speed + (4 * turned * turned / (s * s) + curve.turnBend() / s) * y;
  } else {
    const S y = std::min(a.features, b.features) + radii - speed * w;
    if (y <= 0) return bound;
    second += speed * speed / y;
  }
  return std::max(bound, std::min(a.along, b.along) - second * w * w / 8);
}

void Graze::proveHeights() {
  const double scale = curve_->length() + std::max(tip_.reach, base_.reach);
  const Look<Quad> first = look(*curve_, base_, Quad(0));
  if (curve_->speed(1) == 0) {
    lowest_ = static_cast<double>(std::max(first.flat, first.along)) - error128_;
    return;
  }
  // First, long double finds the intervals in which the bodies are farther apart than required, by
  // more than its rounding. The other intervals are collected in `close`.
  const Curve<long double> rough(*curve_);
  const long double error =
      scale * (0x1p-57L * static_cast<long double>(rough.joints() + 2) + 0x1p-62L * rough.terms());
  using Rough = Look<long double>;
  struct Part {
    Rough a, b;
  };
  std::vector<Part> open;
  std::vector<std::pair<long double, long double>> close;
  const int parts = 8;
  Rough last = look(rough, base_, 0.0L);
  for (int i = 1; i <= parts; ++i) {
    Rough next = look(rough, base_, static_cast<long double>(i) / parts);
    open.push_back({last, next});
    last = next;
  }
  long double lowest = HUGE_VALL;
  // If the bodies hardly move, the whole edge is evaluated in 128 bits.
  if (curve_->speed(std::max(tip_.reach, base_.reach)) < 1e-3 * size_) {
    open.clear();
    close.emplace_back(0, 1);
  }
  for (int looks = 0; !open.empty();) {
    const Part part = open.back();
    open.pop_back();
    const long double bound = boundOf(rough, part.a, part.b) - error;
    const long double width = part.b.t - part.a.t;
    if (bound > keep_ + 1e-9L * size_) {
      lowest = std::min(lowest, bound);
    } else if (width <= kShort) {
      close.emplace_back(part.a.t, part.b.t);
      if (close.size() > 40) return;
    } else {
      if (++looks > kMostSamples) return;
      const Rough middle = look(rough, base_, part.a.t + width / 2);
      if (middle.flat < keep_ - 0.01L * size_ && middle.along < keep_ - 0.01L * size_) return;
      open.push_back({middle, part.b});
      open.push_back({part.a, middle});
    }
  }
  struct QuadPart {
    Look<Quad> a, b;
  };
  Quad enough = keep_ - 2 * baseError_ - 1e-15 * size_;
  Quad least = lowest;
  int looks = 0;
  for (const auto& [from, to] : close) {
    std::vector<QuadPart> parts128{
        {look(*curve_, base_, Quad(from)), look(*curve_, base_, Quad(to))}};
    looks += 2;
    while (!parts128.empty()) {
      const QuadPart part = parts128.back();
      parts128.pop_back();
      const Quad bound = boundOf(*curve_, part.a, part.b);
      if (bound >= enough) {
        least = std::min(least, bound);
        continue;
      }
      if (++looks > kQuadLooks) return;
      const Look<Quad> middle = look(*curve_, base_, (part.a.t + part.b.t) / 2);
      // The bodies may be closer here than at `time_`. Then the bound to be proved is lowered to
      // this distance.
      const Quad met = std::max(middle.flat, middle.along) - 1e-15 * size_;
      enough = std::min(enough, met);
      parts128.push_back({middle, part.b});
      parts128.push_back({part.a, middle});
    }
  }
  lowest_ = static_cast<double>(least) - error128_;
}

/// Chooses the plane's normal at the meeting point, in the rest's frame, so that the tip meets the
/// plane as `meeting` requires. Returns false if this edge has no such normal.
bool Graze::chooseNormal(Dice& dice, Meeting meeting) {
  const Vec<Quad> x(touch_);
  const Quad e = Quad(1e-9) / std::max(1.0, curve_->turned());
  const Quad t = time_;
  const Vec<Quad> before = curve_->at(t - e) * x, at = curve_->at(t) * x,
                  after = curve_->at(t + e) * x;
  const Vec<Quad> v = after - before, bent = (after - at) - (at - before);
  const Vec<Quad> forward = unit(v);
  normal_ = randomUnit(dice);
  if (dot(v, v) == 0) return true;
  switch (meeting) {
    case Meeting::along:
      normal_ = unit(normal_ - forward * dot(forward, normal_));
      if (dice.oneIn(4)) {  // along the part of the acceleration that is orthogonal to the velocity
        const Vec<Quad> in = bent - forward * dot(forward, bent);
        if (dot(in, in) > 0) normal_ = unit(in);
      }
      if (dot(normal_, bent) < 0) normal_ = -normal_;
      break;
    case Meeting::start:
      if (dot(normal_, v) < 0) normal_ = -normal_;
      break;
    case Meeting::end:
      if (dot(normal_, v) > 0) normal_ = -normal_;
      break;
    case Meeting::slide:
      if (!curve_->hasOneRotation()) return false;
      normal_ = curve_->axisAt(t);
      if (dice.oneIn(2)) normal_ = -normal_;
      break;
  }
  return true;
}

/// Replaces `curve_` by a curve at a corner of the edge's tube: the corner at which the tip is
/// lowest at `time_`, to first order.
void Graze::perturbToWorstCorner(const Edge& edge) {
  const Quad e = 1e-12;
  const Vec<Quad> at = curve_->at(time_) * touch_;
  Perturbation stray(static_cast<std::size_t>(edge.tube.size()), 0);
  const auto rise = [&](std::size_t number) {
    Perturbation one(stray.size(), 0);
    one[number] = e;
    const Curve<Quad> moved(edge, restFrame_, tipFrame_, one);
    return dot(normal_, moved.at(time_) * touch_ - at);
  };
  for (const Coordinate& c : edge.space.coordinates()) {
    const Quad most = edge.strayOf(c.first);
    if (most == 0) continue;
    if (c.kind != Coordinate::Kind::rotation) {
      const Quad up = rise(c.first);
      stray[c.first] = up > 0 ? -most : up < 0 ? most : Quad(0);
      continue;
    }
    const Vec<Quad> up = unit(Vec<Quad>(rise(c.first), rise(c.first + 1), rise(c.first + 2)));
    for (std::size_t i = 0; i < 3; ++i) stray[c.first + i] = -up[i] * most * (1 - Quad(0x1p-90));
  }
  curve_.emplace(edge, restFrame_, tipFrame_, stray);
}

Graze::Graze(Dice& dice, const Edge& edge, const Wish& wish)
    : size_(wish.size), keep_(wish.keep), inTube_(wish.inTube) {
  const bool swapped = dice.oneIn(2);
  restFrame_ = swapped ? edge.second : edge.first;
  tipFrame_ = swapped ? edge.first : edge.second;
  nominal_.emplace(edge, restFrame_, tipFrame_);
  curve_ = nominal_;
  const Meeting meetings[] = {Meeting::along, Meeting::along, Meeting::along,
                              Meeting::start, Meeting::end,   Meeting::slide};
  Meeting meeting = meetings[dice.index(6)];
  // The effect of a tube may grow along the edge. So in half of the cases with a tube, the bodies
  // meet at the start or the end.
  if (inTube_ && dice.oneIn(2)) meeting = dice.oneIn(2) ? Meeting::start : Meeting::end;
  const double depth = std::exp2(1 + static_cast<double>(dice.index(10)));
  time_ = dice.oneIn(2) ? std::floor(dice.real(0, depth)) / depth : dice.real(0, 1);
  passesAlong_ = curve_->speed(1) > 0 && (meeting == Meeting::along || meeting == Meeting::slide);
  if (meeting == Meeting::start) time_ = 0;
  if (meeting == Meeting::end) time_ = 1;
  // The first frame often stands still. If the tip is on that frame, it is placed near the position
  // of the rest's frame at `time_`.
  const double away = swapped ? curve_->length() : 0;
  touch_ = Vec<Quad>(Vec3(size_ * dice.real(0, 2) * dice.vector()));
  if (away > 0) {
    const Vec<Quad> seen = curve_->at(time_).inverse() * touch_;
    touch_ = Vec<Quad>(seen.rounded());
  }
  if (!chooseNormal(dice, meeting)) return;
  if (inTube_) {
    if (dice.oneIn(2)) {  // normal along the displacement due to one component of the tube
      std::vector<std::size_t> strays;
      for (const Coordinate& c : edge.space.coordinates())
        if (edge.strayOf(c.first) > 0) strays.push_back(c.first);
      if (strays.empty()) return;
      Perturbation one(static_cast<std::size_t>(edge.tube.size()), 0);
      one[strays[dice.index(strays.size())]] = 1e-12;
      const Curve<Quad> moved(edge, restFrame_, tipFrame_, one);
      const Vec<Quad> way = moved.at(time_) * touch_ - curve_->at(time_) * touch_;
      if (dot(way, way) > 0) normal_ = unit(way);
    }
    perturbToWorstCorner(edge);
    if (meeting == Meeting::along) {  // the perturbed curve, too, must move along the plane
      const Quad e = 1e-12;
      const Vec<Quad> v = unit(curve_->at(time_ + e) * touch_ - curve_->at(time_) * touch_);
      normal_ = unit(normal_ - v * dot(v, normal_));
    }
  }
  const Pose<Quad> X = curve_->at(time_);
  const Vec<Quad> p = X * touch_;
  const Feature tips[] = {Feature::corner, Feature::corner, Feature::edge, Feature::corner};
  const Feature rests[] = {Feature::face, Feature::face, Feature::edge, Feature::corner};
  const std::size_t which = dice.index(4);
  const Vec<Quad> along = unit(cross(normal_, randomUnit(dice)));
  const double turn = dice.real(0.3, 2.8);
  const Vec<Quad> other = along * std::cos(turn) + cross(normal_, along) * std::sin(turn);
  ExactBody tip = randomExactBody(dice, tips[which], p, normal_, along, size_);
  const bool round = tip.radius > 0 && !tip.flatEnds;
  // If the rest's feature is an edge or a corner, a corner of the tip must be round. Otherwise the
  // depth would not be known.
  Feature restFeature = rests[which];
  if (restFeature == Feature::corner && dice.oneIn(2)) restFeature = Feature::edge;
  if (restFeature != Feature::face && tips[which] == Feature::corner && !round)
    restFeature = Feature::face;
  restPlan_ = randomExactBody(dice, restFeature, p - normal_ * keep_, -normal_, other, size_);
  tip_ = stored(tip, X.inverse(), {}, normal_);
  base_ = stored(restPlan_, {}, {}, -normal_, &baseError_);
  const double reach = std::max(tip_.reach, base_.reach), lengths = nominal_->length() + 2 * reach;
  rounding_ = lengths * (static_cast<double>(nominal_->joints() + 2) * 0x1p-43 +
                         0x1p-48 * nominal_->largest());
  ulp_ = 0x1p-53 * lengths;
  error128_ = 1e-30 * (nominal_->length() + reach) * (1 + nominal_->terms());
  usable_ = true;
  if (!inTube_) proveHeights();
}

Shape Graze::rest(double gap, Truth& truth) const {
  double error = 0;
  Shape shape = stored(restPlan_, {}, normal_ * -Quad(gap), -normal_, &error);
  truth.t = time_;
  const double share = shape.feature == Feature::face || gap < 0 ? 1 : 0.5;
  truth.apart = lowest_ + share * gap - (error + baseError_);
  const auto distance = distanceAtMost(shape);
  truth.violates = (distance && *distance < keep_ * (1 - Quad(0x1p-90)) - 100 * Quad(error128_)) ||
                   crosses(shape);
  return shape;
}

std::optional<Quad> Graze::distanceAtMost(const Shape& rest) const {
  const Pose<Quad> X = curve_->at(time_);
  const std::array<Vec<Quad>, 3>& r = rest.core;
  const Vec<Quad> a = X * tip_.core[0], b = X * tip_.core[1];
  const bool tipEdge = tip_.feature == Feature::edge;
  const Quad radii = Quad(tip_.coreRadius) + rest.coreRadius;
  const auto within = [](Quad s) { return s >= 0 && s <= 1; };
  if (rest.feature == Feature::face) {
    const Vec<Quad> n = unit(cross(r[1] - r[0], r[2] - r[0]));
    const Vec<Quad> foot = a - n * dot(n, a - r[0]);
    for (std::size_t i = 0; i < 3; ++i)
      if (dot(cross(r[(i + 1) % 3] - r[i], foot - r[i]), n) <= 0) return std::nullopt;
    return length(a - foot) - radii;
  }
  if (rest.feature == Feature::edge && tipEdge) {
    const Vec<Quad> d = r[1] - r[0], e = b - a, n = cross(d, e), y = a - r[0];
    const Quad s = dot(cross(y, e), n) / dot(n, n), u = dot(cross(y, d), n) / dot(n, n);
    if (!within(s) || !within(u)) return std::nullopt;
    return length(a + e * u - (r[0] + d * s)) - radii;
  }
  if (rest.feature == Feature::edge) {
    const Quad s = closestOn(r[0], r[1] - r[0], a);
    if (!within(s)) return std::nullopt;
    return length(a - (r[0] + (r[1] - r[0]) * s)) - radii;
  }
  if (tipEdge) {
    const Quad s = closestOn(a, b - a, r[0]);
    if (!within(s)) return std::nullopt;
    return length(a + (b - a) * s - r[0]) - radii;
  }
  return length(a - r[0]) - radii;
}

bool Graze::crosses(const Shape& rest) const {
  const Pose<Quad> X = curve_->at(time_);
  const std::array<Vec<Quad>, 3> tip{X * tip_.core[0], X * tip_.core[1], X * tip_.core[2]};
  const double scale =
      (curve_->length() + std::max(tip_.reach, rest.reach)) * (1 + curve_->terms());
  const Vec<Quad> inner = (tip[0] + tip[1] + tip[2]) * (Quad(1) / 3);
  if (rest.feature == Feature::face) return crossesTriangle(tip[0], inner, rest.core, scale);
  if (rest.feature == Feature::edge && tip_.feature == Feature::edge)
    return crossesTriangle(tip[0], tip[1], rest.core, scale) ||
           crossesTriangle(rest.core[0], rest.core[1], tip, scale);
  return false;
}

double Graze::apartAt(const Shape& rest, double t) const {
  const Look<Quad> l = look(*nominal_, rest, Quad(t));
  return static_cast<double>(std::max(l.flat, l.along));
}

}  // namespace corridor::audit
