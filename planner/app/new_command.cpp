#include <algorithm>
#include <cctype>
#include <iostream>
#include <limits>
#include <memory>
#include <sstream>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "collision/core/whole_file.h"
#include "planner/app/commands.h"
#include "planner/app/new_file.h"
#include "planner/app/options.h"
#include "planner/app/output.h"

namespace corridor::app {

namespace fs = std::filesystem;

void requireNewFile(const NewFileArguments& file) {
  if (file.toStdout()) return;
  requireWritable(file.output, "--output");
  std::error_code none;
  if (!file.force && fs::is_regular_file(*file.output, none))
    throw InputError(Fault{"--output", 0,
                           *file.output + " exists; name another file, or replace it by --force"});
}

void writeNewFile(const NewFileArguments& file, const std::string& text) {
  if (file.toStdout())
    std::cout << text;
  else
    writeWhole(*file.output, text);
}

std::string pathFrom(const NewFileArguments& file, const fs::path& path) {
  // If the output is a symbolic link, the new file replaces the link, not the file that the link
  // names. So only the folder is resolved.
  const fs::path folder = file.toStdout()
                              ? fs::current_path()
                              : fs::weakly_canonical(fs::absolute(*file.output).parent_path());
  const fs::path target = fs::weakly_canonical(path);
  const fs::path relative = target.lexically_relative(folder);
  return relative.empty() ? target.string() : relative.string();
}

std::string yamlList(const std::vector<std::string>& words) {
  std::string text = "[";
  for (const std::string& word : words) text += (text.size() > 1 ? ", " : "") + yamlWord(word);
  return text + "]";
}

std::string comment(const std::string& text, int indent) {
  constexpr std::size_t width = 100;
  const std::string margin = std::string(static_cast<std::size_t>(indent), ' ') + "# ";
  std::string begin = margin, line = margin, all;
  bool isFirst = true, hangs = false;
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (isFirst) hangs = word == "-" || word.ends_with(':');
    if (!isFirst && line.size() > begin.size() && line.size() + 1 + word.size() > width) {
      all += line + "\n";
      begin = margin + (hangs ? "  " : "");
      line = begin;
    }
    line += (line.size() > begin.size() ? " " : "") + word;
    isFirst = false;
  }
  return all + line + "\n";
}

