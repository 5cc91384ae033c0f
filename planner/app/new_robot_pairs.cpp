#include "planner/app/new_robot_pairs.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <map>
#include <unistd.h>

#include "collision/core/shortest.h"
#include "planner/app/output.h"

namespace corridor::app {
namespace {

using Verdict = NeverInContactResult::Verdict;

/// Returns whether a pair was in contact in so many random states that it probably is in contact by
/// design, or that a planner would hardly find a valid state.
bool nearlyAlwaysInContact(std::size_t contacts, std::size_t samples) {
  // At least 95 %.
  return samples > 0 && contacts >= samples - samples / 20;
}

bool byContacts(const SurveyedPair& a, const SurveyedPair& b) {
  return a.contacts > b.contacts;
}

/// Shows on stderr, in one line, how far a survey is.
class ProgressLine {
 public:
  explicit ProgressLine(const NewRobotArguments& a) : a_(a) {}
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  ~ProgressLine() {
    if (!shown_.empty()) std::fputs("\r\033[K", stderr);
  }

  void show(const PairSurveyProgress& p) {
    const auto percent = [](std::uint64_t part, std::uint64_t whole) {
      const double share = static_cast<double>(part) / static_cast<double>(whole);
      return std::to_string(static_cast<int>(100 * std::min(share, 1.0))) + " %";
    };
    std::string text = a_.urdf + ": ";
    if (p.samples < a_.samples)
      text += percent(p.samples, a_.samples) + " of " + counted(a_.samples, "random state");
    else if (p.work > 0)
      text += counted(p.proved, "pair") + " proved never in contact, " + grouped(p.undecided) +
              " undecided, " + percent(p.work, a_.work) + " of --work";
    else
      return;
    if (text == shown_) return;
    shown_ = text;
    std::fprintf(stderr, "\r%s\033[K", text.c_str());
  }

