#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Checks the key `format` of a file. Returns false, with a fault, if the file is no map or has
/// another format: other faults would only mislead then. A missing key is a fault, too, but returns
/// true, so that the caller reads on.
bool hasFormat(const YamlValue& document, const std::string& format, YamlSource& source);

/// Returns the file's name without extension, or the folder's name where the file is called
/// `usual`.yaml.
std::string nameOfFile(const std::filesystem::path& file, const std::string& usual);

}  // namespace corridor