namespace {

void addFileOptions(CLI::App& command, NewFileArguments& file) {
  command.add_option("-o,--output", file.output,
                     "write to this file (-: standard output, as without this option)");
  command.add_flag("--force", file.force, "replace the file if it exists");
}

/// Adds a choice of two words. The first is the default.
void addChoice(CLI::App& command, const char* option, std::optional<std::string>& value,
               const std::vector<std::string>& words, const char* help) {
  command.add_option(option, value, help)->check(CLI::IsMember(words));
}

CLI::Validator isLength() {
  return isWithin(0.0, 1e6, "a number from 0 to 1000000");
}

void addNewRobot(CLI::App& parent, int& status) {
  const auto arguments = std::make_shared<NewRobotArguments>();  // the callback keeps it
  NewRobotArguments& a = *arguments;
  CLI::App* command =
      parent.add_subcommand("robot", "Write a robot file: joints, groups, states, pairs of links");
  command->add_option("URDF", a.urdf, "the robot's URDF")->required();
  command->add_option("--srdf", a.srdf,
                      "its SRDF: groups, named states, and pairs of links that may touch");
  addFileOptions(*command, a.file);
  const char* reading = "How the URDF is read (the file gets a key for each of these options)";
  command
      ->add_option("--package", a.packages,
                   "NAME=FOLDER: the folder of package://NAME/…; may be repeated")
      ->allow_extra_args(false)
      ->group(reading);
  addChoice(*command, "--visuals", a.visuals, {"ignore", "collide"},
            "collide: a link without <collision> gets the shapes of its <visual>");
  addChoice(*command, "--limits", a.limits, {"hard", "soft"},
            "soft: the limits of <safety_controller> narrow those of <limit>");
  addChoice(*command, "--collada-up", a.colladaUp, {"ignore", "file"},
            "file: the up-axis of Collada files is applied");
  for (const char* option : {"--visuals", "--limits", "--collada-up"})
    command->get_option(option)->group(reading);
  command
      ->add_option("--joints", a.joints,
                   "NAME,NAME,…: the joints that are planned for, the others are held (default: "
                   "the SRDF's only group, or else all that can move)")
      ->delimiter(',');
  const char* pairs = "Pairs of links";
  command
      ->add_flag("--allow-overlaps", a.allowOverlaps,
                 "allow the pairs that are in contact in nearly all random states, as links do "
                 "whose shapes overlap by design (default: they are listed for you to decide)")
      ->group(pairs);
  command
      ->add_option(
          "--work", a.work,
          "how many boxes of joint values the proofs of all pairs may take together, where "
          "100 tests of volumes and triangles count as one more box (default 250000: "
          "some seconds; 0: prove nothing)")
      ->check(isWithin<std::uint64_t>(0, 1'000'000'000, "a whole number from 0 to 1000000000"))
      ->group(pairs);
  command
      ->add_option("--margin", a.margin,
                   "a pair counts as never in contact if it always keeps this distance, in metres: "
                   "use the largest margin of your problems (default 0.01)")
      ->check(isLength())
      ->group(pairs);
  command
      ->add_option("--beyond-limits", a.beyondLimits,
                   "a proof also covers joint values beyond a limit, up to this far (rad or m): "
                   "use the largest tube of your problems (default 0.01)")
      ->check(isLength())
      ->group(pairs);
  command
      ->add_option("--samples", a.samples,
                   "how many random states are tested for contacts (default 1000)")
      ->check(isWithin<std::uint64_t>(0, 1'000'000'000, "a whole number from 0 to 1000000000"))
      ->group(pairs);
  command->add_option("--seed", a.seed, "of the random states (default 1)")
      ->check(isSeed())
      ->group(pairs);
  command->footer(
      std::string("Example: corridor new robot mine.urdf --srdf mine.srdf -o robot.yaml\n"
                  "Pairs that are proved never in contact are written under never_in_contact. "
                  "Pairs that are in contact in at least 95 % of the random states are written as "
                  "comments, for you to decide. All other pairs are tested.\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = newRobot(*arguments); });
}

void addNewProblem(CLI::App& parent, int& status) {
  const auto arguments = std::make_shared<NewProblemArguments>();  // the callback keeps it
  NewProblemArguments& a = *arguments;
  CLI::App* command =
      parent.add_subcommand("problem", "Write a problem file: robot, start, goal, common keys");
  command->add_option("ROBOT", a.robot, "a robot.yaml, a folder that contains one, or a URDF")
      ->required();
  addFileOptions(*command, a.file);
  command
      ->add_option("--seed", a.seed,
                   "of the random states, which are tried if the robot has no two named states "
                   "that are valid (default 1)")
      ->check(isSeed());
  command->footer(std::string("Example: corridor new problem robot.yaml -o problem.yaml\n"
                              "Exit status 1: no valid start and goal were found; the file is "
                              "written, and a comment in it says so.\n") +
                  kExitStatus);
  command->callback([arguments, &status] { status = newProblem(*arguments); });
}

}  // namespace

void addNew(CLI::App& program, int& status) {
  CLI::App* command =
      program.add_subcommand("new", "Write a commented robot or problem file to start from");
  command->require_subcommand(1);
  addNewRobot(*command, status);
  addNewProblem(*command, status);
  command->footer(std::string("Example: corridor new robot mine.urdf -o robot.yaml\n"
                              "         corridor new problem robot.yaml -o problem.yaml\n"
                              "corridor new KIND --help lists the options.\n") +
                  kExitStatus);
}

}  // namespace corridor::app
