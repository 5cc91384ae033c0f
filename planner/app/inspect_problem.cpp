#include <iostream>
#include <map>
#include <set>

#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/inspect.h"
#include "planner/app/output.h"
#include "planner/checker/edge_costs.h"
#include "planner/checker/enclosed_bodies.h"
#include "planner/checker/left_out.h"
#include "planner/checker/problem_goal.h"
#include "planner/model/reach.h"
#include "planner/problem/digest.h"
#include "planner/solve/state_rows.h"
#include "planner/solve/why_not_free.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

/// Reports a problem, as lines or as JSON.
class ProblemReport {
 public:
  ProblemReport(const Problem& problem, const InspectArguments& a)
      : problem_(problem), a_(a), checker_(problem), out_(a.json) {}

  int run() {
    json_ = {{"format", "corridor-inspect-problem-4"},
             {"file", a_.file},
             {"name", problem_.source.name},
             {"digest", digestOf(problem_)}};
    out_.line("problem", a_.file);
    out_.line("name", problem_.source.name);
    reportSpace();
    reportHeld();
    reportNumbers();
    reportBodies();
    reportPairs();
    std::vector<Note> all = problem_.source.notes;
    addFirst(notesOnStart(checker_, startOf(problem_)), all);
    const std::vector<std::string> notes = textsOf(all);
    json_["notes"] = notes;
    for (const std::string& note : condensed(notes)) out_.line("note", note);
    const bool free = reportEnds();
    reportTrees();
    reportCosts();
    if (a_.json) std::cout << jsonText(json_) << '\n';
    return free ? kDone : kNegativeResult;
  }

 private:
  void reportSpace() {
    const std::string rigid = rigidSpaceOf(problem_.model.space);
    json_["space"] = rigid.empty() ? "joints" : rigid;
    json_["numbers"] = problem_.model.space.numberNames();
    json_["coordinates"] = ordered_json::array();
    if (!rigid.empty()) out_.line("space", rigid);
    for (const Coordinate& c : problem_.model.space.coordinates()) {
      ordered_json j = {{"name", c.name}, {"weight", c.weight}};
      std::string text = "\"" + c.name + "\": ";
      if (c.kind == Coordinate::Kind::line) {
        const char* unit = c.angular ? "rad" : "m";
        j["kind"] = "line";
        j["unit"] = unit;
        j["lower"] = c.lower;
        j["upper"] = c.upper;
        text += rounded(c.lower) + " to " + rounded(c.upper) + " " + unit;
      } else {
        j["kind"] = c.kind == Coordinate::Kind::circle ? "circle" : "rotation";
        text += c.kind == Coordinate::Kind::circle ? "continuous" : "any rotation";
      }
      json_["coordinates"].push_back(j);
      out_.line(rigid.empty() ? "joint" : "coordinate", text);
    }
  }

  /// Reports the joints that are held, their values, and where these values come from.
  void reportHeld() {
    json_["held"] = ordered_json::array();
    for (const ModelRobot& robot : problem_.model.robots)
      for (std::size_t k = 0; k < robot.description.joints.size(); ++k) {
        const JointModel& joint = robot.description.joints[k];
        const auto value = robot.held.find(k);
        const auto pose = robot.heldPoses.find(k);
        if (value == robot.held.end() && pose == robot.heldPoses.end()) continue;
        const auto from = robot.heldFrom.find(k);
        const std::string source = from == robot.heldFrom.end() ? "default" : from->second;
        ordered_json j = {{"name", (robot.name.empty() ? "" : robot.name + "/") + joint.name},
                          {"from", source}};
        std::string text = quotedWord(j["name"].get<std::string>()) + ": ";
        if (value != robot.held.end()) {
          j["value"] = value->second;
          text += rounded(value->second) + (joint.type == JointType::prismatic ? " m" : " rad");
        } else {
          j.update(poseJson(pose->second));
          text += poseText(pose->second);
        }
        json_["held"].push_back(j);
        out_.line("held", text + " (" + source + ")");
      }
  }

