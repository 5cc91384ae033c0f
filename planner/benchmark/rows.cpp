#include "planner/benchmark/rows.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <sstream>

#include "collision/core/csv_text.h"
#include "collision/core/quantiles.h"
#include "collision/core/shortest.h"
#include "planner/benchmark/statistics.h"
#include "planner/benchmark/trajectory_rows.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

RowValue textOrNothing(const std::string& text) {
  return text.empty() ? RowValue{} : RowValue{text};
}

RowValue numberOrNothing(double value) {
  return std::isnan(value) ? RowValue{} : RowValue{value};
}

RowValue lengthOrNothing(double metres) {
  return metres < 0 ? RowValue{} : RowValue{metres};
}

Row namesOf(const Campaign& campaign, const CampaignCell& cell) {
  return {{"problem", campaign.problemNames[cell.problem]},
          {"variant", campaign.variants[cell.variant].name},
          {"planner", cell.planner.label}};
}

std::string csvText(const RowValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return csvField(*text);
  if (const auto* yes = std::get_if<bool>(&value)) return *yes ? "1" : "0";
  if (const auto* count = std::get_if<std::uint64_t>(&value)) return std::to_string(*count);
  if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
  return "";
}

std::string tableText(const RowValue& value) {
  if (const auto* number = std::get_if<double>(&value)) {
    char text[32];
    // Whole numbers are written without an exponent. Numbers from 1000 on are rounded to whole
    // numbers, too: they are counts, or medians of counts, which may be halves.
    const bool whole =
        (*number == std::floor(*number) || std::abs(*number) >= 1000) && std::abs(*number) < 0x1p53;
    std::snprintf(text, sizeof text, whole ? "%.0f" : "%.4g", *number);
    return text;
  }
  const std::string text = csvText(value);
  return text.empty() ? "-" : text;
}

/// Counts characters of UTF-8, not bytes.
std::size_t widthOf(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

}  // namespace

Row runRow(const Campaign& campaign, const CampaignCell& cell, const BenchmarkRun& run) {
  Row row = namesOf(campaign, cell);
  const bool ended = run.result != "failed";
  const auto measure = [&](const char* name, double value) {
    row.emplace_back(name, ended ? RowValue{value} : RowValue{});
  };
  const auto count = [&](const char* name, RowValue value) {
    row.emplace_back(name, ended ? std::move(value) : RowValue{});
  };
  const auto ofPath = [&](const char* name, RowValue value) {
    row.emplace_back(name, run.solved ? std::move(value) : RowValue{});
  };
  row.emplace_back("seed", run.seed);
  row.emplace_back("result", run.result);
  ofPath("certified", run.certified);
  ofPath("verdict", textOrNothing(run.verdict));
  measure("time_s", run.time);
  measure("processor_s", run.processorTime);
  measure("search_processor_s", run.searchProcessorTime);
  measure("set_up_s", run.setUpTime);
  measure("planner_s", run.plannerTime);
  measure("simplification_s", run.simplificationTime);
  measure("certification_s", run.certificationTime);
  measure("checking_s", run.checkingTime);
  ofPath("verification_s", run.verdict.empty() ? RowValue{} : RowValue{run.verificationTime});
  count("states", run.states);
  count("edges", run.edges);
  const bool counts = !campaign.variants[cell.variant].competitor;
  count("edges_undecided", counts ? RowValue{run.counters.undecided} : RowValue{});
  count("box_tests", counts ? RowValue{run.counters.boxTests} : RowValue{});
  count("triangle_tests", counts ? RowValue{run.counters.primitiveTests} : RowValue{});
  ofPath("proved_clearance_m", lengthOrNothing(run.provedClearance));
  ofPath("closest_found_m", lengthOrNothing(run.closestFound));
  ofPath("raw_states", std::uint64_t{run.rawStates});
  ofPath("raw_length_m", run.rawLength.metres);
  ofPath("raw_rotation_rad", run.rawLength.radians);
  ofPath("path_states", std::uint64_t{run.pathStates});
  ofPath("length_m", run.length.metres);
  ofPath("rotation_rad", run.length.radians);
  addTrajectories(campaign, run, row);
  row.emplace_back("why", textOrNothing(run.why));
  row.emplace_back("finding", textOrNothing(run.finding));
  row.emplace_back("failure", textOrNothing(run.failure));
  return row;
}

Row summaryRow(const Campaign& campaign, const CampaignCell& cell) {
  Row row = pathSummaryRow(campaign, cell);
  addTrajectories(campaign, cell, row);
  return row;
}

