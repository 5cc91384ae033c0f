#pragma once

#include <map>
#include <string>

#include "planner/problem/yaml_reader.h"

/// Tables of the legal keys of problem and robot files. A test compares them with the JSON schemas
/// that editors use.
namespace corridor {

/// The keys of each map, by the map's path: "" is the file, "world.*" any map in `world`,
/// "shapes[]" any item of the list `shapes`.
const std::map<std::string, MapKeys>& problemKeys();
const std::map<std::string, MapKeys>& robotKeys();

/// The words that some keys take, by the key's path.
const std::map<std::string, std::vector<std::string>>& problemChoices();
const std::map<std::string, std::vector<std::string>>& robotChoices();

}  // namespace corridor
