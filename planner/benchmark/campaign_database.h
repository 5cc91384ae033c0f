#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "planner/benchmark/campaign.h"

namespace corridor {

/// One execution of a program, such as `corridor benchmark`, that added runs to a campaign.
struct CampaignSession {
  std::string started;   ///< "2026-05-04 03:02:01", UTC
  std::string commit;    ///< the program's commit (`buildCommit`)
  std::size_t jobs = 1;  ///< runs at a time
  std::size_t runs = 0;
};

/// A campaign's results in an SQLite file. The file has the tables and columns that OMPL's
/// `ompl_benchmark_statistics` makes of logs, so that Planner Arena can read it. Further tables of
/// Corridor allow a campaign to be resumed.
/// A run is in all tables or in none, whenever the process ends.
class CampaignDatabase {
 public:
  enum class Mode {
    fresh,  ///< the file must not contain runs yet
    /// The file must belong to this campaign, or not exist. The cells receive its runs, without
    /// their texts (`RunTrimmer`).
    resume,
  };

  /// Opens or creates the file. Only one process can have it open at a time. @pre the campaign
  /// outlives this object.
  /// @param cells the cells that `cellsOf` returns. @param jobs the number of runs at a time, which
  /// is recorded with the session.
  /// @throws InputError, with the file's name, in these cases:
  /// - The file can't be created, read or written, or is in use.
  /// - It is not a campaign's database.
  /// - It contains runs already (only with `fresh`).
  /// - It contains runs of cells or seeds that the campaign doesn't have.
  /// - It contains runs of a cell whose `specOf` has changed.
  /// - It contains runs of another shard than the campaign's.
  CampaignDatabase(const std::filesystem::path& file, Mode mode, const Campaign& campaign,
                   std::vector<CampaignCell>& cells, std::size_t jobs = 1);
  ~CampaignDatabase();

  /// Stores a run. @param cell the index of its cell in the campaign's cells. @throws InputError if
  /// it can't be written; the runs that were stored before remain.
  void add(std::size_t cell, const BenchmarkRun& run);

  /// Stores many runs quickly, all or none. Calls `adds`, which must call `add` for each run.
  /// @throws the exceptions of `add` and `adds`; then none of these runs is stored.
  void addTogether(const std::function<void()>& adds);

  /// Returns a source of the stored runs, with their texts. The source reads one run at a time, and
  /// throws InputError if the file can't be read. @pre this object outlives the source.
  RunSource runs() const;

  /// Returns the sessions that made at least one run, oldest first. @throws InputError if the file
  /// can't be read.
  std::vector<CampaignSession> sessions() const;

 private:
  class Tables;
  std::unique_ptr<Tables> tables_;
};

}  // namespace corridor
