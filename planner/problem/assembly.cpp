#include "planner/problem/assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>

#include "collision/core/fault_list.h"
#include "collision/core/rounding.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_limits.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/nothing_tested.h"
#include "planner/problem/reach_notes.h"
#include "planner/problem/shape_yaml.h"
#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

/// Returns the notes on the mesh files of bodies or links: one for each text, with the files.
template <class Owners>
std::vector<Note> notesOnFiles(const Owners& owners) {
  std::map<std::string, std::set<std::string>> files;
  for (const auto& owner : owners)
    for (const PlacedShape& shape : owner.shapes)
      if (shape.mesh)
        for (const std::string& text : shape.mesh->notes) files[text].insert(shape.file.string());
  std::vector<Note> notes;
  for (const auto& [text, names] : files)
    notes.push_back({text + ": " + joinedFirst({names.begin(), names.end()}, 3),
                     text == kNoteOnLines ? NoteWeight::detail : NoteWeight::coverage});
  return notes;
}

/// Adds a note on the planar joints that are planned for.
/// @throws InputError if a file says that one of them can't move sideways.
void noteOnSliding(Problem& problem) {
  std::vector<std::string> names;
  for (const ModelRobot& robot : problem.model.robots)
    for (const PlannedJoint& planned : robot.plannedJoints) {
      if (planned.type != JointType::planar || planned.name.empty()) continue;  // or a rigid robot
      names.push_back((robot.name.empty() ? "" : robot.name + "/") + planned.name);
      for (const JointModel& joint : robot.description.joints)
        if (joint.name == planned.name && !joint.whyNoSliding.empty())
          throw InputError(Fault{
              problem.source.file.string(), 0,
              joint.whyNoSliding +
                  "; paths of differential drives and cars are not planned for: joint " +
                  quotedWord(names.back()) +
                  " would move in any direction. Hold it (hold), or remove the property if the "
                  "base may slide"});
    }
  if (names.empty()) return;
  problem.source.notes.push_back(
      {"these planar joints move in any direction, so the base may slide: " +
           joinedFirst(names, 6) + "; paths of differential drives and cars are not planned for",
       NoteWeight::motion});
}

/// Returns the notes on the problem's bodies and pairs.
std::vector<Note> notesOnBodies(const Problem& problem) {
  std::vector<Note> notes = notesOnReach(problem);
  for (const ModelBody& body : problem.model.bodies)
    for (const PlacedShape& shape : body.shapes) addAll(shape.notes, notes);
  addAll(notesOnFiles(problem.model.bodies), notes);
  return notes;
}

constexpr std::string_view kNoteOnProofs = " tested: the proof covers a margin of up to ";

/// Adds a note if pairs of `never_in_contact` are tested because their proof does not cover the
/// problem's margin plus the pair's padding, or its tube. Removes an earlier such note.
void noteOnProofs(Problem& problem) {
  std::vector<Note>& notes = problem.source.notes;
  std::erase_if(notes,
                [](const Note& note) { return note.text.find(kNoteOnProofs) != note.text.npos; });
  const Required need = requiredBy(problem.task);
  std::size_t tested = 0;
  PairProof covered;
  for (const auto& [pair, proof] : problem.model.filter.proofs()) {
    if (!problem.model.filter.whyNotTested(pair.first, pair.second, need).empty()) continue;
    covered = proof;
    ++tested;
  }
  if (tested > 0)
    notes.push_back(
        {std::to_string(tested) +
             (tested == 1 ? " pair of never_in_contact is" : " pairs of never_in_contact are") +
             std::string(kNoteOnProofs) + shortest(covered.margin) + " m and a tube of up to " +
             shortest(covered.beyondLimits) + " rad or m",
         NoteWeight::detail});
}

constexpr std::string_view kNoteOnPadding = ".pairs is not kept between ";

