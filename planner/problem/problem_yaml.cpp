#include "planner/problem/problem_yaml.h"

#include <map>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/import/moveit_request.h"
#include "planner/import/moveit_scene.h"
#include "planner/problem/assembly.h"
#include "planner/problem/bounds_yaml.h"
#include "planner/problem/checker_yaml.h"
#include "planner/problem/format_key.h"
#include "planner/problem/goal_yaml.h"
#include "planner/problem/hold_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/limits_yaml.h"
#include "planner/problem/placement.h"
#include "planner/problem/shape_yaml.h"
#include "planner/problem/trajectory_yaml.h"
#include "planner/problem/tube_yaml.h"
#include "planner/problem/world_yaml.h"
#include "planner/problem/yaml_ledger.h"

namespace corridor {
namespace {

const MapKeys* keysOf(const char* map) {
  return &problemKeys().at(map);
}
const std::vector<std::string>& wordsOfKey(const char* key) {
  return problemChoices().at(key);
}

/// Reads robot files. If several robots name the same file, this file is read once, so that its
/// faults are listed once.
class RobotFiles {
 public:
  /// @param notes gets the notes of robots that can't be used.
  RobotFiles(const YamlSource& source, std::vector<Note>& notes) : source_(source), notes_(notes) {}

  /// @param group see readRobotFile.
  std::optional<RobotSetup> read(const YamlMap& map, const char* key,
                                 const std::filesystem::path& folder,
                                 const std::string& group = "") {
    const auto name = map.text(key);
    if (!name) return std::nullopt;
    const std::filesystem::path path = folder / *name;
    if (const std::string why = whyNotOrdinaryFile(path); !why.empty()) {
      map.fault(key, path.string() + ": " + why);
      return std::nullopt;
    }
    const auto known = read_.find(path);
    return known != read_.end()
               ? known->second
               : read_
                     .emplace(path, readRobotFile(path, source_.faults, notes_, group,
                                                  RobotUse::plan, source_.cache))
                     .first->second;
  }

