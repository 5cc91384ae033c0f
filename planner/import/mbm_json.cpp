#include "planner/import/mbm_json.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include <nlohmann/json.hpp>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/import/mbm_excerpt.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/assembly.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/shape_yaml.h"
#include "planner/problem/state_yaml.h"
#include "planner/problem/urdf_robot.h"
#include "planner/robot/urdf_file.h"

namespace corridor {
namespace {

using Json = nlohmann::json;

/// Limits of a set, which keep a damaged or hostile file from using all memory or the whole stack.
/// The parser reports one event for a key, one for a value, and two for a value that is a list or
/// an object (begin, end). So a file beyond the limit has more than 10^7 keys and values.
constexpr std::size_t kMostEvents = 20'000'000;
constexpr int kMostDepth = 64;

/// Reads one problem of a set. Only faults of the JSON syntax have line numbers. All other faults
/// name the key or the object ("goals[2]", "box1.size").
class MbmReader {
 public:
  MbmReader(const std::filesystem::path& file, const std::string& index, FileCache* cache = nullptr)
      : file_(file), index_(index), cache_(cache), faults_(file.string()) {}

  std::vector<std::string> indices() { return indicesOf(parse()); }

  Problem read() {
    readWithNotes(problem_.source.notes, [&] { readAll(); });
    return std::move(problem_);
  }

 private:
  void readAll() {
    const Json set = parse();
    const Json& problem = choose(set);
    problem_.source.file = file_.string() + "#" + index_;
    problem_.source.name = file_.stem().string() + "#" + index_;
    problem_.source.files = {file_};
    faults_.throwIfAny();
    noteUnknown(set, problem);
    readRobot(set, problem);
    for (const Json& object : list(problem, "objects")) readObject(object);
    faults_.throwIfAny();
    problem_.model = builder_.buildForReader();
    problem_.task.start = state(set, field(problem, "start"), "start");
    const Json& goals = list(problem, "goals");
    for (std::size_t i = 0; i < goals.size(); ++i)
      problem_.task.goals.push_back(state(set, goals[i], "goals[" + std::to_string(i) + "]"));
    if (goals.empty()) fault("goals: at least one is needed");
    faults_.throwIfAny();
    finishProblem({}, {}, problem_);
  }

  void fault(const std::string& text) { faults_.add(file_.string(), 0, text); }
  [[noreturn]] void stop(const std::string& text) const {
    throw InputError(Fault{file_.string(), 0, text});
  }

  Json parse() {
    const std::string text =
        excerptOfSet(readTextFile(file_, "a set of problems (format: mbm-scene-1)"), index_);
    std::size_t values = 0;
    std::vector<std::set<std::string>> keys;  // of the open objects
    const auto countValue = [&](int depth, Json::parse_event_t event, const Json& parsed) {
      if (++values > kMostEvents)
        stop("has more than " + std::to_string(kMostEvents / 2) +
             " keys and values; split the set");
      if (depth > kMostDepth)
        stop("has lists and objects nested more than " + std::to_string(kMostDepth) +
             " deep; a set needs no more than six");
      // The parser would take the last of several equal keys.
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      if (event == Json::parse_event_t::object_end) keys.pop_back();
      if (event == Json::parse_event_t::key &&
          !keys.back().insert(parsed.get<std::string>()).second)
        stop("has the key " + quotedWord(parsed.get<std::string>()) +
             " twice in one object; remove one of them");
      return true;
    };
    try {
      return Json::parse(text, countValue);
    } catch (const Json::parse_error& error) {
      const auto end =
          text.begin() + static_cast<std::ptrdiff_t>(std::min(error.byte, text.size()));
      const auto line = 1 + std::count(text.begin(), end, '\n');
      throw InputError(
          Fault{file_.string(), static_cast<int>(line), "is not JSON, or ends too early"});
    } catch (const Json::out_of_range&) {
      stop("has a number that is too large for a double");
    }
  }

