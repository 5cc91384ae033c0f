#include "planner/problem/assembly.h"

#include <algorithm>

#include "collision/core/error.h"
#include "collision/core/shortest.h"
#include "planner/problem/nothing_tested.h"
#include "planner/problem/shape_yaml.h"

namespace corridor {
namespace {

/// Returns for example "a ~ b, c ~ d, e ~ f, g ~ h and 3 more".
std::string listed(const std::vector<std::string>& words) {
  constexpr std::size_t most = 4;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, words.size()); ++i) text += (i ? ", " : "") + words[i];
  return words.size() <= most ? text
                              : text + " and " + std::to_string(words.size() - most) + " more";
}

void addNotesOnPairs(Problem& problem) {
  const std::vector<ModelBody>& bodies = problem.model.bodies;
  std::vector<std::string> still;
  forEachPair(problem.model, [&](std::size_t a, std::size_t b, std::string_view why) {
    if (why == kNeverMove && bodies[a].robot != bodies[b].robot)
      still.push_back(bodies[a].name + " ~ " + bodies[b].name);
  });
  std::vector<std::string>& notes = problem.source.notes;
  if (!still.empty())
    notes.push_back("not tested, since they never move against each other: " + listed(still));
  if (nothingIsTested(problem)) notes.insert(notes.begin(), kNothingTested);
}

/// Lengths above this one, in metres, are refused: squares of sums of them must be finite.
constexpr double kLargestLength = 1e100;

void requireFiniteSizes(const Model& model, const std::string& file) {
  std::vector<Fault> faults;
  const auto require = [&](const std::string& name, double length) {
    if (!(length <= kLargestLength) && faults.size() < 100)
      faults.push_back({file, 0,
                        name + ": a coordinate of " + shortest(length) +
                            " m is too large; at most 1e+100 m is allowed"});
  };
  for (const ModelBody& body : model.bodies) {
    double most = 0;
    for (const PlacedShape& shape : body.shapes) {
      for (const Vec3& p : shape.part ? shape.part->points : shape.mesh->mesh.vertices)
        most = std::max(most, p.cwiseAbs().maxCoeff());
      if (shape.part) most = std::max(most, shape.part->radius);
    }
    require(body.name, most);
  }
  for (const Frame& frame : model.tree.frames)
    require(frame.name.empty() ? "a frame" : frame.name, frame.fixed.p.cwiseAbs().maxCoeff());
  if (!faults.empty()) throw InputError(std::move(faults));
}

}  // namespace

void addRobots(std::vector<RobotSetup> robots, ModelBuilder& builder, Source& source) {
  for (RobotSetup& setup : robots) {
    const std::string& name = setup.robot.name;
    for (const std::string& note : setup.robot.model.notes)
      source.notes.push_back(name.empty() ? note : name + ": " + note);
    for (const auto& file : setup.files) addFile(source.files, file);
    builder.addRobot(std::move(setup.robot));
  }
}

void finishProblem(const AllowedBodies& allowed, const TubeSpec& tube, Problem& problem) {
  requireFewPairs(problem.model, problem.source.file.string());
  requireFiniteSizes(problem.model, problem.source.file.string());
  for (const auto& [a, b] : allowed) problem.model.filter.skip(a, b, "allow");
  addNotesOnPairs(problem);
  problem.task.tube = tubeOf(problem.model.space, tube);
}

}  // namespace corridor
