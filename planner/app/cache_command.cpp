#include <filesystem>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "collision/core/error.h"
#include "collision/core/file_cache.h"
#include "collision/core/spelling.h"
#include "planner/app/commands.h"
#include "planner/app/fill_cache.h"
#include "planner/app/output.h"
#include "planner/app/robot_argument.h"
#include "planner/model/model_builder.h"
#include "planner/problem/assembly.h"
#include "planner/problem/problem.h"
#include "planner/problem/robot_file.h"
#include "planner/problem/user_cache.h"
#include "planner/robot/urdf_file.h"

namespace corridor::app {
namespace {

/// Returns the model of a robot or a problem, with the cache.
Model modelOf(const std::string& file, const std::shared_ptr<FileCache>& cache) {
  const std::string inFolder = robotInFolder(file);
  const std::string extension = lowered(std::filesystem::path(file).extension().string());
  const bool isYaml = extension == ".yaml" || extension == ".yml";
  if (inFolder.empty() && !(isYaml ? isRobotFile(file) : isUrdf(file)))
    return readProblemOf(file, cache).model;
  ModelBuilder builder;
  Source ignored;
  addRobots({readRobotAlone(inFolder.empty() ? file : inFolder, RobotUse::describe, cache.get())},
            builder, ignored);
  Model model = builder.buildForReader();
  model.cache = cache;
  return model;
}

std::string megabytes(std::uint64_t bytes) {
  return rounded(static_cast<double>(bytes) / 1e6) + " MB";
}

void show() {
  const auto cache = requireCache();
  const FileCache::Size size = cache->size();
  const ResultPrinter out(false);
  out.line("folder", cache->folder().string());
  out.line("files", grouped(size.files));
  out.line("size", megabytes(size.bytes) + " of at most " + megabytes(cache->mostBytes()));
}

void build(const std::vector<std::string>& files) {
  const auto cache = requireCache();
  for (const std::string& file : files) fillCache(modelOf(file, cache));
  if (const std::string why = cache->complaint(); !why.empty())
    throw InputError(Fault{"CORRIDOR_CACHE", 0, why});
  const FileCache::Counts counts = cache->counts();
  std::cout << grouped(counts.found) << (counts.found == 1 ? " result was" : " results were")
            << " in the cache, " << grouped(counts.written)
            << (counts.written == 1 ? " was" : " were") << " added\n";
}

}  // namespace

void addCache(CLI::App& program, int& status) {
  CLI::App* const command =
      program.add_subcommand("cache", "show, fill or empty the cache of meshes, trees and hulls");
  command->footer(
      "The cache is a folder of the user: $CORRIDOR_CACHE, $XDG_CACHE_HOME/corridor, or\n"
      "~/.cache/corridor. CORRIDOR_CACHE=off turns it off. `solve` fills it after its answer.");
  auto files = std::make_shared<std::vector<std::string>>();
  CLI::App* const builder = command->add_subcommand(
      "build", "compute now what later commands need of the large meshes of robots and problems");
  builder->add_option("FILE", *files, "a robot or a problem")->required();
  builder->callback([files, &status] {
    build(*files);
    status = kDone;
  });
  command->add_subcommand("clear", "remove all files of the cache")->callback([&status] {
    std::cout << counted(requireCache()->clear(), "file") << " removed\n";
    status = kDone;
  });
  command->callback([command, &status] {
    if (!command->get_subcommands().empty()) return;
    show();
    status = kDone;
  });
}

}  // namespace corridor::app
