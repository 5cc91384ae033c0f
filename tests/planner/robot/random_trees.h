#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "collision/world/scene.h"
#include "planner/robot/kinematic_tree.h"

namespace corridor::test {

/// Random robots and edges with everything that a tree may contain: all kinds of joints, branches,
/// fixed frames, held joints, joints that mimic another joint (with negative multipliers, or on
/// another branch), parallel and intersecting axes, and quaternions and axes of any length.
class RandomTrees {
 public:
  explicit RandomTrees(std::uint64_t seed) : random_(seed) {}

  double real(double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  std::size_t randomIndex(std::size_t count) {
    return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_);
  }
  bool oneIn(std::size_t n) { return randomIndex(n) == 0; }
  Vec3 vector(double size = 1) { return size * Vec3(real(), real(), real()); }
  Vec3 direction() { return vector().normalized(); }

  KinematicTree tree;
  ConfigurationSpace space;
  Configuration from, to;

  /// Makes a tree of `joints` joints. Most joints have one or more degrees of freedom; some are
  /// held, or mimic another joint. Each world coordinate of the tree's base is between -far and
  /// far, metres.
  void makeTree(std::size_t joints, double far = 1) {
    tree = {};
    space = {};
    for (std::size_t n = 0; n < joints; ++n) {
      Frame frame;
      // Mostly unbranched chains.
      frame.parent = n == 0     ? 0
                     : oneIn(4) ? randomIndex(tree.frames.size())
                                : tree.frames.size() - 1;
      frame.fixed.p = oneIn(5) ? Vec3::Zero() : vector(n == 0 ? far : 0.5);
      if (!oneIn(3)) frame.fixed.q = quaternion();
      if (oneIn(6)) {
        frame.parent = tree.add(frame);  // a fixed frame first
        frame.fixed.p = vector(0.2);
      }
      addJoint(frame);
    }
  }

  /// Makes an edge between two random configurations. @param size scales the change of each
  /// coordinate, rad or m. @param range the bound of the start's line coordinates.
  void makeEdge(double size, double range = 3) {
    from = Configuration(static_cast<Eigen::Index>(space.size()));
    to = from;
    for (const Coordinate& c : space.coordinates()) {
      const auto i = static_cast<Eigen::Index>(c.first);
      if (c.kind == Coordinate::Kind::rotation) {
        const Eigen::Quaterniond a = quaternion();
        const double angle = oneIn(4) ? std::pow(10.0, real(-18, 0)) : std::min(3.1, size) * real();
        from.segment<4>(i) = a.coeffs();
        to.segment<4>(i) =
            (Eigen::Quaterniond(Eigen::AngleAxisd(angle, direction())) * a).coeffs() *
            (oneIn(4) ? -3 : 1);
        if (oneIn(6)) to.segment<4>(i) = from.segment<4>(i);
        continue;
      }
      from[i] = real(-range, range);
      to[i] = oneIn(6) ? from[i] : from[i] + size * real();
      if (c.kind == Coordinate::Kind::circle) {
        const double pi = std::numbers::pi;
        from[i] = real(-pi, pi);
        to[i] = oneIn(6) ? from[i] : std::remainder(from[i] + std::min(3.1, size) * real(), 2 * pi);
      }
    }
  }

  Scene::FramePair pair() {
    const std::size_t a = randomIndex(tree.frames.size()), b = randomIndex(tree.frames.size());
    return {std::min(a, b), std::max(a, b)};
  }

  Configuration noTube() const {
    return Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  }

 private:
  Eigen::Quaterniond quaternion() {
    const double size = std::pow(10.0, oneIn(4) ? real(-2, 2) : 0);
    return Eigen::Quaterniond(
        Eigen::Vector4d(size * real(), size * real(), size * real(), size * real()));
  }

  void addJoint(Frame frame) {
    frame.axis = oneIn(3) ? Vec3::Unit(static_cast<Eigen::Index>(randomIndex(3)))
                          : vector(std::pow(10.0, real(-2, 2)));
    const std::size_t kind = randomIndex(12);
    if (kind == 0 || kind == 1) {  // planar or floating
      const bool planar = kind == 0;
      frame.joint = Frame::Joint::translation;
      frame.count = planar ? 2 : 3;
      for (std::size_t k = 0; k < frame.count; ++k) {
        const std::size_t number = addCoordinate(Coordinate::Kind::line);
        if (k == 0) frame.variable = number;
      }
      Frame turn;
      turn.parent = tree.add(frame);
      turn.joint = planar ? Frame::Joint::revolute : Frame::Joint::rotation;
      turn.variable = addCoordinate(planar ? Coordinate::Kind::circle : Coordinate::Kind::rotation);
      tree.add(turn);
      return;
    }
    frame.joint = kind <= 4 ? Frame::Joint::prismatic : Frame::Joint::revolute;
    if (oneIn(8)) {
      frame.offset = real(-3, 3);  // held
    } else {
      const std::size_t other = followed();
      if (other != Frame::noVariable) {
        frame.variable = other;
        frame.multiplier = oneIn(3) ? -1 : real(-2, 2);
        frame.offset = oneIn(2) ? 0 : real();
      } else {
        frame.variable = addCoordinate(frame.joint == Frame::Joint::revolute && oneIn(3)
                                           ? Coordinate::Kind::circle
                                           : Coordinate::Kind::line);
      }
    }
    tree.add(frame);
  }

  /// Returns the variable of a random revolute or prismatic joint, which the new joint shall mimic.
  /// In most cases returns Frame::noVariable: the new joint mimics none.
  std::size_t followed() {
    if (!oneIn(4)) return Frame::noVariable;
    const Frame& other = tree.frames[randomIndex(tree.frames.size())];
    const bool single =
        other.joint == Frame::Joint::revolute || other.joint == Frame::Joint::prismatic;
    if (!single || other.variable == Frame::noVariable) return Frame::noVariable;
    for (const Coordinate& c : space.coordinates())
      if (c.first == other.variable && c.kind == Coordinate::Kind::line) return other.variable;
    return Frame::noVariable;
  }

  std::size_t addCoordinate(Coordinate::Kind kind) {
    Coordinate c;
    c.kind = kind;
    const std::size_t n = space.add(c);
    return space.coordinates()[n].first;
  }

  std::mt19937_64 random_;
};

}  // namespace corridor::test