/// Adds a note for each pair with a padding of its own that is not tested. Removes earlier such
/// notes. (A pair of `never_in_contact` is not tested only if its proof covers the padding.)
void noteOnPadding(Problem& problem) {
  std::vector<Note>& notes = problem.source.notes;
  std::erase_if(notes,
                [](const Note& note) { return note.text.find(kNoteOnPadding) != note.text.npos; });
  const Required need = requiredBy(problem.task);
  // `least`: what each pair keeps besides its own entry.
  const auto noteEach = [&](const char* key, double least, const auto& pairs) {
    for (const auto& [pair, metres] : pairs) {
      const std::string_view why = problem.model.filter.whyNotTested(pair.first, pair.second, need);
      if (least + metres == 0 || why.empty() || why == kTestedAtRest || why == kNeverInContact)
        continue;
      notes.push_back({key + std::string(kNoteOnPadding) + problem.model.bodies[pair.first].name +
                           " and " + problem.model.bodies[pair.second].name +
                           ", which are not tested (" + std::string(why) + ")",
                       NoteWeight::coverage});
    }
  };
  noteEach("padding", 0, problem.task.padding.pairs);
  noteEach("margin", problem.task.margin, problem.task.padding.beyond.pairs);
}

void addNotes(Problem& problem) {
  noteOnProofs(problem);
  noteOnPadding(problem);
  std::vector<Note>& notes = problem.source.notes;
  addAll(notesOnBodies(problem), notes);
  if (nothingIsTested(problem)) notes.insert(notes.begin(), {kNothingTested, NoteWeight::coverage});
}

/// The largest legal length, metres. Larger lengths are refused, because squares of sums of lengths
/// must be finite.
constexpr double kLargestLength = 1e100;

/// Returns the largest absolute coordinate or radius of a body's shapes, metres, in the body's
/// frame.
double largestCoordinate(const ModelBody& body) {
  double most = 0;
  for (const PlacedShape& shape : body.shapes) {
    forEachPoint(shape, [&](const Vec3& p, double radius) {
      most = std::max({most, p.cwiseAbs().maxCoeff(), radius});
    });
  }
  return most;
}

/// Returns the largest absolute coordinate (m) of two translations: the frame's fixed translation,
/// and the translation by its joint within the joint's limits.
double largestTranslation(const Frame& frame, const ConfigurationSpace& space) {
  const double fixed = frame.fixed.p.cwiseAbs().maxCoeff();
  const bool slides =
      frame.joint == Frame::Joint::prismatic || frame.joint == Frame::Joint::translation;
  if (!slides) return fixed;
  if (frame.variable == Frame::noVariable) return std::max(fixed, std::abs(frame.offset));
  double most = fixed;
  for (const Coordinate& c : space.coordinates())
    if (frame.variable <= c.first && c.first < frame.variable + frame.count)
      most = std::max(most,
                      std::abs(frame.multiplier) * std::max(std::abs(c.lower), std::abs(c.upper)) +
                          std::abs(frame.offset));
  return most;
}

void requireFiniteSizes(const Model& model, const std::string& file) {
  FaultList faults(file);
  const auto require = [&](const std::string& name, double length) {
    if (!(length <= kLargestLength))
      faults.add(file, 0,
                 name + ": a coordinate of " + shortest(length) +
                     " m is too large; at most 1e+100 m is allowed");
  };
  std::vector<std::string> names;  // for messages
  for (const Frame& frame : model.tree.frames)
    names.push_back(frame.name.empty() ? "a frame" : "frame " + frame.name);
  for (const ModelBody& body : model.bodies) {
    require(body.name, largestCoordinate(body));
    if (!body.robot) names[body.frame] = body.name;
  }
  for (std::size_t f = 1; f < names.size(); ++f)
    require(names[f], largestTranslation(model.tree.frames[f], model.space));
  faults.throwIfAny();
}

}  // namespace

std::vector<Note> notesOnMeshes(const RobotDescription& robot) {
  return notesOnFiles(robot.links);
}

