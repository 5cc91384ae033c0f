#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// A call of the program that made runs of a campaign.
struct CampaignSession {
  std::string started;   ///< "2026-05-04 03:02:01", UTC
  std::string commit;    ///< its build's (`buildCommit`)
  std::size_t jobs = 1;  ///< runs at a time
  std::size_t runs = 0;
};

/// A campaign's results in a file of SQLite: with the tables and columns that OMPL's
/// `ompl_benchmark_statistics` makes of logs, so that Planner Arena reads it, and with tables of
/// our own beside them, by which a campaign goes on where it stopped. A run is in all of them or in
/// none, whenever the process ends.
class CampaignDatabase {
 public:
  enum class Mode {
    fresh,   ///< there may be no file of that name
    resume,  ///< the file is of this campaign, and the cells get its runs; none yet will do
  };

  /// Only one process can have it at a time. @pre the campaign outlives it.
  /// @param cells as of `cellsOf`. @param jobs runs at a time, to be kept with them.
  /// @throws InputError, which names the file: can't be made, read or written; is in use; is no
  /// database, or of something else than campaigns; holds runs already (`fresh`); holds runs of
  /// cells that the campaign doesn't have, or of cells that were other ones: another problem file,
  /// checker, planner, limit.
  CampaignDatabase(const std::filesystem::path& file, Mode mode, const Campaign& campaign,
                   std::vector<CampaignCell>& cells, std::size_t jobs = 1);
  ~CampaignDatabase();

  /// @param cell which. @throws InputError where it can't be written; what was there before stays.
  void add(std::size_t cell, const BenchmarkRun& run);

  /// Those that made its runs, in the order in which they came. @throws InputError as `add`.
  std::vector<CampaignSession> sessions() const;

 private:
  class Tables;
  std::unique_ptr<Tables> tables_;
};

/// What of a cell must not change from one session to the next, as JSON: problem, checker, planner,
/// limits.
std::string specOf(const Campaign& campaign, const CampaignCell& cell);

}  // namespace corridor
