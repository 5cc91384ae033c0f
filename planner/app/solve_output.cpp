#include "planner/app/solve_output.h"

#include <cmath>
#include <iostream>

#include <nlohmann/json.hpp>

#include "planner/app/limits_output.h"
#include "planner/app/output.h"
#include "planner/trajectory/rows_limits.h"

namespace corridor::app {

using nlohmann::ordered_json;

bool printsFile(const SolveArguments& a) {
  return a.output == "-" || a.picture == "-";
}

std::string durationText(double seconds) {
  return seconds < 1 ? rounded(1e3 * seconds) + " ms" : rounded(seconds) + " s";
}

std::string percent(double share) {
  return rounded(std::floor(1e3 * share) / 10) + " %";
}

namespace {

/// Returns the seconds of each of `kSolvePhases`.
std::array<double, kSolvePhases.size()> secondsOf(const Solved& solved) {
  const SolveReport& r = solved.report;
  const bool finished = r.outcome == SolveOutcome::solved;
  return {solved.readingTime,
          r.setUpTime,
          r.planningTime - r.setUpTime,
          finished ? r.time - r.planningTime - r.certificationTime - r.trajectoryTime : 0,
          r.certificationTime,
          r.trajectoryTime};
}

std::string reasonOf(WhyOffTarget why) {
  switch (why) {
    case WhyOffTarget::detour:
      return "; the ways found that keep it are longer than prefer.detour allows";
    case WhyOffTarget::notFound:
      return "; no way that keeps it was found";
    case WhyOffTarget::time:
      return "; the time ran out before all searches for a way that keeps it were made";
    case WhyOffTarget::unknown:
      break;
  }
  return "";
}

/// Returns the lines of the report about the clearance of the path.
std::vector<std::string> clearanceLines(const PathClearance& c) {
  std::vector<std::string> lines;
  lines.push_back(provedClearanceText(c.proved));
  if (std::isfinite(c.smallestAtEnds))
    lines.back() += " (start and goal themselves: " + rounded(1e3 * c.smallestAtEnds) + " mm)";
  if (!c.a.empty())
    lines.back() += "; closest found: " + c.a + " and " + c.b + ", " + rounded(1e3 * c.smallest) +
                    " mm, edge " + std::to_string(c.edge) + " at " + rounded(c.t);
  lines.push_back("every pair keeps the preferred distance, as far as start and goal allow" +
                  (std::isfinite(c.smallestAtEnds)
                       ? " (" + rounded(1e3 * c.leastTarget) + " mm or more)"
                       : std::string()) +
                  ", on " + percent(c.shareOnTarget) + " of the length" + reasonOf(c.why));
  return lines;
}

ordered_json clearanceJson(const PathClearance& c) {
  ordered_json j = {{"proved_clearance_m", c.proved},
                    {"share_on_target", c.shareOnTarget},
                    {"least_target_m", c.leastTarget}};
  if (c.why != WhyOffTarget::unknown) j["why_off_target"] = nameOf(c.why);
  if (std::isfinite(c.smallestAtEnds)) j["ends_m"] = c.smallestAtEnds;
  if (c.a.empty()) return j;
  j["closest_found_m"] = c.smallest;
  j["closest"] = {{"bodies", {c.a, c.b}}, {"edge", c.edge}, {"t", c.t}};
  return j;
}

/// @param except what the proofs leave out (exceptText).
void printTrajectory(const ResultPrinter& out, const Problem& p, const MadeTrajectory& made,
                     const std::string& except) {
  if (!made.fault.empty()) {
    out.line("trajectory", "none: " + made.fault, Tone::bad);
    return;
  }
  out.line("trajectory", rounded(made.duration) + " s, " + counted(made.rows, "row") + ", " +
                             nameOf(made.between) + " between rows; " +
                             std::to_string(made.rounded) + " of " +
                             counted(made.corners, "corner") + " rounded" +
                             (made.whyStops.empty() ? "" : ": " + made.whyStops));
  const MotionResult& proof = made.proof;
  out.line("trajectory proved",
           made.proved() ? "yes, as it is written" + except
                         : "no: " +
                               std::string(proof.verdict == MotionVerdict::contact ? "contact"
                                                                                   : "undecided") +
                               " between rows " + std::to_string(made.failedPiece) + " and " +
                               std::to_string(made.failedPiece + 1),
           made.proved() ? Tone::good : Tone::bad);
  if (made.clearance)
    out.line("trajectory clearance",
             provedClearanceText(made.clearance->proved) +
                 "; every pair keeps the preferred distance, as far as start and goal allow, " +
                 (made.clearance->shareOnTarget == 1
                      ? "everywhere"
                      : "on " + percent(made.clearance->shareOnTarget) + " of the time") +
                 (made.timeLost.value_or(0) < 0.0005
                      ? ""
                      : "; this costs about " + withDigits(*made.timeLost, 2) + " s"));
  out.line("limits", limitsText(p, made.ratios),
           keepsLimits(made.ratios) ? Tone::plain : Tone::bad);
  for (const std::string& note : p.task.limits.notes) out.line("note", note);
}

ordered_json trajectoryJson(const Problem& p, const MadeTrajectory& made) {
  if (!made.fault.empty()) return {{"why_none", made.fault}};
  ordered_json j = {{"duration_s", made.duration},     {"rows", made.rows},
                    {"between", nameOf(made.between)}, {"proved", made.proved()},
                    {"corners", made.corners},         {"corners_rounded", made.rounded},
                    {"why_stops", made.whyStops},      {"curve_tests", made.curveTests},
                    {"stretch", made.stretch},         {"notes", p.task.limits.notes}};
  if (made.clearance) {
    j["clearance"] = {{"proved_clearance_m", made.clearance->proved},
                      {"share_on_target", made.clearance->shareOnTarget}};
    if (made.timeLost) j["clearance"]["time_lost_s"] = *made.timeLost;
  }
  addLimits(j, made.ratios);
  return j;
}

}  // namespace

void print(const Solved& result, const std::string& problem, const SolveArguments& a) {
  const Problem& p = result.problem;
  const SolveReport& r = result.report;
  const bool solved = r.outcome == SolveOutcome::solved;
  if (printsFile(a)) {
    if (!solved) warn(std::string(nameOf(r.outcome)) + ": " + r.why);
    printNotes(p.source.notes);
  }
  const ResultPrinter out(a.quiet || printsFile(a));
  out.line("problem", problem);
  out.line("result", nameOf(r.outcome), solved ? Tone::good : Tone::bad);
  if (!solved) out.line("why", r.why);
  for (const std::string& note : condensed(textsOf(p.source.notes))) out.line("note", note);
  out.line("planner", r.planner);
  out.line("seed", std::to_string(r.seed) +
                       (result.tries > 1 ? ", the best of " + std::to_string(result.tries) : ""));
  std::string phases;
  const auto seconds = secondsOf(result);
  for (std::size_t i = 0; i < seconds.size(); ++i)
    if (a.trajectory || kSolvePhases[i].key != std::string_view("trajectory_s"))
      phases +=
          (i == 0 ? "" : ", ") + std::string(kSolvePhases[i].name) + " " + durationText(seconds[i]);
  out.line("time", phases);
  if (r.restarts > 0) out.line("restarts of the search", grouped(r.restarts));
  out.line("states checked", grouped(r.counters.states));
  out.line("edges checked", grouped(r.counters.edges));
  out.line("undecided", grouped(r.counters.undecided));
  out.line("box tests N_v", grouped(r.counters.boxTests));
  out.line("triangle tests N_p", grouped(r.counters.primitiveTests));
  if (!solved) return;
  out.line("path length", lengthText(p.model.space, r.length.metres, r.length.radians));
  out.line("path states", grouped(r.path.size()));
  if (r.clearance) {
    for (const std::string& line : clearanceLines(*r.clearance)) out.line("clearance", line);
  }
  if (const std::string margin = marginText(p.task, r.margin); !margin.empty())
    out.line("margin", margin);
  const std::string except = exceptText(p.model, r.leftOut);
  out.line("certified", r.certified ? "yes" + except : "no (" + r.checker + ")",
           r.certified ? Tone::good : Tone::bad);
  if (r.trajectory) printTrajectory(out, p, *r.trajectory, except);
  if (r.trajectory && r.trajectory->proved() && r.clearance && !r.trajectory->clearance)
    out.line("note",
             "the clearance above is the path's; the trajectory may come closer "
             "(prefer.clearance_of: path); "
             "corridor verify reports its clearance");
  if (a.output) out.line("solution", *a.output);
  if (r.trajectory && r.trajectory->proved()) out.line("trajectory file", *a.trajectory);
  if (a.picture) out.line("picture", *a.picture);
}

ordered_json jsonOf(const Solved& result, const std::string& problem) {
  const Problem& p = result.problem;
  const SolveReport& r = result.report;
  ordered_json phases;
  const auto seconds = secondsOf(result);
  for (std::size_t i = 0; i < seconds.size(); ++i)
    if (r.trajectory || kSolvePhases[i].key != std::string_view("trajectory_s"))
      phases[kSolvePhases[i].key] = seconds[i];
  ordered_json j = {{"problem", problem},
                    {"result", nameOf(r.outcome)},
                    {"planner", r.planner},
                    {"seed", r.seed},
                    {"tries", result.tries},
                    {"restarts", r.restarts},
                    {"repeats", r.repeatable},
                    {"time_s", r.time},
                    {"planning_time_s", r.planningTime},
                    {"phases", phases},
                    {"states_checked", r.counters.states},
                    {"edges_checked", r.counters.edges},
                    {"undecided", r.counters.undecided},
                    {"box_tests", r.counters.boxTests},
                    {"triangle_tests", r.counters.primitiveTests},
                    {"checker", r.checker},
                    {"certified", r.certified},
                    {"left_out", leftOutJson(p.model, r.leftOut)},
                    {"tolerance_m", r.tolerance},
                    {"margin_m", r.margin},
                    {"tube", tubeJson(p.model.space, p.task.tube)}};
  if (!p.source.notes.empty()) j["notes"] = textsOf(p.source.notes);
  if (!r.warnings.empty()) {
    j["warnings"] = ordered_json::array();
    for (const Fault& fault : r.warnings) j["warnings"].push_back(fault.text);
  }
  if (r.outcome == SolveOutcome::solved) {
    ordered_json rows = ordered_json::array();
    for (const Configuration& q : r.path) rows.push_back(numbersJson(q));
    if (r.clearance) j["clearance"] = clearanceJson(*r.clearance);
    if (r.trajectory) j["trajectory"] = trajectoryJson(p, *r.trajectory);
    j["numbers"] = p.model.space.numberNames();
    j["path"] = {{"states", r.path.size()},
                 {"length_m", r.length.metres},
                 {"rotation_rad", r.length.radians},
                 {"raw_states", r.rawStates},
                 {"version", r.version},
                 {"rows", rows}};
  } else {
    j["why"] = r.why;
  }
  return j;
}

ordered_json reportJson(const ordered_json& problems) {
  return {{"format", "corridor-solve-report-2"}, {"problems", problems}};
}

}  // namespace corridor::app
