#include "planner/benchmark/campaign_trajectories.h"

#include <algorithm>
#include <cctype>
#include <set>

#include "collision/core/spelling.h"
#include "planner/problem/keys.h"
#include "planner/problem/limits_yaml.h"

namespace corridor {
namespace {

const MapKeys kTrajectories{{"makers", "limits"}, {}};
constexpr const char* kMakersForm = "[blends, stop, spline, inserted]";

/// Returns whether a text can be the name of a set, with which names of columns in CSV files and
/// databases begin.
bool isSetName(const std::string& name) {
  return !name.empty() && std::isalpha(static_cast<unsigned char>(name.front())) &&
         name.size() <= 40 && std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return c < 0x80 && (std::isalnum(c) || c == '_' || c == '-');
         });
}

/// Returns the limits of a robot with the full names of its joints and links, "left/pan", as the
/// model of a problem with several robots has them.
YamlValue withPrefix(YamlValue limits, const std::string& robot) {
  if (robot.empty()) return limits;
  for (YamlValue::Entry& entry : limits.entries)
    if (entry.key == "joints" || entry.key == "link_speed")
      for (YamlValue::Entry& named : entry.value.entries) named.key = robot + "/" + named.key;
  return limits;
}

/// Returns the indices of the entries of a configuration that belong to a robot.
std::vector<Eigen::Index> numbersOf(const Model& model, const ModelRobot& robot) {
  std::vector<std::size_t> first;  // the first coordinate of every joint
  for (const ModelRobot& each : model.robots)
    for (const PlannedJoint& joint : each.plannedJoints) first.push_back(joint.coordinate);
  std::vector<Eigen::Index> numbers;
  const auto& coordinates = model.space.coordinates();
  for (const PlannedJoint& joint : robot.plannedJoints)
    for (std::size_t c = joint.coordinate; c < coordinates.size(); ++c) {
      if (c != joint.coordinate && std::find(first.begin(), first.end(), c) != first.end()) break;
      for (std::size_t i = 0; i < coordinates[c].size(); ++i)
        numbers.push_back(static_cast<Eigen::Index>(coordinates[c].first + i));
    }
  return numbers;
}

/// Replaces the limits of one robot in `all` by the limits of this robot in `by`.
void replace(const Model& model, const ModelRobot& robot, const JointLimits& by, JointLimits& all) {
  for (const Eigen::Index i : numbersOf(model, robot)) {
    all.velocity[i] = by.velocity[i];
    all.acceleration[i] = by.acceleration[i];
    all.jerk[i] = by.jerk[i];
  }
  const auto ofRobot = [&](const LinkSpeed& link) {
    return std::find(robot.linkFrames.begin(), robot.linkFrames.end(), link.frame) !=
           robot.linkFrames.end();
  };
  std::erase_if(all.links, ofRobot);
  std::copy_if(by.links.begin(), by.links.end(), std::back_inserter(all.links), ofRobot);
}

/// Adds the notes in `of`, which are on the limits of a set, such as notes on assumed
/// accelerations. Each added note begins with "trajectories", and the name of the set if it has
/// one.
void addNotes(const std::string& set, const std::set<std::string>& of,
              std::vector<std::string>& notes) {
  for (const std::string& note : of)
    notes.push_back((set.empty() ? "trajectories: " : "trajectories, " + set + ": ") + note);
}

class LimitSets {
 public:
  LimitSets(const YamlMap& sets, std::filesystem::path folder, const std::vector<Problem>& problems,
            std::vector<std::string>& notes)
      : sets_(sets), folder_(std::move(folder)), problems_(problems), notes_(notes) {}

  std::vector<CampaignLimits> read() {
    std::vector<CampaignLimits> all;
    for (const YamlValue::Entry* entry : sets_.entries()) {
      if (!isSetName(entry->key)) {
        sets_.fault(entry->key,
                    "the name of a set of limits begins columns: at most 40 letters, digits, _ "
                    "and -, the first one a letter");
        continue;
      }
      all.push_back(readSet(*entry));
    }
    return all;
  }

 private:
  CampaignLimits readSet(const YamlValue::Entry& entry) {
    CampaignLimits set = ownLimits(problems_);
    set.name = entry.key;
    const YamlMap robots(entry.value, sets_.pathOf(entry.key), nullptr, sets_.source());
    std::set<std::string> used, notes;
    for (std::size_t p = 0; p < problems_.size(); ++p) {
      const Model& model = problems_[p].model;
      for (const ModelRobot& robot : model.robots) {
        const YamlValue* limits = robots.find(robot.description.name);
        if (!limits) {
          notes.insert(set.ofProblem[p].notes.begin(), set.ofProblem[p].notes.end());
          continue;
        }
        used.insert(robot.description.name);
        const JointLimits read = readRobot(*limits, robots, robot, model);
        notes.insert(read.notes.begin(), read.notes.end());
        replace(model, robot, read, set.ofProblem[p]);
      }
    }
    checkNames(robots, used);
    addNotes(set.name, notes, notes_);
    return set;
  }

