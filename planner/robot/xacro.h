#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace corridor {

/// Returns whether xacro must expand the file, that is, whether the file's name ends in .xacro.
bool isXacro(const std::filesystem::path& file);

/// Returns the text that the user's program xacro makes of a file. The program runs in the file's
/// folder, so that the text does not depend on the current folder.
/// @param arguments the arguments of xacro, such as "prefix:=left_".
/// @param seconds time limit.
/// @throws InputError if the file can't be read, if PATH has no xacro, or if xacro fails, takes too
/// long, prints nothing, prints a byte 0, or prints more than 256 MiB.
std::string expandXacro(const std::filesystem::path& file,
                        const std::vector<std::string>& arguments, double seconds = 60);

}  // namespace corridor
