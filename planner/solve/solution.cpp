#include "planner/solve/solution.h"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <unistd.h>

#include "planner/problem/format_key.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

constexpr const char* kFormat = "corridor-solution-1";

std::string digits(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

/// In double quotes, as YAML reads them back.
std::string yamlText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

const char* nameOf(RigidSpace space) {
  return space == RigidSpace::SE3 ? "SE3" : "SE2";
}

std::vector<double> numbersOf(RigidSpace space, const RigidState& s) {
  if (space == RigidSpace::SE2) return {s.pose.p.x(), s.pose.p.y(), s.yaw};
  return {s.pose.p.x(), s.pose.p.y(), s.pose.p.z(), s.pose.q.x(),
          s.pose.q.y(), s.pose.q.z(), s.pose.q.w()};
}

RigidState stateOf(RigidSpace space, const std::vector<double>& v) {
  RigidState s;
  if (space == RigidSpace::SE2) {
    s.pose.p = {v[0], v[1], 0};
    s.yaw = v[2];
  } else {
    s.pose.p = {v[0], v[1], v[2]};
    s.pose.q = {v[6], v[3], v[4], v[5]};
  }
  return s;
}

std::size_t widthOf(RigidSpace space) {
  return space == RigidSpace::SE2 ? 3 : 7;
}

std::string stateNames(RigidSpace space) {
  return space == RigidSpace::SE2 ? "x y yaw" : "x y z qx qy qz qw";
}

std::string yamlOf(const Solution& solution) {
  std::ostringstream text;
  text << "# A path for a rigid body. Check it: corridor verify PROBLEM SOLUTION\n"
       << "format: " << kFormat << "\n"
       << "problem: " << yamlText(solution.problem) << "\n"
       << "digest: " << solution.digest << "\n"
       << "space: " << nameOf(solution.space) << "\n"
       << "planner: " << solution.planner << "\n"
       << "seed: " << solution.seed << "\n"
       << "certified: " << (solution.certified ? "true" : "false") << "\n"
       << "checker: " << yamlText(solution.checker) << "\n"
       << "tolerance: " << digits(solution.tolerance) << "  # m\n"
       << "margin: " << digits(solution.margin) << "  # m\n"
       << "tube: {position: " << digits(solution.tube.position)
       << ", rotation: " << digits(solution.tube.rotation)
       << "}  # m, rad: the proof holds for every curve this close to the path\n"
       << "path:  # " << stateNames(solution.space) << "\n";
  for (const RigidState& state : solution.path) {
    const char* separator = "  - [";
    for (const double value : numbersOf(solution.space, state)) {
      text << separator << digits(value);
      separator = ", ";
    }
    text << "]\n";
  }
  return text.str();
}

bool isState(RigidSpace space, const RigidState& state) {
  return space == RigidSpace::SE2 || !state.pose.q.coeffs().isZero(0);
}
constexpr const char* kZeroQuaternion = "a quaternion of zeros is no rotation";

Solution readPathFile(const std::filesystem::path& file, RigidSpace space) {
  Solution solution;
  solution.space = space;
  solution.checker = "unknown";
  FaultList faults(file.string());
  std::istringstream lines(readTextFile(file, "a path"));
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line);
    std::vector<double> values;
    std::string word, complaint;
    while (words >> word) {
      double value = 0;
      if (const std::string wrong = parseNumber(word, Range::Any, value);
          !wrong.empty() && complaint.empty())
        complaint = wrong;
      values.push_back(value);
    }
    if (values.empty()) continue;
    if (complaint.empty() && values.size() != widthOf(space)) {
      complaint = "a state of " + std::string(nameOf(space)) + " has " +
                  std::to_string(widthOf(space)) + " numbers (" + stateNames(space) + "), not " +
                  std::to_string(values.size());
    }
    if (!complaint.empty()) {
      faults.add(file.string(), number, complaint);
      continue;
    }
    solution.path.push_back(stateOf(space, values));
    if (!isState(space, solution.path.back())) faults.add(file.string(), number, kZeroQuaternion);
  }
  if (solution.path.empty() && faults.size() == 0) faults.add(file.string(), 0, "no states");
  faults.throwIfAny();
  return solution;
}

