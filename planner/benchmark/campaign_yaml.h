#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "planner/benchmark/campaign.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {

/// Is this file a campaign (`format: corridor-campaign-1`)? False for what can't be read as YAML.
bool isCampaignFile(const std::filesystem::path& file);

/// Reads a campaign file, and the problems that it names, relative to its folder. Every key:
/// planner/benchmark/README.md. A key of a checker may be a list; then there is a variant for each
/// combination (1,000 in all at most). Peers that can't take part here are left out, with a note.
/// @throws InputError with all faults of the file and its problems at once.
Campaign readCampaign(const std::filesystem::path& file);

/// The keys of every map of a campaign file, by the map's path (as problemKeys).
const std::map<std::string, MapKeys>& campaignKeys();

/// "set.json#3-5" is three problems, "set.json#3" and all else is itself.
/// @throws InputError for a range that ends before it begins, or of more than 1,000.
std::vector<std::string> problemsOf(const std::string& text);

}  // namespace corridor
