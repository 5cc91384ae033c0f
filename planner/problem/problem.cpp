#include "planner/problem/problem.h"

#include <system_error>

#include "collision/core/fault_list.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/import/mbm_json.h"
#include "planner/import/omplapp_cfg.h"
#include "planner/problem/problem_yaml.h"
#include "planner/robot/urdf_file.h"

namespace corridor {

namespace {

Problem read(const std::filesystem::path& path, FileCache* cache) {
  const std::string text = path.string();
  if (const auto hash = text.rfind(".json#"); hash != text.npos)
    return readMbmProblem(text.substr(0, hash + 5), text.substr(hash + 6), cache);
  if (path.extension() == ".json") return readMbmProblem(path, "", cache);
  std::error_code none;  // ignored: the reader reports a file that can't be accessed
  if (std::filesystem::is_regular_file(path, none) && isUrdf(path))
    throw InputError(
        Fault{path.string(), 0,
              "this is a robot, not a problem; `corridor new problem` writes a problem "
              "for it"});
  if (!std::filesystem::is_directory(path, none))
    return path.extension() == ".cfg" ? readOmplAppCfg(path) : readProblemYaml(path, cache);
  const std::filesystem::path file = path / "problem.yaml";
  if (std::error_code failure; !std::filesystem::exists(file, failure))
    throw InputError(Fault{path.string(), 0,
                           failure ? "this folder can't be read: " + failure.message()
                                   : "no problem.yaml in this folder"});
  return readProblemYaml(file, cache);
}

}  // namespace

Problem readProblem(const std::filesystem::path& path, std::shared_ptr<FileCache> cache) {
  Problem problem = read(path, cache.get());
  problem.model.cache = std::move(cache);
  return problem;
}

Fault Source::faultAt(std::string_view key, std::string text) const {
  for (std::string_view around = key;; around = around.substr(0, around.rfind('.'))) {
    const auto found = lines.find(std::string(around));
    if (found != lines.end()) return {file.string(), found->second, std::move(text)};
    if (around.find('.') == around.npos) return {file.string(), 0, std::move(text)};
  }
}

}  // namespace corridor