  std::vector<std::string> indicesOf(const Json& set) const {
    if (!set.is_object() || set.value("format", Json()) != Json("mbm-scene-1"))
      stop("a set of problems (format: mbm-scene-1) is needed");
    std::vector<std::string> indices;
    std::map<std::string, std::size_t> first;  // place in the list, by the index
    for (const Json& problem : list(set, "problems")) {
      indices.push_back(field(problem, "index").dump());
      const auto [known, isNew] = first.emplace(indices.back(), indices.size() - 1);
      if (!isNew)
        stop("problems[" + std::to_string(known->second) + "] and problems[" +
             std::to_string(indices.size() - 1) + "] have the same index, " + known->first +
             "; give each problem its own");
    }
    return indices;
  }

  /// Returns the problem whose index is `index_`.
  const Json& choose(const Json& set) const {
    const std::vector<std::string> indices = indicesOf(set);
    const Json& problems = list(set, "problems");
    const auto found = std::find(indices.begin(), indices.end(), index_);
    if (found != indices.end()) return problems[static_cast<std::size_t>(found - indices.begin())];
    const std::string example =
        file_.filename().string() + "#" + (indices.empty() ? "1" : indices.front());
    stop((index_.empty() ? "name one of its problems, as in " + example
                         : "has no problem #" + index_) +
         "; there are " + ranges(indices));
  }

  /// Returns a text: "1 to 50" for indices without gaps, else a list of the first indices.
  static std::string ranges(const std::vector<std::string>& indices) {
    bool inRow = indices.size() > 2;
    for (std::size_t i = 0; i < indices.size() && inRow; ++i)
      inRow = indices[i] == std::to_string(std::stoul("0" + indices[0]) + i);
    return inRow ? indices.front() + " to " + indices.back() : joinedFirst(indices);
  }

  const Json& field(const Json& object, const std::string& key) const {
    if (!object.is_object() || !object.contains(key)) stop("missing key " + quotedWord(key));
    return object[key];
  }
  const Json& list(const Json& object, const std::string& key) const {
    const Json& value = field(object, key);
    if (!value.is_array()) stop(key + ": a list is needed");
    return value;
  }
  std::string word(const Json& object, const std::string& key) const {
    const Json& value = field(object, key);
    if (!value.is_string()) stop(key + ": a word is needed");
    return value.get<std::string>();
  }
  double number(const Json& value, const std::string& what) const {
    if (!value.is_number()) stop(what + ": a number is needed");
    return value.get<double>();
  }
  double number(const Json& object, const std::string& of, const char* key) const {
    return number(field(object, key), of + "." + key);
  }
  std::vector<double> numbers(const Json& value, std::size_t count, const std::string& what) const {
    if (!value.is_array() || value.size() != count)
      stop(what + ": a list of " + std::to_string(count) + " numbers is needed");
    std::vector<double> result;
    for (const Json& item : value) result.push_back(number(item, what));
    return result;
  }

  /// Returns the path of the file that `key` names, in the nearest folder above the set that
  /// contains a file of this name.
  std::filesystem::path dataFile(const Json& set, const char* key) const {
    const std::string name = word(set, key);
    std::filesystem::path folder = std::filesystem::absolute(file_).lexically_normal();
    while (folder != folder.parent_path()) {
      folder = folder.parent_path();
      if (whyNotOrdinaryFile(folder / name).empty()) return folder / name;
    }
    stop(std::string(key) + ": " + name + " is in no folder above this file");
  }

