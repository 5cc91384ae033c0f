#include "tests/stress/audit/curve.h"

#include <algorithm>

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

}  // namespace

Quad circleDifference(double from, double to) {
  return withoutTurns(sum(to, -Quad(from)));
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
  const auto wayOf = [&](std::size_t number) {
    const auto i = static_cast<Eigen::Index>(number);
    return coordinateOf(edge.space, number).kind == Coordinate::Kind::circle
               ? circleDifference(edge.from[i], edge.to[i])
               : Quad(edge.to[i]) - Quad(edge.from[i]);
  };
  if (f.joint == Frame::Joint::revolute || f.joint == Frame::Joint::prismatic) {
    // multiplier·q is exact in 106 bits. The sum with the offset stays exact until whole
    // revolutions are removed.
    Twofold value{f.offset, 0};
    if (!held) {
      value = sum(Quad(f.multiplier) * edge.from[first], f.offset);
      e.way = f.multiplier * wayOf(f.variable);
      largest_ = std::max({largest_, std::abs(f.multiplier * edge.from[first]),
                           std::abs(f.multiplier * edge.to[first])});
    }
    const Quad aside = held ? Quad(0) : f.multiplier * strayOf(f.variable);
    const auto way = static_cast<double>(magnitude(e.way));
    if (f.joint == Frame::Joint::revolute) {
      e.value = withoutTurns(value) + aside;
      turned_ += way;
      turning_ += e.way != 0;
    } else {
      e.value = value.high + value.low + aside;
      slid_ += way;
      length_ += static_cast<double>(magnitude(e.value)) + way;
    }
  }
  if (f.joint == Frame::Joint::translation && !held) {
    for (std::size_t k = 0; k < f.count; ++k) {
      e.shift[k] = edge.from[first + static_cast<Eigen::Index>(k)] + strayOf(f.variable + k);
      e.shiftWay[k] = wayOf(f.variable + k);
    }
    const auto way = static_cast<double>(audit::length(e.shiftWay));
    slid_ += way;
    length_ += static_cast<double>(audit::length(e.shift)) + way;
  }
  if (f.joint == Frame::Joint::rotation && !held) {
    e.q0 = normalised(edge.from.data() + first);
    e.q1 = normalised(edge.to.data() + first);
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
    const Vec<Quad> aside(strayOf(f.variable), strayOf(f.variable + 1), strayOf(f.variable + 2));
    const Quad angle = audit::length(aside);
    if (angle > 0) e.stray = turnAbout(unit(aside), sinq(angle), cosq(angle));
    turned_ += 2 * static_cast<double>(e.omega);
    turning_ += e.omega > 0;
  }
  elements_.push_back(e);
}

template <>
Curve<Quad>::Curve(const Edge& edge, std::size_t watcher, std::size_t watched,
                   const Perturbation& stray) {
  std::vector<std::size_t> up, down;
  for (std::size_t a = watcher, b = watched; a != b;) {  // parents come before their children
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
