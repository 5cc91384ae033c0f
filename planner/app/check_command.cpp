#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "collision/core/csv_text.h"
#include "collision/core/shortest.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/app/standard_streams.h"
#include "planner/checker/enclosed_bodies.h"
#include "planner/checker/left_out.h"
#include "planner/checker/problem_goal.h"
#include "planner/problem/bounds_of_ends.h"
#include "planner/problem/state_yaml.h"
#include "planner/solve/solve.h"
#include "planner/solve/state_rows.h"
#include "planner/solve/why_not_free.h"

namespace corridor::app {
namespace {

struct CheckArguments {
  std::string problem;
  std::optional<std::string> states;  ///< a file of states, one per line
  std::optional<std::string> edges;   ///< a file of edges, one per line
  bool json = false;
};

using nlohmann::ordered_json;

/// The verdict on a state of a file, and the reasons.
struct CheckedState {
  bool valid = false;
  std::vector<std::string> pairs;        ///< pairs that are not free: "hand~table"
  std::vector<std::string> outOfBounds;  ///< names of coordinates
  /// Set if a pair is undecided because a large value of the state has a rounding error that may
  /// exceed the clearance. Contains the name of the largest angle, or "" if no angle is beyond 2π;
  /// then the large value is in metres.
  std::optional<std::string> tooLarge;
};

/// Returns the name of the largest angle beyond 2π, or "" if no angle is that large. If it returns
/// "", the large values are coordinates in metres.
std::string largestAngle(const ConfigurationSpace& space, const Configuration& q) {
  const Coordinate* largest = nullptr;
  const auto size = [&](const Coordinate& c) {
    return std::abs(q[static_cast<Eigen::Index>(c.first)]);
  };
  for (const Coordinate& c : space.coordinates()) {
    const bool angle =
        c.kind == Coordinate::Kind::circle || (c.kind == Coordinate::Kind::line && c.angular);
    if (angle && size(c) > 2 * std::numbers::pi && (!largest || size(c) > size(*largest)))
      largest = &c;
  }
  return largest ? largest->name : "";
}

/// Sets each value that exceeds a limit by no more than a rounding error to that limit, and adds a
/// note. Returns the names of the coordinates that are farther outside of their limits.
std::vector<std::string> limitValues(const ConfigurationSpace& space, Configuration& q,
                                     std::vector<Note>& notes) {
  std::vector<std::string> outOfBounds;
  for (const Coordinate& c : space.coordinates()) {
    if (c.kind != Coordinate::Kind::line) continue;
    double& number = q[static_cast<Eigen::Index>(c.first)];
    std::string why;
    if (const auto value = coordinateValue(c, number, c.name, notes, why))
      number = *value;
    else
      outOfBounds.push_back(c.name);
  }
  return outOfBounds;
}

/// Checks a state as given: a continuous joint may have any angle, and no angle is wrapped.
CheckedState checkState(const Checker& checker, Configuration q, std::vector<Note>& notes) {
  CheckedState checked;
  checked.outOfBounds = limitValues(checker.space(), q, notes);
  const std::vector<ModelBody>& bodies = checker.model().bodies;
  for (const Checker::PairNotFree& pair : checker.pairsNotFree(q)) {
    checked.pairs.push_back(bodies[pair.a].name + "~" + bodies[pair.b].name);
    if (pair.tooLarge) checked.tooLarge = largestAngle(checker.space(), q);
  }
  checked.valid = checked.pairs.empty() && checked.outOfBounds.empty();
  return checked;
}

/// Warns of values that `limitValues` has changed.
void warnOfLimits(const std::string& file, std::size_t count, const char* what) {
  if (count)
    warn(file + ": in " + counted(count, what) +
         ", values that exceeded a limit only by rounding were set to the limit");
}

/// Prints the JSON report on the states or edges of a file. Without `a.json`, the rows are printed
/// already; then only prints on stderr the problem's notes, and what the word "free" leaves out.
void printReport(const CheckArguments& a, const Problem& problem, const LeftOut& leftOut,
                 bool valid, const char* key, const ordered_json& rows) {
  if (a.json)
    std::cout << jsonText(ordered_json{{"format", "corridor-check-report-2"},
                                       {"problem", a.problem},
                                       {"numbers", problem.model.space.numberNames()},
                                       {"valid", valid},
                                       {"left_out", leftOutJson(problem.model, leftOut)},
                                       {"not_tested", reasonGroups(leftOut)},
                                       {"notes", textsOf(problem.source.notes)},
                                       {key, rows}})
              << '\n';
  if (a.json) return;
  printNotes(problem.source.notes);
  if (!leftOut.except.empty())
    std::cerr << "note: the " << key << " are tested" << exceptText(problem.model, leftOut) << '\n';
}

/// Adds notes on a file of rows to the problem's for JSON, or else prints them.
void noteFile(const std::vector<Note>& notes, const CheckArguments& a, Problem& problem) {
  if (a.json) return addFirst(notes, problem.source.notes);
  for (const Note& note : notes) std::cerr << "note: " << note.text << '\n';
}

int checkStates(Problem problem, const CheckArguments& a) {
  std::vector<Note> fileNotes;
  const std::vector<StateRow> rows = readStateRows(*a.states, problem.model.space, fileNotes);
  noteFile(fileNotes, a, problem);
  const Checker checker(problem);
  addFirst(notesOnStart(checker, startOf(problem)), problem.source.notes);
  bool all = true;
  std::size_t noted = 0;
  ordered_json states = ordered_json::array();
  if (!a.json) std::cout << "state,valid,pairs\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<Note> notes;
    const CheckedState state = checkState(checker, rows[i].q, notes);
    noted += !notes.empty();
    all &= state.valid;
    if (a.json) {
      states.push_back({{"state", i},
                        {"line", rows[i].line},
                        {"valid", state.valid},
                        {"pairs", state.pairs},
                        {"out_of_bounds", state.outOfBounds}});
      if (state.tooLarge) states.back()["too_large"] = *state.tooLarge;
      continue;
    }
    std::string why;
    for (const std::string& pair : state.pairs) why += (why.empty() ? "" : ";") + pair;
    for (const std::string& name : state.outOfBounds)
      why += (why.empty() ? "bounds:" : ";bounds:") + name;
    if (state.tooLarge)
      why += ";too_large" + (state.tooLarge->empty() ? "" : ":" + *state.tooLarge);
    std::cout << i << ',' << state.valid << ',' << csvField(why) << '\n';
    if (!std::cout) requireResultsWritten();  // throws: nothing can be written any more
  }
  warnOfLimits(*a.states, noted, "state");
  printReport(a, problem, leftOutOf(checker), all, "states", states);
  return all ? kDone : kNegativeResult;
}

/// The answer about an edge of a file, as it is printed.
struct CheckedEdge {
  std::string verdict, pair, reason;
  std::optional<double> t0, t1;
};

CheckedEdge checkEdge(const Checker& checker, EdgeRow row, std::vector<Note>& notes) {
  CheckedEdge edge;
  for (Configuration* q : {&row.from, &row.to})
    for (const std::string& name : limitValues(checker.space(), *q, notes))
      edge.reason += (edge.reason.empty() ? "bounds:" : ";bounds:") + name;
  if (!edge.reason.empty()) {
    edge.verdict = "out_of_bounds";
    return edge;
  }
  // A contact at the beginning of the edge is reported as a contact of its first state.
  MotionResult result = checker.certifyState(row.from);
  if (result.verdict == MotionVerdict::contact)
    result.time = result.certifiedUntil = 0;
  else
    result = checker.certifyEdge(row.from, row.to, {.earliest = true});
  edge.verdict = nameOf(result.verdict);
  edge.reason = nameOf(result.reason);
  edge.t0 = result.certifiedUntil;
  if (result.time >= 0) edge.t1 = result.time;
  if (result.pair) {
    // The two bodies are named in the order of the model's bodies, as for states.
    const auto [a, b] =
        std::minmax({checker.bodyOf(result.pair->bodyA), checker.bodyOf(result.pair->bodyB)});
    edge.pair = checker.model().bodies[a].name + "~" + checker.model().bodies[b].name;
  }
  return edge;
}

/// Decides each edge of a file, and prints its first contact, and how far it is proved free.
int checkEdges(Problem problem, const CheckArguments& a) {
  std::vector<Note> fileNotes;
  const std::vector<EdgeRow> rows = readEdgeRows(*a.edges, problem.model.space, fileNotes);
  noteFile(fileNotes, a, problem);
  const Checker checker(problem);
  addFirst(notesOnStart(checker, startOf(problem)), problem.source.notes);
  bool all = true;
  std::size_t noted = 0;
  ordered_json edges = ordered_json::array();
  if (!a.json) std::cout << "edge,verdict,t0,t1,pair,reason\n";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    std::vector<Note> notes;
    const CheckedEdge edge = checkEdge(checker, rows[i], notes);
    noted += !notes.empty();
    all &= edge.verdict == "free";
    if (a.json) {
      const auto number = [](const std::optional<double>& t) {
        return t ? ordered_json(*t) : ordered_json();
      };
      edges.push_back({{"edge", i},
                       {"line", rows[i].line},
                       {"verdict", edge.verdict},
                       {"t0", number(edge.t0)},
                       {"t1", number(edge.t1)},
                       {"pair", edge.pair},
                       {"reason", edge.reason}});
      continue;
    }
    const auto number = [](const std::optional<double>& t) { return t ? shortest(*t) : ""; };
    std::cout << i << ',' << edge.verdict << ',' << number(edge.t0) << ',' << number(edge.t1) << ','
              << csvField(edge.pair) << ',' << edge.reason << '\n';
    if (!std::cout) requireResultsWritten();  // throws: nothing can be written any more
  }
  warnOfLimits(*a.edges, noted, "edge");
  printReport(a, problem, leftOutOf(checker), all, "edges", edges);
  return all ? kDone : kNegativeResult;
}