  void reportNumbers() {
    json_["tolerance_m"] = checker_.options().tolerance;
    json_["margin_m"] = problem_.task.margin;
    json_["tube"] = tubeJson(problem_.model.space, problem_.task.tube);
    out_.line("tolerance", rounded(checker_.options().tolerance) + " m");
    if (problem_.task.padding.beyond.largest() == 0)
      out_.line("margin", rounded(problem_.task.margin) + " m");
    reportPadding();
    out_.line("tube", tubeText(problem_.model.space, problem_.task.tube));
  }

  void reportPadding() {
    const Padding& padding = problem_.task.padding;
    const auto nameOf = [&](std::size_t body) { return problem_.model.bodies[body].name; };
    const MarginsBeyond& beyond = padding.beyond;
    if (beyond.largest() > 0) {
      const auto total = [&](double metres) {
        // The sum was rounded up, by far less than its twelfth digit.
        return std::stod(withDigits(problem_.task.margin + metres, 12));
      };
      json_["margins"] = {{"self_m", total(beyond.self)}, {"world_m", total(beyond.world)}};
      out_.line("margin", rounded(total(beyond.self)) + " m between links of a robot, " +
                              rounded(total(beyond.world)) + " m between other bodies");
      for (const auto& [pair, metres] : beyond.pairs) {
        const std::string a = nameOf(pair.first), b = nameOf(pair.second);
        json_["margins"]["pairs"].push_back({a, b, total(metres)});
        out_.line("margin", a + " ~ " + b + " " + rounded(total(metres)) + " m");
      }
    }
    for (const auto& [body, metres] : padding.bodies) {
      json_["padding"]["bodies"][nameOf(body)] = metres;
      out_.line("padding", nameOf(body) + " " + rounded(metres) + " m");
    }
    for (const auto& [pair, metres] : padding.pairs) {
      const std::string a = nameOf(pair.first), b = nameOf(pair.second);
      json_["padding"]["pairs"].push_back({a, b, metres});
      out_.line("padding", a + " ~ " + b + " " + rounded(metres) + " m");
    }
  }

  void reportBodies() {
    json_["bodies"] = ordered_json::array();
    for (const ModelBody& body : problem_.model.bodies) {
      ordered_json j = {{"name", body.name},
                        {"moves", body.robot.has_value()},
                        {"shapes", ordered_json::array()}};
      std::string text;
      for (const PlacedShape& shape : body.shapes) {
        ordered_json& one = j["shapes"].emplace_back(shapeJson(shape));
        text += (text.empty() ? "" : "; ") + shapeText(shape);
        if (body.robot) continue;
        one.update(poseJson(shape.at));
        text += ", " + poseText(shape.at);
      }
      json_["bodies"].push_back(j);
      out_.line(body.robot ? "robot" : "world", "\"" + body.name + "\": " + text);
    }
  }

