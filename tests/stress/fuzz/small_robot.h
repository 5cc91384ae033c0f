#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "collision/geometry/mesh_health.h"
#include "collision/motion/edge_method.h"
#include "planner/robot/edge_motion.h"
#include "planner/verify/verify_path.h"
#include "tests/stress/fuzz/decode.h"
#include "tests/stress/fuzz/fuzz.h"

/// Shared code of the targets that compare the checker with the verifier: it makes a small robot
/// among small bodies from bytes, and tests that the checker and the verifier do not contradict
/// each other.
namespace corridor::fuzz {

struct Shape {
  TriangleMesh mesh;
  std::vector<ConvexPart> parts;  ///< empty if the shape is a mesh
  bool solid = false;
  std::size_t frame = 0;
};

struct Robot {
  KinematicTree tree;
  ConfigurationSpace space;
  Configuration from, to, tube;
  std::vector<Shape> shapes;
  double size = 0;   ///< sum of all lengths, metres: the scale of rounding
  double angle = 0;  ///< sum of the largest angles of all revolute joints, radians: `framePoses`
                     ///< rounds these angles to double

  std::size_t variable(Coordinate::Kind kind) {
    Coordinate c;
    c.kind = kind;
    return space.coordinates()[space.add(c)].first;
  }
};

inline void addJoint(Decoder& in, Robot& robot) {
  using Kind = Coordinate::Kind;
  Frame frame;
  frame.parent = in.oneIn(4) ? in.below(robot.tree.frames.size()) : robot.tree.frames.size() - 1;
  frame.fixed = in.pose();
  frame.axis = in.direction();
  switch (in.below(8)) {
    case 0:  // floating
      frame.joint = Frame::Joint::translation;
      frame.count = 3;
      frame.variable = robot.variable(Kind::line);
      robot.variable(Kind::line), robot.variable(Kind::line);
      break;
    case 1:  // planar
      frame.joint = Frame::Joint::translation;
      frame.count = 2;
      frame.variable = robot.variable(Kind::line);
      robot.variable(Kind::line);
      break;
    case 2:
      frame.joint = Frame::Joint::prismatic;
      frame.variable = robot.variable(Kind::line);
      break;
    case 3: {  // mimics the first line or circle coordinate; held still if there is none
      frame.joint = in.oneIn(2) ? Frame::Joint::prismatic : Frame::Joint::revolute;
      frame.multiplier = in.real();
      frame.offset = in.real();
      for (const Coordinate& c : robot.space.coordinates())
        if (c.kind != Kind::rotation && frame.variable == Frame::noVariable)
          frame.variable = c.first;
      break;
    }
    case 4:
      frame.joint = Frame::Joint::revolute;
      frame.variable = robot.variable(Kind::circle);
      break;
    default:
      frame.joint = Frame::Joint::revolute;
      frame.variable = robot.variable(Kind::line);
  }
  const std::size_t added = robot.tree.add(frame);
  if (frame.joint != Frame::Joint::translation) return;
  Frame turn;
  turn.parent = added;
  turn.joint = frame.count == 3 ? Frame::Joint::rotation : Frame::Joint::revolute;
  turn.variable = robot.variable(frame.count == 3 ? Kind::rotation : Kind::circle);
  robot.tree.add(turn);
}

inline void decodeEdge(Decoder& in, Robot& robot) {
  const auto size = static_cast<Eigen::Index>(robot.space.size());
  robot.from = robot.to = robot.tube = Configuration::Zero(size);
  const bool tube = in.oneIn(3);
  const bool little = in.oneIn(3);
  for (const Coordinate& c : robot.space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation) {
      robot.from.segment<4>(i) = in.quaternion().coeffs();
      robot.to.segment<4>(i) = in.quaternion().coeffs();
    } else {
      robot.from[i] = in.real();
      robot.to[i] = little ? robot.from[i] + 1e-3 * in.real() : in.real();
      if (c.kind == Coordinate::Kind::circle && in.oneIn(4))  // many revolutions
        (in.oneIn(2) ? robot.from : robot.to)[i] *= std::pow(10.0, in.below(25));
    }
    if (tube) robot.tube[i] = std::min(std::abs(in.real()), 1.0) * 1e-3;
  }
}

