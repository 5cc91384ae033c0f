#include "planner/problem/problem_yaml.h"

#include <algorithm>

#include "planner/problem/bounds.h"
#include "planner/problem/format_key.h"
#include "planner/problem/keys.h"
#include "planner/problem/placement.h"
#include "planner/problem/robot_file.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

const MapKeys* keysOf(const char* map) {
  return &problemKeys().at(map);
}
const std::vector<std::string>& wordsOf(const char* key) {
  return problemChoices().at(key);
}

/// The robot's file, and its space where that is known.
std::optional<RigidSpace> readRobot(const YamlMap& file, Problem& problem,
                                    std::vector<std::filesystem::path>& files) {
  file.require("robot", "the robot's file, such as robot: ../../robots/piano/robot.yaml");
  const auto name = file.text("robot");
  if (!name) return std::nullopt;
  const std::filesystem::path path = problem.file.parent_path() / *name;
  if (const std::string why = whyNoFile(path); !why.empty()) {
    file.fault("robot", path.string() + ": " + why);
    return std::nullopt;
  }
  files.push_back(path);
  auto robot = readRobotFile(path, file.source().faults);
  if (!robot) return std::nullopt;
  problem.space = robot->space;
  problem.robot = std::move(robot->shapes);
  problem.rotationWeight = robot->rotationWeight;
  problem.notes.insert(problem.notes.end(), robot->notes.begin(), robot->notes.end());
  return robot->space;
}

void readWorld(const YamlMap& file, Problem& problem) {
  const YamlValue* world =
      file.require("world", "the obstacles, such as world: {table: {mesh: table.obj, unit: m}}");
  if (!world) return;
  const YamlMap obstacles(*world, "world", nullptr, file.source());
  if (world->kind == YamlValue::Kind::Map && world->entries.empty())
    file.fault("world", "at least one obstacle is needed");
  for (const YamlValue::Entry* entry : obstacles.entries()) {
    const YamlMap map(entry->value, "world." + entry->key, keysOf("world.*"), file.source());
    if (auto mesh = readPlacedMesh(map, entry->key, problem.file.parent_path()))
      problem.world.push_back(std::move(*mesh));
  }
}

void readGoalRegion(const YamlValue& goal, Problem& problem, YamlSource& source) {
  const auto within = std::find_if(goal.entries.begin(), goal.entries.end(),
                                   [](const auto& entry) { return entry.key == "within"; });
  if (within == goal.entries.end()) return;
  const YamlMap map(within->value, "goal.within", keysOf("goal.within"), source);
  problem.goalRegion = Problem::GoalRegion{map.number("at", Range::NotNegative).value_or(0),
                                           map.angle("angle", Range::NotNegative).value_or(0)};
}

void readPoses(const YamlMap& file, RigidSpace space, Problem& problem, bool& startIsSound,
               bool& goalIsSound) {
  for (const bool isStart : {true, false}) {
    const std::string what = isStart ? "start" : "goal";
    const YamlValue* value =
        file.require(what, "the robot's pose, such as " + what +
                               (space == RigidSpace::SE3 ? ": {at: [0, 0, 1], rpy_deg: [0, 0, 90]}"
                                                         : ": {at: [0, 0], yaw_deg: 90}"));
    if (!value) continue;
    const auto pose = readPose(*value, what, space, file.source(), problem.notes);
    if (!isStart && value->kind == YamlValue::Kind::Map)
      readGoalRegion(*value, problem, file.source());
    if (!pose) continue;
    (isStart ? problem.start : problem.goal) = pose->pose;
    (isStart ? problem.startYaw : problem.goalYaw) = pose->yaw;
    (isStart ? startIsSound : goalIsSound) = true;
  }
}

const char* boundsForm(RigidSpace space) {
  return space == RigidSpace::SE3 ? "at: [[x, y, z], [x, y, z]]" : "at: [[x, y], [x, y]]";
}

/// @returns whether the bounds are given and sound.
bool readBounds(const YamlMap& file, Problem& problem) {
  const YamlValue* value = file.find("bounds");
  if (!value) return false;
  const YamlMap map(*value, "bounds", keysOf("bounds"), file.source());
  const std::size_t count = problem.space == RigidSpace::SE3 ? 3 : 2;
  const std::string form = boundsForm(problem.space);
  const YamlValue* at = map.require("at", "the lower and the upper corner, " + form);
  if (!at) return false;
  if (at->kind != YamlValue::Kind::List || at->items.size() != 2) {
    map.fault("at",
              "the lower and the upper corner are needed, " + form + ", not " + described(*at));
    return false;
  }
  const auto lower = readNumbers(at->items[0], count, "bounds.at", file.source());
  const auto upper = readNumbers(at->items[1], count, "bounds.at", file.source());
  if (!lower || !upper) return false;
  for (std::size_t k = 0; k < count; ++k) {
    problem.lower[static_cast<Eigen::Index>(k)] = (*lower)[k];
    problem.upper[static_cast<Eigen::Index>(k)] = (*upper)[k];
  }
  const std::string why = whyBadBounds(problem);
  if (!why.empty()) map.fault("at", why);
  return why.empty();
}

