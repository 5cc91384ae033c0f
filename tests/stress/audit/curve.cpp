#include "tests/stress/audit/curve.h"

#include <algorithm>
#include <span>

namespace corridor::audit {
namespace {

std::array<Quad, 4> normalised(const double* q) {
  Quad largest = 0;
  for (int i = 0; i < 4; ++i) largest = std::max(largest, magnitude(Quad(q[i])));
  std::array<Quad, 4> n;
  Quad squares = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    n[i] = q[i] / largest;
    squares += n[i] * n[i];
  }
  for (Quad& x : n) x /= sqrtq(squares);
  return n;
}

const Coordinate& coordinateOf(const ConfigurationSpace& space, std::size_t number) {
  const auto& all = space.coordinates();
  return *std::find_if(all.begin(), all.end(), [&](const Coordinate& c) {
    return c.first <= number && number < c.first + c.size();
  });
}

/// Returns multiplier·(q(t) − q(0)) for component q of the configuration (index `number`). It is
/// exact if the differences of two doubles, and the products, fit into 113 bits.
Polynomial<Quad> changeOf(const Edge& edge, std::size_t number, double multiplier) {
  const auto i = static_cast<Eigen::Index>(number);
  Polynomial<Quad> change;
  if (edge.piece) {
    const Eigen::MatrixXd& d = edge.piece->coefficients;
    change.degree = edge.piece->degree();
    for (int k = 0; k <= change.degree; ++k)
      change.d[static_cast<std::size_t>(k)] = multiplier * (Quad(d(i, k)) - Quad(d(i, 0)));
    return change;
  }
  const bool circle = coordinateOf(edge.space, number).kind == Coordinate::Kind::circle;
  change.degree = 1;
  change.d[1] = multiplier * (circle ? circleDifference(edge.from[i], edge.to[i])
                                     : Quad(edge.to[i]) - Quad(edge.from[i]));
  return change;
}

/// Returns the magnitude to which the rounding errors of component i of the configuration are
/// proportional. On a piece of degree n, this is n times the largest coefficient; on an edge, the
/// larger magnitude of the component in both states.
double largestOf(const Edge& edge, Eigen::Index i) {
  return edge.piece ? edge.piece->degree() * edge.piece->coefficients.row(i).cwiseAbs().maxCoeff()
                    : std::max(std::abs(edge.from[i]), std::abs(edge.to[i]));
}

/// Upper bounds of the norm, the rate and the acceleration of a vector of up to three polynomials.
/// The vector and its derivatives are polynomials in Bernstein form, so each is bounded by the norm
/// of its longest coefficient.
struct Size {
  double way = 0, rate = 0, bend = 0;
};
Size sizeOf(std::span<const Polynomial<Quad>> vector) {
  Size size;
  const auto longest = [&](std::size_t i, int order) {
    Vec<Quad> v;
    for (std::size_t k = 0; k < vector.size(); ++k) {
      const auto& d = vector[k].d;
      v[k] = order == 0   ? d[i]
             : order == 1 ? d[i + 1] - d[i]
                          : (d[i + 2] - d[i + 1]) - (d[i + 1] - d[i]);
    }
    return static_cast<double>(length(v));
  };
  const int n = vector[0].degree;
  for (int i = 0; i <= n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    size.way = std::max(size.way, longest(k, 0));
    if (i < n) size.rate = std::max(size.rate, n * longest(k, 1));
    if (i + 1 < n) size.bend = std::max(size.bend, n * (n - 1) * longest(k, 2));
  }
  return size;
}

}  // namespace

Quad circleDifference(double from, double to) {
  return withoutTurns(sum(to, -Quad(from)));
}

