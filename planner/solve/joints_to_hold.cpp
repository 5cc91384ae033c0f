#include "planner/solve/joints_to_hold.h"

#include <algorithm>
#include <string>

#include "collision/core/spelling.h"
#include "planner/model/planned_joints.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

/// Returns whether every joint that can move is planned for, passive ones aside.
bool plansForAll(const ModelRobot& robot) {
  return std::all_of(robot.held.begin(), robot.held.end(), [&](const auto& held) {
    const JointModel& joint = robot.description.joints[held.first];
    return joint.passive || !canMove(joint);
  });
}

}  // namespace

std::vector<Note> notesOnJointsToHold(const Problem& problem, const Path& path) {
  const Task& task = problem.task;
  if (path.empty() || task.goalRegion) return {};
  std::vector<std::string> names;
  for (const ModelRobot& robot : problem.model.robots) {
    if (robot.jointsAreChosen || !plansForAll(robot)) continue;
    for (const PlannedJoint& planned : robot.plannedJoints) {
      if (isPoseJoint(planned.type)) continue;
      const Coordinate& coordinate = problem.model.space.coordinates()[planned.coordinate];
      const auto i = static_cast<Eigen::Index>(coordinate.first);
      const auto is = [&, first = path.front()[i]](const Configuration& q) {
        return q[i] == first;
      };
      if (std::all_of(task.goals.begin(), task.goals.end(), is) &&
          !std::all_of(path.begin(), path.end(), is))
        names.push_back(coordinate.name);
    }
  }
  if (names.empty()) return {};
  return {{"the path moves " + joinedFirst(names) +
               ", although start and goal have the same value; if the path should not, choose the "
               "other joints (joints in a robot.yaml)",
           NoteWeight::motion}};
}

}  // namespace corridor