int checkEnds(Problem problem, const CheckArguments& a) {
  checkSettings(problem);
  const Checker checker(problem);
  addFirst(notesOnStart(checker, startOf(problem)), problem.source.notes);
  const LeftOut leftOut = leftOutOf(checker);
  const ResultPrinter out(a.json);
  ordered_json ends;
  const auto checkEnd = [&](const std::string& name, const Configuration& q) {
    const auto why = whyNotFree(q, checker);
    ends[name] = why.value_or("free");
    out.line(name, why.value_or("free" + exceptText(problem.model, leftOut)),
             why ? Tone::bad : Tone::good);
    return !why;
  };
  out.line("problem", a.problem);
  bool all = checkEnd("start", startOf(problem));
  const std::vector<Configuration> goals = goalsOf(problem);
  for (std::size_t i = 0; i < goals.size(); ++i)
    all &= checkEnd(goals.size() == 1 ? "goal" : "goal " + std::to_string(i + 1), goals[i]);
  out.line("not tested", notTestedText(leftOut));
  for (const std::string& note : condensed(textsOf(problem.source.notes))) out.line("note", note);
  if (a.json)
    std::cout << jsonText(ordered_json{{"format", "corridor-check-report-2"},
                                       {"problem", a.problem},
                                       {"valid", all},
                                       {"ends", ends},
                                       {"left_out", leftOutJson(problem.model, leftOut)},
                                       {"not_tested", reasonGroups(leftOut)},
                                       {"notes", textsOf(problem.source.notes)}})
              << '\n';
  return all ? kDone : kNegativeResult;
}