  /// Adds one note that lists the keys that are not known.
  void noteUnknown(const Json& set, const Json& problem) {
    std::map<std::string, std::size_t> unknown;  // number of objects that have the key
    const auto check = [&](const Json& object, const std::string& path,
                           std::initializer_list<std::string_view> known) {
      if (object.is_object())
        for (const auto& [key, value] : object.items())
          if (std::find(known.begin(), known.end(), key) == known.end()) ++unknown[path + key];
    };
    check(
        set, "",
        {"format", "robot", "urdf", "srdf", "scene", "frame", "group", "joint_names", "problems"});
    check(problem, "problems[].",
          {"index", "valid", "vamp", "mesh", "mesh_contacts", "start", "goals", "fixed_joints",
           "objects"});
    for (const Json& object : list(problem, "objects"))
      check(object, "objects[].",
            {"id", "type", "size", "radius", "length", "position", "orientation_xyzw"});
    std::vector<std::string> texts;
    for (const auto& [key, count] : unknown)
      texts.push_back(count == 1 ? key : key + " (" + std::to_string(count) + ")");
    if (!texts.empty())
      problem_.source.notes.push_back(
          {file_.string() + ": not used: " + joinedFirst(texts), NoteWeight::motion});
  }

  /// Holds joints that are not planned for at the values of `fixed_joints`.
  void holdFixed(const Json& problem, ModelRobot& robot) {
    if (!problem.contains("fixed_joints")) return;
    const Json& values = problem["fixed_joints"];
    if (!values.is_object()) stop("fixed_joints: a map of joint values is needed");
    std::vector<std::string> unused;
    std::vector<std::pair<std::size_t, double>> followers;
    for (const auto& [name, value] : values.items()) {
      const std::string path = "fixed_joints." + name;
      const double wanted = number(value, path);
      const auto j = findJoint(robot.description, name);
      if (j && std::find(robot.planned.begin(), robot.planned.end(), *j) != robot.planned.end()) {
        fault(path + ": the joint is planned for (joint_names), and can't be held");
      } else if (j && robot.description.joints[*j].mimic) {
        followers.emplace_back(*j, wanted);
      } else if (!j || !robot.held.contains(*j)) {
        unused.push_back(name);
      } else {
        const JointModel& joint = robot.description.joints[*j];
        if (const auto held =
                withinLimits(wanted, joint.lower, joint.upper, path, robot.description.notes))
          robot.held[*j] = *held, robot.heldFrom[*j] = "fixed_joints";
        else
          fault(path + ": " + outsideLimits(wanted, joint.lower, joint.upper));
      }
    }
    for (const auto& [j, wanted] : followers) {
      const JointModel& joint = robot.description.joints[j];
      const auto leader = robot.held.find(joint.mimic->joint);
      if (leader == robot.held.end() ||
          std::abs(wanted - (joint.mimic->multiplier * leader->second + joint.mimic->offset)) >
              limitSlack)
        fault("fixed_joints." + joint.name + ": the joint mimics " +
              quotedWord(robot.description.joints[joint.mimic->joint].name) +
              ", which gives it another value; leave it out");
    }
    if (!unused.empty())
      problem_.source.notes.push_back(
          {file_.string() +
               ": fixed_joints: not used, because they are no joints that can be "
               "held: " +
               joinedFirst(unused),
           NoteWeight::detail});
  }

  void readRobot(const Json& set, const Json& problem) {
    RobotSetup setup;
    std::vector<Fault> found;
    std::vector<std::filesystem::path> files;
    const auto urdf = dataFile(set, "urdf"), srdf = dataFile(set, "srdf");
    auto model = readUrdf(urdf, {.cache = cache_}, found, files, &problem_.source.notes);
    for (const auto& file : files) addFile(setup.files, file);
    addFile(setup.files, srdf);
    if (model) readSrdf(srdf, *model, found);
    faults_.add(found);
    if (model && !found.empty()) problem_.source.notes = model->notes;
    faults_.throwIfAny();
    setup.robot.description = std::move(*model);

    std::vector<std::size_t> active;
    for (const Json& name : list(set, "joint_names")) {
      const std::string text = name.is_string() ? name.get<std::string>() : name.dump();
      const auto j = findJoint(setup.robot.description, text);
      if (!j)
        fault("joint_names: " + noSuchJoint(text, setup.robot.description));
      else if (const std::string why = whyNotActive(setup.robot.description, *j); !why.empty())
        fault("joint_names: " + text + " " + why);
      else if (isPoseJoint(setup.robot.description.joints[*j].type))
        fault("joint_names: " + text + " is planar or floating; only single joints are supported");
      else if (std::find(active.begin(), active.end(), *j) != active.end())
        fault("joint_names: " + text + " is named twice");
      else
        active.push_back(*j);
    }
    faults_.throwIfAny();
    chooseJoints(setup.robot, active);
    const std::string& root = setup.robot.description.links[setup.robot.description.root].name;
    if (set.contains("frame") && set["frame"] != Json(root))
      fault("frame: the robot's root link, " + quotedWord(root) + ", is needed, not " +
            set["frame"].dump());
    holdFixed(problem, setup.robot);
    faults_.throwIfAny();
    addRobots({std::move(setup)}, builder_, problem_.source);
  }

