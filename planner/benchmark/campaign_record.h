#pragma once

#include <nlohmann/json_fwd.hpp>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// Returns a campaign as JSON, to be stored with its runs: everything that reports and `specOf`
/// need to know about it. Bodies, robots, starts and goals are left out.
nlohmann::ordered_json recordOf(const Campaign& campaign);

/// Reads a record. The returned campaign gives the same reports and the same `specOf` as the
/// recorded one, on any machine and without the recorded campaign's files. It can't be run: its
/// problems have no bodies, and its competitors have names only.
/// @throws nlohmann::json::exception or std::invalid_argument if the record is damaged.
Campaign campaignOfRecord(const nlohmann::ordered_json& record);

}  // namespace corridor
