#pragma once

#include <string>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Returns a campaign as JSON, for its database: everything that reports and the database itself
/// need to know about it. Bodies, robots, starts and goals are left out.
std::string recordOf(const Campaign& campaign);

/// Reads a record. The returned campaign gives the same reports and the same `specOf` as the
/// recorded one, on any machine and without the recorded campaign's files. It can't be run: its
/// problems have no bodies, and its competitors have names only.
/// @throws nlohmann::json::exception or InputError if the record is damaged.
Campaign campaignOfRecord(const std::string& record);

}  // namespace corridor
