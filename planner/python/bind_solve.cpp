#include <atomic>
#include <chrono>
#include <future>
#include <mutex>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <string>

#include "collision/core/file_cache.h"
#include "planner/checker/left_out.h"
#include "planner/problem/digest.h"
#include "planner/python/arrays.h"
#include "planner/python/bindings.h"
#include "planner/python/native_problem.h"
#include "planner/solve/solution.h"
#include "planner/solve/solve.h"
#include "planner/solve/verify_solution.h"
#include "planner/view/path_picture.h"
#include "planner/view/view_page.h"

namespace corridor::python {
namespace {

/// Solves the problem in a new thread. Meanwhile the calling thread runs Python's signal handlers
/// and the callback, ten times a second.
SolveReport solveInThread(const Problem& problem, SolveOptions& options,
                          const py::object& callback) {
  std::atomic<bool> interrupted = false;
  std::mutex mutex;
  SolveProgress latest;
  options.interrupted = &interrupted;
  options.progress = [&](const SolveProgress& p) {
    const std::lock_guard lock(mutex);
    latest = p;
  };
  bool failed = false;  // a call of Python raised an exception
  std::future<SolveReport> report;
  {
    const py::gil_scoped_release unlocked;
    report = std::async(std::launch::async, [&] { return solveProblem(problem, options); });
    while (report.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) {
      if (failed) continue;
      failed = runSignalHandlers();
      if (!failed && !callback.is_none()) {
        SolveProgress now;
        {
          const std::lock_guard lock(mutex);
          now = latest;
        }
        const py::gil_scoped_acquire lock;
        try {
          callback(now.seconds, now.edges);
        } catch (py::error_already_set& error) {
          error.restore();
          failed = true;
        }
      }
      if (failed) interrupted = true;
    }
  }
  if (failed) throw py::error_already_set();
  if (const auto& cache = problem.model.cache) cache->save();
  return report.get();
}

py::dict trajectoryDict(const MadeTrajectory& made) {
  py::dict d;
  d["why_none"] = made.fault;
  if (!made.fault.empty()) return d;
  if (made.proved()) d["text"] = made.text;
  d["duration_s"] = made.duration;
  d["proved"] = made.proved();
  d["keeps_limits"] = keepsLimits(made.ratios);
  d["proved_clearance_m"] = made.clearance ? py::cast(made.clearance->proved) : py::none();
  if (made.clearance) {
    d["share_on_target"] = made.clearance->shareOnTarget;
    d["time_lost_s"] = made.timeLost ? py::object(py::cast(*made.timeLost)) : py::none();
  }
  return d;
}

/// Returns (a, b, reason) for each pair that the proofs leave out.
std::vector<std::tuple<std::string, std::string, std::string>> leftOutList(const Model& model,
                                                                           const LeftOut& leftOut) {
  std::vector<std::tuple<std::string, std::string, std::string>> list;
  for (const LeftOutPair& pair : leftOut.except)
    list.emplace_back(model.bodies[pair.a].name, model.bodies[pair.b].name, nameOf(pair.reason));
  return list;
}

py::dict solve(const NativeProblem& native, const std::optional<std::string>& trajectory,
               const py::object& callback) {
  const Problem& problem = native.problem();
  SolveOptions options;
  options.noteLeftOut = true;
  options.valueOrigins = native.origins();
  const std::vector<Body> meshes = native.ownMeshes();  // their trees serve later problems, too
  options.earlier = meshes;
  if (trajectory)
    options.trajectory =
        *trajectory == "csv" ? TrajectoryFileKind::csv : TrajectoryFileKind::message;
  std::string digest;  // computed first: the files may change during planning
  try {
    if (!problem.source.files.empty()) digest = digestOf(problem);
  } catch (const InputError&) {  // a file is missing: no digest, so no solution file
  }
  const SolveReport r = solveInThread(problem, options, callback);
  py::dict d;
  d["outcome"] = nameOf(r.outcome);
  d["why"] = r.why;
  d["path"] = arrayOf(r.path, problem.model.space.size());
  d["certified"] = r.certified;
  d["left_out"] = leftOutList(problem.model, r.leftOut);
  d["except"] = exceptText(problem.model, r.leftOut);
  d["planner"] = r.planner;
  d["checker"] = r.checker;
  d["seed"] = r.seed;
  d["repeats"] = r.repeatable;
  d["time_s"] = r.time;
  d["planning_time_s"] = r.planningTime;
  d["certify_s"] = r.certificationTime;
  d["states_checked"] = r.counters.states;
  d["edges_checked"] = r.counters.edges;
  d["length_m"] = r.length.metres;
  d["rotation_rad"] = r.length.radians;
  d["proved_clearance_m"] = r.clearance ? py::cast(r.clearance->proved) : py::none();
  if (r.clearance) {
    d["closest_found_m"] =
        r.clearance->a.empty() ? py::none() : py::object(py::cast(r.clearance->smallest));
    d["share_on_target"] = r.clearance->shareOnTarget;
    d["why_off_target"] = nameOf(r.clearance->why);
  }
  d["warnings"] = [&] {
    std::vector<std::string> texts;
    for (const Fault& fault : r.warnings) texts.push_back(fault.str());
    return texts;
  }();
  if (r.outcome == SolveOutcome::solved && !digest.empty())
    d["text"] = solutionText(makeSolution(problem, r, digest));
  if (r.trajectory) d["trajectory"] = trajectoryDict(*r.trajectory);
  return d;
}

py::dict reportDict(const Problem& problem, const VerifyReport& report, const LeftOut& leftOut) {
  py::dict d;
  d["verdict"] = verdictName(report);
  d["left_out"] = leftOutList(problem.model, leftOut);
  d["not_tested"] = reasonGroups(leftOut);
  d["proved_clearance_m"] = report.pathReport.provedClearance;
  d["closest_found_m"] = report.pathReport.closestFound;
  d["edges"] = report.pathReport.edges;
  d["edges_proved"] = report.pathReport.edgesProved;
  d["violations"] = report.violations;
  d["reaches_goal"] = report.reachesGoal;
  d["notes"] = textsOf(report.notes);
  py::list findings;
  for (const PathFinding& f : report.pathReport.findings) {
    py::dict finding;
    finding["edge"] = f.edge;
    finding["t"] = f.t;
    finding["in_every_state"] = f.inEveryState;
    finding["verdict"] = nameOf(f.verdict);
    finding["gap_m"] = f.gap;
    finding["required_m"] = f.required;
    finding["reason"] = f.reason;
    if (!f.a.empty()) finding["bodies"] = py::make_tuple(f.a, f.b);
    findings.append(std::move(finding));
  }
  d["findings"] = findings;
  return d;
}

/// Returns a path as the solution of a problem. It has no digest, because it belongs to the problem
/// in memory, not to the problem's files.
Solution solutionFrom(const Problem& problem, const Array& path) {
  Solution solution;
  solution.numbers = problem.model.space.numberNames();
  solution.margin = problem.task.margin;
  solution.tube = problem.task.tube;
  solution.path = configurationsOf(path, problem.model.space, "path");
  if (solution.path.empty()) refuse("path", "at least one state is needed");
  return solution;
}

/// Verifies a path. @param clearance metres: the bound of the path's clearance is refined until it
/// reaches this value, if the path may have such a clearance.
py::dict verifyPathOf(const NativeProblem& native, const Array& path, double clearance) {
  const Problem& problem = native.problem();
  Solution solution = solutionFrom(problem, path);
  solution.clearance = clearance;
  VerifyReport report;
  LeftOut leftOut;
  {
    const py::gil_scoped_release unlocked;
    report = verifySolution(problem, solution);
    leftOut = leftOutOf(native.checker());
  }
  return reportDict(problem, report, leftOut);
}

/// Verifies a trajectory. @param text the content of the trajectory's file: rows, or a message.
py::dict verifyTrajectoryOf(const NativeProblem& native, const std::string& text) {
  const Problem& problem = native.problem();
  VerifyReport report;
  LeftOut leftOut;
  {
    const py::gil_scoped_release unlocked;
    report = verifyTrajectory(problem, readTrajectory("trajectory", text, problem.model));
    leftOut = leftOutOf(native.checker());
  }
  py::dict d = reportDict(problem, report, leftOut);
  if (report.limits) d["keeps_limits"] = keepsLimits(*report.limits);
  return d;
}

std::string page(const NativeProblem& native, const std::optional<Array>& states) {
  const Problem& problem = native.problem();
  std::optional<ViewedPath> path;
  if (states) path.emplace().solution = solutionFrom(problem, *states);
  const py::gil_scoped_release unlocked;
  if (path) path->report = verifySolution(problem, path->solution);
  return viewPage(problem, path);
}

/// Returns a picture of the scene and the path as an SVG document. @param seenFrom a direction that
/// `viewDirection` accepts. @throws InputError for any other text.
std::string picture(const NativeProblem& native, const Array& states,
                    const std::optional<std::string>& seenFrom) {
  std::optional<ViewDirection> from;
  if (seenFrom) from = viewDirection(*seenFrom, "seen_from");
  const Path path = solutionFrom(native.problem(), states).path;
  const py::gil_scoped_release unlocked;
  return svgPicture(native.problem(), path, from);
}

/// Returns the same picture as the bytes of a PNG file.
py::bytes png(const NativeProblem& native, const Array& states,
              const std::optional<std::string>& seenFrom, int width) {
  std::optional<ViewDirection> from;
  if (seenFrom) from = viewDirection(*seenFrom, "seen_from");
  const Path path = solutionFrom(native.problem(), states).path;
  std::string bytes;
  {
    const py::gil_scoped_release unlocked;
    bytes = pngPicture(native.problem(), path, from, width);
  }
  return bytes;
}

}  // namespace

void bindSolve(py::module_& module) {
  using py::arg;
  module.def("solve", &solve, arg("problem"), arg("trajectory"), arg("progress"));
  module.def("verify_path", &verifyPathOf, arg("problem"), arg("path"), arg("clearance"));
  module.def("verify_trajectory", &verifyTrajectoryOf, arg("problem"), arg("text"));
  module.def("page", &page, arg("problem"), arg("path"));
  module.def("picture", &picture, arg("problem"), arg("path"), arg("seen_from"));
  module.def("png", &png, arg("problem"), arg("path"), arg("seen_from"), arg("width"));
}

}  // namespace corridor::python
