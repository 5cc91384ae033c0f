#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "collision/core/shortest.h"
#include "planner/app/commands.h"
#include "planner/app/limits_output.h"
#include "planner/app/motion_file.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/checker/enclosed_bodies.h"
#include "planner/checker/fixed_pairs.h"
#include "planner/checker/left_out.h"
#include "planner/checker/problem_goal.h"
#include "planner/model/held_joints.h"
#include "planner/problem/nothing_tested.h"
#include "planner/solve/verify_solution.h"
#include "planner/trajectory/rows_limits.h"

namespace corridor::app {
namespace {

struct VerifyArguments {
  std::string problem, solution;
  std::optional<double> margin;
  std::optional<std::string> between;  ///< the name of a RowInterpolation; trajectories only
  bool ignoreDigest = false;  ///< verify the solution even if its digest is not the problem's
  bool limits = false;        ///< the exit status is 0 only if all limits over time are kept, too
  bool json = false, quiet = false;
};

using nlohmann::ordered_json;

/// Returns a body's name with the index of its triangle or part: "shelf" (triangle 3), or "cloud"
/// (part 7). Returns the name alone for a body of a single convex part.
std::string sideText(const std::string& name, std::uint32_t triangle, const Problem& problem) {
  std::string kind;
  for (const ModelBody& body : problem.model.bodies) {
    if (body.name != name) continue;
    const PlacedShape& shape = body.shapes.front();
    kind = shape.mesh ? "triangle" : shape.parts.size() > 1 ? "part" : "";
  }
  return "\"" + name + "\"" +
         (kind.empty() ? "" : " (" + kind + " " + std::to_string(triangle) + ")");
}

/// Returns the time, seconds, at which an edge of a trajectory has the parameter t.
double timeAt(const VerifyReport& report, int edge, double t) {
  const auto k = static_cast<std::size_t>(edge);
  return report.times[k] + t * (report.times[k + 1] - report.times[k]);
}

/// Returns the seconds with seven significant digits.
std::string secondsText(double seconds) {
  char text[32];
  std::snprintf(text, sizeof text, "%.7g", seconds + 0.0);  // no "-0"
  return text;
}

/// The maximum number of findings that are printed, and also of violations.
constexpr std::size_t kMostLines = 20;

/// Returns "edge 3 at t = 0.3, free until 0.25" or, with times, "edge 3 at 1.2 s, free until 1.1
/// s". Leaves out "free until" if no part of the edge before the finding is proved.
std::string whenText(const PathFinding& f, const VerifyReport& report) {
  const auto textAt = [&](double t) {
    return report.times.empty() ? rounded(t) : secondsText(timeAt(report, f.edge, t)) + " s";
  };
  const std::string at = textAt(f.t);
  std::string text =
      "edge " + std::to_string(f.edge) + (report.times.empty() ? " at t = " : " at ") + at;
  if (f.freeUntil && *f.freeUntil > 0) {
    const std::string until = textAt(*f.freeUntil);
    text += ", free until " + (until == at ? "then" : until);
  }
  return text;
}

/// Returns what can be done about a finding that concerns every state of the path.
std::string adviceOn(const PathFinding& f, const Model& model) {
  const auto bodyNamed = [&](const std::string& name) {
    return static_cast<std::size_t>(
        std::find_if(model.bodies.begin(), model.bodies.end(),
                     [&](const ModelBody& body) { return body.name == name; }) -
        model.bodies.begin());
  };
  return adviceAtRest(model, bodyNamed(f.a), bodyNamed(f.b));
}

std::string text(const PathFinding& f, const VerifyReport& report, const Problem& problem) {
  std::string line = std::string(nameOf(f.verdict)) + ": " +
                     (f.inEveryState ? "in every state" : whenText(f, report)) + ": " + f.reason;
  if (!f.a.empty()) {
    line += ": " + sideText(f.a, f.primitiveA, problem) + " and " +
            sideText(f.b, f.primitiveB, problem);
    if (f.gap > 0 && f.gap < f.required) {
      const auto [gap, required] = orderedTexts(f.gap, f.required);
      line += ", " + gap + " m apart, and more than " + required + " m is needed";
    } else if (f.gap > 0) {
      line += ", " + rounded(f.gap) + " m apart";
    }
    line += ", near " + rounded(f.point);
  }
  if (f.inEveryState) return line + ", and " + adviceOn(f, problem.model);
  return line + "; at " + stateText(problem.model.space, f.configuration);
}

ordered_json jsonOf(const PathFinding& f, const VerifyReport& report) {
  const auto seconds = [&](const std::optional<double>& t) {
    return t && !report.times.empty() ? ordered_json(timeAt(report, f.edge, *t)) : ordered_json();
  };
  return {{"verdict", nameOf(f.verdict)},
          {"reason", f.reason},
          {"edge", f.edge},
          {"t", f.t},
          {"in_every_state", f.inEveryState},
          {"free_until", f.freeUntil ? ordered_json(*f.freeUntil) : ordered_json()},
          {"time_s", seconds(f.t)},
          {"free_until_s", seconds(f.freeUntil)},
          {"state", numbersJson(f.configuration)},
          {"a", f.a},
          {"triangle_a", f.primitiveA},
          {"b", f.b},
          {"triangle_b", f.primitiveB},
          {"point", numbersJson(f.point)},
          {"gap_m", f.gap},
          {"required_m", f.required}};
}

ordered_json jsonOf(const Verified& verified, const Problem& problem, const LeftOut& leftOut,
                    const VerifyArguments& a) {
  const VerifyReport& r = verified.report;
  ordered_json j = {{"format", "corridor-verify-report-4"},
                    {"problem", a.problem},
                    {"solution", a.solution},
                    {"verdict", verdictName(r)},
                    {"digest", nameOf(r.digest)},
                    {"between", r.between ? ordered_json(nameOf(*r.between)) : ordered_json()},
                    {"begin_s", r.times.empty() ? ordered_json() : ordered_json(r.times.front())},
                    {"end_s", r.times.empty() ? ordered_json() : ordered_json(r.times.back())},
                    {"notes", textsOf(problem.source.notes)},
                    {"warnings", verified.warnings},
                    {"edges", r.pathReport.edges},
                    {"edges_proved", r.pathReport.edgesProved},
                    {"proved_clearance_m", numberJson(r.pathReport.provedClearance)},
                    {"closest_found_m", numberJson(r.pathReport.closestFound)},
                    {"margin_m", r.margin},
                    {"tube", tubeJson(problem.model.space, r.tube)},
                    {"numbers", problem.model.space.numberNames()},
                    {"distance_queries", r.pathReport.distanceQueries},
                    {"left_out", leftOutJson(problem.model, leftOut)},
                    {"not_tested", reasonGroups(leftOut)},
                    {"violations", r.violations},
                    {"findings", ordered_json::array()}};
  for (const PathFinding& finding : r.pathReport.findings)
    j["findings"].push_back(jsonOf(finding, r));
  if (r.limits) addLimits(j, *r.limits);
  return j;
}

void print(const VerifyReport& r, const Problem& problem, const LeftOut& leftOut,
           const VerifyArguments& a) {
  const ResultPrinter out(a.quiet);
  out.line("problem", a.problem);
  out.line(r.between ? "trajectory" : "solution", a.solution);
  const bool isProved = r.verdict == PathVerdict::proved;
  out.line("verdict", verdictName(r) + (isProved ? exceptText(problem.model, leftOut) : ""),
           isProved ? Tone::good : Tone::bad);
  if (r.otherProblem) return;
  for (const std::string& note : condensed(textsOf(problem.source.notes))) out.line("note", note);
  if (r.between)
    out.line("between rows",
             std::string(nameOf(*r.between)) +
                 (r.times.empty() ? ", without times"
                                  : ", from " + secondsText(r.times.front()) + " s to " +
                                        secondsText(r.times.back()) + " s"));
  out.line("edges proved",
           std::to_string(r.pathReport.edgesProved) + " of " + std::to_string(r.pathReport.edges));
  out.line("not tested", notTestedText(leftOut));
  if (r.pathReport.verdict == PathVerdict::proved)
    out.line("clearance", nothingIsTested(problem)
                              ? "none: no pair is tested"
                              : provedClearanceText(r.pathReport.provedClearance) +
                                    "; closest found: " + rounded(1e3 * r.pathReport.closestFound) +
                                    " mm");
  if (const std::string margin = marginText(problem.task, r.margin); !margin.empty())
    out.line("margin", margin);
  Padding padding = problem.task.padding;
  padding.beyond = {};
  if (!padding.empty())
    out.line("padding", "up to " + rounded(padding.largest()) + " m, as in the problem");
  out.line("tube", tubeText(problem.model.space, r.tube));
  out.line(r.between ? "bounds" : "start, goal, bounds", r.violations.empty() ? "hold" : "violated",
           r.violations.empty() ? Tone::plain : Tone::bad);
  for (std::size_t i = 0; i < std::min(r.violations.size(), kMostLines); ++i)
    out.line("violation", r.violations[i]);
  const auto addRest = [&](const char* key, std::size_t count) {
    if (count > kMostLines)
      out.line(key, grouped(count - kMostLines) + " more; --json has all of them");
  };
  addRest("violation", r.violations.size());
  if (r.limits)
    out.line("limits over time", limitsText(problem, *r.limits),
             exceedsLimits(*r.limits) ? Tone::bad : Tone::plain);
  // Edges that were not tested because of the work limit are counted; only the first of them is
  // printed.
  std::size_t findings = 0, notExamined = 0;
  for (const PathFinding& finding : r.pathReport.findings)
    if ((finding.reason != kWorkLimit || ++notExamined == 1) && ++findings <= kMostLines)
      out.line("finding", text(finding, r, problem));
  addRest("finding", findings);
  if (notExamined > 1)
    out.line("not examined",
             counted(notExamined - 1, "more edge") + ", because the work limit was reached");
  out.line("distance queries", grouped(r.pathReport.distanceQueries));
}

/// Reads and verifies the solution or trajectory. Adds the notes on a trajectory to the problem's.
Verified verify(Problem& problem, const VerifyArguments& a) {
  MotionFile motion = readMotion(problem, a.solution, a.between);
  if (motion.solution) {
    addAll(motion.solution->notes, problem.source.notes);
    return verifyWithWarning(problem, *motion.solution, a.problem, a.solution, a.ignoreDigest);
  }
  Verified verified{verifyTrajectory(problem, std::move(*motion.trajectory), motion.between), {}};
  addAll(verified.report.notes, problem.source.notes);
  if (verified.report.limits)  // some of the limits may be assumed
    for (const std::string& note : problem.task.limits.notes)
      problem.source.notes.push_back({note});
  return verified;
}

int verifyCommand(const VerifyArguments& a) {
  Problem problem = readProblemOf(a.problem);
  if (a.margin) setMargin(problem, *a.margin);
  const Verified verified = verify(problem, a);
  if (a.limits && !verified.report.limits)
    throw InputError(Fault{"--limits", 0, a.solution + " has no times, so it has no speed"});
  const Checker checker(problem);  // for notes, and what the proof leaves out
  addFirst(notesOnStart(checker, startOf(problem)), problem.source.notes);
  const LeftOut leftOut = leftOutOf(checker);
  if (!a.json) {
    print(verified.report, problem, leftOut, a);
  } else if (!a.quiet) {
    std::cout << jsonText(jsonOf(verified, problem, leftOut, a)) << '\n';
  }
  const std::optional<LimitRatios>& limits = verified.report.limits;
  const bool holds = verified.report.verdict == PathVerdict::proved &&
                     !(a.limits && limits && !keepsLimits(*limits));
  return holds ? kDone : kNegativeResult;
}

}  // namespace

void addVerify(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<VerifyArguments>();  // the callback keeps it
  VerifyArguments& a = *arguments;
  CLI::App* command = program.add_subcommand(
      "verify", "Prove or refute a path, independently of the checker that planned it");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  command
      ->add_option(
          "FILE", a.solution,
          "a solution file (-: standard input), rows of joint values (CSV) with or without "
          "times, a JointTrajectory of ROS or MoveIt (YAML, JSON), or an OMPL.app .path "
          "file")
      ->required();
  command
      ->add_option("--between", a.between,
                   "what a trajectory does between its rows: linear, cubic (with their velocities) "
                   "or quintic (and their accelerations). Default: the highest for which the file "
                   "has the values, as controllers of ros_control do")
      ->check(isOneOf({"linear", "cubic", "quintic"}));
  command
      ->add_option("--margin", a.margin,
                   "metres that all tested pairs must keep apart, in place of the problem's margin")
      ->check(isMetres());
  command->add_flag(
      "--limits", a.limits,
      "also exit with status 1 if a trajectory exceeds a limit of velocity, acceleration or jerk, "
      "or can't be tested against it");
  addIgnoreDigest(*command, a.ignoreDigest);
  addJson(*command, a.json);
  addQuiet(*command, a.quiet);
  command->footer(
      std::string("A trajectory makes no claim to solve the problem: if it does not begin at the "
                  "start or end in the goal, a note says so.\n"
                  "Example: corridor verify problems/piano piano.solution.yaml\n"
                  "         corridor verify mine/problem.yaml recorded.csv --between linear\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = verifyCommand(*arguments); });
}

}  // namespace corridor::app
