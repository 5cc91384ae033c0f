#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// Text files of numbers: poses, motions, points, planes.
namespace corridor::app {

/// Reads the lines of a file of numbers. The numbers of a line are blank or comma separated; the
/// rest of a line from `#` on is a comment; blank lines are skipped. The file may be a pipe; "-" is
/// the standard input.
/// @param what the name of the lines in messages, such as "poses"
/// @param take receives the numbers of each line, and returns what is wrong, or ""
/// @throws InputError with the faults of all lines; a file without lines is a fault.
void readNumberLines(const std::filesystem::path& file, const std::string& what,
                     const std::function<std::string(const std::vector<double>&)>& take);

}  // namespace corridor::app
