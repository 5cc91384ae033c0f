#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "collision/core/transform.h"
#include "planner/problem/problem.h"
#include "planner/robot/configuration_space.h"
#include "planner/solve/verify_solution.h"

namespace corridor::app {

enum class Tone { plain, good, bad };

/// Results for people on stdout: `key: value` lines; in colour on a terminal only.
class Lines {
 public:
  explicit Lines(bool quiet) : quiet_(quiet) {}
  void line(std::string_view key, const std::string& value, Tone tone = Tone::plain) const;
  void blank() const;

 private:
  bool quiet_;
};

/// To stderr, in front of results that go to stdout.
void warn(const std::string& text);

/// Reads the problem of a command. If no pair of its bodies is tested, a warning says so before any
/// other output (`notes` says it, too). @throws InputError as readProblem.
Problem readProblemOf(const std::string& file);

/// Verifies a solution. If it was made for other files than the problem's, a warning says so first,
/// and nothing is verified unless `ignoreDigest`.
VerifyReport verifyAloud(const Problem& problem, const Solution& solution,
                         const std::string& problemFile, const std::string& solutionFile,
                         bool ignoreDigest);

/// Before any time is spent on what is to be written: is there a folder for the file, and may files
/// be made in it?
/// @throws InputError that names the option.
void requireFolderFor(const std::optional<std::string>& file, const char* option);

/// And would that file take the place of one that is read? @param what these are: "the problem".
/// @throws InputError that names the option.
void requireNotRead(const std::optional<std::string>& file, const char* option,
                    const std::vector<std::filesystem::path>& read, const std::string& what);

/// For people: four significant digits.
std::string rounded(double value);
std::string rounded(const Vec3& v, int dimension = 3);  ///< "[1, 2, 3]"
/// "2 m, turning 3 rad" where something moves as a whole, else "2 m, 3 rad" or the one of them that
/// there is in the space.
std::string lengthText(const ConfigurationSpace& space, double metres, double radians);
/// "1e-12 m, 6e-12 rad": the largest part of a tube in lengths and in angles, as far as there are.
std::string tubeText(const ConfigurationSpace& space, const Configuration& tube);
nlohmann::ordered_json tubeJson(const ConfigurationSpace& space, const Configuration& tube);
/// "x = 1, y = 2, yaw = 0.5"
std::string stateText(const ConfigurationSpace& space, const Configuration& q);
nlohmann::ordered_json numbersJson(const Configuration& q);
/// null for what is infinite or no number, for which JSON has no word.
nlohmann::ordered_json numberJson(double value);

/// Digits in groups of three: 12,345.
std::string grouped(std::uint64_t count);
/// "1 edge", "2 edges"
std::string counted(std::uint64_t count, const std::string& noun);

}  // namespace corridor::app
