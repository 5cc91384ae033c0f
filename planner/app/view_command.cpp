#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iostream>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/interrupt.h"
#include "planner/app/output.h"
#include "planner/problem/problem.h"
#include "planner/solve/whole_file.h"
#include "planner/view/browser_picture.h"
#include "planner/view/view_page.h"

namespace corridor::app {
namespace {

/// Returns "bookshelf_1.html", safe as a file's name: a problem's name may have any characters.
std::string pageName(const Problem& problem) {
  std::string name = problem.source.name;
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-' && c != '_' && c != '.') c = '_';
  return (name.empty() || name[0] == '.' ? "view" + name : name) + ".html";
}

/// Refuses a file whose extension names another format. A name without an extension is accepted.
/// @throws InputError
void requireExtension(const std::optional<std::string>& file, const char* option,
                      const std::string& kind, const std::vector<std::string>& extensions) {
  if (!file) return;
  std::string extension = std::filesystem::path(*file).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (!extension.empty() &&
      std::find(extensions.begin(), extensions.end(), extension) == extensions.end())
    throw InputError(Fault{option, 0,
                           kind + ": a name that ends in " + extensions.front() +
                               " is needed, not " + quotedWord(*file)});
}

}  // namespace

int viewCommand(const ViewArguments& a) {
  requireFolderFor(a.output, "--output");
  requireFolderFor(a.image, "--image");
  requireExtension(a.output, "--output", "pages are HTML", {".html", ".htm"});
  requireExtension(a.image, "--image", "pictures are PNG", {".png"});
  if (a.size && !a.image) throw InputError(Fault{"--size", 0, "needs --image, which is not given"});
  const PictureSize size = a.size ? pictureSize(*a.size, "--size") : PictureSize();
  const std::optional<std::filesystem::path> browser =
      a.image ? std::optional(requireBrowser("--image")) : std::nullopt;

  const Problem problem = readProblemOf(a.problem);
  std::optional<std::string> pageFile = a.output;
  if (!a.output && !a.image) {
    pageFile = pageName(problem);
    requireFolderFor(pageFile, "--output");
  }
  for (const auto& [file, option] : {std::pair(pageFile, "--output"), {a.image, "--image"}}) {
    requireNotRead(file, option, problem.source.files, "the problem");
    if (a.solution) requireNotRead(file, option, {*a.solution}, "the solution");
  }
  std::optional<ViewedPath> path;
  if (a.solution) {
    path.emplace();
    path->solution = readSolution(*a.solution, problem.model.space);
    path->report = verifyAloud(problem, path->solution, a.problem, *a.solution, a.ignoreDigest);
  }
  const std::string page = viewPage(problem, path);
  const Lines out(a.quiet);
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
    // A second signal is ignored: on the first, the browser and its folder are removed in a moment.
    const std::atomic<bool>& interrupted = listenForInterrupts(SecondInterrupt::isIgnored);
    if (!writePicture(page, *browser, size, *a.image, interrupted)) return interruptedStatus();
    out.line("image", *a.image);
  }
  return kDone;
}

}  // namespace corridor::app
