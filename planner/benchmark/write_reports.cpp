#include "planner/benchmark/write_reports.h"

#include <algorithm>
#include <cctype>

#include "collision/core/error.h"
#include "planner/benchmark/ompl_log.h"
#include "planner/benchmark/rows.h"
#include "planner/solve/solution.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::string fileName(std::string text) {
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return !std::isalnum(c) && c != '.' && c != '_' && c != '-'; }, '-');
  return text;
}

bool makeReportFolder(const fs::path& folder) {
  std::error_code failure, ignored;
  if (fs::exists(folder, ignored) && !fs::is_directory(folder, ignored))
    throw InputError(Fault{folder.string(), 0, "is a file; a folder is needed"});
  const bool made = fs::create_directory(folder, failure);
  if (failure) throw InputError(Fault{folder.string(), 0, "can't be made: " + failure.message()});
  const fs::path probe = folder / ".corridor-benchmark";
  try {
    writeWhole(probe, "");
  } catch (const InputError&) {
    if (made) fs::remove(folder, ignored);
    throw InputError(Fault{folder.string(), 0, "can't be written to"});
  }
  fs::remove(probe, ignored);
  return made;
}

std::vector<fs::path> writeReports(const Campaign& campaign, const CampaignResult& result,
                                   const fs::path& folder) {
  std::vector<fs::path> files{folder / "runs.csv", folder / "summary.csv"};
  writeWhole(files[0], csvOf(runRows(campaign, result.cells)));
  writeWhole(files[1], csvOf(summaryRows(campaign, result.cells)));
  for (std::size_t p = 0; p < campaign.problems.size(); ++p)
    for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
      const auto isRun = [&](const CampaignCell& cell) {
        return cell.problem == p && cell.variant == v && !cell.runs.empty();
      };
      if (std::none_of(result.cells.begin(), result.cells.end(), isRun)) continue;
      const std::string name = fileName(campaign.problemNames[p] + "." + campaign.variants[v].name);
      fs::path file = folder / (name + ".log");
      for (int i = 2; std::find(files.begin(), files.end(), file) != files.end(); ++i)
        file = folder / (name + "-" + std::to_string(i) + ".log");
      writeWhole(file, omplLog(campaign, result, p, v));
      files.push_back(file);
    }
  return files;
}

}  // namespace corridor
