#include <chrono>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "collision/core/fault_list.h"
#include "collision/core/file_cache.h"
#include "collision/core/read_file.h"
#include "planner/app/commands.h"
#include "planner/app/fill_cache.h"
#include "planner/app/output.h"
#include "planner/app/problem_list.h"
#include "planner/app/robot_argument.h"
#include "planner/model/model_builder.h"
#include "planner/problem/assembly.h"
#include "planner/problem/problem.h"
#include "planner/problem/robot_file.h"
#include "planner/problem/user_cache.h"

namespace corridor::app {
namespace {

/// Returns the model of a robot or a problem, with the cache.
Model modelOf(const std::string& file, const std::shared_ptr<FileCache>& cache) {
  const std::string inFolder = robotInFolder(file);
  const InputKind kind = inFolder.empty() ? inputKindOf(file) : InputKind::robot;
  if (kind == InputKind::mesh && whyNotOrdinaryFile(file).empty())
    throw InputError(Fault{file, 0, "is neither a robot nor a problem; name one that uses it"});
  if (kind != InputKind::robot) return readProblemOf(file, cache).model;
  ModelBuilder builder;
  Source ignored;
  addRobots({readRobotAlone(inFolder.empty() ? file : inFolder, RobotUse::describe, cache.get())},
            builder, ignored);
  Model model = builder.buildForReader();
  model.cache = cache;
  return model;
}

/// Returns a size with its unit: "12 kB".
std::string sizeText(std::uint64_t bytes) {
  const auto size = static_cast<double>(bytes);
  return bytes < 1'000           ? counted(bytes, "byte")
         : bytes < 1'000'000     ? rounded(size / 1e3) + " kB"
         : bytes < 1'000'000'000 ? rounded(size / 1e6) + " MB"
                                 : rounded(size / 1e9) + " GB";
}

void show() {
  const auto cache = requireCache();
  const FileCache::Size size = cache->size();
  requireNoNotes(*cache);
  const ResultPrinter out(false);
  out.line("folder", cache->folder().string());
  out.line("files", grouped(size.files));
  out.line("size", sizeText(size.bytes) + " of at most " + sizeText(cache->mostBytes()));
}

void build(const std::vector<std::string>& files) {
  const auto cache = requireCache();
  const ResultPrinter out(false);
  FaultList faults;
  for (const ListedProblem& each : listProblems(files).problems)
    faults.collect([&] {
      const auto start = std::chrono::steady_clock::now();
      const std::uint64_t before = cache->counts().written;
      fillCache(modelOf(each.file, cache));
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
      const std::uint64_t added = cache->counts().written - before;
      out.line(each.file,
               added == 0 ? "nothing to add"
                          : counted(added, "file") + " added in " + rounded(took.count()) + " s");
      std::cout.flush();
    });
  printCacheNotes(cache->takeNotes());
  faults.throwIfAny();
}

void clear() {
  const auto cache = requireCache();
  std::cout << counted(cache->clear(), "file") << " removed\n";
  requireNoNotes(*cache);
}

}  // namespace

void addCache(CLI::App& program, int& status) {
  CLI::App* const command = program.add_subcommand(
      "cache", "Show, fill or empty the cache: a folder with results on large meshes");
  command->footer(
      "The folder is $CORRIDOR_CACHE, $XDG_CACHE_HOME/corridor or ~/.cache/corridor.\n"
      "CORRIDOR_CACHE=off turns the cache off. `solve` reads it, and adds to it after its answer.\n"
      "planner/README.md says more.");
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* const builder = command->add_subcommand(
      "build", "Compute now what later commands need of the large meshes of robots and problems");
  builder
      ->add_option("ROBOT|PROBLEM", *files,
                   "URDFs, robot.yaml files or a robot's folder; or problems as for solve")
      ->required();
  builder->callback([files, &status] {
    build(*files);
    status = kDone;
  });
  command->add_subcommand("clear", "Remove all files of the cache")->callback([&status] {
    clear();
    status = kDone;
  });
  command->callback([command, &status] {
    if (!command->get_subcommands().empty()) return;
    show();
    status = kDone;
  });
}

}  // namespace corridor::app
