#include "planner/app/problem_list.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <set>
#include <system_error>

#include "collision/core/error.h"
#include "collision/core/fault_list.h"
#include "planner/import/mbm_json.h"
#include "planner/import/set_range.h"

namespace corridor::app {
namespace {

namespace fs = std::filesystem;

/// Adds the problems of a range of a set, `SET.json#A-B`. @param range as `problemsOf` returns it.
void addRange(const std::string& argument, const std::vector<std::string>& range,
              std::vector<std::string>& files) {
  const std::string set = range.front().substr(0, range.front().rfind('#') + 1);
  const std::vector<std::string> indices = mbmIndices(set.substr(0, set.size() - 1));
  const auto isIn = [&](const std::string& problem) {
    return std::find(indices.begin(), indices.end(), problem.substr(set.size())) != indices.end();
  };
  for (const std::string& end : {range.front(), range.back()})
    if (!isIn(end))
      throw InputError(Fault{argument, 0,
                             "the set has no problem #" + end.substr(set.size()) +
                                 (indices.empty() ? ""
                                                  : "; its indices are from " + indices.front() +
                                                        " to " + indices.back())});
  std::copy_if(range.begin(), range.end(), std::back_inserter(files), isIn);
}

/// Returns the folders in a folder that have a problem.yaml, sorted.
std::vector<std::string> problemsIn(const fs::path& folder) {
  std::vector<std::string> files;
  std::error_code none;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, none))
    if (fs::is_regular_file(entry.path() / "problem.yaml", none))
      files.push_back(entry.path().string());
  std::sort(files.begin(), files.end());
  return files;
}

/// Returns a short name of a problem: the name of the folder that has the problem.yaml ("piano"),
/// or the file's name without extension ("set-3"). With `parent`, the name of the folder above
/// comes first.
std::string shortNameOf(const std::string& file, bool parent) {
  std::string path = file, index;
  if (const auto hash = file.rfind(".json#"); hash != std::string::npos) {
    path = file.substr(0, hash + 5);
    index = "-" + file.substr(hash + 6);
  }
  fs::path named = fs::absolute(path).lexically_normal();
  if (!named.has_filename()) named = named.parent_path();  // "problems/piano/"
  if (named.filename() == "problem.yaml") named = named.parent_path();
  const std::string extension = named.extension().string();
  const bool isFile = extension == ".yaml" || extension == ".json" || extension == ".cfg";
  const std::string own = (isFile ? named.stem() : named.filename()).string() + index;
  const std::string folder = named.parent_path().filename().string();
  return parent && !folder.empty() ? folder + "-" + own : own;
}

/// Returns the files, each with a name of its own. If the names of two files are equal, the name of
/// the folder is added; if they are still equal, a number is added.
std::vector<ListedProblem> named(const std::vector<std::string>& files) {
  std::map<std::string, std::set<std::string>> uses;  // the files of each name
  for (const std::string& file : files) uses[shortNameOf(file, false)].insert(file);
  std::vector<ListedProblem> problems;
  std::set<std::string> taken;
  for (const std::string& file : files) {
    const std::string own = shortNameOf(file, false),
                      name = uses[own].size() > 1 ? shortNameOf(file, true) : own;
    std::string unique = name;
    for (int n = 2; !taken.insert(unique).second; ++n) unique = name + "-" + std::to_string(n);
    problems.push_back({file, unique});
  }
  return problems;
}

}  // namespace

ProblemList listProblems(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  bool several = arguments.size() > 1;
  std::error_code none;
  FaultList faults;
  for (const std::string& argument : arguments) {
    std::vector<std::string> range{argument};
    faults.collect([&] { range = problemsOf(argument); });
    if (range.front() != argument) {
      several = true;
      faults.collect([&] { addRange(argument, range, files); });
      continue;
    }
    std::vector<std::string> inside;
    if (fs::is_directory(argument, none) && !fs::exists(fs::path(argument) / "problem.yaml", none))
      inside = problemsIn(argument);
    several = several || !inside.empty();
    if (inside.empty()) inside.push_back(argument);
    files.insert(files.end(), inside.begin(), inside.end());
  }
  faults.throwIfAny();
  return {named(files), several};
}

}  // namespace corridor::app
