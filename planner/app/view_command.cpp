#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "collision/core/whole_file.h"
#include "collision/geometry/mesh_file.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/limits_output.h"
#include "planner/app/motion_file.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/app/read_mesh.h"
#include "planner/checker/left_out.h"
#include "planner/problem/problem.h"
#include "planner/view/browser_picture.h"
#include "planner/view/view_page.h"
#include "planner/view/volume_picture.h"

namespace corridor::app {
namespace {

struct ViewArguments {
  std::string problem;
  std::optional<std::string> trajectory;  ///< a file: a trajectory or a solution
  std::optional<std::string> between;     ///< as in `VerifyArguments`
  std::optional<std::string> output, image, size, from;
  std::optional<std::string> volume;   ///< of a mesh: the volumes to draw
  std::optional<std::uint64_t> level;  ///< with `volume` only
  bool ignoreDigest = false;           ///< as in `VerifyArguments`
  bool quiet = false;
};

/// Returns a file name for the page, such as "bookshelf_1.html". In the problem's name, every
/// character except letters, digits, "-", "_" and "." is replaced by "_".
std::string pageName(const Problem& problem) {
  std::string name = problem.source.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.') c = '_';
  return (name.empty() || name[0] == '.' ? "view" + name : name) + ".html";
}

/// Refuses "-", and a file name whose extension stands for another format. Accepts a name without
/// an extension.
/// @throws InputError
void requireExtension(const std::optional<std::string>& file, const char* option,
                      const std::string& kind, const std::vector<std::string>& extensions) {
  if (!file) return;
  if (*file == "-")
    throw InputError(Fault{option, 0, "is not written to the standard output; name a file"});
  const std::string extension = lowered(std::filesystem::path(*file).extension().string());
  if (!extension.empty() &&
      std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    throw InputError(Fault{option, 0,
                           kind + ": a name that ends in " + extensions.front() +
                               " is needed, not " + quotedWord(*file)});
}

/// Draws the bounding volumes of one level of a mesh's tree as an SVG picture. @returns the exit
/// status.
int viewVolumes(const ViewArguments& a) {
  const auto refuseIfGiven = [](const char* option, bool given) {
    if (given)
      throw InputError(Fault{option, 0, "can't be used with --volume, which draws a mesh"});
  };
  refuseIfGiven("TRAJECTORY", a.trajectory.has_value());
  refuseIfGiven("--between", a.between.has_value());
  refuseIfGiven("--ignore-digest", a.ignoreDigest);
  refuseIfGiven("--image", a.image.has_value());
  refuseIfGiven("--size", a.size.has_value());
  requireExtension(a.output, "--output", "pictures of volumes are SVG", {".svg"});
  if (const auto wrong = invalidNameIn({*a.volume, "", ""}))
    throw InputError(Fault{"--" + wrong->key, 0, wrong->text});
  std::optional<ViewDirection> from;
  if (a.from) from = viewDirection(*a.from, "--from");
  const MeshFile mesh = readMeshAndPrintNotes(a.problem);
  const std::uint64_t level = a.level.value_or(3);
  const VolumePicture picture = volumePicture(mesh.mesh, {*a.volume, "", ""}, level, from);
  if (a.level && level >= picture.levels)
    throw InputError(Fault{"--level", 0,
                           "the tree has the levels 0 to " + std::to_string(picture.levels - 1) +
                               ", not " + std::to_string(level)});
  const std::uint64_t shown = std::min<std::uint64_t>(level, picture.levels - 1);
  const std::string file =
      a.output.value_or(std::filesystem::path(a.problem).stem().string() + "_" + *a.volume + "_" +
                        std::to_string(shown) + ".svg");
  requireWritable(file, "--output");
  requireNotAnInput(file, "--output", {a.problem}, "the mesh");
  writeWhole(file, picture.svg);
  const ResultPrinter out(a.quiet);
  out.line("mesh", a.problem);
  out.line("volumes",
           (picture.drawn < picture.volumes ? "the nearest " + grouped(picture.drawn) + " of "
                                            : std::string()) +
               grouped(picture.volumes) + ", on level " + std::to_string(shown) + " of " +
               std::to_string(picture.levels - 1));
  out.line("picture", file);
  return kDone;
}

/// @throws InputError if a mesh is given where a problem is needed.
void refuseMesh(const std::string& file) {
  if (hasMeshExtension(file))
    throw InputError(Fault{file, 0,
                           "is a mesh, and view draws a problem; add --volume NAME to draw the "
                           "bounding volumes of a mesh"});
}

/// Reads a solution or a trajectory, and verifies it as `corridor verify` does. Returns the
/// path or trajectory, and the report of the verifier, for the page.
ViewedPath viewedPath(const Problem& problem, const ViewArguments& a) {
  const MotionFile motion = readMotion(problem, *a.trajectory, a.between);
  ViewedPath path;
  if (motion.solution) {
    path.solution = *motion.solution;
    path.report =
        verifyWithWarning(problem, path.solution, a.problem, *a.trajectory, a.ignoreDigest).report;
    return path;
  }
  const TrajectoryRows& rows = *motion.trajectory;
  path.report = verifyTrajectory(problem, rows, motion.between);
  path.curve = curveOf(rows, problem.model.space, *path.report.between);
  for (const TrajectoryRow& row : rows.rows) path.solution.path.push_back(row.positions);
  path.velocityLimits = problem.task.limits.velocity;
  path.accelerationLimits = problem.task.limits.acceleration;
  if (path.report.limits) path.limitsText = limitsText(problem, *path.report.limits);
  return path;
}

int viewCommand(const ViewArguments& a) {
  if (a.volume) return viewVolumes(a);
  if (a.level) throw InputError(Fault{"--level", 0, "needs --volume, which is not given"});
  requireExtension(a.output, "--output", "pages are HTML", {".html", ".htm"});
  requireExtension(a.image, "--image", "pictures are PNG", {".png"});
  requireWritable(a.output, "--output");
  requireWritable(a.image, "--image");
  if (a.size && !a.image) throw InputError(Fault{"--size", 0, "needs --image, which is not given"});
  std::optional<ViewDirection> from;
  if (a.from) from = viewDirection(*a.from, "--from");
  const PictureSize size = a.size ? pictureSize(*a.size, "--size") : PictureSize();
  const std::optional<std::filesystem::path> browser =
      a.image ? std::optional(requireBrowser("--image")) : std::nullopt;

  refuseMesh(a.problem);
  Problem problem = readProblemOf(a.problem);
  std::optional<std::string> pageFile = a.output;
  if (!a.output && !a.image) {
    pageFile = pageName(problem);
    requireWritable(pageFile, "--output");
  }
  for (const auto& [file, option] : {std::pair(pageFile, "--output"), {a.image, "--image"}}) {
    requireNotAnInput(file, option, problem.source.files, "the problem");
    if (a.trajectory) requireNotAnInput(file, option, {*a.trajectory}, "the path");
  }
  std::optional<ViewedPath> path;
  if (a.trajectory) {
    path = viewedPath(problem, a);
    addAll(path->report.notes, problem.source.notes);
    if (!path->report.times.empty())  // plots show limits, some of which may be assumed
      for (const std::string& note : problem.task.limits.notes)
        problem.source.notes.push_back({note});
  }
  const std::string page = viewPage(problem, path, from);
  const ResultPrinter out(a.quiet);
  out.line("problem", a.problem);
  if (path) {
    const bool isProved = path->report.verdict == PathVerdict::proved;
    out.line(
        "verdict",
        verdictName(path->report) + (isProved ? exceptText(problem.model, leftOutOf(problem)) : ""),
        isProved ? Tone::good : Tone::bad);
  }
  if (pageFile) {
    writeWhole(*pageFile, page);
    out.line("page", *pageFile);
  }
  if (a.image) {
    // A second signal is ignored: soon after the first one, the browser has ended and its folder is
    // removed.
    const std::atomic<bool>& interrupted = listenForInterrupts(SecondInterrupt::isIgnored);
    if (!writePicture(page, *browser, size, *a.image, interrupted)) return interruptedStatus();
    out.line("image", *a.image);
  }
  return kDone;
}

}  // namespace

void addView(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<ViewArguments>();  // the callback keeps it
  ViewArguments& a = *arguments;
  CLI::App* command = program.add_subcommand(
      "view",
      "Show a problem and a path or trajectory in 3D, as a page for any browser or as a picture");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  command->add_option("TRAJECTORY", a.trajectory,
                      "a solution file (-: standard input), rows of joint values (CSV) with or "
                      "without times, a JointTrajectory of ROS or MoveIt (YAML, JSON), or an "
                      "OMPL.app .path file; without it, only start and goal are shown");
  command
      ->add_option("--between", a.between,
                   "what a trajectory does between its rows, as for verify: linear, cubic or "
                   "quintic")
      ->check(isOneOf({"linear", "cubic", "quintic"}));
  addIgnoreDigest(*command, a.ignoreDigest);
  const char* results = "Results";
  command
      ->add_option("-o,--output", a.output,
                   "write the page to this file: HTML that loads no other file (default, unless "
                   "--image is given: the problem's name with .html)")
      ->group(results);
  command
      ->add_option("--image", a.image,
                   "write a PNG to this file, with the scene, poses along the path and the verdict "
                   "of verify; needs Chromium, but no display")
      ->group(results);
  command
      ->add_option("--size", a.size, "size of the image: WIDTHxHEIGHT, pixels (default 1366x768)")
      ->group(results);
  addFrom(*command, a.from, results);
  const char* volumes = "Volumes of a mesh";
  std::vector<std::string> names;
  for (const VolumeKind& kind : volumeKinds()) names.push_back(kind.name);
  command
      ->add_option("--volume", a.volume,
                   "draw the bounding volumes of a mesh's tree as an SVG picture (-o, default: "
                   "MESH_VOLUME_LEVEL.svg); PROBLEM is then a mesh file. One of " +
                       joined(names))
      ->group(volumes);
  command
      ->add_option("--level", a.level,
                   "the level of the tree to draw, with the leaves of the levels above; the root "
                   "is level 0 (default 3)")
      ->check(isWithin<std::uint64_t>(0, 1'000'000, "a whole number from 0 to 1000000"))
      ->group(volumes);
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/two_arms -o arms.yaml && corridor view "
          "problems/two_arms arms.yaml -o arms.html\n"
          "         corridor view robots/piano/piano.obj --volume obb-binary --level 4 -o "
          "boxes.svg\n"
          "The page plays the path, or a trajectory at its true speed, with plots of its joints. "
          "It can show the OBB trees, the closest pair of bodies with its distance along the path, "
          "the pairs that are never tested and why, and the contact where `corridor verify` "
          "refutes the path. The path is verified again for the page; the verdict does not change "
          "the exit status.\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = viewCommand(*arguments); });
}

}  // namespace corridor::app