int checkCommand(const CheckArguments& a) {
  Problem problem = readProblemOf(a.problem);
  if (a.states) return checkStates(std::move(problem), a);
  return a.edges ? checkEdges(std::move(problem), a) : checkEnds(std::move(problem), a);
}

}  // namespace

void addCheck(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<CheckArguments>();  // the callback keeps it
  CheckArguments& a = *arguments;
  CLI::App* command =
      program.add_subcommand("check", "Check a problem, or many states or edges, without planning");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  CLI::Option* states = command->add_option(
      "--states", a.states,
      "check the states in this file (-: standard input): one per line, numbers "
      "separated by blanks or commas, # starts a comment. Prints a line "
      "state,valid,pairs for each state");
  command
      ->add_option(
          "--edges", a.edges,
          "decide the edges in this file (-: standard input): one per line, the numbers of "
          "its two states. Prints a line edge,verdict,t0,t1,pair,reason for each edge. The "
          "edge is proved free until t0. The verdict is free; contact: the pair touches at t1, or "
          "is within the margin; undecided: the pair could not be decided at t1; or out_of_bounds")
      ->excludes(states);
  addJson(*command, a.json);
  command->footer(
      std::string(
          "Example: corridor check problems/arm_at_shelf --states states.txt > valid.csv\n"
          "The numbers of a state are the values of the problem's joints, in the order that "
          "`corridor inspect` prints.\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = checkCommand(*arguments); });
}

}  // namespace corridor::app
