#include "planner/app/problem_list.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <system_error>

#include "collision/core/error.h"
#include "planner/problem/mbm_json.h"

namespace corridor::app {
namespace {

namespace fs = std::filesystem;

struct Range {
  std::string file;
  std::uint64_t first = 0, last = 0;
};

/// Returns the range of `SET.json#A-B`, or nullopt for another argument.
std::optional<Range> rangeIn(const std::string& argument) {
  const auto hash = argument.rfind(".json#");
  if (hash == std::string::npos) return std::nullopt;
  Range range{argument.substr(0, hash + 5)};
  const char* const end = argument.data() + argument.size();
  const auto [dash, error] = std::from_chars(argument.data() + hash + 6, end, range.first);
  if (error != std::errc{} || dash == end || *dash != '-') return std::nullopt;
  const auto [stop, wrong] = std::from_chars(dash + 1, end, range.last);
  if (wrong != std::errc{} || stop != end) return std::nullopt;
  return range;
}

void addRange(const Range& range, const std::string& argument, std::vector<std::string>& files) {
  if (range.last < range.first)
    throw InputError(Fault{argument, 0, "the range is empty: its end is below its beginning"});
  std::set<std::uint64_t> indices;
  for (const std::string& text : mbmIndices(range.file)) {
    std::uint64_t index = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), index);
    if (error == std::errc{} && stop == text.data() + text.size()) indices.insert(index);
  }
  for (const std::uint64_t end : {range.first, range.last})
    if (!indices.contains(end))
      throw InputError(Fault{
          argument, 0,
          "the set has no problem #" + std::to_string(end) +
              (indices.empty() ? ""
                               : "; its indices are from " + std::to_string(*indices.begin()) +
                                     " to " + std::to_string(*indices.rbegin()))});
  for (auto i = indices.find(range.first); i != indices.end() && *i <= range.last; ++i)
    files.push_back(range.file + "#" + std::to_string(*i));
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

/// Returns the name of a problem without its folder: "set-3", "piano". With `parent`, the name of
/// that folder comes first.
std::string nameOf(const std::string& file, bool parent) {
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

/// Returns the files with names that differ: where two are alike, the name of the folder is added,
/// and then a number.
std::vector<ListedProblem> named(const std::vector<std::string>& files) {
  std::map<std::string, int> uses;
  for (const std::string& file : files) ++uses[nameOf(file, false)];
  std::vector<ListedProblem> problems;
  std::set<std::string> taken;
  for (const std::string& file : files) {
    const std::string own = nameOf(file, false), name = uses[own] > 1 ? nameOf(file, true) : own;
    std::string unique = name;
    for (int n = 2; !taken.insert(unique).second; ++n) unique = name + "-" + std::to_string(n);
    problems.push_back({file, unique});
  }
  return problems;
}

}  // namespace

std::vector<ListedProblem> listProblems(const std::vector<std::string>& arguments) {
  std::vector<std::string> files;
  std::error_code none;
  for (const std::string& argument : arguments) {
    if (const auto range = rangeIn(argument)) {
      addRange(*range, argument, files);
      continue;
    }
    std::vector<std::string> inside;
    if (fs::is_directory(argument, none) && !fs::exists(fs::path(argument) / "problem.yaml", none))
      inside = problemsIn(argument);
    if (inside.empty()) inside.push_back(argument);
    files.insert(files.end(), inside.begin(), inside.end());
  }
  return named(files);
}

}  // namespace corridor::app
