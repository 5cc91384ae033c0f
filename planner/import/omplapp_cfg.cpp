#include "planner/import/omplapp_cfg.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/import/ini_file.h"
#include "planner/import/omplapp_planners.h"
#include "planner/problem/assembly.h"
#include "planner/problem/bounds_of_ends.h"
#include "planner/problem/placement.h"
#include "planner/problem/shape_yaml.h"

namespace corridor {
namespace {

using Keys = std::vector<std::string>;

const Keys planarKeys{"start.x", "start.y", "start.theta", "goal.x", "goal.y", "goal.theta"};
const Keys spatialOnlyKeys{"start.z", "start.axis.x", "start.axis.y", "start.axis.z",
                           "goal.z",  "goal.axis.x",  "goal.axis.y",  "goal.axis.z"};

/// OMPL.app's default of `threshold`: a distance in the state space.
constexpr double kThreshold = 1e-6;

/// Returns the keys in `keys` that the section `problem` has, or, if `present` is false, those that
/// it lacks.
Keys select(const IniFile& ini, const Keys& keys, bool present) {
  Keys result;
  for (const std::string& key : keys)
    if ((ini.find("problem." + key) != nullptr) == present) result.push_back(key);
  return result;
}

/// Returns planar or floating by OMPL.app's rule: planar if the file has only x, y and theta,
/// floating if it has z and axis, too. Returns nullopt if a fault was added.
std::optional<JointType> spaceOf(const IniFile& ini) {
  const Keys missing = select(ini, planarKeys, false),
             missing3 = select(ini, spatialOnlyKeys, false);
  if (missing.empty() && missing3.size() == spatialOnlyKeys.size()) return JointType::planar;
  if (missing.empty() && missing3.empty()) return JointType::floating;
  Keys all = missing;
  if (missing3.size() < spatialOnlyKeys.size())
    all.insert(all.end(), missing3.begin(), missing3.end());
  ini.fault(0,
            "start and goal need x, y, theta (2D), or x, y, z, theta, axis.x, axis.y, axis.z (3D); "
            "missing: " +
                joined(all));
  return std::nullopt;
}

/// Computes the same as OMPL's setAxisAngle: the axis is normalised, and an axis shorter than the
/// machine epsilon means no rotation.
Eigen::Quaterniond axisAngle(const Vec3& axis, double angle) {
  const double norm = axis.stableNorm();
  if (norm < std::numeric_limits<double>::epsilon()) return Eigen::Quaterniond::Identity();
  const Vec3 v = std::sin(angle / 2) / norm * axis;
  return {std::cos(angle / 2), v.x(), v.y(), v.z()};
}

bool isPlanar(const Problem& problem) {
  return problem.model.robots.front().description.mount == JointType::planar;
}

Configuration readPose(const IniFile& ini, const std::string& what, Problem& problem) {
  const auto number = [&](const std::string& key) {
    return ini.number("problem." + what + "." + key).value_or(0);
  };
  problem.source.lines[what] = ini.find("problem." + what + ".x")->line;
  const double x = number("x"), y = number("y"), theta = number("theta");
  if (!isPlanar(problem)) {
    const double z = number("z");
    const auto q = axisAngle({number("axis.x"), number("axis.y"), number("axis.z")}, theta);
    return (Configuration(7) << x, y, z, q.coeffs()).finished();
  }
  const double yaw = wrappedYaw(theta);
  if (yaw != theta)
    problem.source.notes.push_back({what + ".theta: " + shortest(theta) + " is read as " +
                                    shortest(yaw) + ", the same angle up to full turns"});
  return (Configuration(3) << x, y, yaw).finished();
}

void readVolume(const IniFile& ini, Problem& problem) {
  const CoordinateGroup& group = problem.model.space.groups().front();
  const std::string axes = isPlanar(problem) ? "xy" : "xyz";
  bool all = true, any = false;
  for (const std::string side : {"min", "max"})
    for (const char axis : axes) {
      const bool given = ini.find("problem.volume." + side + "." + axis);
      all &= given;
      any |= given;
    }
  if (!all) {
    problem.source.notes.push_back(
        {std::string("bounds: those of the world") +
             (any ? ", since volume is incomplete" : ", since no volume is given"),
         NoteWeight::motion});
    setBounds(problem.model.space, group, boundsOfWorld(problem.model).value());
  } else {
    problem.source.lines["bounds"] = ini.find("problem.volume.min.x")->line;
    Corners corners;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      corners.lower[i] = ini.number(std::string("problem.volume.min.") + axes[k]).value_or(0);
      corners.upper[i] = ini.number(std::string("problem.volume.max.") + axes[k]).value_or(1);
      if (!(corners.lower[i] <= corners.upper[i]))
        ini.fault(*ini.find(std::string("problem.volume.min.") + axes[k]),
                  shortest(corners.lower[i]) + " is above volume.max." + axes[k] + ", " +
                      shortest(corners.upper[i]));
    }
    setBounds(problem.model.space, group, corners);
  }
  if (enlargeBounds(problem, group))
    problem.source.notes.push_back(
        {"bounds: enlarged to contain start and goal", NoteWeight::motion});
}

struct CfgMesh {
  OmplAppMesh read;
  PlacedShape shape;
};

/// Reads the mesh that the key `robot` or `world` names. Returns nullopt if a fault was added.
std::optional<CfgMesh> readMesh(const IniFile& ini, const std::string& key, Problem& problem,
                                FaultList& faults) {
  const IniFile::Entry* entry = ini.find("problem." + key);
  if (!entry || entry->value.empty()) {
    ini.fault(entry ? entry->line : 0,
              "missing key \"" + key + "\": a mesh file in the folder of this file");
    return std::nullopt;
  }
  problem.source.lines[key] = entry->line;
  const std::filesystem::path path = problem.source.file.parent_path() / entry->value;
  if (const std::string why = whyNotOrdinaryFile(path); !why.empty()) {
    ini.fault(*entry, path.string() + ": " + why);
    return std::nullopt;
  }
  addFile(problem.source.files, path);
  try {
    CfgMesh mesh{readOmplAppMesh(path), {}};
    for (const std::string& other : mesh.read.otherFiles) addFile(problem.source.files, other);
    mesh.shape.name = path.stem().string();
    mesh.shape.file = path;
    MeshFile file;
    file.mesh = mesh.read.mesh;
    file.format =
        path.extension().string().substr(path.has_extension() ? 1 : 0) + ", as OMPL.app reads it";
    file.unitRule = "1 m per unit (OMPL.app knows no units)";
    file.upRule = "rotated to y up by assimp's rule, as in OMPL.app";
    file.notes = mesh.read.notes;
    mesh.shape.mesh = std::make_shared<const MeshFile>(std::move(file));
    return mesh;
  } catch (const InputError& error) {
    faults.add(error);
    return std::nullopt;
  }
}

/// Makes a robot of one mesh. The robot's reference point is the average of the mesh's vertices. If
/// the mesh's file could not be read, `mesh` is empty; the poses of the robot can still be checked.
RobotSetup robotOf(CfgMesh mesh, JointType type) {
  Vec3 centre = mesh.read.vertexAverage;
  if (type == JointType::planar) centre.z() = 0;
  if (mesh.shape.mesh) shift(mesh.shape, -centre);
  RobotSetup setup;
  const std::string name = mesh.shape.name;
  setup.robot.description = rigidModel(name, type, {std::move(mesh.shape)});
  setup.robot.description.notes.push_back(
      {"reference of the robot: (" + shortest(centre.x()) + ", " + shortest(centre.y()) + ", " +
       shortest(centre.z()) + ") of its file, the average of its " +
       std::to_string(mesh.read.importedVertices) + " imported vertices"});
  return setup;
}

void readObjective(const IniFile& ini, Problem& problem) {
  if (const auto* entry = ini.find("problem.objective")) {
    problem.source.lines["objective"] = entry->line;
    const Keys& known = wordsFor<Objective>();
    for (const std::string& name : known)
      if (entry->value.starts_with(name)) problem.settings.objective = choiceNamed<Objective>(name);
    if (!problem.settings.objective) ini.fault(*entry, notOneOf(entry->value, known));
  }
  problem.settings.objectiveThreshold = ini.number("problem.objective.threshold").value_or(0);
  problem.task.goalThreshold =
      ini.number("problem.threshold", Range::NotNegative).value_or(kThreshold);
}

void rejectDynamics(const IniFile& ini) {
  if (const auto* entry = ini.find("problem.control"))
    ini.fault(*entry, quotedWord(entry->value) +
                          " is not supported: Corridor plans for rigid bodies without dynamics");
  if (const auto* entry = ini.find("problem.statespace"))
    ini.fault(*entry,
              quotedWord(entry->value) +
                  " is not supported: Corridor plans in SE2 and SE3, where edges are straight");
}

void faultDuplicates(const IniFile& ini) {
  std::set<std::string> seen;
  for (const IniFile::Entry& entry : ini.entries())
    if (!entry.key.starts_with("planner.") && !seen.insert(entry.key).second)
      ini.fault(entry.line, "duplicate key " +
                                quotedWord(entry.key.substr(entry.key.find('.') + 1)) +
                                ", first on line " + std::to_string(ini.find(entry.key)->line));
}

/// Adds a note that lists the keys that are not used. `turningradius` is not listed: it has a
/// meaning only for the state spaces that `rejectDynamics` refuses.
void noteUnused(const IniFile& ini, Problem& problem) {
  std::set<std::string> used{"problem.name",
                             "problem.robot",
                             "problem.world",
                             "problem.objective",
                             "problem.objective.threshold",
                             "problem.threshold",
                             "problem.sampler",
                             "problem.longest_valid_segment_fraction",
                             "problem.turningradius",
                             "benchmark.time_limit",
                             "benchmark.simplify"};
  for (const Keys* keys : {&planarKeys, &spatialOnlyKeys})
    for (const std::string& key : *keys) used.insert("problem." + key);
  for (const char* side : {"min", "max"})
    for (const char axis : {'x', 'y', 'z'})
      used.insert(std::string("problem.volume.") + side + "." + axis);
  Keys unused;
  for (const IniFile::Entry& entry : ini.entries())
    if (!used.contains(entry.key) && !entry.key.starts_with("planner."))
      unused.push_back(entry.key);
  if (!unused.empty()) problem.source.notes.push_back({"not used: " + joined(unused)});
}

void readSettings(const IniFile& ini, Problem& problem) {
  if (const auto* entry = ini.find("problem.name"); entry && !entry->value.empty())
    problem.source.name = entry->value;
  if (const auto* entry = ini.find("problem.sampler")) readSampler(ini, *entry, problem);
  if (const auto* entry = ini.find("problem.longest_valid_segment_fraction"))
    problem.source.lines["checker.resolution"] = entry->line;
  problem.settings.checker.resolution =
      ini.number("problem.longest_valid_segment_fraction", Range::Resolution)
          .value_or(problem.settings.checker.resolution);
  if (const auto* entry = ini.find("benchmark.time_limit"))
    problem.source.lines["planner.time"] = entry->line;
  problem.settings.planner.time =
      ini.number("benchmark.time_limit", Range::Positive).value_or(problem.settings.planner.time);
  if (const auto* entry = ini.find("benchmark.simplify"))
    problem.settings.simplify =
        entry->value != "0" && entry->value != "false" ? Simplifier::corridor : Simplifier::none;
}

/// Reads the file into `problem`. Even if an exception is thrown, `problem` has the notes that were
/// made before.
void readCfg(const std::filesystem::path& file, Problem& problem) {
  FaultList faults(file.string());
  const IniFile ini(file.string(),
                    readTextFile(file, "a problem ([problem], robot = …, world = …)"), faults);
  faultDuplicates(ini);
  rejectDynamics(ini);

  problem.source.file = file;
  problem.source.files = {file};
  problem.source.name = file.stem().string();
  const auto space = spaceOf(ini);
  readSettings(ini, problem);
  readObjective(ini, problem);
  readOmplAppPlanners(ini, problem);
  auto robot = readMesh(ini, "robot", problem, faults);
  auto world = readMesh(ini, "world", problem, faults);
  if (space) {
    // Poses are read even if a mesh has a fault, so that all faults are reported at once.
    std::vector<RobotSetup> robots{robotOf(robot ? std::move(*robot) : CfgMesh{}, *space)};
    ModelBuilder builder;
    addRobots(std::move(robots), builder, problem.source);
    if (world) {
      const std::string name = world->shape.name;  // a copy: the shape is moved
      builder.addObstacle(name, {std::move(world->shape)});
    }
    problem.model = builder.buildForReader();
    problem.task.start = readPose(ini, "start", problem);
    problem.task.goals = {readPose(ini, "goal", problem)};
    if (world) readVolume(ini, problem);
  }
  faults.throwIfAny();
  const CoordinateGroup& group = problem.model.space.groups().front();
  if (const std::string why =
          whyBadBounds(boundsOf(problem.model.space, group), dimensionsOf(group));
      !why.empty())
    throw InputError(problem.source.faultAt("bounds", "volume: " + why));
  noteUnused(ini, problem);
  finishProblem({}, {}, problem);
}

}  // namespace

Problem readOmplAppCfg(const std::filesystem::path& file) {
  Problem problem;
  readWithNotes(problem.source.notes, [&] { readCfg(file, problem); });
  return problem;
}

}  // namespace corridor
