#include "tests/stress/audit/families.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace corridor::audit {
namespace {

using std::numbers::pi;
using Kind = Coordinate::Kind;

/// Makes a kinematic tree and an edge in its configuration space, one coordinate at a time.
struct Maker {
  explicit Maker(Dice& d) : dice(d) {}

  Dice& dice;
  double scale = 1, step = 1, slideAt = 1, valueAt = 3;
  bool circles = true, still = false, halfTurn = false;
  Edge edge;
  std::vector<double> from, to;

  std::size_t coordinate(Kind kind) {
    Coordinate c;
    c.kind = kind;
    const std::size_t first = edge.space.coordinates()[edge.space.add(c)].first;
    return first;
  }
  Eigen::Quaterniond quaternion() {
    Eigen::Vector4d q(dice.real(), dice.real(), dice.real(), dice.real());
    return Eigen::Quaterniond(dice.oneIn(3) ? Eigen::Vector4d(q * dice.power(-2, 2)) : q);
  }
  void number(double a, double b) {
    from.push_back(a);
    to.push_back(still ? a : b);
  }
  std::size_t line(double at, double most) {
    const double a = at * dice.real();
    number(a, dice.oneIn(6) ? a : a + most * dice.real());
    return coordinate(Kind::line);
  }
  std::size_t circle() {
    const double a = dice.real(-pi, pi);
    double b = a + std::min(3.1, step) * dice.real();
    if (halfTurn) b = a + dice.sign() * (pi - dice.power(-8.69, -1));
    number(a, dice.oneIn(8) ? b : std::remainder(b, 2 * pi));
    return coordinate(Kind::circle);
  }
  std::size_t rotation() {
    const Eigen::Quaterniond a = quaternion();
    const double angle = halfTurn ? pi - dice.power(-8.69, -1) : std::min(3.1, step) * dice.real();
    const Eigen::Quaterniond b =
        Eigen::Quaterniond(Eigen::AngleAxisd(angle, dice.vector().normalized())) * a;
    const double times = dice.oneIn(4) ? -3 : 1;
    for (int i = 0; i < 4; ++i) number(a.coeffs()[i], times * b.coeffs()[i]);
    return coordinate(Kind::rotation);
  }
  Frame place(std::size_t parent, double far) {
    Frame f;
    f.parent = parent;
    f.fixed.p = dice.oneIn(6) ? Vec3::Zero() : Vec3(far * dice.vector());
    if (!dice.oneIn(3)) f.fixed.q = quaternion();
    return f;
  }
  std::size_t single(std::size_t parent) {
    Frame f = place(parent, 0.7 * scale);
    f.axis = dice.oneIn(3) ? Vec3(Vec3::Unit(static_cast<Eigen::Index>(dice.index(3))))
                           : Vec3(dice.power(-2, 2) * dice.vector());
    if (dice.oneIn(3)) {
      f.joint = Frame::Joint::prismatic;
      f.variable = line(slideAt * scale, std::min(step, 3.0) * scale);
    } else {
      f.joint = Frame::Joint::revolute;
      f.variable = circles && dice.oneIn(3) ? circle() : line(valueAt, step);
    }
    if (dice.oneIn(10)) {  // constant along the edge
      f.offset = dice.real(-3, 3) * (f.joint == Frame::Joint::prismatic ? scale : 1);
      f.variable = Frame::noVariable;
    }
    return edge.tree.add(f);
  }
  std::size_t base(std::size_t parent, bool planar, double far = 0) {
    Frame shift = far > 0 ? place(parent, far) : Frame{};
    shift.parent = parent;
    shift.joint = Frame::Joint::translation;
    shift.count = planar ? 2 : 3;
    for (std::size_t k = 0; k < shift.count; ++k) {
      const std::size_t n = line(slideAt * 2 * scale, step * scale);
      if (k == 0) shift.variable = n;
    }
    Frame turn;
    turn.parent = edge.tree.add(shift);
    turn.joint = planar ? Frame::Joint::revolute : Frame::Joint::rotation;
    turn.variable = planar ? circle() : rotation();
    return edge.tree.add(turn);
  }
  std::size_t joints(std::size_t parent, std::size_t count) {
    for (; count > 0; --count) parent = single(parent);
    return parent;
  }
  /// Adds a joint that mimics another joint. The multiplier is an integer if the other joint has a
  /// circle coordinate, and arbitrary if it has a line coordinate.
  std::size_t follower(std::size_t parent) {
    Frame f = place(parent, 0.7 * scale);
    f.axis = dice.vector();
    std::vector<std::size_t> lines, around;
    for (const Coordinate& c : edge.space.coordinates()) {
      if (c.kind == Kind::line) lines.push_back(c.first);
      if (c.kind == Kind::circle) around.push_back(c.first);
    }
    const double whole[] = {-1, 1, -2, 2, 3, -3};
    if (!around.empty() && (lines.empty() || dice.oneIn(2))) {
      f.joint = Frame::Joint::revolute;
      f.variable = dice.of(std::span<const std::size_t>(around));
      f.multiplier = dice.of(std::span<const double>(whole));
    } else {
      f.joint = dice.oneIn(3) ? Frame::Joint::prismatic : Frame::Joint::revolute;
      f.variable = dice.of(std::span<const std::size_t>(lines));
      f.multiplier = dice.oneIn(4) ? -1 : dice.oneIn(4) ? 0.5 : dice.real(-2.5, 2.5);
      if (f.joint == Frame::Joint::prismatic) f.multiplier *= scale;
    }
    if (dice.oneIn(2)) f.offset = dice.real() * (f.joint == Frame::Joint::prismatic ? scale : 1);
    return edge.tree.add(f);
  }
  void onlyTurns(std::size_t count) {  // a chain of continuous joints
    std::size_t parent = 0;
    for (; count > 0; --count) {
      Frame f = place(parent, 0.7 * scale);
      f.axis = dice.vector();
      f.joint = Frame::Joint::revolute;
      f.variable = circle();
      parent = edge.tree.add(f);
    }
    edge.second = parent;
  }
  Edge done() {
    const auto n = static_cast<Eigen::Index>(from.size());
    edge.from = Eigen::Map<Configuration>(from.data(), n);
    edge.to = Eigen::Map<Configuration>(to.data(), n);
    edge.tube = Configuration::Zero(n);
    return edge;
  }
  void anything() {
    switch (dice.index(4)) {
      case 0:
        edge.second = base(0, true);
        break;
      case 1:
        edge.second = base(0, false);
        break;
      case 2:
        edge.second = joints(base(0, dice.oneIn(2)), 1 + dice.index(2));
        break;
      default:
        edge.second = joints(0, 1 + dice.index(4));
    }
  }
};

}  // namespace