/// Adds to the robot's `size` and `angle` the lengths and angles of its frames, states and shapes.
/// @pre both members are 0.
inline void setSize(Robot& robot) {
  const auto length = [](const Vec3& v) { return v.stableNorm(); };
  for (const Shape& shape : robot.shapes) {
    double most = 0, radius = 0;
    for (const Vec3& v : shape.mesh.vertices) most = std::max(most, length(v));
    for (const ConvexPart& part : shape.parts) {
      for (const Vec3& v : part.points) most = std::max(most, length(v));
      radius = std::max(radius, part.radius);
    }
    robot.size += most + radius;
  }
  for (const Frame& frame : robot.tree.frames) {
    robot.size += length(frame.fixed.p);
    if (frame.joint == Frame::Joint::revolute && frame.variable != Frame::noVariable) {
      const auto i = static_cast<Eigen::Index>(frame.variable);
      robot.angle +=
          std::abs(frame.offset) +
          std::abs(frame.multiplier) * std::max(std::abs(robot.from[i]), std::abs(robot.to[i]));
    }
    if (frame.joint == Frame::Joint::prismatic || frame.joint == Frame::Joint::translation) {
      double most = std::abs(frame.offset);
      if (frame.variable != Frame::noVariable)
        for (std::size_t k = 0; k < frame.count; ++k) {
          const auto i = static_cast<Eigen::Index>(frame.variable + k);
          most +=
              std::abs(frame.multiplier) * std::max(std::abs(robot.from[i]), std::abs(robot.to[i]));
        }
      robot.size += most;
    }
  }
}

/// Returns a robot with bodies, or nullopt if the bytes make an invalid mesh or lengths that
/// overflow.
inline std::optional<Robot> decodeRobot(Decoder& in) {
  Robot robot;
  for (std::size_t n = 1 + in.below(4); n > 0; --n) addJoint(in, robot);
  decodeEdge(in, robot);
  const std::size_t bodies = 2 + in.below(3);
  for (std::size_t n = 0; n < bodies; ++n) {
    Shape shape;
    // The first body is on the last frame; the second is fixed in the world.
    shape.frame = n == 0   ? robot.tree.frames.size() - 1
                  : n == 1 ? 0
                           : in.below(robot.tree.frames.size());
    const std::size_t kind = in.below(4);
    shape.solid = kind == 1;
    if (kind == 0)
      for (std::size_t count = in.oneIn(2) ? 1 : 1 + in.below(5); count > 0; --count)
        shape.parts.push_back(in.part());
    else
      shape.mesh = shape.solid ? in.closedMesh() : in.mesh();
    if (kind != 0 && checkMesh(shape.mesh)) return std::nullopt;
    robot.shapes.push_back(std::move(shape));
  }
  setSize(robot);
  if (!std::isfinite(robot.size)) return std::nullopt;
  return robot;
}

inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// The scene of a robot for the checker, and the same data for the verifier. Keeps references to
/// the robot, which must outlive this object.
struct Comparison {
  PathProblem problem;
  Scene scene;
  MotionOptions options;
  EdgeMethod method = EdgeMethod::certified;
  double rounding = 0;   ///< metres: a distance below which checker and verifier may disagree
  std::string who = {};  ///< for messages: the method and the trees
};