  /// Reads the limits of a robot. A fault that occurs with several problems is reported once.
  JointLimits readRobot(const YamlValue& value, const YamlMap& robots, const ModelRobot& robot,
                        const Model& model) {
    FaultList faults;
    YamlSource source{robots.source().file, faults, {}};
    std::vector<std::filesystem::path> files;
    LimitSpec spec;
    const YamlValue named = withPrefix(value, robot.name);
    try {
      const YamlMap map(named, robots.pathOf(robot.description.name), &problemKeys().at("limits"),
                        source);
      spec = readLimitMap(map, folder_, model, true, files);
      faults.throwIfAny();
    } catch (const InputError& error) {
      for (const Fault& fault : error.faults())
        if (seenFaults_.insert(fault.str()).second)
          robots.source().faults.add(fault.file, fault.line, fault.text);
      spec = {};
    }
    // Joints of other robots get no note on assumed accelerations, since their limits are not used
    // here.
    for (const LimitedJoint& joint : jointsWithLimits(model))
      if (!robot.name.empty() && !joint.name.starts_with(robot.name + "/") && !joint.isMimic)
        spec.named[joint.name].acceleration = kAssumedAcceleration;
    JointLimits limits = limitsOf(model, spec);
    for (const Note& note : source.notes) limits.notes.push_back(note.text);
    return limits;
  }

  void checkNames(const YamlMap& robots, const std::set<std::string>& used) const {
    std::set<std::string> names;
    for (const Problem& problem : problems_)
      for (const ModelRobot& robot : problem.model.robots) names.insert(robot.description.name);
    const std::vector<std::string> known(names.begin(), names.end());
    for (const YamlValue::Entry* entry : robots.entries())
      if (!used.count(entry->key) && !problems_.empty())
        robots.fault(entry->key, "no problem has a robot of that name" +
                                     didYouMean(entry->key, known) + knownWords(known));
  }

  const YamlMap& sets_;
  std::filesystem::path folder_;
  const std::vector<Problem>& problems_;
  std::vector<std::string>& notes_;
  std::set<std::string> seenFaults_;
};

std::vector<TrajectoryMaker> readMakers(const YamlValue& value, const std::string& path,
                                        const YamlSource& source) {
  const auto names = readWords(value, kMakersForm, path, source);
  if (!names) return {};
  if (names->empty())
    source.fault(value.line, path + ": at least one is needed, such as " + kMakersForm);
  try {
    return trajectoryMakersNamed(*names, path);
  } catch (const InputError& error) {
    for (const Fault& fault : error.faults())
      source.fault(value.line, fault.file + ": " + fault.text);
    return {};
  }
}

std::vector<TrajectoryMaker> allMakers() {
  return trajectoryMakersNamed(trajectoryMakerNames(), "");
}

}  // namespace

void addOwnNotes(const std::vector<Problem>& problems, std::vector<std::string>& notes) {
  std::set<std::string> own;
  for (const Problem& problem : problems)
    own.insert(problem.task.limits.notes.begin(), problem.task.limits.notes.end());
  addNotes("", own, notes);
}

CampaignLimits ownLimits(const std::vector<Problem>& problems) {
  CampaignLimits own;
  for (const Problem& problem : problems) own.ofProblem.push_back(problem.task.limits);
  return own;
}

std::vector<TrajectoryMaker> trajectoryMakersNamed(const std::vector<std::string>& names,
                                                   const std::string& place) {
  std::vector<TrajectoryMaker> makers;
  std::vector<Fault> faults;
  for (const std::string& name : names) {
    const auto maker = trajectoryMakerNamed(name);
    if (!maker)
      faults.push_back({place, 0,
                        "there is no maker of trajectories " + quotedWord(name) +
                            didYouMean(name, trajectoryMakerNames()) +
                            "; there are: " + joined(trajectoryMakerNames())});
    else if (std::find(makers.begin(), makers.end(), *maker) != makers.end())
      faults.push_back({place, 0, quotedWord(name) + " is named twice"});
    else
      makers.push_back(*maker);
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  return makers;
}

CampaignTrajectories readTrajectories(const YamlMap& campaign, const std::filesystem::path& folder,
                                      const std::vector<Problem>& problems,
                                      std::vector<std::string>& notes) {
  CampaignTrajectories trajectories;
  const YamlValue* value = campaign.find("trajectories");
  if (!value) return trajectories;
  if (value->kind == YamlValue::Kind::List) {
    trajectories.makers = readMakers(*value, "trajectories", campaign.source());
    trajectories.limits = {ownLimits(problems)};
    addOwnNotes(problems, notes);
    return trajectories;
  }
  if (value->kind != YamlValue::Kind::Map) {
    campaign.fault("trajectories", "a list of makers is needed, such as " +
                                       std::string(kMakersForm) +
                                       ", or a map of makers and limits, not " + described(*value));
    return trajectories;
  }
  const YamlMap map(*value, "trajectories", &kTrajectories, campaign.source());
  const YamlValue* makers = map.find("makers");
  trajectories.makers =
      makers ? readMakers(*makers, "trajectories.makers", campaign.source()) : allMakers();
  const YamlValue* limits = map.find("limits");
  if (!limits) {
    trajectories.limits = {ownLimits(problems)};
    addOwnNotes(problems, notes);
    return trajectories;
  }
  const YamlMap sets(*limits, "trajectories.limits", nullptr, campaign.source());
  if (sets.empty() && limits->kind == YamlValue::Kind::Map)
    map.fault("limits", "at least one set is needed, such as {own: {}}: each problem's own limits");
  trajectories.limits = LimitSets(sets, folder, problems, notes).read();
  return trajectories;
}

void addTrajectoryKeys(std::map<std::string, MapKeys>& keys) {
  keys["trajectories"] = kTrajectories;
  for (const auto& [path, map] : problemKeys())
    if (path == "limits" || path.starts_with("limits."))
      keys["trajectories.limits.*.*" + path.substr(std::string("limits").size())] = map;
}

}  // namespace corridor