  /// Adds a fault for each size that objects of this type do not have: perhaps the type is wrong.
  void faultOtherSizes(const Json& object, const std::string& id, const std::string& type) {
    static const std::map<std::string, std::set<std::string>> sizes{
        {"box", {"size"}}, {"cylinder", {"radius", "length"}}, {"sphere", {"radius"}}};
    const auto own = sizes.find(type);
    if (own == sizes.end()) return;
    for (const char* const key : {"size", "radius", "length"})
      if (object.contains(key) && !own->second.contains(key))
        fault(id + "." + key + ": a " + type + " has none; remove it, or change the type");
  }

  void readObject(const Json& object) {
    const std::string id = word(object, "id"), type = word(object, "type");
    faultOtherSizes(object, id, type);
    Primitive primitive;
    if (type == "box") {
      const auto size = numbers(field(object, "size"), 3, id + ".size");
      primitive = Box{{size[0], size[1], size[2]}};
    } else if (type == "cylinder") {
      primitive = Cylinder{number(object, id, "radius"), number(object, id, "length")};
    } else if (type == "sphere") {
      primitive = Sphere{number(object, id, "radius")};
    } else {
      return fault(id + ".type: " + notOneOf(type, {"box", "cylinder", "sphere"}));
    }
    if (const auto why = checkPrimitive(primitive)) return fault(id + ": " + *why);
    const auto p = numbers(field(object, "position"), 3, id + ".position");
    const auto q = numbers(field(object, "orientation_xyzw"), 4, id + ".orientation_xyzw");
    RigidPose at{{p[0], p[1], p[2]}, Eigen::Quaterniond(q[3], q[0], q[1], q[2])};
    if (!(at.q.coeffs().stableNorm() > 0))
      return fault(id + ".orientation_xyzw: zeros are no rotation");
    at.q = ofOrdinarySize(at.q);
    builder_.addObstacle(id, primitive, at);
  }

  Configuration state(const Json& set, const Json& values, const std::string& what) {
    Configuration q = Configuration::Zero(static_cast<Eigen::Index>(problem_.model.space.size()));
    const auto given = numbers(values, problem_.model.robots.front().plannedJoints.size(), what);
    const Json& names = set["joint_names"];
    for (std::size_t i = 0; i < given.size(); ++i) {
      const Coordinate& c =
          problem_.model.space
              .coordinates()[problem_.model.robots.front().plannedJoints[i].coordinate];
      std::string why;
      const auto value = coordinateValue(c, given[i], what + "." + names[i].get<std::string>(),
                                         problem_.source.notes, why);
      if (value)
        q[static_cast<Eigen::Index>(c.first)] = *value;
      else
        fault(why);
    }
    return q;
  }

  std::filesystem::path file_;
  std::string index_;
  FileCache* cache_;
  FaultList faults_;
  ModelBuilder builder_;
  Problem problem_;
};

}  // namespace

Problem readMbmProblem(const std::filesystem::path& file, const std::string& index,
                       FileCache* cache) {
  return MbmReader(file, index, cache).read();
}

std::vector<std::string> mbmIndices(const std::filesystem::path& file) {
  return MbmReader(file, "").indices();
}

}  // namespace corridor
