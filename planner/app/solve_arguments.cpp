#include "planner/app/solve_arguments.h"

#include "collision/core/error.h"
#include "collision/core/spelling.h"

namespace corridor::app {
namespace {

/// @throws InputError if a clearance is preferred, but the other settings don't allow that.
void requireClearance(const SolveArguments& a, const Problem& problem) {
  if (!(problem.settings.prefer.clearance.value_or(0) > 0)) return;
  if (const auto why = whyNoClearance(problem.task.margin, problem.settings))
    throw InputError(Fault{a.clearance ? "--clearance" : "the problem's prefer.clearance", 0,
                           *why + (a.clearance ? "" : " (--clearance 0 replaces it)")});
}

}  // namespace

std::map<std::string, std::string> applyArguments(const SolveArguments& a, Problem& problem) {
  std::map<std::string, std::string> set;
  if (a.planner && *a.planner != problem.settings.planner.name) {
    problem.settings.planner.name = *a.planner;
    problem.settings.planner.params.clear();  // they belong to the problem's planner
    set["planner.name"] = "--planner";
  }
  if (a.sampler) {
    const auto sampler = choiceNamed<ValidSampler>(*a.sampler);
    if (!sampler)
      throw InputError(Fault{"--sampler", 0, notOneOf(*a.sampler, wordsFor<ValidSampler>())});
    problem.settings.sampler = *sampler;
  }
  for (const std::string& assignment : a.set) {
    const auto equals = assignment.find('=');
    if (equals == std::string::npos || equals == 0)
      throw InputError(Fault{"--set", 0, "key=value is needed, not " + quotedWord(assignment)});
    const std::string key = assignment.substr(0, equals);
    if (set.count("planner.params." + key))
      throw InputError(Fault{"--set", 0, quotedWord(key) + " is set twice"});
    problem.settings.planner.params[key] = assignment.substr(equals + 1);
    set["planner.params." + key] = "--set";
  }
  if (a.time) problem.settings.planner.time = *a.time;
  if (a.stop) problem.settings.planner.stopAtFirst = *a.stop == "first";
  if (a.seed) problem.settings.seed = *a.seed;
  if (a.edges) problem.settings.checker.edges = choiceNamed<EdgeMethod>(*a.edges).value();
  if (const auto wrong = invalidNameIn(problem.settings.checker))
    throw InputError(
        Fault{"--edges", 0, "the problem's checker." + wrong->key + ": " + wrong->text});
  if (a.resolution) {
    if (problem.settings.checker.edges != EdgeMethod::discrete)
      throw InputError(
          Fault{"--resolution", 0,
                "needs --edges discrete, and edges are " + wordOf(problem.settings.checker.edges)});
    problem.settings.checker.resolution = *a.resolution;
  }
  if (a.margin) setMargin(problem, *a.margin);
  if (a.clearance) problem.settings.prefer.clearance = *a.clearance;
  if (a.simplify) problem.settings.simplify = choiceNamed<Simplifier>(*a.simplify).value();
  if (a.noSimplify) problem.settings.simplify = Simplifier::none;
  requireClearance(a, problem);
  TrajectorySettings& trajectory = problem.settings.trajectory;
  if (a.smooth && a.cornerDeviation && *a.smooth != wordOf(Smoothing::corners))
    throw InputError(
        Fault{"--corner-deviation", 0,
              "can't be combined with --smooth " + *a.smooth + "; leave one of them out"});
  if (a.smooth) {
    trajectory.smooth = choiceNamed<Smoothing>(*a.smooth).value();
    trajectory.cornerDeviation.reset();  // the file's value would replace `smooth`: corners only
  }
  if (a.deviation) trajectory.deviation = *a.deviation;
  if (a.cornerDeviation) trajectory.cornerDeviation = a.cornerDeviation;
  if (a.rate) trajectory.rate = a.rate;
  return set;
}

}  // namespace corridor::app
