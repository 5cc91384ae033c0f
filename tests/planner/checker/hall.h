#pragma once

#include <memory>
#include <numbers>
#include <string>

#include <ompl/base/ScopedState.h>
#include <ompl/base/SpaceInformation.h>

#include "planner/checker/checker.h"
#include "planner/checker/problem_state_space.h"
#include "planner/model/model_builder.h"
#include "planner/problem/problem.h"

namespace corridor::test {

/// Returns the surface of a box with the edge lengths `size`, centred at `at`.
inline TriangleMesh boxMesh(const Vec3& size, const Vec3& at = Vec3::Zero()) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back(
        at + 0.5 * size.cwiseProduct(Vec3(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1)));
  mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                    {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return mesh;
}

inline PlacedShape meshShape(const std::string& name, const TriangleMesh& mesh) {
  return shapeOf(name, mesh);
}

inline PlacedShape partShape(const std::string& name, const Primitive& primitive,
                             const Vec3& at = Vec3::Zero()) {
  return shapeOf(name, primitive, {at, Eigen::Quaterniond::Identity()});
}

/// Returns a tube whose half widths are 2^-40 of the range of each coordinate (for circles and
/// rotations: of 2π). This equals the default tube if all coordinates of the kind `line` have the
/// same range.
inline Configuration roundingTube(const ConfigurationSpace& space) {
  Configuration tube = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  for (const Coordinate& c : space.coordinates())
    tube[static_cast<Eigen::Index>(c.first)] =
        0x1p-40 * (c.kind == Coordinate::Kind::line ? c.upper - c.lower : 2 * std::numbers::pi);
  return tube;
}

enum class Rigid { SE2, SE3 };

/// Returns a problem of one rigid body in [−5, 5]² or [−5, 5]³, without shapes and obstacles.
inline Problem rigidProblem(Rigid kind, double rotationWeight = 1) {
  using Kind = Coordinate::Kind;
  Problem problem;
  problem.model.robots.resize(1);
  const bool spatial = kind == Rigid::SE3;
  CoordinateGroup group{
      spatial ? CoordinateGroup::Kind::floating : CoordinateGroup::Kind::planar, "bar", {}};
  for (const char* name : {"x", "y", "z"})
    if (spatial || *name != 'z')
      group.coordinates.push_back(problem.model.space.add({Kind::line, name, 0, -5, 5, false, 1}));
  group.coordinates.push_back(
      problem.model.space.add({spatial ? Kind::rotation : Kind::circle,
                               spatial ? "rotation" : "yaw", 0, 0, 0, true, rotationWeight}));
  problem.model.space.addGroup(group);
  Frame shift, turn;
  shift.name = "bar's position";
  shift.joint = Frame::Joint::translation;
  shift.variable = 0;
  shift.count = spatial ? 3 : 2;
  turn.name = "bar";
  turn.parent = problem.model.tree.add(shift);
  turn.joint = spatial ? Frame::Joint::rotation : Frame::Joint::revolute;
  turn.variable = shift.count;
  problem.model.tree.add(turn);
  problem.task.tube = roundingTube(problem.model.space);
  return problem;
}

inline Configuration poseOf(Rigid kind, double x, double y, double yaw = 0) {
  Configuration q(kind == Rigid::SE3 ? 7 : 3);
  if (kind == Rigid::SE3)
    q << x, y, 0, 0, 0, std::sin(yaw / 2), std::cos(yaw / 2);
  else
    q << x, y, yaw;
  return q;
}

/// Returns a problem: a bar of 1 × 0.2 × 0.2 in a hall of [−5, 5]³. A wall of thickness 0.001 at x
/// = 0 has a gap above y = 2. Start and goal are on different sides of the wall. @param
/// edges,volume the values of these keys in `checker: {edges: …, volume: …}`.
inline Problem hallProblem(Rigid kind, const std::string& edges = "certified",
                           const std::string& volume = "obb") {
  Problem problem = rigidProblem(kind);
  problem.settings.checker.edges = edgeMethodNamed(edges).value();
  problem.settings.checker.trees.volume = volume;
  problem.source.file = "hall.yaml";
  problem.source.name = "hall";
  problem.model.bodies = {
      {"bar", 2, 0, {meshShape("bar", boxMesh({1, 0.2, 0.2}))}},
      {"wall", 0, {}, {meshShape("wall", boxMesh({0.001, 7, 10}, {0, -1.5, 0}))}}};
  problem.task.start = poseOf(kind, -3, -2);
  problem.task.goals = {poseOf(kind, 3, -2, 3)};
  problem.settings.planner.time = 20;
  problem.source.lines = {{"start", 4},
                          {"goal", 5},
                          {"planner", 7},
                          {"planner.name", 8},
                          {"planner.params.range", 9},
                          {"sampler", 11},
                          {"objective", 12}};
  return problem;
}

/// The problem of the hall, with the OMPL objects for it.
struct Hall {
  explicit Hall(Rigid rigid, const std::string& edges = "certified",
                const std::string& volume = "obb")
      : kind(rigid),
        problem(hallProblem(rigid, edges, volume)),
        checker(problem),
        space(std::make_shared<ProblemStateSpace>(problem.model.space)),
        si(std::make_shared<ompl::base::SpaceInformation>(space)) {}

