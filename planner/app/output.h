#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "collision/core/transform.h"
#include "planner/robot/configuration_space.h"
#include "planner/verify/verify_path.h"

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

/// Before any time is spent on what is to be written: is there a folder for the file?
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
const char* nameOf(PathVerdict verdict);
nlohmann::ordered_json numbersJson(const Configuration& q);

/// Digits in groups of three: 12,345.
std::string grouped(std::uint64_t count);
/// "1 edge", "2 edges"
std::string counted(std::uint64_t count, const std::string& noun);

}  // namespace corridor::app