template <>
void Curve<Quad>::addRotation(const Edge& edge, std::size_t number, const Vec<Quad>& aside,
                              Element& e) {
  e.q0 = normalised(edge.from.data() + number);
  e.q1 = normalised(edge.to.data() + number);
  Quad product = 0, less = 0, more = 0;
  for (std::size_t i = 0; i < 4; ++i) product += e.q0[i] * e.q1[i];
  if (product < 0)
    for (Quad& x : e.q1) x = -x;
  for (std::size_t i = 0; i < 4; ++i) {
    less += (e.q1[i] - e.q0[i]) * (e.q1[i] - e.q0[i]);
    more += (e.q1[i] + e.q0[i]) * (e.q1[i] + e.q0[i]);
  }
  e.omega = 2 * atan2q(sqrtq(less), sqrtq(more));
  e.sineOfOmega = sinq(e.omega);
  const Quad angle = audit::length(aside);
  if (angle > 0) e.stray = turnAbout(unit(aside), sinq(angle), cosq(angle));
  turned_ += 2 * static_cast<double>(e.omega);
  turning_ += e.omega > 0;
}

template <>
void Curve<Quad>::add(const Edge& edge, std::size_t index, bool inverted,
                      const Perturbation& stray) {
  const Frame& f = edge.tree.frames[index];
  Element e;
  e.inverted = inverted;
  e.joint = f.joint;
  const double q[] = {f.fixed.q.x(), f.fixed.q.y(), f.fixed.q.z(), f.fixed.q.w()};
  e.fixed = {rotationOf(normalised(q)), Vec<Quad>(f.fixed.p)};
  e.axis = unit(Vec<Quad>(f.axis));
  const bool held = f.variable == Frame::noVariable;
  const auto strayOf = [&](std::size_t number) { return stray.empty() ? Quad(0) : stray[number]; };
  const auto first = static_cast<Eigen::Index>(held ? 0 : f.variable);
  length_ += f.fixed.p.norm();
  if (f.joint == Frame::Joint::revolute || f.joint == Frame::Joint::prismatic) {
    // multiplier·q has at most 106 bits, so it is exact. Adding the offset is exact, too, until
    // whole revolutions are removed.
    Twofold value{f.offset, 0};
    if (!held) {
      value = sum(Quad(f.multiplier) * edge.from[first], f.offset);
      e.change = changeOf(edge, f.variable, f.multiplier);
      largest_ = std::max(largest_, std::abs(f.multiplier) * largestOf(edge, first));
    }
    const Quad aside = held ? Quad(0) : f.multiplier * strayOf(f.variable);
    const Size size = sizeOf({&e.change, 1});
    if (f.joint == Frame::Joint::revolute) {
      e.value = withoutTurns(value) + aside;
      e.turns = size.way > 0;
      turned_ += size.rate;
      turnBend_ += size.bend;
      terms_ += e.change.degree * size.way;
      turning_ += e.turns;
    } else {
      e.value = value.high + value.low + aside;
      slid_ += size.rate;
      slideBend_ += size.bend;
      length_ += static_cast<double>(magnitude(e.value)) + size.way;
    }
  }
  if (f.joint == Frame::Joint::translation && !held) {
    for (std::size_t k = 0; k < f.count; ++k) {
      e.shift[k] = edge.from[first + static_cast<Eigen::Index>(k)] + strayOf(f.variable + k);
      e.shiftChange[k] = changeOf(edge, f.variable + k, 1);
    }
    const Size size = sizeOf(e.shiftChange);
    slid_ += size.rate;
    slideBend_ += size.bend;
    length_ += static_cast<double>(audit::length(e.shift)) + size.way;
  }
  if (f.joint == Frame::Joint::rotation && !held)
    addRotation(edge, f.variable,
                {strayOf(f.variable), strayOf(f.variable + 1), strayOf(f.variable + 2)}, e);
  elements_.push_back(e);
}

template <>
Curve<Quad>::Curve(const Edge& edge, std::size_t watcher, std::size_t watched,
                   const Perturbation& stray) {
  std::vector<std::size_t> up, down;
  // The index of a parent is smaller than those of its children.
  for (std::size_t a = watcher, b = watched; a != b;) {
    if (a > b) {
      up.push_back(a);
      a = edge.tree.frames[a].parent;
    } else {
      down.push_back(b);
      b = edge.tree.frames[b].parent;
    }
  }
  std::reverse(down.begin(), down.end());
  for (const std::size_t f : up) add(edge, f, true, stray);
  for (const std::size_t f : down) add(edge, f, false, stray);
}

}  // namespace corridor::audit
