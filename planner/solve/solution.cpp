#include "planner/solve/solution.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <utility>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/core/whole_file.h"
#include "planner/problem/format_key.h"
#include "planner/problem/text_words.h"
#include "planner/problem/yaml_reader.h"
#include "planner/solve/state_rows.h"
#include "planner/trajectory/trajectory_file.h"

namespace corridor {
namespace {

constexpr const char* kFormat = "corridor-solution-1";

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

std::string listed(const std::vector<std::string>& words, const char* separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

double at(const Configuration& q, std::size_t i) {
  return q[static_cast<Eigen::Index>(i)];
}

std::string row(const Configuration& q) {
  std::string text = "[";
  for (const double value : q) text += (text.size() > 1 ? ", " : "") + digits(value);
  return text + "]";
}

std::string quoted(const std::vector<std::string>& names) {
  std::vector<std::string> texts;
  for (const std::string& name : names) texts.push_back(yamlText(name));
  return "[" + listed(texts, ", ") + "]";
}

std::string yamlOf(const Solution& solution) {
  std::ostringstream text;
  const std::string& space = solution.space;
  text << "# A path. Check it: corridor verify PROBLEM SOLUTION\n"
       << "format: " << kFormat << "\n"
       << "problem: " << yamlText(solution.problem) << "\n"
       << "digest: " << solution.digest << "\n"
       << (space.empty() ? "joints: " + quoted(solution.numbers) : "space: " + space) << "\n"
       << "planner: " << solution.planner << "\n"
       << "seed: " << solution.seed << "\n"
       << "certified: " << (solution.certified ? "true" : "false") << "\n"
       << "checker: " << yamlText(solution.checker) << "\n"
       << "tolerance: " << digits(solution.tolerance) << "  # m\n"
       << "margin: " << digits(solution.margin) << "  # m\n";
  if (solution.clearance > 0) text << "clearance: " << shortest(solution.clearance) << "  # m\n";
  text << "tube: ";
  if (space.empty())
    text << row(solution.tube) << "  # m, rad, of each number";
  else
    text << "{position: " << digits(at(solution.tube, 0))
         << ", rotation: " << digits(at(solution.tube, space == "SE2" ? 2 : 3)) << "}  # m, rad";
  text << ": the proof holds for every curve this close to the path\n"
       << "path:  # " << withoutControls(listed(solution.numbers, " ")) << "\n";
  for (const Configuration& state : solution.path) text << "  - " << row(state) << "\n";
  return text.str();
}

Solution readPathFile(const std::filesystem::path& file, const ConfigurationSpace& space) {
  Solution solution;
  solution.space = rigidSpaceOf(space);
  solution.numbers = space.numberNames();
  solution.checker = "unknown";
  for (StateRow& row : readStateRows(file, space, solution.notes))
    solution.path.push_back(std::move(row.q));
  return solution;
}

Configuration fromRow(const std::vector<double>& row) {
  return Eigen::Map<const Configuration>(row.data(), Eigen::Index(row.size()));
}

void readStates(const YamlValue& list, const ConfigurationSpace& space, Solution& solution,
                YamlSource& source) {
  if (list.kind == YamlValue::Kind::List && list.items.empty())
    return source.fault(list.line, "path: has no states; at least one is needed");
  if (list.kind != YamlValue::Kind::List) {
    source.fault(list.line, "path: a list of states is needed, not " + described(list));
    return;
  }
  for (const YamlValue& item : list.items) {
    const auto values = readNumbers(item, space.size(), "path", source);
    if (!values) continue;
    if (const auto wrong = rowFault(*values, space))
      source.fault(item.line, "path: " + *wrong);
    else
      solution.path.push_back(fromRow(*values));
  }
}

/// Reads the tube. A file without one gives a tube of 0.
void readTube(const YamlMap& map, Solution& solution, YamlSource& source) {
  const std::size_t size = solution.numbers.size();
  solution.tube = Configuration::Zero(static_cast<Eigen::Index>(size));
  if (solution.space.empty()) {
    if (const auto numbers = map.numbers("tube", size)) {
      solution.tube = fromRow(*numbers);
      if ((solution.tube.array() < 0).any()) map.fault("tube", "numbers of at least 0 are needed");
    }
    return;
  }
  const YamlValue* tube = map.find("tube");
  if (!tube) return;
  static const MapKeys keys{{"position", "rotation"}, {}};
  const YamlMap inner(*tube, "tube", &keys, source);
  const Eigen::Index dimension = size == 3 ? 2 : 3;
  solution.tube.head(dimension).setConstant(
      inner.number("position", Range::NotNegative).value_or(0));
  solution.tube[dimension] = inner.number("rotation", Range::NotNegative).value_or(0);
}

/// Returns whether the file's states are of the problem's space. If they are not, adds a fault.
bool sameSpace(const YamlMap& map, const Solution& solution, YamlSource& source) {
  const std::vector<std::string>& numbers = solution.numbers;
  const std::string& rigid = solution.space;
  const std::string key = map.find("joints") ? "joints" : "space";
  const std::string needed = rigid.empty() ? "joints" : "space";
  if (!map.find(key)) {
    map.require(needed, rigid.empty() ? quoted(numbers) : "SE2 or SE3");
    return false;
  }
  if (key == "space") {
    const auto stated = map.choice("space", {"SE2", "SE3"});
    if (stated && *stated != rigid)
      map.fault("space", "the problem is in " +
                             (rigid.empty() ? "the joints " + quoted(numbers) : rigid) +
                             ", this solution in " + *stated);
    return stated && *stated == rigid;
  }
  const auto stated = readWords(*map.find("joints"), quoted(numbers), "joints", source);
  if (stated && *stated != numbers)
    map.fault("joints", "the problem is in " +
                            (rigid.empty() ? "the joints " + quoted(numbers) : rigid) +
                            ", this solution in " + quoted(*stated));
  return stated && *stated == numbers;
}

Solution readYaml(const std::filesystem::path& file, const std::string& text,
                  const ConfigurationSpace& space) {
  const YamlValue document = parseYaml(file.string(), text);
  FaultList faults(file.string());
  YamlSource source{file.string(), faults, {}};
  Solution solution;
  if (acceptsFormat(document, kFormat, source)) {
    static const MapKeys keys{
        {"format", "problem", "digest", "space", "joints", "planner", "seed", "certified",
         "checker", "tolerance", "margin", "clearance", "tube", "path"},
        {}};
    const YamlMap map(document, "", &keys, source);
    solution.problem = map.text("problem").value_or("");
    solution.digest = map.text("digest").value_or("");
    solution.planner = map.text("planner").value_or("");
    solution.seed = map.wholeNumber("seed").value_or(0);
    solution.certified = map.boolean("certified").value_or(false);
    solution.checker = map.text("checker").value_or("");
    solution.tolerance = map.number("tolerance", Range::NotNegative).value_or(0);
    solution.margin = map.number("margin", Range::NotNegative).value_or(0);
    solution.clearance = map.number("clearance", Range::NotNegative).value_or(0);
    solution.space = rigidSpaceOf(space);
    solution.numbers = space.numberNames();
    if (sameSpace(map, solution, source)) {
      readTube(map, solution, source);
      if (const YamlValue* path =
              map.require("path", "the states, such as - [0, 0, 0, 0, 0, 0, 1]"))
        readStates(*path, space, solution, source);
    }
  }
  faults.throwIfAny();
  return solution;
}

}  // namespace

Solution makeSolution(const Problem& problem, const SolveReport& report, std::string digest) {
  Solution solution;
  solution.problem = problem.source.file.string();
  solution.digest = std::move(digest);
  solution.space = rigidSpaceOf(problem.model.space);
  solution.numbers = problem.model.space.numberNames();
  solution.planner = report.planner;
  solution.seed = report.seed;
  solution.certified = report.certified;
  solution.checker = report.checker;
  solution.tolerance = report.tolerance;
  solution.margin = report.margin;
  if (report.clearance) solution.clearance = report.clearance->proved;
  solution.tube = problem.task.tube;
  solution.path = report.path;
  return solution;
}

namespace {

/// Returns the text of a solution file in `folder`. The name of the problem's file is relative to
/// this folder.
std::string textIn(const std::filesystem::path& folder, const Solution& solution) {
  Solution placed = solution;
  std::error_code failure;
  const auto relative = std::filesystem::proximate(
      std::filesystem::absolute(solution.problem, failure), folder, failure);
  if (!failure && !relative.empty()) placed.problem = relative.generic_string();
  return yamlOf(placed);
}

}  // namespace

void writeSolution(const Solution& solution, const std::filesystem::path& file) {
  std::error_code failure;
  writeWhole(file, textIn(std::filesystem::absolute(file, failure).parent_path(), solution));
}

std::string solutionText(const Solution& solution) {
  std::error_code failure;
  return textIn(std::filesystem::current_path(failure), solution);
}

bool isSolutionFile(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none)) return false;  // reading a pipe may never end
  std::ifstream stream(file, std::ios::binary);
  std::string text(4096, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text.find(std::string("format: ") + kFormat) != std::string::npos;
}

Solution readSolution(const std::filesystem::path& file, const ConfigurationSpace& space) {
  return file.extension() == ".path" ? readPathFile(file, space)
                                     : solutionOf(file, readMotionText(file, "a solution"), space);
}

Solution solutionOf(const std::filesystem::path& file, const std::string& text,
                    const ConfigurationSpace& space) {
  return readYaml(file, text, space);
}

}  // namespace corridor
