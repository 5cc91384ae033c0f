#include <algorithm>
#include <cmath>
#include <utility>

#include "collision/core/fault_list.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/new_file.h"
#include "planner/app/new_robot_pairs.h"
#include "planner/app/output.h"
#include "planner/model/model_builder.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/assembly.h"
#include "planner/problem/joint_yaml.h"
#include "planner/robot/joint_types.h"
#include "planner/robot/urdf_file.h"

namespace corridor::app {
namespace {

namespace fs = std::filesystem;

/// Half the edge of the box in which random states place a planar or floating joint, metres. Any
/// length will do: if such a joint moves only one of the two bodies of a pair, contacts of this
/// pair are not used.
constexpr double kAnywhere = 1;

/// If a robot without groups has more moving joints than two arms, the file explains how to choose
/// among them.
constexpr std::size_t kManyJoints = 14;

/// A URDF, and the SRDF if one is given.
struct RobotFiles {
  RobotDescription model;            ///< without the SRDF's pairs
  std::vector<AllowedPair> allowed;  ///< the SRDF's pairs
};

PackageMap packagesOf(const NewRobotArguments& a) {
  PackageMap packages;
  for (const std::string& package : a.packages) {
    const std::size_t sign = package.find('=');
    if (sign == package.npos || sign == 0 || sign + 1 == package.size())
      throw InputError(Fault{"--package", 0, "NAME=FOLDER is needed, not " + quotedWord(package)});
    const std::string folder = package.substr(sign + 1);
    std::error_code none;
    if (!fs::is_directory(folder, none))
      throw InputError(Fault{"--package", 0, folder + ": no such folder"});
    packages[package.substr(0, sign)] = folder;
  }
  return packages;
}

RobotFiles readFiles(const NewRobotArguments& a) {
  const UrdfRules rules{packagesOf(a), a.visuals == "collide", a.limits == "soft",
                        a.colladaUp == "file"};
  std::error_code none;
  if (fs::is_directory(a.urdf, none) || lowered(fs::path(a.urdf).extension().string()) == ".yaml")
    throw InputError(Fault{a.urdf, 0,
                           "a URDF is needed; corridor new problem takes a robot.yaml or its "
                           "folder"});
  std::vector<Fault> faults;
  std::vector<fs::path> files;
  auto model = readUrdf(a.urdf, rules, faults, files);
  const auto ownPairs = model ? std::exchange(model->allowed, {}) : std::vector<AllowedPair>();
  if (model && a.srdf) readSrdf(*a.srdf, *model, faults);
  if (!faults.empty()) throw InputError(std::move(faults));
  files.emplace_back(a.urdf);
  if (a.srdf) files.emplace_back(*a.srdf);
  if (!a.file.toStdout()) requireNotAnInput(a.file.output, "--output", files, "the robot");
  RobotFiles read{std::move(*model), {}};
  read.allowed = std::exchange(read.model.allowed, ownPairs);
  return read;
}

/// Returns the model in which every joint that can move is planned for.
Model modelOf(RobotDescription description, const std::string& urdf) {
  ModelRobot robot;
  robot.description = std::move(description);
  const std::vector<std::size_t> moving = allMoving(robot);
  if (moving.empty()) throw InputError(Fault{urdf, 0, whyNoneMoves(robot)});
  ModelBuilder builder;
  for (const std::size_t j : moving)
    if (isPoseJoint(robot.description.joints[j].type))
      builder.bound(robot.description.joints[j].name,
                    {Vec3::Constant(-kAnywhere), Vec3::Constant(kAnywhere)});
  chooseJoints(robot, moving);
  return builder.addRobot(std::move(robot)).build();
}

std::string jointText(const RobotDescription& model, const JointModel& joint) {
  std::string text = yamlWord(joint.name) + ": " + nameOf(joint.type);
  if (joint.mimic) return text + ", follows " + yamlWord(model.joints[joint.mimic->joint].name);
  if (std::isfinite(joint.lower) || std::isfinite(joint.upper))
    text += ", " + rounded(joint.lower) + " to " + rounded(joint.upper) +
            (joint.type == JointType::prismatic ? " m" : " rad");
  return text;
}

/// @throws InputError if a joint of --joints is not one that can be planned for.
void requireMoving(const std::vector<std::string>& joints, const RobotDescription& model) {
  const auto refuse = [](const std::string& why) { throw InputError(Fault{"--joints", 0, why}); };
  for (auto name = joints.begin(); name != joints.end(); ++name) {
    const auto j = findJoint(model, *name);
    if (!j) refuse(noSuchJoint(*name, model));
    if (const std::string why = whyNotActive(model, *j); !why.empty())
      refuse(quotedWord(*name) + " " + why);
    if (!canMove(model.joints[*j])) refuse(quotedWord(*name) + " can't move: its limits are equal");
    if (std::find(joints.begin(), name, *name) != name)
      refuse(quotedWord(*name) + " is named twice");
  }
}

/// Returns the joints, the states, and the groups that can be used and have a moving joint, all as
/// comments. If there is only one such group, it is written as a key, not as a comment, unless
/// `chosen` has the joints that are planned for.
std::string jointsText(const RobotDescription& model, bool hasSrdf,
                       const std::vector<std::string>& chosen) {
  std::string text = "\n" + comment("Joints:");
  for (const JointModel& joint : model.joints)
    if (joint.type != JointType::fixed) text += comment("- " + jointText(model, joint));
  std::vector<std::pair<std::string, std::vector<std::string>>> groups;
  for (const auto& [name, group] : model.groups) {
    std::vector<std::string> moving;
    for (const std::string& joint : group.joints)
      if (const auto j = findJoint(model, joint); j && canMove(model.joints[*j]))
        moving.push_back(joint);
    if (group.unusable.empty() && !moving.empty()) groups.emplace_back(name, std::move(moving));
  }
  std::vector<std::string> all;
  std::string zero;
  for (const JointModel& joint : model.joints) {
    if (!canMove(joint)) continue;
    all.push_back(joint.name);
    if (isPoseJoint(joint.type)) continue;
    const double value =
        joint.type == JointType::continuous ? 0 : std::clamp(0.0, joint.lower, joint.upper);
    zero += (zero.empty() ? "" : ", ") + yamlWord(joint.name) + ": " + shortest(value);
  }
  text += "\n" + comment(
                     "The joints that are planned for. Without group and joints: all that can "
                     "move. The others are held.");
  for (const auto& [name, joints] : groups)
    if (groups.size() == 1 && chosen.empty())
      text += "group: " + yamlWord(name) + "\n" +
              comment(counted(joints.size(), "joint") + ": " + joined(joints));
    else
      text += comment("group: " + yamlWord(name) + "  # " + counted(joints.size(), "joint") + ": " +
                      joined(joints));
  if (groups.empty() && chosen.empty() && all.size() > kManyJoints)
    text += comment("Without joints, all " + std::to_string(all.size()) +
                    " are planned for, also those of wheels and fingers: a path is hard to find, "
                    "and few states are valid. Remove the # of joints, and keep the joints between "
                    "the base and the hand that you plan for.");
  text +=
      chosen.empty() ? comment("joints: " + yamlList(all)) : "joints: " + yamlList(chosen) + "\n";
  text +=
      comment("hold: {NAME: 0}  # values of joints that are not planned for, or a state's name");
  text += "\n" + comment(hasSrdf ? "Named states of the SRDF, for start and goal of problems:"
                                 : "Named states, for start and goal of problems, such as:");
  bool any = false;
  for (const auto& [name, state] : model.states) {
    std::string values;
    for (const auto& [joint, value] : state.values)
      values += (values.empty() ? "" : ", ") + yamlWord(joint) + ": " + shortest(value);
    text +=
        comment("- " + yamlWord(name) + ": " +
                (state.unusable.empty() ? "{" + values + "}" : "can't be used: " + state.unusable));
    any = true;
  }
  if (hasSrdf && !any) text += comment("none");
  text += comment("states: {zero: {" + zero + "}}");
  return text;
}

/// Returns the links without shapes, the reader's notes, and the keys that change how the URDF is
/// read.
std::string readingText(const NewRobotArguments& a, const RobotDescription& model,
                        const std::vector<std::string>& noShapes) {
  std::string text = "\n";
  if (!a.packages.empty()) {
    text += "packages: {";
    bool first = true;
    for (const auto& [name, folder] : packagesOf(a)) {
      text += (first ? "" : ", ") + yamlWord(name) + ": " + yamlWord(pathFrom(a.file, folder));
      first = false;
    }
    text += "}\n";
  } else {
    text += comment("packages: {NAME: FOLDER}  # package://NAME/…; default: searched for");
  }
  const auto choice = [&](const char* key, const std::optional<std::string>& value,
                          const char* byDefault, const std::string& help) {
    text += (value.value_or(byDefault) == byDefault ? "# " : "") + std::string(key) + ": " +
            value.value_or(byDefault) + "  # " + help + "\n";
  };
  choice("visuals", a.visuals, "ignore", "collide: links without <collision> get their <visual>");
  choice("limits", a.limits, "hard", "soft: the limits of <safety_controller> count, too");
  choice("collada_up", a.colladaUp, "ignore", "file: the up-axis of Collada files is applied");
  if (!noShapes.empty())
    text += comment("Links without shapes, which are in no test: " + joined(noShapes));
  for (const std::string& note : condensed(textsOf(model.notes))) text += comment("Note: " + note);
  return text;
}

}  // namespace

int newRobot(const NewRobotArguments& a) {
  requireNewFile(a.file);
  RobotFiles files = readFiles(a);
  requireMoving(a.joints, files.model);
  RobotDescription description = files.model;  // keeps what the text needs
  std::vector<std::string> noShapes;
  addAll(notesOnMeshes(description), description.notes);
  for (LinkModel& link : description.links) {
    if (link.shapes.empty()) noShapes.push_back(link.name);
    link.shapes.clear();
  }
  const RobotDigest digest = digestOfRobot(files.model);
  const Model model = modelOf(std::move(files.model), a.urdf);
  const Checker checker(model);
  // Before this line, a signal ends the program by its default action, because nothing has been
  // written yet.
  const std::atomic<bool>& interrupted = listenForInterrupts();
  const SortedPairs pairs = sortedPairs(checker, files.allowed, a, interrupted);
  if (interrupted) {
    warn("interrupted; nothing is written");
    return interruptedStatus();
  }

  std::string text = comment(
      "A robot with joints, written by corridor new robot. Edit it as you "
      "like: what follows a # is a comment.");
  text += comment(
      "corridor inspect FILE shows what this file says; corridor new problem FILE "
      "writes a problem for it.");
  text += "format: corridor-robot-1\nname: " + yamlWord(description.name) +
          "\nurdf: " + yamlWord(pathFrom(a.file, a.urdf)) + "\n";
  text += a.srdf ? "srdf: " + yamlWord(pathFrom(a.file, *a.srdf)) + "\n"
                 : comment("srdf: FILE  # groups, named states, pairs of links that may touch");
  text += readingText(a, description, noShapes);
  text += jointsText(description, a.srdf.has_value(), a.joints);
  text += pairsText(a, model, pairs, digest);
  writeNewFile(a.file, text);

  const ResultPrinter out(a.file.toStdout());
  if (a.file.output) out.line("robot", *a.file.output);
  out.line("pairs", grouped(pairs.adjacent) + " adjacent" +
                        (a.srdf ? ", " + grouped(pairs.bySrdf) + " by the SRDF" : "") + ", " +
                        grouped(pairs.proved.size()) + " proved never in contact, " +
                        grouped(pairs.nearlyAlways.size()) +
                        " in contact in nearly all random states, " + grouped(pairs.tested.size()) +
                        " others");
  if (!pairs.nearlyAlways.empty() && a.allowOverlaps)
    out.line("allowed", counted(pairs.nearlyAlways.size(), "pair") + " in contact in nearly all " +
                            "random states: see allow in the file");
  else if (!pairs.nearlyAlways.empty())
    out.line("decide",
             "the pairs that are marked DECIDE in the file, or run this with --allow-overlaps; "
             "until then hardly any state is valid",
             Tone::bad);
  if (!pairs.contradicted.empty())
    out.line("check",
             counted(pairs.contradicted.size(), "pair") +
                 " of the SRDF that touched in some random states only: marked CHECK in the file",
             Tone::bad);
  return kDone;
}

}  // namespace corridor::app
