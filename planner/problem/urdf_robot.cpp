#include "planner/problem/urdf_robot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "collision/core/read_file.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_health.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/hold_yaml.h"
#include "planner/problem/joint_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/proof_digest.h"
#include "planner/problem/shape_yaml.h"
#include "planner/robot/urdf_file.h"
#include "planner/robot/xacro.h"

namespace corridor {
namespace {

/// Returns the path of the file that a key names. Returns nullopt if the key is absent, or if a
/// fault was added.
std::optional<std::filesystem::path> readFileName(const YamlMap& map, const char* key,
                                                  const std::filesystem::path& folder) {
  const auto name = map.text(key);
  if (!name) return std::nullopt;
  const std::filesystem::path path = folder / *name;
  if (const std::string why = whyNotOrdinaryFile(path); !why.empty()) {
    map.fault(key, path.string() + ": " + why);
    return std::nullopt;
  }
  return path;
}

PackageMap readPackages(const YamlMap& file, const std::filesystem::path& folder) {
  PackageMap packages;
  const YamlValue* value = file.find("packages");
  if (!value) return packages;
  const YamlMap map(*value, "packages", nullptr, file.source());
  for (const YamlValue::Entry* entry : map.entries()) {
    const auto name = map.text(entry->key);
    if (!name) continue;
    packages[entry->key] = folder / *name;
    std::error_code none;
    if (!std::filesystem::is_directory(packages[entry->key], none))
      map.fault(entry->key, packages[entry->key].string() + ": no such folder");
  }
  return packages;
}

/// Reads `xacro: {prefix: left_}` as arguments of xacro: "prefix:=left_".
std::vector<std::string> readXacro(const YamlMap& file) {
  std::vector<std::string> arguments;
  const YamlValue* value = file.find("xacro");
  if (!value) return arguments;
  const YamlMap map(*value, "xacro", nullptr, file.source());
  for (const YamlValue::Entry* entry : map.entries()) {
    const auto text = map.text(entry->key);
    if (text && (entry->key.starts_with('-') || entry->key.find(":=") != std::string::npos))
      map.fault(entry->key, "is not the name of an argument of xacro");
    else if (text)
      arguments.push_back(entry->key + ":=" + *text);
  }
  return arguments;
}

/// Reads URDF and SRDF. Returns nullopt if one of them has a fault; `notesOfFaulty` then gets the
/// notes.
std::optional<RobotDescription> readModel(const std::filesystem::path& urdf, const UrdfRules& rules,
                                          const std::optional<std::filesystem::path>& srdf,
                                          FaultList& faults,
                                          std::vector<std::filesystem::path>& files,
                                          std::vector<Note>& notesOfFaulty) {
  std::vector<Fault> found;
  std::vector<std::filesystem::path> named;
  auto model = readUrdf(urdf, rules, found, named, &notesOfFaulty);
  for (const auto& file : named) addFile(files, file);
  if (srdf) {
    addFile(files, *srdf);
    if (model) readSrdf(*srdf, *model, found, rules.xacro);
  }
  faults.add(found);
  if (found.empty()) return model;
  if (model) addAll(model->notes, notesOfFaulty);
  return std::nullopt;
}

using JointList = std::vector<std::size_t>;

/// Adds the states of the group a second time, under their names without the group's name. For
/// example, if the group is "arm", the name "home" then also means "arm/home".
void addStatesOf(const std::string& group, RobotDescription& model) {
  const std::string prefix = group + "/";
  std::map<std::string, NamedState> added;
  for (const auto& [name, state] : model.states)
    if (state.group == group && name.starts_with(prefix))
      added.emplace(name.substr(prefix.size()), state);
  model.states.merge(added);
}

/// Returns the joints of the group that are planned for, and adds faults to the map's source.
/// @param byDefault the name of the group that is used if the file has no key `group`.
JointList readGroup(const YamlMap& map, const std::string& byDefault, RobotDescription& model) {
  JointList active;
  const auto name = map.find("group") ? map.text("group") : std::optional(byDefault);
  if (!name) return active;
  const auto found = model.groups.find(*name);
  if (!map.find("srdf")) {
    map.fault("group", "a group needs an SRDF; add srdf: FILE, or use joints: [NAME, …]");
  } else if (found == model.groups.end()) {
    const std::vector<std::string> known = usableNames(model.groups);
    if (model.groups.empty())
      map.fault("group", map.find("srdf")->text + " names no group, so there is no " +
                             quotedWord(*name) + "; use joints: [NAME, …]");
    else
      map.fault(
          "group",
          (map.find("group") ? "there is no group " : "the request names it; there is no group ") +
              quotedWord(*name) + " in the SRDF" + didYouMean(*name, known) +
              (known.empty() ? ", and none of its groups can be used" : knownWords(known)));
  } else if (const JointGroup& group = found->second; !group.unusable.empty()) {
    map.fault("group", "the group " + quotedWord(*name) + " can't be used: " + group.unusable);
  } else {
    for (const std::string& joint : group.joints)
      if (const auto j = findJoint(model, joint);
          j && canMove(model.joints[*j]) && !model.joints[*j].passive)
        active.push_back(*j);
    if (!group.missing.empty())
      model.notes.push_back({"the group " + quotedWord(*name) + " is used without " +
                                 joinedFirst(group.missing) + ", which the URDF lacks",
                             NoteWeight::motion});
    if (!group.virtualJoints.empty())
      model.notes.push_back(
          {"the group " + quotedWord(*name) + " is used without " +
               joinedFirst(group.virtualJoints) +
               (group.virtualJoints.size() == 1 ? ", which is a virtual joint of the SRDF"
                                                : ", which are virtual joints of the SRDF"),
           NoteWeight::motion});
    addStatesOf(*name, model);
    if (active.empty())
      map.fault("group",
                "the group " + quotedWord(*name) + " has no joint that can be planned for");
  }
  return active;
}

JointList readJointList(const YamlMap& map, const RobotDescription& model) {
  JointList active;
  const auto names = readWords(*map.find("joints"), "such as [pan, lift]", "joints", map.source());
  if (!names) return active;
  if (names->empty()) map.fault("joints", "at least one joint is needed");
  for (const std::string& name : *names) {
    const auto j = findJoint(model, name);
    if (!j)
      map.fault("joints", noSuchJoint(name, model));
    else if (const std::string why = whyNotActive(model, *j); !why.empty())
      map.fault("joints", name + " " + why);
    else if (!canMove(model.joints[*j]))
      map.fault("joints", name + " can't move: its limits are equal");
    else if (std::find(active.begin(), active.end(), *j) != active.end())
      map.fault("joints", name + " is named twice");
    else
      active.push_back(*j);
  }
  return active;
}

/// Adds a note that no joint of the robot can move.
void noteThatNoneMoves(const std::filesystem::path& urdf, ModelRobot& robot) {
  robot.description.notes.push_back(
      {urdf.string() + ": " + whyNoneMoves(robot) + "; problems refuse this robot",
       NoteWeight::motion});
}

/// Reads `states`: maps of joint values, by the state's name. A state replaces the SRDF's state of
/// the same name.
void readStates(const YamlMap& file, RobotDescription& model) {
  const YamlValue* value = file.find("states");
  if (!value) return;
  const YamlMap states(*value, "states", nullptr, file.source());
  for (const YamlValue::Entry* named : states.entries()) {
    const YamlMap map(named->value, states.pathOf(named->key), nullptr, file.source());
    NamedState state;
    readJointValues(map, model, [&](std::size_t j, const YamlValue::Entry& entry, bool degrees) {
      const JointModel& joint = model.joints[j];
      if (!hasOwnValue(joint)) return map.fault(entry.key, whyNotActive(model, j));
      if (isPoseJoint(joint.type)) {
        if (const auto pose = readJointPose(entry.value, map.pathOf(entry.key), joint,
                                            file.source(), model.notes))
          for (const auto& [number, x] : numbersOf(joint, *pose)) state.values[number] = x;
      } else if (const auto number = map.number(entry.key)) {
        state.values[joint.name] = degrees ? *number * (std::numbers::pi / 180) : *number;
      }
    });
    if (model.states.contains(named->key))
      model.notes.push_back(
          {"state " + named->key + ": robot.yaml's is used, not the SRDF's", NoteWeight::motion});
    model.states[named->key] = std::move(state);
  }
}

/// Reads a list of pairs of links.
std::vector<std::array<std::string, 2>> readLinkPairs(const YamlMap& map, const char* key,
                                                      const RobotDescription& model) {
  std::vector<std::array<std::string, 2>> pairs;
  const YamlValue& value = *map.find(key);
  std::vector<std::string> links;
  for (const LinkModel& link : model.links) links.push_back(link.name);
  if (value.kind != YamlValue::Kind::List) {
    map.fault(key, "a list of pairs of links is needed, such as [[hand, finger]], not " +
                       described(value));
    return pairs;
  }
  const std::string path = map.pathOf(key);
  for (const YamlValue& item : value.items) {
    const auto pair = readWords(item, "such as [hand, finger]", path, map.source());
    if (!pair) continue;
    if (pair->size() != 2) {
      map.source().fault(item.line, path + ": two links are needed, such as [hand, finger], not " +
                                        std::to_string(pair->size()));
      continue;
    }
    bool known = true;
    for (const std::string& name : *pair)
      if (std::find(links.begin(), links.end(), name) == links.end()) {
        map.source().fault(item.line, path + ": there is no link " + quotedWord(name) +
                                          didYouMean(name, links) + knownWords(links));
        known = false;
      }
    if (known) pairs.push_back({(*pair)[0], (*pair)[1]});
  }
  return pairs;
}

/// Reads `never_in_contact`. Its pairs are added to the model if the digest shows that they were
/// proved for this robot. Otherwise a note says that they are tested.
void readProvedPairs(const YamlMap& map, RobotDescription& model) {
  map.require("margin", "metres: the margin that the proof of these pairs covers");
  map.require("beyond_limits", "rad or m: how far the proof goes beyond the limits of joints");
  map.require("pairs", "pairs of links, such as [[hand, foot]]");
  const auto margin = map.number("margin", Range::NotNegative),
             beyond = map.number("beyond_limits", Range::NotNegative);
  const auto digest = map.find("digest") ? map.text("digest") : std::optional<std::string>("");
  if (!margin || !beyond || !digest || !map.find("pairs")) return;
  const std::size_t before = map.source().faults.size();
  const auto pairs = readLinkPairs(map, "pairs", model);
  if (map.source().faults.size() != before || pairs.empty()) return;
  const AllowedPair::Proof proof{*margin, *beyond};
  std::string why = ", because it has no digest";
  try {
    if (!digest->empty() && *digest == proofDigest(digestOfRobot(model), proof, pairs)) {
      for (const auto& [a, b] : pairs)
        model.allowed.push_back({a, b, std::string(kNeverInContact), proof});
      return;
    }
    if (!digest->empty())
      why =
          ", because its digest does not match: the shapes, joints or limits of the robot, or the "
          "list, have changed since the proof";
  } catch (const std::runtime_error& error) {  // of sha256
    why = std::string(", because its digest can't be compared: ") + error.what();
  }
  model.notes.push_back(
      {"never_in_contact: " +
           (pairs.size() == 1 ? std::string("its pair is tested")
                              : "its " + std::to_string(pairs.size()) + " pairs are tested") +
           why +
           "; corridor new robot proves the pairs again, and writes a never_in_contact with a "
           "digest",
       NoteWeight::motion});
}

/// Reads `solid`: true, or a list of links. The meshes of these links are made solid. With `true`,
/// meshes that are not watertight stay surfaces, and a note names their links.
void readSolid(const YamlMap& file, RobotDescription& model) {
  const YamlValue* const value = file.find("solid");
  if (!value) return;
  const bool isList = value->kind == YamlValue::Kind::List;
  std::vector<std::string> names;
  if (isList) {
    const auto words = readWords(*value, "such as [hand, finger]", "solid", file.source());
    if (!words) return;
    names = *words;
  } else if (value->text != "true" && value->text != "false") {
    return file.fault("solid", "true, false, or a list of links such as [hand] is needed, not " +
                                   described(*value));
  } else if (!file.boolean("solid").value_or(false)) {
    return;
  }
  std::vector<std::string> links, open;
  for (LinkModel& link : model.links) {
    links.push_back(link.name);
    const auto named = std::find(names.begin(), names.end(), link.name);
    if (isList && named == names.end()) continue;
    for (PlacedShape& shape : link.shapes) {
      if (!shape.mesh) continue;  // other shapes are always solid
      const std::string why = inspectMesh(shape.mesh->mesh).whyNotWatertight;
      shape.solid = why.empty();
      if (!why.empty() && isList)
        file.fault("solid", "needs watertight meshes, and " + shape.file.string() + " of " +
                                quotedWord(link.name) + " is not watertight: " + why +
                                "; repair the mesh, or leave the link out");
      else if (!why.empty())
        open.push_back(link.name);
    }
  }
  for (const std::string& name : names)
    if (std::find(links.begin(), links.end(), name) == links.end())
      file.fault("solid", "there is no link " + quotedWord(name) + didYouMean(name, links) +
                              knownWords(links));
  if (!open.empty())
    model.notes.push_back(
        {"solid: meshes that are not watertight stay surfaces: " + joinedFirst(open),
         NoteWeight::coverage});
}

void readAllow(const YamlMap& file, RobotDescription& model) {
  if (file.find("allow"))
    for (const auto& [a, b] : readLinkPairs(file, "allow", model))
      model.allowed.push_back({a, b, std::string(kAllowedByRobot)});
  if (const YamlValue* value = file.find("never_in_contact"))
    readProvedPairs(
        YamlMap(*value, "never_in_contact", &robotKeys().at("never_in_contact"), file.source()),
        model);
}

void readWeights(const YamlMap& file, RobotSetup& setup) {
  const YamlValue* value = file.find("weights");
  if (!value) return;
  const YamlMap weights(*value, "weights", &robotKeys().at("weights"), file.source());
  setup.robot.rotationWeight =
      weights.number("rotation", Range::Positive).value_or(setup.robot.rotationWeight);
  const YamlValue* joints = weights.find("joints");
  if (!joints) return;
  const YamlMap map(*joints, "weights.joints", nullptr, file.source());
  for (const YamlValue::Entry* entry : map.entries()) {
    const auto weight = map.number(entry->key, Range::Positive);
    if (!findJoint(setup.robot.description, entry->key))
      map.fault(entry->key, noSuchJoint(entry->key, setup.robot.description));
    else if (weight)
      setup.robot.jointWeights[entry->key] = *weight;
  }
}

}  // namespace

std::optional<double> withinLimits(double value, double lower, double upper,
                                   const std::string& path, std::vector<Note>& notes) {
  if (lower <= value && value <= upper) return value;
  if (!(lower - limitSlack <= value && value <= upper + limitSlack)) return std::nullopt;
  const double limit = value < lower ? lower : upper;
  notes.push_back({path + ": " + shortest(value) + " is read as its limit, " + shortest(limit),
                   NoteWeight::motion});
  return limit;
}

std::optional<RobotSetup> readUrdfRobot(const YamlMap& map, const std::string& name,
                                        const std::string& group,
                                        const std::filesystem::path& folder, RobotUse use,
                                        RobotSetup setup, std::vector<Note>& notesOfFaulty) {
  for (const char* key : {"shapes", "reference"})
    if (map.find(key)) map.fault(key, "is for rigid robots; this one's shapes are in its URDF");
  UrdfRules rules{.packages = readPackages(map, folder)};
  rules.visualsCollide = map.choice("visuals", robotChoices().at("visuals")) == "collide";
  rules.softLimits = map.choice("limits", robotChoices().at("limits")) == "soft";
  rules.colladaUp = map.choice("collada_up", robotChoices().at("collada_up")) == "file";
  rules.xacro = readXacro(map);
  rules.cache = map.source().cache;
  const auto urdf = readFileName(map, "urdf", folder);
  const auto srdf = readFileName(map, "srdf", folder);
  if (!urdf || (map.find("srdf") && !srdf)) return std::nullopt;
  if (map.find("xacro") && !isXacro(*urdf) && !(srdf && isXacro(*srdf)))
    map.fault("xacro", "is for a URDF or SRDF whose name ends in .xacro; leave it out");
  auto model = readModel(*urdf, rules, srdf, map.source().faults, setup.files, notesOfFaulty);
  if (!model) return std::nullopt;

  setup.robot.description = std::move(*model);
  setup.robot.description.name = name;
  const std::size_t before = map.source().faults.size();
  readSolid(map, setup.robot.description);
  readStates(map, setup.robot.description);
  const std::optional<std::string> heldState = readHold(map, setup);
  const YamlPlace hold{map.source(), "hold", heldState ? map.find("hold")->line : 0};
  // If the file does not choose the planned joints, all joints of the held state are held, and none
  // of them is planned for.
  const bool hasDefault = !group.empty() && srdf && !map.find("joints");
  const bool isChosen = map.find("group") || map.find("joints") || hasDefault;
  setup.robot.jointsAreChosen = isChosen || heldState || map.find("hold");
  if (heldState && !isChosen) holdState(*heldState, {}, hold, setup);
  readAllow(map, setup.robot.description);
  readWeights(map, setup);
  JointList active;
  if (map.find("group") && map.find("joints"))
    map.fault("joints", "one of group and joints is needed, not both");
  else if (map.find("group") || hasDefault)
    active = readGroup(map, group, setup.robot.description);
  else if (map.find("joints"))
    active = readJointList(map, setup.robot.description);
  else if ((active = allMoving(setup.robot)).empty() && use == RobotUse::plan)
    map.fault("urdf", whyNoneMoves(setup.robot));
  else if (active.empty())
    noteThatNoneMoves(*urdf, setup.robot);
  if (!group.empty() && !(map.find("group") ? map.find("group")->text == group : hasDefault))
    setup.robot.description.notes.push_back(
        {"the request's group " + quotedWord(group) + " is not used: " +
             (isChosen ? "robot.yaml chooses the joints that are planned for"
                       : "the robot has no SRDF, so all joints that can move are planned for"),
         NoteWeight::motion});
  for (const std::size_t j : active)
    if (setup.robot.held.contains(j) || setup.robot.heldPoses.contains(j))
      map.fault("hold", setup.robot.description.joints[j].name +
                            " is planned for, and can't be held; remove it from hold");
  if (heldState && isChosen) holdState(*heldState, active, hold, setup);
  if (map.source().faults.size() != before) {
    addAll(setup.robot.description.notes, notesOfFaulty);
    return std::nullopt;
  }
  std::vector<std::string> unweighted;
  for (const auto& [joint, weight] : setup.robot.jointWeights)
    if (const auto j = findJoint(setup.robot.description, joint);
        j && std::find(active.begin(), active.end(), *j) == active.end())
      unweighted.push_back(joint);
  if (!unweighted.empty())
    setup.robot.description.notes.push_back({"weights of " + joinedFirst(unweighted) +
                                                 " are not used: these joints are not planned for",
                                             NoteWeight::detail});
  for (const auto& [j, value] : setup.robot.held) setup.robot.heldByFile.insert(j);
  for (const auto& [j, pose] : setup.robot.heldPoses) setup.robot.heldByFile.insert(j);
  chooseJoints(setup.robot, active);
  return setup;
}

std::optional<RobotSetup> readBareUrdf(const std::filesystem::path& file, RobotUse use,
                                       FaultList& faults, std::vector<Note>& notesOfFaulty,
                                       FileCache* cache) {
  RobotSetup setup;
  auto model = readModel(file, {.cache = cache}, std::nullopt, faults, setup.files, notesOfFaulty);
  if (!model) return std::nullopt;
  setup.robot.description = std::move(*model);
  const JointList active = allMoving(setup.robot);
  if (active.empty() && use == RobotUse::describe) {
    noteThatNoneMoves(file, setup.robot);
  } else if (active.empty()) {
    faults.add(file.string(), 0, whyNoneMoves(setup.robot));
    addAll(setup.robot.description.notes, notesOfFaulty);
    return std::nullopt;
  }
  chooseJoints(setup.robot, active);
  return setup;
}

}  // namespace corridor
