#pragma once

#include <filesystem>
#include <string>

#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Checks the key `format` of a file. False: the file is of another kind, which is the one fault
/// worth telling. A missing key is faulted, and reading may go on.
bool hasFormat(const YamlValue& document, const std::string& format, YamlSource& source);

/// A name for what stands in a file: its own, or its folder's where the file is called
/// `usual`.yaml.
std::string nameOfFile(const std::filesystem::path& file, const std::string& usual);

}  // namespace corridor
