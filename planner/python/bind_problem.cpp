#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/model/bounds.h"
#include "planner/model/model_builder.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/assembly.h"
#include "planner/problem/user_cache.h"
#include "planner/python/arrays.h"
#include "planner/python/bindings.h"
#include "planner/python/fingerprint.h"
#include "planner/python/native_problem.h"
#include "planner/python/robots.h"
#include "planner/python/shapes.h"
#include "planner/solve/why_not_free.h"

namespace corridor::python {
namespace {

using ProblemPointer = std::shared_ptr<NativeProblem>;

/// Builds the model. Its faults name the class `Problem`, which Python users know.
Model built(ModelBuilder& builder) {
  try {
    return builder.build();
  } catch (const InputError& error) {
    std::vector<Fault> faults = error.faults();
    for (Fault& fault : faults)
      if (fault.file == ModelBuilder::kFaultFile) fault.file = "Problem";
    throw InputError(std::move(faults));
  }
}

void addObstacles(ModelBuilder& builder, const py::dict& obstacles) {
  for (const auto& [key, shapes] : obstacles) {
    const auto name = key.cast<std::string>();
    builder.addObstacle(name, shapesFrom(name, shapes.cast<py::list>()));
  }
}

/// Builds a problem from descriptions of robots and obstacles (corridor/problem.py).
ProblemPointer build(const py::list& robots, const py::dict& obstacles, const py::list& allowed) {
  ModelBuilder builder;
  for (const py::handle each : robots) addRobot(builder, each.cast<py::dict>());
  addObstacles(builder, obstacles);
  for (const py::handle pair : allowed) {
    const auto [a, b] = pair.cast<std::pair<std::string, std::string>>();
    builder.allow(a, b);
  }
  Problem problem;
  problem.model = built(builder);
  problem.source.name = "problem";
  problem.task.start = Configuration::Zero(static_cast<Eigen::Index>(problem.model.space.size()));
  finishProblem({}, {}, problem);
  return std::make_shared<NativeProblem>(std::move(problem));
}

/// Converts the value of an edit. @param what words for the message that say what the value must
/// be, such as "a number".
template <class T>
T valueFrom(const py::handle value, const char* key, const char* what) {
  try {
    return value.cast<T>();
  } catch (const py::cast_error&) {
    refuse(key, std::string(what) + " is needed, not " + py::repr(value).cast<std::string>());
  }
}

template <class Choice>
Choice choiceFrom(const py::handle value, const char* key) {
  const auto word = valueFrom<std::string>(value, key, "a text");
  if (const auto choice = choiceNamed<Choice>(word)) return *choice;
  std::string known;
  for (const std::string& each : wordsFor<Choice>()) known += (known.empty() ? "" : ", ") + each;
  refuse(key, "one of " + known + " is needed, not \"" + word + "\"");
}

double numberFrom(const py::handle value, const char* key, double least) {
  const auto number = valueFrom<double>(value, key, "a number");
  if (!(number >= least && std::isfinite(number)))
    refuse(key, least > 0 ? "a finite number above 0 is needed"
                          : "a finite number of 0 or more is needed");
  return number;
}

double numberWithin(const py::handle value, const char* key, const ClosedRange& range) {
  const auto number = valueFrom<double>(value, key, "a number");
  if (range.contains(number)) return number;
  refuse(key, range.text() + " is needed, not " + shortest(number));
}

/// Applies one edit to a problem. If problem files have a key for the value, the edit has the same
/// key.
void apply(const std::string& key, const py::handle value, Problem& problem) {
  const ConfigurationSpace& space = problem.model.space;
  constexpr double kPositive = std::numeric_limits<double>::min();
  const auto inBounds = [&](Configuration q, const char* name) {
    space.normalise(q);
    if (!space.inBounds(q)) refuse(name, whyOutOfBounds(q, space));
    return q;
  };
  if (key == "start") {
    problem.task.start = inBounds(configurationOf(value.cast<Array>(), space, "start"), "start");
  } else if (key == "goals") {
    std::vector<Configuration> goals = configurationsOf(value.cast<Array>(), space, "goals");
    if (goals.empty()) refuse("goals", "at least one goal is needed");
    for (Configuration& goal : goals) goal = inBounds(goal, "goals");
    problem.task.goals = std::move(goals);
    problem.task.goalRegion.reset();
    problem.task.goalThreshold.reset();
  } else if (key == "margin") {
    setMargin(problem, numberFrom(value, "margin", 0));
  } else if (key == "tube") {
    using Widths = std::map<std::string, py::object>;
    TubeSpec tube;
    for (const auto& [word, width] :
         valueFrom<Widths>(value, "tube", "a dictionary such as {\"joints\": 0.01}")) {
      const double number = numberFrom(width, "tube", 0);
      if (word == "joints")
        tube.joints = number;
      else if (word == "slides")
        tube.slides = number;
      else if (word == "position")
        tube.position = number;
      else if (word == "rotation")
        tube.rotation = number;
      else
        refuse("tube", "the keys are joints, slides, position and rotation, not \"" + word + "\"");
    }
    setTube(problem, tubeOf(space, tube));
  } else if (key == "planner") {
    problem.settings.planner.name = valueFrom<std::string>(value, "planner", "a text");
    problem.settings.planner.params.clear();
  } else if (key == "params") {
    problem.settings.planner.params = valueFrom<std::map<std::string, std::string>>(
        value, "params", "a dictionary of the planner's parameters");
  } else if (key == "time") {
    problem.settings.planner.time = numberFrom(value, "time", kPositive);
  } else if (key == "seed") {
    problem.settings.seed =
        valueFrom<std::uint64_t>(value, "seed", "a whole number from 0 to 2^64 - 1");
  } else if (key == "simplify") {
    problem.settings.simplify = choiceFrom<Simplifier>(value, "simplify");
  } else if (key == "edges") {
    problem.settings.checker.edges = choiceFrom<EdgeMethod>(value, "edges");
  } else if (key == "rate") {
    problem.settings.trajectory.rate = numberWithin(value, "rate", TrajectorySettings::kRates);
  } else if (key == "deviation") {
    problem.settings.trajectory.deviation =
        numberWithin(value, "deviation", TrajectorySettings::kDeviations);
  } else if (key == "corner_deviation") {
    problem.settings.trajectory.cornerDeviation =
        numberWithin(value, "corner_deviation", TrajectorySettings::kCornerDeviations);
  } else if (key == "smooth") {
    problem.settings.trajectory.smooth = choiceFrom<Smoothing>(value, "smooth");
  } else if (key == "clearance") {
    problem.settings.prefer.clearance = numberFrom(value, "clearance", 0);
  } else if (key == "tolerance") {
    problem.settings.checker.tolerance = numberFrom(value, "tolerance", kPositive);
  } else {
    throw py::key_error(key);
  }
}

/// Returns a copy of the problem with the edits applied. @param edits in the order in which they
/// are applied.
ProblemPointer edited(const NativeProblem& from, const py::dict& edits) {
  Problem problem = from.problem();
  for (const auto& [key, value] : edits) {
    const auto name = key.cast<std::string>();
    apply(name, value, problem);
  }
  if (problem.settings.prefer.clearance.value_or(0) > 0)
    if (const auto why = whyNoClearance(problem.task.margin, problem.settings))
      refuse("clearance", *why);
  std::map<std::string, std::string> origins = from.origins();
  if (edits.contains("planner")) origins["planner.name"] = "planner";
  if (edits.contains("start")) origins["start"] = "";
  if (edits.contains("goals")) origins["goal"] = "";
  if (edits.contains("params"))
    for (const auto& [key, value] : problem.settings.planner.params)
      origins["planner.params." + key] = "params";
  return std::make_shared<NativeProblem>(std::move(problem), std::move(origins), from, from.base());
}

/// Returns a copy of the problem with other obstacles (`replaceObstacles`).
ProblemPointer withObstacles(const ProblemPointer& from, const py::dict& obstacles) {
  ModelBuilder builder;
  addObstacles(builder, obstacles);
  const std::shared_ptr<const NativeProblem> base = from->base() ? from->base() : from;
  Problem problem = from->problem();
  replaceObstacles(base->problem(), built(builder).bodies, problem);
  return std::make_shared<NativeProblem>(std::move(problem), from->origins(), *from, base);
}

}  // namespace

void bindProblem(py::module_& module) {
  py::class_<NativeProblem, ProblemPointer>(module, "Problem")
      .def_property_readonly(
          "name", [](const NativeProblem& p) { return withoutControls(p.problem().source.name); })
      .def_property_readonly(
          "numbers", [](const NativeProblem& p) { return p.problem().model.space.numberNames(); })
      .def_property_readonly("bodies",
                             [](const NativeProblem& p) {
                               std::vector<std::string> names;
                               for (const ModelBody& body : p.problem().model.bodies)
                                 names.push_back(body.name);
                               return names;
                             })
      .def_property_readonly("files",
                             [](const NativeProblem& p) {
                               py::list files;  // as bytes, since they need not be UTF-8
                               for (const auto& file : p.problem().source.files)
                                 files.append(py::bytes(file.string()));
                               return files;
                             })
      .def_property_readonly(
          "notes", [](const NativeProblem& p) { return textsOf(p.problem().source.notes); })
      .def_property_readonly("limit_notes",
                             [](const NativeProblem& p) { return p.problem().task.limits.notes; })
      .def_property_readonly("start",
                             [](const NativeProblem& p) {
                               const Configuration& q = p.problem().task.start;
                               return Array(q.size(), q.data());
                             })
      .def_property_readonly("goals",
                             [](const NativeProblem& p) {
                               return arrayOf(p.problem().task.goals,
                                              p.problem().model.space.size());
                             })
      .def_property_readonly(
          "bounds",
          [](const NativeProblem& p) {
            const ConfigurationSpace& space = p.problem().model.space;
            std::vector<Configuration> rows(
                2, Configuration::Constant(static_cast<Eigen::Index>(space.size()), 1));
            rows[0] = -rows[0];
            for (const Coordinate& c : space.coordinates()) {
              const auto i = static_cast<Eigen::Index>(c.first);
              if (c.kind == Coordinate::Kind::line) rows[0][i] = c.lower, rows[1][i] = c.upper;
              if (c.kind == Coordinate::Kind::circle) rows[0][i] = -M_PI, rows[1][i] = M_PI;
            }
            return arrayOf(rows, space.size());
          })
      .def_property_readonly("margin",
                             [](const NativeProblem& p) { return p.problem().task.margin; })
      .def_property_readonly("tube",
                             [](const NativeProblem& p) {
                               const Configuration& q = p.problem().task.tube;
                               return Array(q.size(), q.data());
                             })
      .def_property_readonly(
          "planner", [](const NativeProblem& p) { return p.problem().settings.planner.name; })
      .def_property_readonly(
          "time", [](const NativeProblem& p) { return p.problem().settings.planner.time; })
      .def_property_readonly("seed",
                             [](const NativeProblem& p) { return p.problem().settings.seed; })
      .def_property_readonly("fingerprint",
                             [](const NativeProblem& p) { return fingerprintOf(p.problem()); })
      .def("edited", &edited, py::arg("edits"))
      .def("with_obstacles", &withObstacles, py::arg("obstacles"));
  module.def(
      "read_problem",
      [](const std::string& file) {
        const py::gil_scoped_release unlocked;
        Problem problem = readProblem(file);
        // Meshes don't come from the cache, as trees, hulls and grids do: a script may also verify
        // with this problem, and the verifier must not depend on a cache.
        problem.model.cache = userCache();
        if (problem.model.cache && !problem.model.cache->whyUnusable().empty())
          problem.source.notes.push_back({problem.model.cache->whyUnusable(), NoteWeight::detail});
        return std::make_shared<NativeProblem>(std::move(problem));
      },
      py::arg("file"));
  module.def("build_problem", &build, py::arg("robots"), py::arg("obstacles"), py::arg("allow"));
}

}  // namespace corridor::python
