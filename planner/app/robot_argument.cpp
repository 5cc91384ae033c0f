#include "planner/app/robot_argument.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/problem/yaml_value.h"
#include "planner/robot/urdf_file.h"

namespace corridor::app {
namespace {

/// Returns whether a file is a `robot.yaml`. @throws InputError if it can't be read as YAML.
bool isRobotFile(const std::string& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;
  const YamlValue document = parseYaml(file, readTextFile(file, "a problem or a robot"));
  return std::any_of(document.entries.begin(), document.entries.end(), [](const auto& entry) {
    return entry.key == "format" && entry.value.text.starts_with("corridor-robot-");
  });
}

}  // namespace

InputKind inputKindOf(const std::string& file) {
  const std::string extension = lowered(std::filesystem::path(file).extension().string());
  if (extension == ".srdf" && whyNotOrdinaryFile(file).empty())
    throw InputError(Fault{file, 0,
                           "is an SRDF, which only adds to a URDF; name the URDF, or a robot.yaml "
                           "with the keys urdf and srdf"});
  const bool yaml = extension == ".yaml" || extension == ".yml";
  if (yaml ? isRobotFile(file) : isUrdf(file)) return InputKind::robot;
  std::error_code none;
  const bool problem = yaml || std::filesystem::is_directory(file, none) || extension == ".cfg" ||
                       file.find(".json") != file.npos;
  return problem ? InputKind::problem : InputKind::mesh;
}

std::string robotInFolder(const std::filesystem::path& folder) {
  std::error_code none;
  if (!std::filesystem::is_directory(folder, none) ||
      std::filesystem::exists(folder / "problem.yaml", none))
    return "";
  if (std::filesystem::exists(folder / "robot.yaml", none)) return folder / "robot.yaml";
  std::vector<std::string> robots;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (lowered(entry.path().extension().string()) == ".urdf")
      robots.push_back(entry.path().string());
  std::sort(robots.begin(), robots.end());
  if (robots.size() == 1) return robots[0];
  throw InputError(Fault{folder.string(), 0,
                         robots.empty() ? "no problem.yaml, robot.yaml or URDF in this folder"
                                        : "no problem.yaml or robot.yaml in this folder, and "
                                          "several URDFs: name one of " +
                                              joined(robots)});
}

}  // namespace corridor::app
