#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "planner/benchmark/campaign.h"

/// A campaign's results as rows of named values, with the same names in CSV files, JSON, the table
/// and OMPL's database. planner/benchmark/README.md lists every column.
namespace corridor {

/// One of: nothing (for example for the length of a path if there is no path), a text, yes or no, a
/// count, or a measure.
using RowValue = std::variant<std::monostate, std::string, bool, std::uint64_t, double>;
using Row = std::vector<std::pair<std::string, RowValue>>;

/// Returns the row of one run.
Row runRow(const Campaign& campaign, const CampaignCell& cell, const BenchmarkRun& run);

/// Return the row of all runs of a cell: counts of their results, and medians over the solved runs.
/// `pathSummaryRow` has the columns of paths only; `summaryRow` also has the columns of
/// trajectories.
Row pathSummaryRow(const Campaign& campaign, const CampaignCell& cell);
Row summaryRow(const Campaign& campaign, const CampaignCell& cell);

std::vector<Row> runRows(const Campaign& campaign, const std::vector<CampaignCell>& cells);
std::vector<Row> pathSummaryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells);
std::vector<Row> summaryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells);

/// Writes rows as CSV: a line of names, then a line per row. A number is written with as many
/// digits as are needed to read the same double; yes is written as 1, no as 0. @pre all rows have
/// the same columns.
class CsvWriter {
 public:
  explicit CsvWriter(std::ostream& out) : out_(out) {}
  void add(const Row& row);

 private:
  std::ostream& out_;
  bool hasNames_ = false;
};
std::string csvOf(const std::vector<Row>& rows);

/// Returns an aligned table for people to read. Numbers have four significant digits; numbers from
/// 1000 on are rounded to whole numbers. A column that has 0 or nothing in every row is left out,
/// except `runs`, `solved` and `refuted`. @pre all rows have the same columns.
std::string tableOf(const std::vector<Row>& rows);

}  // namespace corridor
