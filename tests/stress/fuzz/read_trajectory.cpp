// Fuzz target: trajectory files (rows and messages), for an arm with held and mimic joints, and for
// a floating body. The rows that are read must give a curve or a fault. If they are written as text
// and read again, they must be the same.
#include "planner/solve/outside_bounds.h"
#include "planner/trajectory/trajectory_curve.h"
#include "planner/trajectory/trajectory_text.h"
#include "tests/stress/fuzz/fuzz.h"

namespace {

using namespace corridor;

Coordinate coordinate(Coordinate::Kind kind, const char* name) {
  Coordinate c;
  c.kind = kind;
  c.name = name;
  c.lower = -9;
  c.upper = 9;
  return c;
}

Model armModel() {
  Model model;
  ModelRobot robot;
  for (const auto& [name, type] :
       {std::pair{"pan", JointType::continuous}, std::pair{"lift", JointType::revolute},
        std::pair{"grip", JointType::prismatic}, std::pair{"follow", JointType::revolute},
        std::pair{"wrist", JointType::fixed}}) {
    JointModel joint;
    joint.name = name;
    joint.type = type;
    robot.description.joints.push_back(joint);
  }
  robot.description.joints[3].mimic = Mimic{1, -2, 0.5};
  robot.held[2] = 0.02;
  robot.planned = {0, 1};
  CoordinateGroup group;
  for (const auto& [kind, joint] :
       {std::pair{Coordinate::Kind::circle, 0}, std::pair{Coordinate::Kind::line, 1}}) {
    const std::string& name = robot.description.joints[std::size_t(joint)].name;
    group.coordinates.push_back(model.space.add(coordinate(kind, name.c_str())));
    robot.plannedJoints.push_back({name, JointType::revolute, group.coordinates.back()});
  }
  model.space.addGroup(group);
  model.robots.push_back(robot);
  return model;
}

Model bodyModel() {
  Model model;
  CoordinateGroup group;
  group.kind = CoordinateGroup::Kind::floating;
  for (const char* name : {"x", "y", "z"})
    group.coordinates.push_back(model.space.add(coordinate(Coordinate::Kind::line, name)));
  group.coordinates.push_back(model.space.add(coordinate(Coordinate::Kind::rotation, "rotation")));
  model.space.addGroup(group);
  return model;
}

void checkCurve(const Curve& curve, const ConfigurationSpace& space) {
  if (curve.pieces.empty() || curve.knots.size() != curve.pieces.size() + 1)
    fuzz::fail("a curve without pieces, or with another number of knots");
  for (std::size_t k = 0; k < curve.pieces.size(); ++k) {
    const CurvePiece& piece = curve.pieces[k];
    if (!piece.coefficients.allFinite() || !piece.error.allFinite() ||
        (piece.error.array() < 0).any())
      fuzz::fail("a piece that is not finite, or has a negative error");
    if (!(curve.knots[k] < curve.knots[k + 1])) fuzz::fail("knots that do not ascend");
  }
  outsideBounds(space, curve.pieces);
}

void checkText(const TrajectoryRows& rows, const Model& model) {
  const TrajectoryRows back = readTrajectory("b", csvText(rows, model), model);
  if (back.rows.size() != rows.rows.size() || back.timed != rows.timed)
    fuzz::fail("a text that reads back with other rows");
  for (std::size_t k = 0; k < rows.rows.size(); ++k)
    if (back.rows[k].positions != rows.rows[k].positions ||
        back.rows[k].velocities != rows.rows[k].velocities ||
        (rows.timed && back.rows[k].time != rows.rows[k].time))
      fuzz::fail("a text that reads back with other values");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Model models[] = {armModel(), bodyModel()};
  const std::string text(fuzz::textOf(data, size));
  if (trajectoryFormatOf(text) == TrajectoryFormat::solution) return 0;
  for (const Model& model : models)
    fuzz::readsOrRefuses([&] {
      TrajectoryRows rows = readTrajectory("t", text, model);
      checkText(rows, model);
      for (const auto wanted :
           {std::optional<RowInterpolation>(), std::optional(RowInterpolation::linear),
            std::optional(RowInterpolation::cubic)}) {
        const RowInterpolation between = interpolationOf(rows, wanted);
        checkCurve(curveOf(rows, model.space, between), model.space);
      }
    });
  return 0;
}