 private:
  const NewRobotArguments& a_;
  std::string shown_;
};

std::string pairText(const Model& model, const SurveyedPair& pair) {
  return yamlList({model.bodies[pair.a].name, model.bodies[pair.b].name});
}

/// Returns "in 12 of 1,000": the random states in which the pair was in contact.
std::string contactsText(const NewRobotArguments& a, const SurveyedPair& pair) {
  return "in " + grouped(pair.contacts) + " of " + grouped(a.samples);
}

/// Returns the pairs that are nearly always in contact: as comments, for the user to decide, or as
/// allowed pairs.
std::string decideText(const NewRobotArguments& a, const Model& model,
                       const std::vector<SurveyedPair>& nearlyAlways) {
  if (nearlyAlways.empty()) return "";
  const auto always = static_cast<std::size_t>(
      std::count_if(nearlyAlways.begin(), nearlyAlways.end(),
                    [&](const SurveyedPair& pair) { return pair.contacts == a.samples; }));
  const std::string found =
      counted(nearlyAlways.size(), "pair") + " in contact in at least 95 % of " +
      counted(a.samples, "random state") + ", of which " + grouped(always) + " in all. ";
  const std::string unreported = "No contact of an allowed pair is reported.";
  const std::string sign = a.allowOverlaps ? "" : "# ";
  std::string text = comment(
      a.allowOverlaps
          ? "Allowed by --allow-overlaps: " + found + unreported
          : "DECIDE: " + found +
                "While these pairs are tested, hardly any state is valid. If the shapes overlap by "
                "design, remove the # of allow and of these pairs, or run corridor new robot with "
                "--allow-overlaps; if not, correct the URDF, or plan for fewer joints (see joints "
                "above). " +
                unreported);
  text += sign + "allow:\n";
  for (const SurveyedPair& pair : nearlyAlways)
    text += sign + "  - " + pairText(model, pair) + "  # " + contactsText(a, pair) + "\n";
  return text;
}

/// Returns how many pairs are tested, and why, as a comment.
std::string testedText(const NewRobotArguments& a, const Model& model,
                       const std::vector<SurveyedPair>& tested) {
  std::size_t close = 0, others = 0;
  std::vector<SurveyedPair> inContact, undecided;
  for (const SurveyedPair& pair : tested)
    if (pair.contacts > 0 && !pair.movesFreely)
      inContact.push_back(pair);
    else if (pair.proof && pair.proof->verdict == Verdict::tooClose)
      ++close;
    else if (pair.proof && pair.proof->verdict == Verdict::workLimit)
      undecided.push_back(pair);
    else
      ++others;
  std::stable_sort(inContact.begin(), inContact.end(), byContacts);
  std::string text = comment(
      "Tested: " + counted(tested.size(), "pair") + ". Closer than " + shortest(a.margin) +
          " m at some joint values: " + grouped(close) +
          ". No proof possible (such as a joint without limits, a planar or floating "
          "joint, a solid mesh), or none tried: " +
          grouped(others) + ". In contact in some of " + counted(a.samples, "random state") + ": " +
          grouped(inContact.size()) + (inContact.empty() ? "." : ":"),
      2);
  for (const SurveyedPair& pair : inContact)
    text += "  # - " + pairText(model, pair) + ": " + contactsText(a, pair) + "\n";
  text += comment("Not decided within --work " + std::to_string(a.work) + ": " +
                      grouped(undecided.size()) + (undecided.empty() ? "." : ":"),
                  2);
  for (const SurveyedPair& pair : undecided) text += "  # - " + pairText(model, pair) + "\n";
  return text;
}

}  // namespace

SortedPairs sortedPairs(const Checker& checker, const std::vector<AllowedPair>& allowed,
                        const NewRobotArguments& a, const std::atomic<bool>& interrupted) {
  const Model& model = checker.model();
  std::map<std::pair<std::string, std::string>, std::string> reasons;
  for (const AllowedPair& pair : allowed)
    reasons.emplace(std::minmax(pair.a, pair.b), pair.reason);  // the first reason counts
  const auto reasonOf = [&](std::size_t i, std::size_t k) {
    const auto found = reasons.find(std::minmax(model.bodies[i].name, model.bodies[k].name));
    return found == reasons.end() ? std::string() : found->second;
  };
  SortedPairs pairs;
  forEachPair(model, checker.required(), [&](std::size_t, std::size_t, std::string_view why) {
    pairs.adjacent += why == "adjacent";
  });
  PairSurveyOptions options{a.margin, a.beyondLimits, a.work, a.samples, a.seed, {}, &interrupted};
  ProgressLine line(a);
  if (::isatty(STDERR_FILENO) != 0)
    options.progress = [&](const PairSurveyProgress& p) { line.show(p); };
  const auto surveyed = surveyPairs(
      checker, options, [&](std::size_t i, std::size_t k) { return reasonOf(i, k).empty(); });
  for (const SurveyedPair& pair : surveyed) {
    if (const std::string reason = reasonOf(pair.a, pair.b); !reason.empty()) {
      ++pairs.bySrdf;
      if (!pair.movesFreely && 0 < pair.contacts && pair.contacts < a.samples)
        pairs.contradicted.emplace_back(pair, reason);
    } else if (pair.proof && pair.proof->verdict == Verdict::proved) {
      pairs.proved.push_back(pair);
    } else if (!pair.movesFreely && nearlyAlwaysInContact(pair.contacts, a.samples)) {
      pairs.nearlyAlways.push_back(pair);
    } else {
      pairs.tested.push_back(pair);
    }
  }
  std::stable_sort(pairs.nearlyAlways.begin(), pairs.nearlyAlways.end(), byContacts);
  return pairs;
}

std::string pairsText(const NewRobotArguments& a, const Model& model, const SortedPairs& pairs,
                      const RobotDigest& robot) {
  std::string text =
      "\n" +
      comment("Pairs of links that are not tested, besides adjacent links (" +
              grouped(pairs.adjacent) + ")" +
              (a.srdf ? " and those of the SRDF (" + grouped(pairs.bySrdf) + ")" : "") + ":");
  if (pairs.proved.empty()) {
    text += comment("No pair was proved never in contact.");
  } else {
    std::vector<std::array<std::string, 2>> names;
    for (const SurveyedPair& pair : pairs.proved)
      names.push_back({model.bodies[pair.a].name, model.bodies[pair.b].name});
    text +=
        "never_in_contact:\n" +
        comment(
            counted(pairs.proved.size(), "pair") +
                " proved: the two links keep the margin (m) for all joint values within the "
                "limits, where each limit is extended by beyond_limits (rad or m). Problems "
                "with a larger margin or tube test these pairs. If the robot's shapes, joints or "
                "limits, or these lines change, the digest no longer matches: all the pairs "
                "are tested, until you write this file again.",
            2) +
        "  margin: " + shortest(a.margin) + "\n  beyond_limits: " + shortest(a.beyondLimits) +
        "\n  digest: " + proofDigest(robot, {a.margin, a.beyondLimits}, names) + "\n  pairs:\n";
    for (const SurveyedPair& pair : pairs.proved) text += "  - " + pairText(model, pair) + "\n";
  }
  text += decideText(a, model, pairs.nearlyAlways);
  text += testedText(a, model, pairs.tested);
  if (!pairs.contradicted.empty()) {
    text += "\n" + comment(
                       "CHECK: the SRDF excludes these pairs from all tests, but they were in "
                       "contact in some of the random states, and free in others. A path may "
                       "lead through such a contact unnoticed.");
    for (const auto& [pair, reason] : pairs.contradicted)
      text += comment("- " + pairText(model, pair) + ": " + contactsText(a, pair) + " (" + reason +
                      ")");
  }
  return text;
}

}  // namespace corridor::app