  Configuration at(double x, double y, double yaw = 0) const { return poseOf(kind, x, y, yaw); }
  ompl::base::ScopedState<> scoped(const Configuration& q) const {
    ompl::base::ScopedState<> state(si);
    space->write(q, state.get());
    return state;
  }

  Rigid kind;
  Problem problem;
  Checker checker;
  std::shared_ptr<ProblemStateSpace> space;
  ompl::base::SpaceInformationPtr si;
};

/// Returns a problem of an arm in the plane z = 0 with three links of 1 m. The shapes of the first
/// two links are capsules, that of the third is a mesh. Joints about z are at the origin and
/// between the links. The obstacles are a post at (1.2, 1.2) and a slab.
inline Problem armProblem() {
  using Kind = Coordinate::Kind;
  Problem problem;
  problem.source.file = "arm.yaml";
  problem.source.name = "arm";
  problem.model.robots.resize(1);
  CoordinateGroup group;
  std::size_t parent = 0;
  const char* names[] = {"shoulder", "elbow", "wrist"};
  for (std::size_t i = 0; i < 3; ++i) {
    // The shoulder is continuous.
    group.coordinates.push_back(problem.model.space.add(
        {i == 0 ? Kind::circle : Kind::line, names[i], 0, -2.5, 2.5, true, 1}));
    Frame frame;
    frame.name = names[i];
    frame.parent = parent;
    if (i > 0) frame.fixed.p = {1, 0, 0};
    frame.joint = Frame::Joint::revolute;
    frame.variable = i;
    parent = problem.model.tree.add(frame);
  }
  problem.model.space.addGroup(group);
  const Capsule capsule{0.1, 0.8};
  PlacedShape upper = partShape("upper", capsule), lower = partShape("lower", capsule);
  for (PlacedShape* shape : {&upper, &lower})  // along x
    shape->parts.at(0).points = {{0.1, 0, 0}, {0.9, 0, 0}};
  problem.model.bodies = {
      {"upper", 1, 0, {upper}},
      {"lower", 2, 0, {lower}},
      {"hand",
       3,
       0,
       {meshShape("hand/1", boxMesh({0.5, 0.1, 0.1}, {0.3, 0, 0})),
        meshShape("hand/2", boxMesh({0.1, 0.4, 0.1}, {0.55, 0, 0}))}},
      {"post", 0, {}, {partShape("post", Cylinder{0.1, 2}, {1.2, 1.2, 0})}},
      {"slab", 0, {}, {meshShape("slab", boxMesh({0.05, 1, 1}, {-1.5, 0, 0}))}}};
  problem.model.filter.skip(0, 1, "adjacent");
  problem.model.filter.skip(1, 2, "adjacent");
  problem.task.start = Configuration::Zero(3);
  problem.task.goals = {Configuration(Vec3(2.0, -0.5, 0.3))};
  problem.task.tube = roundingTube(problem.model.space);
  problem.settings.planner.time = 20;
  problem.source.lines = {{"start", 4}, {"goal", 5}};
  return problem;
}

}  // namespace corridor::test