void defaultBounds(Problem& problem, YamlSource& source) {
  setBoundsOfWorld(problem);
  enlargeBounds(problem);
  if (whyBadBounds(problem).empty()) {
    problem.notes.push_back("bounds: those of the world, start and goal, since none are given");
    return;
  }
  int flat = 0;
  while (problem.lower[flat] < problem.upper[flat]) ++flat;
  source.fault(0, std::string("missing key \"bounds\": world, start and goal lie in a plane (") +
                      "xyz"[flat] + " = " + shortest(problem.lower[flat]) + "), so bounds: {" +
                      boundsForm(problem.space) + "} is needed");
}

void readTube(const YamlMap& file, Problem& problem) {
  const YamlValue* value = file.find("tube");
  if (!value) return;
  const YamlMap map(*value, "tube", keysOf("tube"), file.source());
  problem.tube = Tube{map.number("position", Range::NotNegative).value_or(0),
                      map.angle("rotation", Range::NotNegative).value_or(0)};
}

void readPlanner(const YamlMap& file, Problem& problem) {
  const YamlValue* value = file.find("planner");
  if (!value) return;
  const YamlMap map(*value, "planner", keysOf("planner"), file.source());
  Problem::PlannerSpec& planner = problem.planner;
  planner.name = map.text("name").value_or(planner.name);
  planner.time = map.number("time", Range::Positive).value_or(planner.time);
  if (const auto stop = map.choice("stop", wordsOf("planner.stop")))
    planner.stopAtFirst = *stop == "first";
  const YamlValue* params = map.find("params");
  if (!params) return;
  const YamlMap paramMap(*params, "planner.params", nullptr, file.source());
  for (const YamlValue::Entry* entry : paramMap.entries())
    if (const auto text = paramMap.text(entry->key)) planner.params[entry->key] = *text;
}

void readChecker(const YamlMap& file, Problem& problem) {
  const YamlValue* value = file.find("checker");
  if (!value) return;
  const YamlMap map(*value, "checker", keysOf("checker"), file.source());
  Problem::CheckerSpec& checker = problem.checker;
  checker.edges = map.choice("edges", wordsOf("checker.edges")).value_or(checker.edges);
  checker.resolution = map.number("resolution", Range::Fraction).value_or(checker.resolution);
  checker.tolerance = map.number("tolerance", Range::Positive);
  checker.fit = map.choice("fit", wordsOf("checker.fit")).value_or(checker.fit);
}

}  // namespace

Problem readProblemYaml(const std::filesystem::path& file) {
  const YamlValue document =
      parseYaml(file.string(), readTextFile(file, "a problem (format: corridor-problem-1)"));
  FaultList faults(file.string());
  YamlSource source{file.string(), faults, {}};
  if (!hasFormat(document, "corridor-problem-1", source)) faults.throwIfAny();
  const YamlMap map(document, "", &problemKeys().at(""), source);

  Problem problem;
  problem.file = file;
  problem.name = nameOfFile(file, "problem");
  std::vector<std::filesystem::path> files{file};
  const auto space = readRobot(map, problem, files);
  readWorld(map, problem);
  problem.margin = map.number("margin", Range::NotNegative).value_or(problem.margin);
  readTube(map, problem);
  readPlanner(map, problem);
  problem.sampler = map.text("sampler").value_or(problem.sampler);
  problem.simplify = map.boolean("simplify").value_or(problem.simplify);
  readChecker(map, problem);
  problem.seed = map.wholeNumber("seed").value_or(problem.seed);
  if (space) {  // what poses and bounds look like depends on it
    bool start = false, goal = false;
    readPoses(map, *space, problem, start, goal);
    if (readBounds(map, problem)) {
      if (const std::string why = start ? whyOutside(problem, problem.start) : ""; !why.empty())
        map.fault("start", why);
      if (const std::string why = goal ? whyOutside(problem, problem.goal) : ""; !why.empty())
        map.fault("goal", why);
    } else if (!map.find("bounds") && faults.size() == 0) {
      defaultBounds(problem, source);
    }
  }
  faults.throwIfAny();

  for (const auto* meshes : {&problem.robot, &problem.world})
    for (const ProblemMesh& mesh : *meshes) files.push_back(mesh.file);
  problem.digest = digestOfFiles(files);
  problem.lines = std::move(source.lines);
  return problem;
}

}  // namespace corridor
