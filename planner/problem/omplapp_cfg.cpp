#include "planner/problem/omplapp_cfg.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "collision/core/nearest.h"
#include "planner/problem/bounds.h"
#include "planner/problem/ini_file.h"
#include "planner/problem/omplapp_planners.h"
#include "planner/problem/placement.h"

namespace corridor {
namespace {

using Keys = std::vector<std::string>;

const Keys planarKeys{"start.x", "start.y", "start.theta", "goal.x", "goal.y", "goal.theta"};
const Keys spatialOnlyKeys{"start.z", "start.axis.x", "start.axis.y", "start.axis.z",
                           "goal.z",  "goal.axis.x",  "goal.axis.y",  "goal.axis.z"};

/// OMPL.app's default of `threshold`, in the state space's distance.
constexpr double kThreshold = 1e-6;

/// Those of `keys` that section `problem` has or, with `present` false, lacks.
Keys select(const IniFile& ini, const Keys& keys, bool present) {
  Keys result;
  for (const std::string& key : keys)
    if ((ini.find("problem." + key) != nullptr) == present) result.push_back(key);
  return result;
}

/// OMPL.app's rule. nullopt: faulted.
std::optional<RigidSpace> spaceOf(const IniFile& ini) {
  const Keys missing = select(ini, planarKeys, false),
             missing3 = select(ini, spatialOnlyKeys, false);
  if (missing.empty() && missing3.size() == spatialOnlyKeys.size()) return RigidSpace::SE2;
  if (missing.empty() && missing3.empty()) return RigidSpace::SE3;
  Keys all = missing;
  if (missing3.size() < spatialOnlyKeys.size())
    all.insert(all.end(), missing3.begin(), missing3.end());
  ini.fault(0,
            "start and goal need x, y, theta (2D), or x, y, z, theta, axis.x, axis.y, axis.z (3D); "
            "missing: " +
                joined(all));
  return std::nullopt;
}

/// OMPL's setAxisAngle: the axis is normalised, and one shorter than the machine epsilon means no
/// rotation.
Eigen::Quaterniond axisAngle(const Vec3& axis, double angle) {
  const double norm = axis.stableNorm();
  if (norm < std::numeric_limits<double>::epsilon()) return Eigen::Quaterniond::Identity();
  const Vec3 v = std::sin(angle / 2) / norm * axis;
  return {std::cos(angle / 2), v.x(), v.y(), v.z()};
}

void readPose(const IniFile& ini, const std::string& what, Problem& problem, RigidPose& pose,
              double& yaw) {
  const auto number = [&](const std::string& key) {
    return ini.number("problem." + what + "." + key).value_or(0);
  };
  pose.p = Vec3(number("x"), number("y"), 0);
  const double theta = number("theta");
  problem.lines[what] = ini.find("problem." + what + ".x")->line;
  if (problem.space == RigidSpace::SE3) {
    pose.p.z() = number("z");
    pose.q = axisAngle({number("axis.x"), number("axis.y"), number("axis.z")}, theta);
    return;
  }
  yaw = wrappedYaw(theta);
  if (yaw != theta)
    problem.notes.push_back(what + ".theta: " + shortest(theta) + " is read as " + shortest(yaw) +
                            ", which is the same but for full turns");
  pose.q = fromRpy({0, 0, yaw}).q;
}

void readVolume(const IniFile& ini, Problem& problem) {
  const std::vector<char> axes =
      problem.space == RigidSpace::SE3 ? std::vector{'x', 'y', 'z'} : std::vector{'x', 'y'};
  bool all = true, any = false;
  for (const std::string side : {"min", "max"})
    for (const char axis : axes) {
      const bool given = ini.find("problem.volume." + side + "." + axis);
      all &= given;
      any |= given;
    }
  if (!all) {
    problem.notes.push_back(
        std::string("bounds: those of the world") +
        (any ? ", since volume is not given whole" : ", since no volume is given"));
    setBoundsOfWorld(problem);
  } else {
    problem.lines["bounds"] = ini.find("problem.volume.min.x")->line;
    for (std::size_t k = 0; k < axes.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      problem.lower[i] = ini.number(std::string("problem.volume.min.") + axes[k]).value_or(0);
      problem.upper[i] = ini.number(std::string("problem.volume.max.") + axes[k]).value_or(1);
      if (!(problem.lower[i] <= problem.upper[i]))
        ini.fault(*ini.find(std::string("problem.volume.min.") + axes[k]),
                  shortest(problem.lower[i]) + " is above volume.max." + axes[k] + ", " +
                      shortest(problem.upper[i]));
    }
  }
  if (enlargeBounds(problem)) problem.notes.push_back("bounds: enlarged to contain start and goal");
}

/// A mesh of the key `robot` or `world`. nullopt: faulted.
std::optional<OmplAppMesh> readMesh(const IniFile& ini, const std::string& key, Problem& problem,
                                    FaultList& faults, std::vector<ProblemMesh>& meshes) {
  const IniFile::Entry* entry = ini.find("problem." + key);
  if (!entry || entry->value.empty()) {
    ini.fault(entry ? entry->line : 0,
              "missing key \"" + key + "\": a mesh file in the folder of this file");
    return std::nullopt;
  }
  problem.lines[key] = entry->line;
  const std::filesystem::path path = problem.file.parent_path() / entry->value;
  if (const std::string why = whyNoFile(path); !why.empty()) {
    ini.fault(*entry, path.string() + ": " + why);
    return std::nullopt;
  }
  try {
    OmplAppMesh mesh = readOmplAppMesh(path);
    ProblemMesh body{path.stem().string(), path, {}};
    body.source.mesh = mesh.mesh;
    body.source.format =
        path.extension().string().substr(path.has_extension() ? 1 : 0) + ", as OMPL.app reads it";
    body.source.unitRule = "1 m per unit (OMPL.app knows no units)";
    body.source.upRule = "turned to y up by assimp's rule, as OMPL.app has it";
    body.source.floatVertices = true;
    meshes.push_back(std::move(body));
    return mesh;
  } catch (const InputError& error) {
    faults.add(error);
    return std::nullopt;
  }
}

void recentre(const OmplAppMesh& read, Problem& problem) {
  Vec3 centre = read.vertexAverage;
  if (problem.space == RigidSpace::SE2) centre.z() = 0;
  for (Vec3& vertex : problem.robot.back().source.mesh.vertices) vertex -= centre;
  problem.notes.push_back("reference of the robot: (" + shortest(centre.x()) + ", " +
                          shortest(centre.y()) + ", " + shortest(centre.z()) +
                          ") of its file, the average of its " +
                          std::to_string(read.importedVertices) + " imported vertices");
}

void readObjective(const IniFile& ini, Problem& problem) {
  if (const auto* entry = ini.find("problem.objective")) {
    problem.lines["objective"] = entry->line;
    const Keys known{"length", "max_min_clearance", "mechanical_work"};
    for (const std::string& name : known)
      if (entry->value.starts_with(name)) problem.objective = name;
    if (!problem.objective)
      ini.fault(*entry, "one of " + joined(known) + " is needed, not " + quotedWord(entry->value));
  }
  problem.objectiveThreshold = ini.number("problem.objective.threshold").value_or(0);
  problem.goalThreshold = ini.number("problem.threshold", Range::NotNegative).value_or(kThreshold);
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

/// Keys that are neither read above nor without effect by their nature.
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
  if (!unused.empty()) problem.notes.push_back("not used: " + joined(unused));
}

void readSettings(const IniFile& ini, Problem& problem) {
  if (const auto* entry = ini.find("problem.name"); entry && !entry->value.empty())
    problem.name = entry->value;
  if (const auto* entry = ini.find("problem.sampler")) {
    problem.sampler = entry->value;
    problem.lines["sampler"] = entry->line;
  }
  if (const auto* entry = ini.find("problem.longest_valid_segment_fraction"))
    problem.lines["checker.resolution"] = entry->line;
  problem.checker.resolution = ini.number("problem.longest_valid_segment_fraction", Range::Fraction)
                                   .value_or(problem.checker.resolution);
  if (const auto* entry = ini.find("benchmark.time_limit"))
    problem.lines["planner.time"] = entry->line;
  problem.planner.time =
      ini.number("benchmark.time_limit", Range::Positive).value_or(problem.planner.time);
  if (const auto* entry = ini.find("benchmark.simplify"))
    problem.simplify = entry->value != "0" && entry->value != "false";
}

}  // namespace

Problem readOmplAppCfg(const std::filesystem::path& file) {
  FaultList faults(file.string());
  const IniFile ini(file.string(),
                    readTextFile(file, "a problem ([problem], robot = …, world = …)"), faults);
  faultDuplicates(ini);
  rejectDynamics(ini);

  Problem problem;
  problem.file = file;
  problem.name = file.stem().string();
  const auto space = spaceOf(ini);
  problem.space = space.value_or(RigidSpace::SE3);
  problem.rotationWeight = problem.space == RigidSpace::SE3 ? 1 : 0.5;
  readSettings(ini, problem);
  readObjective(ini, problem);
  readOmplAppPlanners(ini, problem);
  const auto robot = readMesh(ini, "robot", problem, faults, problem.robot);
  const auto world = readMesh(ini, "world", problem, faults, problem.world);
  if (space) {
    readPose(ini, "start", problem, problem.start, problem.startYaw);
    readPose(ini, "goal", problem, problem.goal, problem.goalYaw);
    if (world) readVolume(ini, problem);
    if (robot) recentre(*robot, problem);
  }
  faults.throwIfAny();
  if (const std::string why = whyBadBounds(problem); !why.empty())
    throw InputError(problem.faultAt("bounds", "volume: " + why));
  noteUnused(ini, problem);
  problem.digest = digestOfFiles({file, problem.robot.front().file, problem.world.front().file});
  return problem;
}

}  // namespace corridor
