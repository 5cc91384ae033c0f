#include "planner/benchmark/write_reports.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ostream>
#include <unistd.h>

#include "collision/core/error.h"
#include "collision/core/whole_file.h"
#include "planner/benchmark/ompl_database.h"
#include "planner/benchmark/rows.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

/// Tests whether files can be created in a folder, by creating one and removing it. (Permissions
/// don't show whether the file system is read-only.)
/// @returns the reason why files can't be created, or "" if they can.
std::string whyNoFiles(const fs::path& folder) {
  std::string probe = (folder / ".corridor-benchmark-XXXXXX").string();
  const int file = ::mkstemp(probe.data());  // a new file, never an existing one
  if (file < 0) return std::string("can't be written to: ") + std::strerror(errno);
  ::close(file);
  ::unlink(probe.c_str());
  return "";
}

/// Returns what would prevent writing the reports into an existing folder.
std::vector<Fault> inTheWay(const fs::path& folder) {
  std::vector<Fault> faults;
  std::error_code none;
  if (const std::string why = whyNoFiles(folder); !why.empty()) return {{folder.string(), 0, why}};
  for (const char* name : {"runs.jsonl", "campaign.db", "runs.csv", "summary.csv", "report.html"})
    if (const fs::path file = folder / name; fs::is_directory(file, none))
      faults.push_back({file.string(), 0, "is a folder; a file is to be written here"});
  const fs::path database = folder / "campaign.db";
  if (const std::string why = whyNotReplaced(database); !why.empty())
    faults.push_back({database.string(), 0, why});
  const fs::path plots = folder / "plots";
  if (fs::is_directory(plots, none)) {
    if (const std::string why = whyNoFiles(plots); !why.empty())
      faults.push_back({plots.string(), 0, why});
    // Every folder whose name ends in .csv or .svg is refused, because the names of the plots are
    // not known yet.
    for (const auto& entry : fs::directory_iterator(plots, none))
      if (const auto kind = entry.path().extension();
          (kind == ".csv" || kind == ".svg") && entry.is_directory(none))
        faults.push_back({entry.path().string(), 0, "is a folder; a file may be written here"});
  } else if (fs::exists(fs::symlink_status(plots, none))) {
    faults.push_back({plots.string(), 0, "is a file; a folder is needed"});
  }
  return faults;
}

}  // namespace

std::string fileName(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return !std::isalnum(c) && c != '.' && c != '_' && c != '-'; }, '-');
  // File systems allow names of 255 bytes; the other bytes are left for prefixes and endings that
  // callers add.
  constexpr std::size_t kLongest = 120;
  return text.substr(0, kLongest);
}

bool makeReportFolder(const fs::path& folder) {
  std::error_code failure, ignored;
  if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored))
    throw InputError(Fault{folder.string(), 0, "is a file; a folder is needed"});
  const bool made = fs::create_directory(folder, failure);
  if (failure)
    throw InputError(Fault{folder.string(), 0, "can't be created: " + failure.message()});
  if (std::vector<Fault> faults = inTheWay(folder); !faults.empty()) {
    if (made) fs::remove(folder, ignored);
    throw InputError(std::move(faults));
  }
  return made;
}

void writeReports(const Campaign& campaign, const CampaignResult& result, const RunSource& runs,
                  const fs::path& folder) {
  writeWhole(folder / "runs.csv", [&](std::ostream& out) {
    CsvWriter csv(out);
    for (std::size_t c = 0; c < result.cells.size(); ++c)
      runs(c, [&](const BenchmarkRun& run) { csv.add(runRow(campaign, result.cells[c], run)); });
  });
  writeWhole(folder / "summary.csv", csvOf(summaryRows(campaign, result.cells)));
  writeOmplDatabase(campaign, result, runs, folder / "campaign.db");
}

void writeReports(const Campaign& campaign, const CampaignResult& result, const fs::path& folder) {
  writeReports(campaign, result, runsOf(result.cells), folder);
}

}  // namespace corridor
