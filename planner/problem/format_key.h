#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Checks the key `format` of a file. Returns true if the format is right. If the file is not a map
/// or has another format, adds a fault and returns false; the caller must then read no further,
/// because any further fault of this file would mislead the user. If the key is missing, adds a
/// fault and returns true, so that the caller reads on.
bool acceptsFormat(const YamlValue& document, const std::string& format, YamlSource& source);

/// Returns the file's name without extension. If this name is `usual`, the usual name of files of
/// this kind (such as "problem"), returns the name of the file's folder.
std::string nameOfFile(const std::filesystem::path& file, const std::string& usual);

}  // namespace corridor
