#include <algorithm>
#include <atomic>
#include <cctype>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/problem/problem.h"
#include "planner/solve/whole_file.h"
#include "planner/view/browser_picture.h"
#include "planner/view/view_page.h"

namespace corridor::app {
namespace {

struct ViewArguments {
  std::string problem;
  std::optional<std::string> solution;
  std::optional<std::string> output, image, size, from;
  bool ignoreDigest = false;  ///< as in `VerifyArguments`
  bool quiet = false;
};

/// Returns "bookshelf_1.html", safe as a file's name: a problem's name may have any characters.
std::string pageName(const Problem& problem) {
  std::string name = problem.source.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.') c = '_';
  return (name.empty() || name[0] == '.' ? "view" + name : name) + ".html";
}

/// Refuses a file name whose extension stands for another format. Accepts one without extension.
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

int viewCommand(const ViewArguments& a) {
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

  const Problem problem = readProblemOf(a.problem);
  std::optional<std::string> pageFile = a.output;
  if (!a.output && !a.image) {
    pageFile = pageName(problem);
    requireWritable(pageFile, "--output");
  }
  for (const auto& [file, option] : {std::pair(pageFile, "--output"), {a.image, "--image"}}) {
    requireNotAnInput(file, option, problem.source.files, "the problem");
    if (a.solution) requireNotAnInput(file, option, {*a.solution}, "the solution");
  }
  std::optional<ViewedPath> path;
  if (a.solution) {
    path.emplace();
    path->solution = readSolution(*a.solution, problem.model.space);
    path->report =
        verifyWithWarning(problem, path->solution, a.problem, *a.solution, a.ignoreDigest).report;
  }
  const std::string page = viewPage(problem, path, from);
  const ResultPrinter out(a.quiet);
  out.line("problem", a.problem);
  if (path) {
    out.line("verdict", verdictName(path->report),
             path->report.verdict == PathVerdict::proved ? Tone::good : Tone::bad);
  }
  if (pageFile) {
    writeWhole(*pageFile, page);
    out.line("page", *pageFile);
  }
  if (a.image) {
    // A second signal is ignored: after the first, the browser ends and its folder is removed soon.
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
      "view", "Show a problem and a path in 3D, as a page for any browser or as a picture");
  command->add_option("PROBLEM", a.problem, "the problem, as for solve")->required();
  command->add_option("SOLUTION", a.solution,
                      "a solution file, or an OMPL.app .path file; without it, only start and goal "
                      "are shown");
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
  addQuiet(*command, a.quiet, results);
  command->footer(
      std::string(
          "Example: corridor solve problems/two_arms -o arms.yaml && corridor view "
          "problems/two_arms arms.yaml -o arms.html\n"
          "The page plays the path. It can show the OBB trees, the closest pair of bodies with its "
          "distance along the path, the pairs that are never tested and why, and the contact where "
          "`corridor verify` refutes the path. The path is verified again for the page; the "
          "verdict does not change the exit status.\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = viewCommand(*arguments); });
}

}  // namespace corridor::app