std::vector<Note> notesOf(const RobotSetup& setup) {
  std::vector<Note> notes = setup.robot.description.notes;
  if (const std::string held = heldText(setup.robot); !held.empty())
    notes.push_back({"joints that are not planned for are held: " + held, NoteWeight::motion});
  return notes;
}

void addRobots(std::vector<RobotSetup> robots, ModelBuilder& builder, Source& source) {
  for (RobotSetup& setup : robots) {
    const std::string& name = setup.robot.name;
    for (const Note& note : notesOf(setup))
      source.notes.push_back({name.empty() ? note.text : name + ": " + note.text, note.weight});
    for (const auto& file : setup.files) addFile(source.files, file);
    builder.addRobot(std::move(setup.robot));
  }
}

void finishProblem(const AllowedBodies& allowed, const TubeSpec& tube, Problem& problem) {
  if (problem.task.limits.velocity.size() == 0) problem.task.limits = limitsOf(problem.model);
  requireFewPairs(problem.model, problem.source.file.string());
  requireFiniteSizes(problem.model, problem.source.file.string());
  noteOnSliding(problem);
  for (const auto& [a, b] : allowed) problem.model.filter.skip(a, b, "allow");
  problem.task.tube = tubeOf(problem.model.space, tube);
  addNotes(problem);
}

void replaceObstacles(const Problem& base, std::vector<ModelBody> obstacles, Problem& problem) {
  Model& model = problem.model;
  model = base.model;
  std::erase_if(model.bodies, [](const ModelBody& body) { return !body.robot; });
  std::map<std::string, std::size_t> byName;
  for (std::size_t i = 0; i < model.bodies.size(); ++i) byName[model.bodies[i].name] = i;
  const std::size_t links = model.bodies.size();
  for (ModelBody& obstacle : obstacles) {
    const auto link = byName.find(obstacle.name);
    if (link != byName.end() && link->second < links) obstacle.name.insert(0, "world/");
    if (!byName.emplace(obstacle.name, model.bodies.size()).second)
      throw InputError(Fault{problem.source.file.string(), 0,
                             "two obstacles have the name " + quotedWord(obstacle.name) +
                                 "; give each a name of its own"});
    model.bodies.push_back(std::move(obstacle));
  }
  std::vector<std::optional<std::size_t>> places;  // of the bodies of `base`
  for (const ModelBody& body : base.model.bodies) {
    const auto found = byName.find(body.name);
    places.push_back(found == byName.end() ? std::nullopt : std::optional(found->second));
  }
  model.filter = base.model.filter.renumbered(places);
  setMovers(model);
  Padding& padding = problem.task.padding = {};
  for (const auto& [body, metres] : base.task.padding.bodies)
    if (places[body]) padding.bodies[*places[body]] = metres;
  const auto renumber = [&](const auto& from, auto& to) {
    for (const auto& [pair, metres] : from)
      if (places[pair.first] && places[pair.second])
        to[std::minmax(*places[pair.first], *places[pair.second])] = metres;
  };
  renumber(base.task.padding.pairs, padding.pairs);
  padding.beyond.self = base.task.padding.beyond.self;
  padding.beyond.world = base.task.padding.beyond.world;
  renumber(base.task.padding.beyond.pairs, padding.beyond.pairs);
  requireFewPairs(model, problem.source.file.string());
  requireFiniteSizes(model, problem.source.file.string());
  std::set<std::string> ofBodies{kNothingTested};  // notes on the bodies of `base`
  for (const Note& note : notesOnBodies(base)) ofBodies.insert(note.text);
  problem.source.notes = base.source.notes;
  std::erase_if(problem.source.notes,
                [&](const Note& note) { return ofBodies.contains(note.text); });
  addNotes(problem);
}

void setMargin(Problem& problem, double margin) {
  problem.task.margin = margin;
  problem.task.padding.beyond = {};
  noteOnProofs(problem);
  noteOnPadding(problem);
}

void setTube(Problem& problem, Configuration tube) {
  problem.task.tube = std::move(tube);
  noteOnProofs(problem);
  noteOnPadding(problem);
}

}  // namespace corridor
