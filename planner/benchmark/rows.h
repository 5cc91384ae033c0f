#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "planner/benchmark/campaign.h"

/// A campaign's results as rows of named values: the same names in CSV files, JSON, the table and
/// OMPL's log. Every column: planner/benchmark/README.md.
namespace corridor {

/// Nothing (a run without a path has no length), a text, yes or no, a count, a measure.
using RowValue = std::variant<std::monostate, std::string, bool, std::uint64_t, double>;
using Row = std::vector<std::pair<std::string, RowValue>>;

/// One run.
Row runRow(const Campaign& campaign, const CampaignCell& cell, const BenchmarkRun& run);

/// All runs of a cell: how many ended how, and medians over those that were solved.
Row summaryRow(const Campaign& campaign, const CampaignCell& cell);

std::vector<Row> runRows(const Campaign& campaign, const std::vector<CampaignCell>& cells);
std::vector<Row> summaryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells);

/// A line of names, then a line a row; numbers with all their digits, yes is 1. @pre all rows have
/// the same columns.
std::string csvOf(const std::vector<Row>& rows);

/// For people: columns side by side, four digits. A column that says nothing in any row (0, or
/// nothing) is left out, unless it is `runs`, `solved` or `refuted`.
std::string tableOf(const std::vector<Row>& rows);

}  // namespace corridor