 private:
  const YamlSource& source_;
  std::vector<Note>& notes_;
  std::map<std::filesystem::path, std::optional<RobotSetup>> read_;
};

void readBase(const YamlMap& map, std::optional<RobotSetup>& robot) {
  const YamlValue* value = map.find("base");
  if (!value) return;
  const auto base =
      readPlacement(YamlMap(*value, map.pathOf("base"), keysOf("base"), map.source()));
  if (!robot || !base) return;
  if (robot->robot.isRigid())
    map.fault("base", "a rigid robot has no base: start and goal give its pose; leave base out");
  robot->robot.base = base->pose;
}

/// Reads `robot` or `robots`. Returns an empty list if there are no robots, or if `readRobotFile`
/// returned nullopt for one of them.
/// @param group the group of a single robot whose file chooses no joints; empty: none.
/// @param notes gets the notes of robots that can't be used.
std::vector<RobotSetup> readRobots(const YamlMap& file, const std::filesystem::path& folder,
                                   const std::string& group, std::vector<Note>& notes) {
  std::vector<RobotSetup> robots;
  RobotFiles files(file.source(), notes);
  const auto key = file.requireOne({"robot", "robots"}, "one of robot and robots",
                                   "the robot's file, such as robot: "
                                   "../../robots/piano/robot.yaml");
  if (key == "robot") {
    auto robot = files.read(file, "robot", folder, group);
    readBase(file, robot);
    if (robot) robots.push_back(std::move(*robot));
  }
  if (key != "robots") return robots;
  if (file.find("base"))
    file.fault("base", "each of several robots has its own: robots: {left: {file: …, base: …}}");
  const YamlMap map(*file.find("robots"), "robots", nullptr, file.source());
  bool known = true;
  for (const YamlValue::Entry* entry : map.entries()) {
    if (entry->key == "within" || entry->key == "any" || entry->key.empty() ||
        entry->key.find('/') != std::string::npos)
      map.fault(entry->key, "can't be the name of a robot");
    const YamlMap own(entry->value, map.pathOf(entry->key), keysOf("robots.*"), file.source());
    own.require("file", "the robot's file, such as file: ../../robots/arm6/robot.yaml");
    auto robot = files.read(own, "file", folder);
    readBase(own, robot);
    known &= robot.has_value();
    if (!robot) continue;
    robot->robot.name = entry->key;
    robots.push_back(std::move(*robot));
  }
  if (known && robots.empty() && map.empty())
    file.fault("robots", "at least one robot is needed, such as {left: {file: robot.yaml}}");
  if (known) return robots;
  for (const RobotSetup& robot : robots) addAll(robot.robot.description.notes, notes);
  return {};
}

/// Adds a fault if a robot has polygons, although another robot moves in space.
void faultSheets(const YamlMap& file, const std::vector<RobotSetup>& robots) {
  for (const RobotSetup& setup : robots)
    for (const LinkModel& link : setup.robot.description.links)
      for (const PlacedShape& shape : link.shapes)
        if (!shape.polygon.empty())
          return file.fault("robots", quotedWord(setup.robot.name) +
                                          " has a polygon, which is for the plane, so all robots "
                                          "must be rigid: SE2; write box, convex or mesh");
}

void readPlanner(const YamlMap& file, PlannerSettings& planner) {
  const YamlValue* value = file.find("planner");
  if (!value) return;
  const YamlMap map(*value, "planner", keysOf("planner"), file.source());
  planner.name = map.text("name").value_or(planner.name);
  planner.time = map.number("time", Range::Positive).value_or(planner.time);
  if (const auto stop = map.choice("stop", wordsOfKey("planner.stop")))
    planner.stopAtFirst = *stop == "first";
  if (const auto edges = map.wholeNumber("restart")) planner.restart = edges;
  const YamlValue* params = map.find("params");
  if (!params) return;
  const YamlMap paramMap(*params, "planner.params", nullptr, file.source());
  for (const YamlValue::Entry* entry : paramMap.entries())
    if (const auto text = paramMap.text(entry->key)) planner.params[entry->key] = *text;
}

/// Reads `prefer`. @pre margin, simplify and checker have been read.
void readPrefer(const YamlMap& file, double margin, Settings& settings) {
  const YamlValue* value = file.find("prefer");
  if (!value) return;
  const YamlMap map(*value, "prefer", keysOf("prefer"), file.source());
  PreferSettings& prefer = settings.prefer;
  prefer.clearance = map.number("clearance", Range::NotNegative);
  prefer.detour = map.number("detour", Range::NotNegative).value_or(prefer.detour);
  if (const auto word = map.choice("clearance_of", wordsFor<ClearanceOf>()))
    prefer.clearanceOf = *choiceNamed<ClearanceOf>(*word);
  if (!(prefer.clearance.value_or(0) > 0)) return;
  if (const auto why = whyNoClearance(margin, settings)) map.fault("clearance", *why);
}

/// Reads `moveit: {scene: FILE, request: FILE}`.
std::pair<std::optional<MoveitScene>, std::optional<MoveitRequest>> readMoveit(
    const YamlMap& problem, const std::filesystem::path& folder,
    std::vector<std::filesystem::path>& files) {
  std::pair<std::optional<MoveitScene>, std::optional<MoveitRequest>> found;
  const YamlValue* const value = problem.find("moveit");
  if (!value) return found;
  const YamlMap map(*value, "moveit", keysOf("moveit"), problem.source());
  if (problem.find("robots"))
    problem.fault("moveit", "a scene or request of MoveIt is for one robot; use robot: FILE");
  const auto read = [&](const char* key, auto& message) {
    const auto name = map.text(key);
    if (!name) return;
    const std::filesystem::path file = folder / *name;
    if (const std::string why = whyNotOrdinaryFile(file); !why.empty())
      return map.fault(key, file.string() + ": " + why);
    addFile(files, file);
    FaultList& faults = problem.source().faults;
    faults.collect([&] { message.emplace(file, faults); });
  };
  read("scene", found.first);
  read("request", found.second);
  if (map.empty()) problem.fault("moveit", "scene: FILE, request: FILE, or both are needed");
  return found;
}

/// Adds a note on the paddings of a scene that the problem's own paddings replace by smaller ones.
void noteSmaller(const Padding& scene, const Padding& own, Problem& problem) {
  const std::vector<ModelBody>& bodies = problem.model.bodies;
  std::vector<std::string> names;
  const auto add = [&](const std::string& name, double metres, double replaced) {
    if (metres < replaced)
      names.push_back(name + " (" + shortest(metres) + ", not " + shortest(replaced) + ")");
  };
  const auto sceneOf = [&](std::size_t body) {
    const auto found = scene.bodies.find(body);
    return found == scene.bodies.end() ? 0 : found->second;
  };
  for (const auto& [body, metres] : own.bodies) add(bodies[body].name, metres, sceneOf(body));
  for (const auto& [pair, metres] : own.pairs)
    if (bodies[pair.first].robot != bodies[pair.second].robot)  // the scene pads no other pairs
      add(bodies[pair.first].name + " ~ " + bodies[pair.second].name, metres,
          sceneOf(pair.first) + sceneOf(pair.second));
  if (!names.empty())
    problem.source.notes.push_back(
        {"padding of the problem is used instead of the scene's larger link_padding (m): " +
             joinedFirst(names),
         NoteWeight::coverage});
}

/// Reads the problem's file, and the files that it names, into `problem`. Even if an exception is
/// thrown, `problem` has the notes that were made before.
void readYaml(const std::filesystem::path& file, FileCache* cache, Problem& problem) {
  const YamlValue document =
      parseYaml(file.string(), readTextFile(file, "a problem (format: corridor-problem-1)"));
  FaultList faults(file.string());
  YamlSource source{file.string(), faults, {}};
  source.places = problemPlaces();
  source.cache = cache;
  if (!acceptsFormat(document, "corridor-problem-1", source)) faults.throwIfAny();
  const YamlMap map(document, "", &problemKeys().at(""), source);

  problem.source.file = file;
  problem.source.name = nameOfFile(file, "problem");
  problem.source.files = {file};
  auto [scene, request] = readMoveit(map, file.parent_path(), problem.source.files);
  std::vector<RobotSetup> robots =
      readRobots(map, file.parent_path(), request ? request->group() : "", problem.source.notes);
  const bool known = !robots.empty();
  const bool worldNeeded = !scene && !map.find("robots") &&
                           (!map.find("robot") || (known && robots.front().robot.isRigid()));
  const bool isPlanar =  // true also if there are no usable robots
      std::all_of(robots.begin(), robots.end(), [](const RobotSetup& setup) {
        return setup.robot.isRigid() && setup.robot.description.mount == JointType::planar;
      });
  if (!isPlanar) faultSheets(map, robots);
  ModelBuilder builder;
  if (request && known && robots.front().robot.isRigid()) {
    map.fault("moveit", "a request is for a robot with joints; this one is rigid");
    request.reset();
  }
  if (scene && known && !robots.front().robot.isRigid()) scene->hold(robots.front());
  if (request && known) request->hold(robots.front());
  holdAsStart(map, robots);
  std::string root;  // the root link of the robot to which a scene of MoveIt belongs
  RigidPose base;
  if (scene && known) {
    const ModelRobot& robot = robots.front().robot;
    root = robot.description.links[robot.description.root].name;
    base = robot.base;
  }
  addRobots(std::move(robots), builder, problem.source);
  readWorld(map, worldNeeded, isPlanar, builder, problem.source);
  if (scene && known) scene->addWorld(root, base, builder);
  problem.model = builder.buildForReader();
  if (scene && known) scene->applyAllowed(problem.model);
  AllowedBodies allowed;
  if (known && faults.size() == 0) {
    if (scene) problem.task.padding = scene->paddingOf(problem.model);
    allowed = readAllow(map, problem.model);
    Padding padding = readPadding(map, problem.model);
    noteSmaller(problem.task.padding, padding, problem);
    for (const auto& [body, metres] : padding.bodies) problem.task.padding.bodies[body] = metres;
    problem.task.padding.pairs = std::move(padding.pairs);
  }
  readMargin(map, known ? &problem.model : nullptr, problem.task);
  const TubeSpec tube = readTube(map, problem.model.space, known);
  const LimitSpec limits =
      readLimits(map, file.parent_path(), problem.model, known, problem.source.files);
  readPlanner(map, problem.settings.planner);
  if (const auto sampler = map.choice("sampler", wordsFor<ValidSampler>()))
    problem.settings.sampler = *choiceNamed<ValidSampler>(*sampler);
  if (const auto simplify = map.choice("simplify", wordsFor<Simplifier>()))
    problem.settings.simplify = *choiceNamed<Simplifier>(*simplify);
  if (const YamlValue* checker = map.find("checker"))
    readCheckerKeys(YamlMap(*checker, "checker", keysOf("checker"), source),
                    problem.settings.checker);
  readTrajectoryKeys(map, problem.settings.trajectory);
  readPrefer(map, problem.task.margin, problem.settings);
  problem.settings.seed = map.wholeNumber("seed").value_or(problem.settings.seed);
  if (known) {  // the form of states and bounds depends on the robots
    readBounds(map, problem);
    if (request && !map.find("start")) request->readStart(problem);
    if (request && !map.find("goal")) request->readGoals(problem);
    readStartAndGoals(map, source.lines.contains("moveit.request"), problem);
    if (faults.size() == 0) setDefaultBounds(problem, source);
  }
  addAll(source.notes, problem.source.notes);
  faults.throwIfAny();
  if (scene) addAll(scene->takeNotes(problem), problem.source.notes);
  if (request) addAll(request->takeNotes(problem), problem.source.notes);
  addAll(notesOnUnread(document, file.string(), DefaultValues::count), problem.source.notes);
  faults.throwIfAny();
  problem.task.limits = limitsOf(problem.model, limits);
  finishProblem(allowed, tube, problem);
  problem.source.lines = std::move(source.lines);
}

}  // namespace

Problem readProblemYaml(const std::filesystem::path& file, FileCache* cache) {
  Problem problem;
  readWithNotes(problem.source.notes, [&] { readYaml(file, cache, problem); });
  return problem;
}

}  // namespace corridor
