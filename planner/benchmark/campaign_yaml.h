#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "planner/benchmark/campaign.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Returns whether a file is a campaign: its name ends in .yaml or .yml, and it has `format:
/// corridor-campaign…` or the key `checkers`. Returns false for a file that can't be read as YAML.
bool isCampaignFile(const std::filesystem::path& file);

/// Reads a campaign file and the problems that it names. The problems' paths are relative to the
/// folder of the campaign file. planner/benchmark/README.md lists every key. A key of a checker may
/// have a list of values. Then each combination of the lists' values is a variant (1,000 variants
/// at most). Competitors that are not available are left out, with a note.
/// @throws InputError with all faults of the file and its problems at once.
Campaign readCampaign(const std::filesystem::path& file);

/// Returns the legal keys of every map of a campaign file, by the map's path (like problemKeys).
const std::map<std::string, MapKeys>& campaignKeys();

}  // namespace corridor