void readStates(const YamlValue& list, Solution& solution, YamlSource& source) {
  if (list.kind != YamlValue::Kind::List || list.items.empty()) {
    source.fault(list.line, "path: a list of states is needed, not " + described(list));
    return;
  }
  for (const YamlValue& item : list.items) {
    const auto values = readNumbers(item, widthOf(solution.space), "path", source);
    if (!values) continue;
    solution.path.push_back(stateOf(solution.space, *values));
    if (!isState(solution.space, solution.path.back()))
      source.fault(item.line, std::string("path: ") + kZeroQuaternion);
  }
}

Solution readYaml(const std::filesystem::path& file, RigidSpace space) {
  const YamlValue document = parseYaml(file.string(), readTextFile(file, "a solution"));
  FaultList faults(file.string());
  YamlSource source{file.string(), faults, {}};
  Solution solution;
  if (hasFormat(document, kFormat, source)) {
    static const MapKeys keys{{"format", "problem", "digest", "space", "planner", "seed",
                               "certified", "checker", "tolerance", "margin", "tube", "path"},
                              {}};
    static const MapKeys tubeKeys{{"position", "rotation"}, {}};
    const YamlMap map(document, "", &keys, source);
    solution.problem = map.text("problem").value_or("");
    solution.digest = map.text("digest").value_or("");
    solution.planner = map.text("planner").value_or("");
    solution.seed = map.wholeNumber("seed").value_or(0);
    solution.certified = map.boolean("certified").value_or(false);
    solution.checker = map.text("checker").value_or("");
    solution.tolerance = map.number("tolerance", Range::NotNegative).value_or(0);
    solution.margin = map.number("margin", Range::NotNegative).value_or(0);
    if (const YamlValue* tube = map.find("tube")) {
      const YamlMap inner(*tube, "tube", &tubeKeys, source);
      solution.tube.position = inner.number("position", Range::NotNegative).value_or(0);
      solution.tube.rotation = inner.number("rotation", Range::NotNegative).value_or(0);
    }
    map.require("space", "SE2 or SE3");
    const auto stated = map.choice("space", {"SE2", "SE3"});
    solution.space = space;
    if (stated && *stated != nameOf(space)) {
      map.fault("space", "the problem is in " + std::string(nameOf(space)) + ", this solution in " +
                             *stated);
    } else if (const YamlValue* path =
                   map.require("path", "the states, such as - [0, 0, 0, 0, 0, 0, 1]")) {
      readStates(*path, solution, source);
    }
  }
  faults.throwIfAny();
  return solution;
}

}  // namespace

Solution makeSolution(const Problem& problem, const SolveReport& report) {
  Solution solution;
  solution.problem = problem.file.string();
  solution.digest = problem.digest;
  solution.space = problem.space;
  solution.planner = report.planner;
  solution.seed = report.seed;
  solution.certified = report.certified;
  solution.checker = report.checker;
  solution.tolerance = report.motion.tolerance;
  solution.margin = report.motion.margin;
  solution.tube = report.motion.tube;
  solution.path = report.path;
  return solution;
}

void writeSolution(const Solution& solution, const std::filesystem::path& file) {
  Solution placed = solution;
  std::error_code failure;
  const auto folder = std::filesystem::absolute(file, failure).parent_path();
  const auto relative = std::filesystem::proximate(
      std::filesystem::absolute(solution.problem, failure), folder, failure);
  if (!failure && !relative.empty()) placed.problem = relative.generic_string();
  writeWhole(file, yamlOf(placed));
}

void writeWhole(const std::filesystem::path& file, const std::string& text) {
  std::error_code failure, ignored;
  // A device or a pipe is written to: renaming a file over it would replace it.
  const bool inPlace =
      std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  const std::filesystem::path written =
      inPlace ? file : std::filesystem::path(file.string() + ".tmp" + std::to_string(::getpid()));
  std::ofstream out(written, std::ios::binary);
  out << text;
  out.close();
  if (out && !inPlace) std::filesystem::rename(written, file, failure);
  if (!out || failure) {
    if (!inPlace) std::filesystem::remove(written, ignored);
    throw InputError(
        Fault{file.string(), 0,
              "can't be written" + (failure ? ": " + failure.message() : std::string())});
  }
}

Solution readSolution(const std::filesystem::path& file, RigidSpace space) {
  return file.extension() == ".path" ? readPathFile(file, space) : readYaml(file, space);
}

}  // namespace corridor
