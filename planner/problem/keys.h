#pragma once

#include <map>
#include <string>

#include "planner/problem/yaml_reader.h"

/// Tables of the legal keys of problem and robot files. A test compares these tables with the JSON
/// schemas that editors use.
namespace corridor {

/// The legal keys of each map, by the map's path: "" is the whole file, "world.*" is any map in
/// `world`, "shapes[]" is any item of the list `shapes`.
const std::map<std::string, MapKeys>& problemKeys();
const std::map<std::string, MapKeys>& robotKeys();

/// Where keys of problem files belong that people write into a wrong map (`YamlSource::places`).
const std::map<std::string, std::string>& problemPlaces();

/// The legal words of each key whose value is one of several words, by the key's path.
const std::map<std::string, std::vector<std::string>>& problemChoices();
const std::map<std::string, std::vector<std::string>>& robotChoices();

}  // namespace corridor
