#include "planner/problem/digest.h"

#include <algorithm>

#include "collision/core/read_file.h"
#include "planner/problem/sha256.h"

namespace corridor {

namespace {

/// Returns the texts that were read instead of a file. A xacro file has one text for each different
/// set of arguments, in the order of the robots. For any other file, the result is empty.
std::vector<const std::string*> expandedTexts(const Problem& problem,
                                              const std::filesystem::path& file) {
  std::vector<const std::string*> texts;
  for (const ModelRobot& robot : problem.model.robots) {
    const auto found = robot.description.expanded.find(file);
    if (found == robot.description.expanded.end()) continue;
    const auto isSame = [&](const std::string* text) { return *text == found->second; };
    if (std::none_of(texts.begin(), texts.end(), isSame)) texts.push_back(&found->second);
  }
  return texts;
}

}  // namespace

std::string digestOf(const Problem& problem) {
  std::string digests;
  const auto add = [&](const std::string& text) {
    for (const std::uint8_t byte : sha256(text)) digests += static_cast<char>(byte);
  };
  for (const std::filesystem::path& file : problem.source.files) {
    const std::vector<const std::string*> texts = expandedTexts(problem, file);
    for (const std::string* text : texts) add(*text);
    if (texts.empty()) add(readFile(file, "an input"));
  }
  return sha256Hex(digests);
}

}  // namespace corridor