  void reportPairs() {
    const LeftOut leftOut = leftOutOf(checker_);
    const std::size_t tested = leftOut.tested;
    std::size_t far = 0;
    const std::vector<ReachBox> reach = reachOf(problem_.model);
    json_["pair_list"] = ordered_json::array();
    const Required need = requiredBy(problem_.task);
    forEachPair(problem_.model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
      const std::string &nameA = problem_.model.bodies[a].name,
                        &nameB = problem_.model.bodies[b].name;
      const bool isFar = outOfReach(problem_.task, reach[a], reach[b]);
      const bool isTested = why.empty();
      far += isTested && isFar;
      json_["pair_list"].push_back(
          {{"a", nameA}, {"b", nameB}, {"skipped", why}, {"out_of_reach", isFar}});
      if (a_.pairs)
        out_.line("pair", nameA + "~" + nameB + ": " +
                              (isTested               ? "tested"
                               : why == kTestedAtRest ? std::string(why)
                                                      : "not tested: " + std::string(why)) +
                              (isFar ? " (out of reach)" : ""));
    });
    json_["pairs"] = {{"tested", tested},
                      {"tested_at_rest", leftOut.testedAtRest},
                      {"out_of_reach", far},
                      {"skipped", leftOut.reasons},
                      {"left_out", leftOutJson(problem_.model, leftOut)},
                      {"not_tested", reasonGroups(leftOut)}};
    except_ = exceptText(problem_.model, leftOut);
    out_.line("pairs tested",
              grouped(tested) + (tested ? "" : ": NOTHING IS TESTED, every state is valid"),
              tested ? Tone::plain : Tone::bad);
    if (far)
      out_.line("of them out of reach",
                grouped(far) + (far == tested ? ": no contact is possible" : ""),
                far == tested ? Tone::bad : Tone::plain);
    if (leftOut.testedAtRest)
      out_.line("pairs tested once",
                grouped(leftOut.testedAtRest) + ": only held joints between them");
    for (const auto& [reason, count] : leftOut.reasons)
      out_.line("pairs skipped", grouped(count) + ": " + reason);
    out_.line("not tested", notTestedText(leftOut));
    out_.line("never a pair", "two obstacles, a body with itself");
  }

  bool reportEnds() {
    bool free = reportEnd("start", startOf(problem_), json_["start"]);
    const std::vector<Configuration> goals = goalsOf(problem_);
    if (goals.size() == 1) return reportEnd("goal", goals[0], json_["goal"]) && free;
    bool any = false;
    json_["goal"] = ordered_json::array();
    for (std::size_t i = 0; i < goals.size(); ++i)
      any |= reportEnd("goal " + std::to_string(i + 1), goals[i], json_["goal"].emplace_back());
    return any && free;
  }

  bool reportEnd(const std::string& name, const Configuration& q, ordered_json& json) {
    const auto why = whyNotFree(q, checker_);
    json = why.value_or("free");
    out_.line(name, why.value_or("free" + except_), why ? Tone::bad : Tone::plain);
    return !why;
  }

  void reportTrees() {
    std::set<const TriangleMesh*> built, meshes;  // bodies of one mesh share its tree
    for (const Scene::Placed& placed : checker_.scene().bodies()) {
      if (!placed.body.isMesh()) continue;
      meshes.insert(&placed.body.mesh());
      if (placed.body.treeBuilt()) built.insert(&placed.body.mesh());
    }
    json_["trees_built"] = built.size();
    out_.line("trees built", std::to_string(built.size()) + " of " + std::to_string(meshes.size()) +
                                 ", for start and goal; the others when first needed");
  }

  /// Reports the pairs of bodies that take most of the time of random edges.
  void reportCosts() {
    constexpr std::size_t kEdges = 200, kShown = 5;
    constexpr double kSeconds = 2;  // keeps `inspect` quick
    const EdgeCosts costs = sampleEdgeCosts(checker_, kEdges, kSeconds, problem_.settings.seed);
    json_["random_edges"] = {{"edges", costs.edges},
                             {"free", costs.free},
                             {"free_us", 1e6 * costs.freeSeconds},
                             {"other_us", 1e6 * costs.otherSeconds},
                             {"pairs", ordered_json::array()}};
    std::string text = grouped(costs.free) + " of " + grouped(costs.edges) + " free";
    if (costs.free > 0) text += ", " + rounded(1e6 * costs.freeSeconds) + " µs each";
    if (costs.free < costs.edges)
      text += "; the others " + rounded(1e6 * costs.otherSeconds) + " µs each (medians)";
    out_.line("random edges", text);
    for (std::size_t i = 0; i < costs.pairs.size(); ++i) {
      const EdgeCosts::OfPair& pair = costs.pairs[i];
      const std::string &a = problem_.model.bodies[pair.a].name,
                        &b = problem_.model.bodies[pair.b].name;
      json_["random_edges"]["pairs"].push_back({{"a", a},
                                                {"b", b},
                                                {"share", pair.share},
                                                {"box_tests", pair.boxTests},
                                                {"triangle_tests", pair.primitiveTests}});
      if (i < kShown)
        out_.line("time goes to",
                  a + "~" + b + ": " + std::to_string(std::lround(100 * pair.share)) + " %, " +
                      grouped(pair.boxTests / costs.edges) + " box and " +
                      grouped(pair.primitiveTests / costs.edges) + " triangle tests per edge");
    }
  }

  const Problem& problem_;
  const InspectArguments& a_;
  Checker checker_;
  ResultPrinter out_;
  ordered_json json_;
  std::string except_;  // what the word "free" leaves out
};

}  // namespace

int inspectProblem(const InspectArguments& a) {
  const Problem problem = readProblemOf(a.file);
  return ProblemReport(problem, a).run();
}

}  // namespace corridor::app
