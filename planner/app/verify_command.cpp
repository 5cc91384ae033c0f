#include <iostream>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/checker/problem_goal.h"
#include "planner/checker/still_pairs.h"
#include "planner/problem/nothing_tested.h"
#include "planner/solve/verify_solution.h"

namespace corridor::app {
namespace {

struct VerifyArguments {
  std::string problem, solution;
  std::optional<double> margin;
  bool ignoreDigest = false;  ///< verify the solution even if its digest is not the problem's
  bool json = false, quiet = false;
};

using nlohmann::ordered_json;

/// Returns "shelf" (triangle 3), or "cloud" (part 7), or the name alone for a single convex part.
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

/// Returns ", free until then", ", free until 0.25", or "" if nothing is proved before the finding.
std::string freeUntilText(const PathFinding& f) {
  if (!f.freeUntil || *f.freeUntil == 0) return "";
  const std::string until = rounded(*f.freeUntil);
  return ", free until " + (until == rounded(f.t) ? "then" : until);
}

std::string text(const PathFinding& f, const Problem& problem) {
  std::string line = std::string(nameOf(f.verdict)) + ": edge " + std::to_string(f.edge) +
                     " at t = " + rounded(f.t) + freeUntilText(f) + ": " + f.reason;
  if (!f.a.empty()) {
    line +=
        ": " + sideText(f.a, f.triangleA, problem) + " and " + sideText(f.b, f.triangleB, problem);
    if (f.gap > 0) line += ", " + rounded(f.gap) + " m apart";
    line += ", near " + rounded(f.point);
  }
  return line + "; at " + stateText(problem.model.space, f.configuration);
}

ordered_json jsonOf(const PathFinding& f) {
  return {{"verdict", nameOf(f.verdict)},
          {"reason", f.reason},
          {"edge", f.edge},
          {"t", f.t},
          {"free_until", f.freeUntil ? ordered_json(*f.freeUntil) : ordered_json()},
          {"state", numbersJson(f.configuration)},
          {"a", f.a},
          {"triangle_a", f.triangleA},
          {"b", f.b},
          {"triangle_b", f.triangleB},
          {"point", numbersJson(f.point)},
          {"gap_m", f.gap}};
}

ordered_json jsonOf(const Verified& verified, const Problem& problem, const VerifyArguments& a) {
  const VerifyReport& r = verified.report;
  ordered_json j = {{"format", "corridor-verify-report-3"},
                    {"problem", a.problem},
                    {"solution", a.solution},
                    {"verdict", verdictName(r)},
                    {"digest", nameOf(r.digest)},
                    {"notes", textsOf(problem.source.notes)},
                    {"warnings", verified.warnings},
                    {"edges", r.pathReport.edges},
                    {"edges_proved", r.pathReport.edgesProved},
                    {"proven_clearance_m", numberJson(r.pathReport.provenClearance)},
                    {"smallest_distance_met_m", numberJson(r.pathReport.smallestDistanceMet)},
                    {"margin_m", r.margin},
                    {"tube", tubeJson(problem.model.space, r.tube)},
                    {"numbers", problem.model.space.numberNames()},
                    {"distance_queries", r.pathReport.distanceQueries},
                    {"violations", r.violations},
                    {"findings", ordered_json::array()}};
  for (const PathFinding& finding : r.pathReport.findings) j["findings"].push_back(jsonOf(finding));
  return j;
}

void print(const VerifyReport& r, const Problem& problem, const VerifyArguments& a) {
  const ResultPrinter out(a.quiet);
  out.line("problem", a.problem);
  out.line("solution", a.solution);
  out.line("verdict", verdictName(r), r.verdict == PathVerdict::proved ? Tone::good : Tone::bad);
  if (r.otherProblem) return;
  for (const std::string& note : condensed(textsOf(problem.source.notes))) out.line("note", note);
  out.line("edges proved",
           std::to_string(r.pathReport.edgesProved) + " of " + std::to_string(r.pathReport.edges));
  if (r.pathReport.verdict == PathVerdict::proved)
    out.line("clearance", nothingIsTested(problem)
                              ? "none: no pair is tested"
                              : "at least " + rounded(r.pathReport.provenClearance) +
                                    " m, at most " + rounded(r.pathReport.smallestDistanceMet) +
                                    " m");
  if (r.margin > 0) out.line("margin", rounded(r.margin) + " m");
  if (!problem.task.padding.empty())
    out.line("padding",
             "up to " + rounded(problem.task.padding.largest()) + " m, as in the problem");
  out.line("tube", tubeText(problem.model.space, r.tube));
  out.line("start, goal, bounds", r.violations.empty() ? "hold" : "violated",
           r.violations.empty() ? Tone::plain : Tone::bad);
  for (const std::string& violation : r.violations) out.line("violation", violation);
  for (const PathFinding& finding : r.pathReport.findings)
    out.line("finding", text(finding, problem));
  out.line("distance queries", grouped(r.pathReport.distanceQueries));
}

int verifyCommand(const VerifyArguments& a) {
  Problem problem = readProblemOf(a.problem);
  if (a.margin) setMargin(problem, *a.margin);
  const Solution solution = readSolution(a.solution, problem.model.space);
  const Verified verified =
      verifyWithWarning(problem, solution, a.problem, a.solution, a.ignoreDigest);
  if (hasStillPairs(problem.model))
    addFirst(notesOnStillPairs(Checker(problem), startOf(problem)), problem.source.notes);
  if (!a.json) {
    print(verified.report, problem, a);
  } else if (!a.quiet) {
    std::cout << jsonOf(verified, problem, a).dump(2) << '\n';
  }
  return verified.report.verdict == PathVerdict::proved ? kDone : kNegativeResult;
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
          "SOLUTION", a.solution,
          "a solution file (-: standard input), or an OMPL.app .path file with one state per "
          "line")
      ->required();
  command
      ->add_option("--margin", a.margin,
                   "metres that all tested pairs must keep apart, in place of the problem's margin")
      ->check(isMetres());
  addIgnoreDigest(*command, a.ignoreDigest);
  addJson(*command, a.json);
  addQuiet(*command, a.quiet);
  command->footer(std::string("Example: corridor verify problems/piano piano.solution.yaml\n") +
                  kExitStatus);
  command->callback([arguments, &status] { status = verifyCommand(*arguments); });
}

}  // namespace corridor::app