/// Returns what is needed to compare checker and verifier on a robot, or nullopt if the robot makes
/// no valid scene.
inline std::optional<Comparison> comparisonOf(const Robot& robot, Decoder& in) {
  PathProblem problem;
  problem.tree = &robot.tree;
  problem.space = &robot.space;
  problem.tube = robot.tube;
  std::vector<Scene::Placed> bodies;
  for (const Shape& shape : robot.shapes) {
    problem.bodies.push_back({"body " + std::to_string(bodies.size()),
                              shape.parts.empty() ? &shape.mesh : nullptr, shape.parts, shape.solid,
                              shape.frame});
    const std::string name = problem.bodies.back().name;
    try {
      bodies.push_back(
          {shape.parts.empty() ? Body(name, shape.mesh, shape.solid) : Body(name, shape.parts),
           shape.frame});
    } catch (const std::invalid_argument&) {
      if (!shape.solid) throw;
      return std::nullopt;  // corners coincide, so the surface is not closed
    }
  }
  std::vector<Scene::Pair> pairs;
  for (std::size_t b = 1; b < bodies.size(); ++b)
    for (std::size_t a = 0; a < b; ++a)
      if (bodies[a].frame != bodies[b].frame) {
        pairs.push_back({a, b});
        problem.pairs.push_back({a, b});
      }
  Comparison c{std::move(problem), Scene(std::move(bodies), std::move(pairs)), {}};
  // A joint's angle, multiplier·q + offset, is off by at most 2^-53 times the sum of the magnitudes
  // of its terms and of its result.
  c.rounding = (0x1p-40 + 0x1p-51 * robot.angle) * robot.size;
  c.options.tolerance = std::max(c.scene.defaultTolerance(), 4 * c.rounding);
  c.options.clearanceSlack = c.options.tolerance;
  c.options.margin = in.oneIn(3) ? std::min(std::abs(in.real()), 0.1) : 0;
  c.options.earliest = in.oneIn(4);
  c.options.workLimit = 20'000;
  c.options.trees = static_cast<TreeKind>(in.below(10));
  c.method = static_cast<EdgeMethod>(in.oneIn(2) ? 0 : in.below(3));
  if (!(c.options.tolerance > 0) || !std::isfinite(c.options.tolerance)) return std::nullopt;
  c.problem.margin = c.options.margin;
  c.problem.tolerance = 0.1 * c.options.tolerance;
  c.problem.workLimit = 1'000;
  c.who = edgeMethodNames()[static_cast<std::size_t>(c.method)] + ", trees " +
          std::to_string(static_cast<int>(c.options.trees)) + ": ";
  return c;
}

/// Fails if the checker and the verifier contradict each other about a motion. `undecided`
/// contradicts nothing.
inline void requireAgreement(const Comparison& c, const MotionResult& checked,
                             const PathReport& verified) {
  if (checked.verdict == MotionVerdict::free && verified.verdict == PathVerdict::refuted)
    for (const PathFinding& finding : verified.findings)
      if (finding.verdict == PathVerdict::refuted)
        fail(c.who + "free, but refuted at t = " + number(finding.t) + " (" + finding.reason +
             "), gap " + number(finding.gap) + ", " + finding.a + " and " + finding.b);
  // The checker finds contacts at rounded poses, so a contact may be off by the rounding.
  if (checked.verdict == MotionVerdict::contact && verified.verdict == PathVerdict::proved &&
      verified.provedClearance > c.options.margin + c.rounding)
    fail(c.who + "contact at t = " + number(checked.time) + ", but proved with a clearance of " +
         number(verified.provedClearance));
}

/// Compares the checker with the verifier on the robot's edge, and on the edge's two states.
inline void compareEdge(const Robot& robot, Decoder& in) {
  auto comparison = comparisonOf(robot, in);
  if (!comparison) return;
  Comparison& c = *comparison;
  EdgeMotion motion(robot.tree, robot.space, c.scene.framePairs(), robot.tube);
  motion.set(robot.from, robot.to);
  QueryContext context;
  requireAgreement(c, c.scene.certify(motion, c.options, context, c.method),
                   verifyPath(c.problem, {robot.from, robot.to}));

  // The two states of the edge are compared without margin and tube.
  c.problem.margin = 0;
  c.problem.tube.setZero();
  for (const Configuration& q : {robot.from, robot.to}) {
    const std::vector<Transform> X_WF = framePoses(robot.tree, q);
    const bool touches = c.scene.interference(X_WF, context, c.options.trees).has_value();
    const double clearance = c.scene.clearance(X_WF, context, c.options.trees);
    const PathReport state = verifyPath(c.problem, {q});
    if (touches != (clearance == 0)) fail(c.who + "contact, at a distance of " + number(clearance));
    if (touches && state.verdict == PathVerdict::proved && state.provedClearance > c.rounding)
      fail(c.who + "the scene reports contact in a state that is verified with a clearance of " +
           number(state.provedClearance));
    if (clearance > c.rounding && state.verdict == PathVerdict::refuted)
      fail(c.who + "a state refuted (" + state.findings.front().reason + ") at a clearance of " +
           number(clearance));
    if (state.provedClearance > clearance + c.rounding)
      fail(c.who + "the verifier proves a clearance of " + number(state.provedClearance) +
           " in a state, but the scene measures " + number(clearance));
  }
}

}  // namespace corridor::fuzz
