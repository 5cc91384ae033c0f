#include "planner/problem/reach_notes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/model/reach.h"

namespace corridor {
namespace {

/// Returns true if the problem has obstacles, and no body of a robot can reach any of them.
bool hasObstaclesOutOfReachOnly(const Problem& problem, const std::vector<ReachBox>& reach) {
  const Model& model = problem.model;
  const auto isReached = [&](std::size_t obstacle) {
    for (std::size_t b = 0; b < model.bodies.size() && model.bodies[b].robot; ++b)
      if (!outOfReach(problem.task, reach[obstacle], reach[b])) return true;
    return false;
  };
  std::size_t obstacles = 0;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (model.bodies[b].robot) continue;
    if (isReached(b)) return false;
    ++obstacles;
  }
  return obstacles > 0;
}

/// Sets `boxes` to one box for each robot, which contains the robot's bodies in all configurations.
/// Returns half of the longest side of these boxes, in metres. Returns 0 if no robot has a body.
double halfReach(const Model& model, const std::vector<ReachBox>& reach,
                 std::vector<ReachBox>& boxes) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  boxes.assign(model.robots.size(), {Vec3::Constant(infinity), Vec3::Constant(-infinity)});
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    if (!model.bodies[b].robot) continue;
    ReachBox& box = boxes[*model.bodies[b].robot];
    box.lower = box.lower.cwiseMin(reach[b].lower);
    box.upper = box.upper.cwiseMax(reach[b].upper);
  }
  double most = 0;
  for (const ReachBox& box : boxes) most = std::max(most, (box.upper - box.lower).maxCoeff() / 2);
  return most;
}

/// Returns the hint for an obstacle whose lengths may be in millimetres. The hint names the key
/// `unit` only if the obstacle can have it: primitives and octomaps can't.
std::string unitHint(const ModelBody& obstacle) {
  for (const PlacedShape& shape : obstacle.shapes) {
    const bool isMap = !shape.mesh && !shape.primitive && shape.parts.front().radius == 0;
    if (!shape.file.empty() && !isMap) return "; if its lengths are in millimetres, write unit: mm";
  }
  return "; are its lengths in metres?";
}

/// Returns a length as text, rounded to a millimetre.
std::string metres(double length) {
  return shortest(std::round(length * 1000) / 1000) + " m";
}

/// Adds a note for each obstacle (at most 100) that is far larger than the robots, or far away from
/// them, because its lengths are probably in millimetres. A floor may be large in two directions.
/// So an obstacle counts as large only if all its three sides are long, or if it is read from a
/// file and one side is very long.
void addNotesOnSizes(const Problem& problem, const std::vector<ReachBox>& reach,
                     std::vector<Note>& notes) {
  // An arm reaches 0.3 m to 3 m. A floor of 100 m gets no note. A file in millimetres gets a note
  // if, for example, it contains a shelf that is really 0.4 m long, or a mesh whose three sides are
  // all really above 0.09 m.
  constexpr double longestPerReach = 100, leastLongest = 200, thickPerReach = 30;
  constexpr int mostNotes = 100;
  const Model& model = problem.model;
  std::vector<ReachBox> robots;
  const double own = halfReach(model, reach, robots);
  if (!(own > 0)) return;
  const double longest = std::max(longestPerReach * own, leastLongest);
  int count = 0;
  for (std::size_t b = 0; b < model.bodies.size() && count < mostNotes; ++b) {
    const ModelBody& body = model.bodies[b];
    if (body.robot) continue;
    const Vec3 size = reach[b].upper - reach[b].lower;
    double away = std::numeric_limits<double>::infinity();
    for (const ReachBox& box : robots) {
      const Vec3 gap =
          (reach[b].lower - box.upper).cwiseMax(box.lower - reach[b].upper).cwiseMax(Vec3::Zero());
      away = std::min(away, gap.norm());
    }
    const bool isRead = !body.shapes.front().file.empty();
    const bool isLarge =
        (isRead && size.maxCoeff() > longest) || size.minCoeff() > thickPerReach * own;
    if (!isLarge && !(away > longest)) continue;
    ++count;
    notes.push_back(
        {"obstacle " + quotedWord(body.name) + " is " +
             (isLarge ? metres(size.maxCoeff()) + " long" : metres(away) + " away") +
             (robots.size() == 1 ? ", while the robot reaches " : ", while the robots reach ") +
             metres(own) + unitHint(body),
         NoteWeight::coverage});
  }
}

/// Adds a note for each body that polygons never meet, because it does not reach their plane, z =
/// 0.
void addNotesOnPlane(const Problem& problem, const std::vector<ReachBox>& reach,
                     std::vector<Note>& notes) {
  const std::vector<ModelBody>& bodies = problem.model.bodies;
  const auto hasPolygon = [](const ModelBody& body) {
    return std::any_of(body.shapes.begin(), body.shapes.end(),
                       [](const PlacedShape& shape) { return !shape.polygon.empty(); });
  };
  if (std::none_of(bodies.begin(), bodies.end(), hasPolygon)) return;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (reach[b].lower.z() > 0 || reach[b].upper.z() < 0)
      notes.push_back({quotedWord(bodies[b].name) +
                           " does not reach the plane z = 0, so it never meets a polygon",
                       NoteWeight::coverage});
}

}  // namespace

std::vector<Note> notesOnReach(const Problem& problem) {
  const std::vector<ReachBox> reach = reachOf(problem.model);
  std::vector<Note> notes;
  if (hasObstaclesOutOfReachOnly(problem, reach))
    notes.push_back(
        {"no obstacle is within reach; are all lengths in metres?", NoteWeight::coverage});
  addNotesOnSizes(problem, reach, notes);
  addNotesOnPlane(problem, reach, notes);
  return notes;
}

}  // namespace corridor
