#pragma once

#include <string>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Returns a campaign as JSON, for its database: all that reports, and the database itself, need of
/// it. Bodies, robots, starts and goals are left out.
std::string recordOf(const Campaign& campaign);

/// Reads a record. The campaign gives the same reports and `specOf` as the one that was recorded,
/// on any machine and without its files. It can't be run: its problems have no bodies, and its
/// competitors have names only.
/// @throws nlohmann::json::exception or InputError if the record is damaged.
Campaign campaignOfRecord(const std::string& record);

}  // namespace corridor
