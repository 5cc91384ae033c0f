#pragma once

#include <map>
#include <string>

#include "planner/problem/yaml_reader.h"

/// The keys of every map of the files, by the map's path: "" is the file, "world.*" any map in
/// world, "shapes[]" any item of the list. The JSON schemas for editors are held against these
/// lists by a test.
namespace corridor {

const std::map<std::string, MapKeys>& problemKeys();
const std::map<std::string, MapKeys>& robotKeys();

/// What words some keys take, by the key's path.
const std::map<std::string, std::vector<std::string>>& problemChoices();
const std::map<std::string, std::vector<std::string>>& robotChoices();

}  // namespace corridor