std::string nameOf(Family family) {
  const char* names[] = {"planar body", "spatial body", "chain",        "branches",
                         "moving base", "mimics",       "far slides",   "many turns",
                         "half turns",  "nearly equal", "scales",       "offsets",
                         "tiny bodies", "reaching arm", "large circles"};
  return names[static_cast<std::size_t>(family)];
}

Edge randomEdge(Dice& dice, Family family, bool still, double& size) {
  Maker m(dice);
  m.still = still;
  m.step = dice.power(-2, 0.3);
  double bodies = 1;
  switch (family) {
    case Family::planarBody:
      m.edge.second = m.base(0, true);
      break;
    case Family::spatialBody:
      m.edge.second = m.base(0, false);
      break;
    case Family::chain:
      m.edge.second = m.joints(0, 1 + dice.index(8));
      break;
    case Family::branches: {
      const std::size_t trunk = m.joints(0, dice.index(3));
      m.edge.first = m.joints(trunk, 1 + dice.index(3));
      m.edge.second = m.joints(trunk, 1 + dice.index(3));
      break;
    }
    case Family::movingBase:
      m.edge.second = m.joints(m.base(0, dice.oneIn(2), 1), 1 + dice.index(4));
      break;
    case Family::mimics: {
      std::size_t end = m.joints(m.base(0, true), dice.index(3));
      for (std::size_t n = 1 + dice.index(3); n > 0; --n) end = m.follower(end);
      m.edge.second = end;
      if (dice.oneIn(2)) m.edge.first = m.follower(0);
      break;
    }
    case Family::farSlides:
      m.slideAt = dice.power(1, 6);
      m.edge.second = m.joints(0, 1 + dice.index(4));
      break;
    case Family::manyTurns:
      m.circles = false;
      m.step = dice.power(0, 2.3);
      m.valueAt = dice.power(0, 7);
      m.edge.second = m.joints(0, 1 + dice.index(3));
      break;
    case Family::halfTurns:
      m.halfTurn = true;
      if (dice.oneIn(3))
        m.onlyTurns(1 + dice.index(2));
      else
        m.edge.second = m.base(0, dice.oneIn(2));
      break;
    case Family::nearlyEqual:
      m.step = dice.power(-17, -3);
      m.anything();
      break;
    case Family::scales:
      bodies = m.scale = dice.power(-6, 6);
      m.anything();
      break;
    case Family::offsets: {
      Frame far;
      far.fixed.p = dice.power(2, 6) * dice.vector();
      if (dice.oneIn(2)) {  // two moving bodies that meet far from the world's origin
        m.edge.first = m.base(0, dice.oneIn(2));
        m.edge.second = m.base(0, dice.oneIn(2));
        far.fixed.p[2] = 0;
        for (const Frame& f : m.edge.tree.frames)
          for (std::size_t k = 0; f.joint == Frame::Joint::translation && k < f.count; ++k)
            for (std::vector<double>* state : {&m.from, &m.to})
              (*state)[f.variable + k] += far.fixed.p[static_cast<Eigen::Index>(k)];
        break;
      }
      if (dice.oneIn(2)) {  // large translations: the bodies meet far from the world's origin
        m.slideAt = dice.power(2, 5);
        m.anything();
      } else {  // the robot is far from the world's origin
        const std::size_t base = m.edge.tree.add(far);
        m.edge.second = m.joints(base, 1 + dice.index(4));
        if (dice.oneIn(3)) m.edge.first = base;
      }
      break;
    }
    case Family::tinyBodies:
      bodies = 2e-5;
      m.slideAt = dice.real(40, 330);
      m.step = dice.power(-6, -2);
      m.anything();
      break;
    case Family::reachingArm: {
      bodies = 0.2;
      Frame turn = m.place(0, 0.7), slide;
      turn.joint = Frame::Joint::revolute;
      turn.variable = m.line(3, 0);
      slide.parent = m.edge.tree.add(turn);
      slide.joint = Frame::Joint::prismatic;
      slide.fixed.p = Vec3(dice.real(1, 3), 0, dice.real());
      slide.axis = Vec3(1, 0, dice.real());  // away from the axis of rotation
      slide.variable = m.line(1, 2);
      m.edge.second = m.edge.tree.add(slide);
      break;
    }
    case Family::largeCircles: {
      m.onlyTurns(1 + dice.index(3));
      if (dice.oneIn(3)) m.edge.second = m.base(m.edge.second, true);
      for (const Coordinate& c : m.edge.space.coordinates()) {
        if (c.kind != Kind::circle) continue;
        const std::size_t which = dice.index(3);
        const double large = dice.sign() * dice.power(4, dice.oneIn(2) ? 25 : 12);
        if (which != 0) m.from[c.first] = large;
        if (which != 1) m.to[c.first] = dice.oneIn(2) ? large : large * (1 + dice.power(-16, -1));
        if (still) m.to[c.first] = m.from[c.first];
      }
      break;
    }
  }
  size = bodies;
  return m.done();
}

bool isRigidBody(const Edge& edge) {
  return edge.first == 0 && edge.second == 2 && edge.tree.frames.size() == 3 &&
         edge.tree.frames[1].joint == Frame::Joint::translation &&
         edge.tree.frames[1].fixed.p.isZero(0) &&
         edge.tree.frames[1].fixed.q.coeffs() == Eigen::Vector4d(0, 0, 0, 1);
}

}  // namespace corridor::audit
