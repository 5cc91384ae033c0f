#include "planner/benchmark/campaign_merge.h"

#include <algorithm>
#include <string>

#include "collision/core/error.h"
#include "planner/benchmark/campaign_spec.h"
#include "planner/benchmark/ompl_database.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuseSource(const fs::path& file, const std::string& why) {
  throw InputError(Fault{file.string(), 0, why});
}

fs::path runsIn(const fs::path& source) {
  std::error_code none;
  const bool isDatabase = source.filename() == "campaign.db";  // stands for its folder
  if (!isDatabase && !fs::is_directory(source, none)) {
    if (!fs::exists(source, none))
      refuseSource(source,
                   "there is no such file; a folder of results, or its runs.jsonl, is needed");
    return source;
  }
  const fs::path folder = isDatabase ? source.parent_path() : source, file = folder / "runs.jsonl",
                 database = folder / "campaign.db";
  if (fs::exists(file, none)) return file;
  if (const std::string why = whyNotReplaced(database); !why.empty()) refuseSource(database, why);
  refuseSource(file, "there is no such file; a folder of results, or its runs.jsonl, is needed");
}

/// Tests that a campaign has all cells of the first file's campaign, with the same settings.
void requireSameCells(const Campaign& campaign, const fs::path& file, const Campaign& firstCampaign,
                      const fs::path& first) {
  const std::string refusal = "is not of the campaign of " + first.string() + ": ";
  const std::vector<CampaignCell> cells = cellsOf(firstCampaign);
  const std::vector<CellMatch> matches = matchCells(firstCampaign, campaign);
  for (std::size_t c = 0; c < cells.size(); ++c)
    if (!matches[c].index)
      refuseSource(file, refusal + "it does not have " + cellName(firstCampaign, cells[c]));
  for (const CellMatch& match : matchCells(campaign, firstCampaign))
    if (match.index && !match.fault.empty()) refuseSource(file, refusal + match.fault);
}

/// Gives the first campaign the seeds of all. @throws InputError if there would be a seed that none
/// of the campaigns has, because the seeds of a campaign have no gap.
void joinSeeds(Campaign& campaign, std::vector<std::pair<std::uint64_t, std::uint64_t>> ranges,
               const fs::path& file) {
  std::sort(ranges.begin(), ranges.end());
  std::uint64_t end = ranges.front().first;
  for (const auto& [first, runs] : ranges) {
    if (first > end)
      refuseSource(file, "can't be merged with the others: none of them is for the seeds from " +
                             std::to_string(end) + " to " + std::to_string(first - 1) +
                             ", and a campaign has seeds without a gap");
    end = std::max(end, first + runs);
  }
  campaign.seed = ranges.front().first;
  campaign.runs = end - campaign.seed;
}

}  // namespace

CampaignMerge readCampaigns(const std::vector<fs::path>& sources) {
  CampaignMerge merge;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> seeds;
  for (const fs::path& source : sources) {
    merge.files.push_back(runsIn(source));
    const Campaign campaign = campaignIn(merge.files.back());
    if (merge.files.size() == 1)
      merge.campaign = campaign;
    else
      requireSameCells(campaign, merge.files.back(), merge.campaign, merge.files.front());
    seeds.emplace_back(campaign.seed, campaign.runs);
    std::vector<std::string>& notes = merge.campaign.notes;
    for (const std::string& note : campaign.notes)
      if (std::find(notes.begin(), notes.end(), note) == notes.end()) notes.push_back(note);
  }
  joinSeeds(merge.campaign, std::move(seeds), merge.files.front());
  merge.campaign.shard = {};
  return merge;
}

std::unique_ptr<RunFile> mergeInto(const CampaignMerge& merge, const fs::path& file,
                                   std::vector<CampaignCell>& cells) {
  const fs::path part = file.string() + ".part";
  std::error_code ignored;
  fs::remove(part, ignored);
  try {
    auto runs = std::make_unique<RunFile>(part, RunFile::Mode::fresh, merge.campaign, cells);
    for (const fs::path& source : merge.files) runs->take(source, merge.files.front(), cells);
    runs->finish(file);
    return runs;
  } catch (...) {
    fs::remove(part, ignored);
    throw;
  }
}

}  // namespace corridor
