#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

/// Commands of programs of their own: `corridor benchmark`, `corridor query`, `corridor course`.
namespace corridor::app {

/// Runs another program of Corridor in place of this one: the first that is found in the folder of
/// this program, or in the folder where helper programs are installed beside it. Returns only if
/// there is no such program: prints a message, and returns the exit status.
int becomeProgram(const std::string& name, const std::vector<std::string>& arguments);

/// Adds a command to the help and to messages on unknown commands.
void listBenchmark(CLI::App& program, int& status);
void listQuery(CLI::App& program, int& status);
void listCourse(CLI::App& program, int& status);

/// What --help of `corridor` says of these commands.
inline constexpr const char* kBenchmarkHelp =
    "Compare checkers and planners: run time, and how many paths are refuted";
inline constexpr const char* kQueryHelp =
    "Query two meshes at many poses, or along many motions: CSV on stdout, times on stderr";
inline constexpr const char* kCourseHelp =
    "Algorithms of the course on planes, polygons, linear programs and moving boxes";

}  // namespace corridor::app
