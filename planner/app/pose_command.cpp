#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "collision/core/fault_list.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/model/model_builder.h"
#include "planner/model/planned_joints.h"
#include "planner/problem/hold_yaml.h"
#include "planner/problem/robot_file.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

struct PoseArguments {
  std::string file;
  std::optional<std::string> state;
  std::vector<std::string> links;
  bool json = false;
};

/// Holds the robot's joints at the values of the option --state: a named state, or joint values.
/// @throws InputError with all faults, without a file's name and line.
void applyState(const std::string& state, RobotSetup& setup) {
  const bool isName = state.find(':') == state.npos && state.find('{') == state.npos;
  const bool isMap = state.starts_with('{');
  FaultList faults("--state");
  try {
    const YamlValue document =
        parseYaml("--state", "hold: " + (isName || isMap ? state : "{" + state + "}"));
    YamlSource source{"--state", faults, {}};
    const YamlMap map(document, "", nullptr, source);
    setup.robot.heldByFile.clear();
    if (const auto name = readHold(map, setup)) holdState(*name, {}, {source, "hold", 0}, setup);
    faults.throwIfAny();
  } catch (const InputError& error) {
    std::vector<Fault> own;
    for (Fault fault : error.faults()) {
      for (const std::string_view path : {"hold.", "hold: "})
        if (fault.text.starts_with(path)) fault.text.erase(0, path.size());
      own.push_back({fault.file, 0, fault.text});
    }
    throw InputError(std::move(own));
  }
}

int poseCommand(const PoseArguments& a) {
  std::filesystem::path file = a.file;
  if (std::filesystem::is_directory(file)) file /= "robot.yaml";
  RobotSetup setup = readRobotAlone(file, RobotUse::describe);
  if (setup.robot.isRigid())
    throw InputError(Fault{a.file, 0, "is a rigid robot; only a robot with joints has links"});
  if (a.state) applyState(*a.state, setup);
  // All joints are held, so the configuration has no numbers.
  chooseJoints(setup.robot, {});
  const Model model = ModelBuilder().addRobot(std::move(setup.robot)).buildForReader();
  const ModelRobot& robot = model.robots.front();
  const std::vector<Transform> X_WF = framePoses(model.tree, Configuration());

  std::vector<std::string> names;
  for (const LinkModel& link : robot.description.links) names.push_back(link.name);
  for (const std::string& link : a.links)
    if (std::find(names.begin(), names.end(), link) == names.end())
      throw InputError(Fault{
          "--link", 0,
          "there is no link " + quotedWord(link) + didYouMean(link, names) + knownWords(names)});
  ordered_json links = ordered_json::array();
  const ResultPrinter out(a.json);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!a.links.empty() && std::find(a.links.begin(), a.links.end(), names[i]) == a.links.end())
      continue;
    const Transform& X = X_WF[robot.linkFrames[i]];
    const Eigen::Quaterniond q(X.m);
    links.push_back({{"name", names[i]},
                     {"position", numbersJson(X.t)},
                     {"quat_xyzw", std::vector<double>{q.x(), q.y(), q.z(), q.w()}}});
    out.line("link", quotedWord(names[i]) + ": at " + rounded(X.t) + ", rpy_deg " +
                         rounded(rpyDegrees(X.m)));
  }
  ordered_json joints = ordered_json::object();
  for (const auto& [j, value] : robot.held) joints[robot.description.joints[j].name] = value;
  if (a.json)
    std::cout << jsonText(
                     ordered_json{{"format", "corridor-pose-1"},
                                  {"file", a.file},
                                  {"root", robot.description.links[robot.description.root].name},
                                  {"joints", joints},
                                  {"links", links}})
              << '\n';
  return kDone;
}

}  // namespace

void addPose(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<PoseArguments>();  // the callback keeps it
  PoseArguments& a = *arguments;
  CLI::App* command = program.add_subcommand("pose", "Print the poses of a robot's links");
  command->add_option("ROBOT", a.file, "a robot.yaml, a folder that contains one, or a URDF")
      ->required();
  command->add_option("--state", a.state,
                      "a named state, or joint values such as \"pan: 0.3, lift_deg: 20\"; joints "
                      "without a value are where the robot's file holds them, or else at 0 or at "
                      "the limit nearest to 0");
  command->add_option("--link", a.links, "print only this link; may be repeated")
      ->allow_extra_args(false);
  addJson(*command, a.json);
  command->footer(std::string("Example: corridor pose robots/arm7 --state ready --link hand\n"
                              "Poses are those of the links' frames, seen from the root link: "
                              "metres; roll, pitch and yaw in degrees.\n") +
                  kExitStatus);
  command->callback([arguments, &status] { status = poseCommand(*arguments); });
}

}  // namespace corridor::app
