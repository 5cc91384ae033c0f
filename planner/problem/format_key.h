#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Checks the key `format` of a file. If the file is no map or has another format, adds a fault and
/// returns false: further faults would only mislead. If the key is missing, adds a fault and
/// returns true, so that the caller reads on.
bool hasFormat(const YamlValue& document, const std::string& format, YamlSource& source);

/// Returns the file's name without extension. If that is the usual name of such files (`usual`:
/// "problem"), returns the name of the file's folder.
std::string nameOfFile(const std::filesystem::path& file, const std::string& usual);

}  // namespace corridor