Row pathSummaryRow(const Campaign& campaign, const CampaignCell& cell) {
  Row row = namesOf(campaign, cell);
  const auto number = [&](const char* name, const std::function<bool(const BenchmarkRun&)>& is) {
    row.emplace_back(
        name, static_cast<std::uint64_t>(std::count_if(cell.runs.begin(), cell.runs.end(), is)));
  };
  const auto values = [&](const std::function<double(const BenchmarkRun&)>& of) {
    std::vector<double> all;
    for (const BenchmarkRun& run : cell.runs)
      if (run.solved) all.push_back(of(run));
    return all;
  };
  const auto median = [&](const char* name, const std::function<double(const BenchmarkRun&)>& of) {
    row.emplace_back(name, numberOrNothing(medianOf(values(of))));
  };
  using Run = BenchmarkRun;
  const auto verdict = [](const char* is) {
    return [is](const Run& r) { return r.verdict == is; };
  };
  row.emplace_back("runs", std::uint64_t{cell.runs.size()});
  number("failed", [](const Run& r) { return r.result == "failed"; });
  number("solved", [](const Run& r) { return r.solved; });
  number("certified", [](const Run& r) { return r.certified; });
  number("proved", verdict("proved"));
  number("refuted", verdict("refuted"));
  number("undecided", verdict("undecided"));
  const auto time = [](const Run& r) { return r.time; };
  median("time_s", time);
  row.emplace_back("time_p95_s", numberOrNothing(quantileOf(values(time), 0.95)));
  median("processor_s", [](const Run& r) { return r.processorTime; });
  median("search_processor_s", [](const Run& r) { return r.searchProcessorTime; });
  median("checking_share", [](const Run& r) { return r.checkingTime / r.time; });
  median("states", [](const Run& r) { return static_cast<double>(r.states); });
  median("edges", [](const Run& r) { return static_cast<double>(r.edges); });
  std::uint64_t edgesUndecided = 0;
  for (const Run& run : cell.runs) edgesUndecided += run.counters.undecided;
  const bool counts = !campaign.variants[cell.variant].competitor;
  const double none = std::numeric_limits<double>::quiet_NaN();
  row.emplace_back("edges_undecided", counts ? RowValue{edgesUndecided} : RowValue{});
  median("box_tests",
         [&](const Run& r) { return counts ? static_cast<double>(r.counters.boxTests) : none; });
  median("triangle_tests", [&](const Run& r) {
    return counts ? static_cast<double>(r.counters.primitiveTests) : none;
  });
  std::vector<double> distances;
  for (const Run& run : cell.runs)
    if (run.solved && run.closestFound >= 0) distances.push_back(run.closestFound);
  row.emplace_back("closest_found_m", numberOrNothing(medianOf(distances)));
  median("raw_length_m", [](const Run& r) { return r.rawLength.metres; });
  median("raw_rotation_rad", [](const Run& r) { return r.rawLength.radians; });
  median("length_m", [](const Run& r) { return r.length.metres; });
  median("rotation_rad", [](const Run& r) { return r.length.radians; });
  return row;
}

std::vector<Row> runRows(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  std::vector<Row> rows;
  for (const CampaignCell& cell : cells)
    for (const BenchmarkRun& run : cell.runs) rows.push_back(runRow(campaign, cell, run));
  return rows;
}

std::vector<Row> pathSummaryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  std::vector<Row> rows;
  for (const CampaignCell& cell : cells) rows.push_back(pathSummaryRow(campaign, cell));
  return rows;
}

std::vector<Row> summaryRows(const Campaign& campaign, const std::vector<CampaignCell>& cells) {
  std::vector<Row> rows;
  for (const CampaignCell& cell : cells) rows.push_back(summaryRow(campaign, cell));
  return rows;
}

void CsvWriter::add(const Row& row) {
  const auto line = [&](auto cell) {
    for (const auto& column : row) out_ << (&column == &row.front() ? "" : ",") << cell(column);
    out_ << '\n';
  };
  if (!hasNames_) line([](const auto& column) { return column.first; });
  hasNames_ = true;
  line([](const auto& column) { return csvText(column.second); });
}

std::string csvOf(const std::vector<Row>& rows) {
  std::ostringstream text;
  CsvWriter csv(text);
  for (const Row& row : rows) csv.add(row);
  return text.str();
}

std::string tableOf(const std::vector<Row>& rows) {
  if (rows.empty()) return "";
  std::string text;
  std::vector<std::string> lines(rows.size() + 1);
  for (std::size_t c = 0; c < rows[0].size(); ++c) {
    const std::string& name = rows[0][c].first;
    std::vector<std::string> cells{name};
    for (const Row& row : rows) cells.push_back(tableText(row[c].second));
    const bool says = std::any_of(cells.begin() + 1, cells.end(), [](const std::string& cell) {
      return cell != "0" && cell != "-";
    });
    if (!says && name != "runs" && name != "solved" && name != "refuted") continue;
    std::size_t width = 0;
    for (const std::string& cell : cells) width = std::max(width, widthOf(cell));
    const bool left = std::holds_alternative<std::string>(rows[0][c].second);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string pad(width - widthOf(cells[i]), ' ');
      lines[i] += (c ? "  " : "") + (left ? cells[i] + pad : pad + cells[i]);
    }
  }
  for (const std::string& line : lines) text += line + '\n';
  return text;
}

}  // namespace corridor
