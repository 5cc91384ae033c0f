#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "planner/benchmark/campaign.h"
#include "planner/benchmark/line_file.h"

namespace corridor {

/// One execution of a program, such as `corridor benchmark`, that added runs to a campaign.
struct CampaignSession {
  std::string started;   ///< "2026-05-04 03:02:01", UTC
  std::string commit;    ///< the program's commit (`buildCommit`)
  std::size_t jobs = 1;  ///< runs at a time
  std::size_t runs = 0;
};

/// A campaign's runs in a file of JSON lines, `runs.jsonl`. The file is a sequence of sessions:
/// * a line that begins a session: the format, when and how it ran, its shard, and its campaign
///   (campaign_record.h);
/// * lines `{"setup":…}`: parts of OMPL's record that many runs share, such as the machine. They
/// are
///   numbered from 0 in each session;
/// * lines `{"cell":…,"setup":…,"run":…}`: a run, with the number of its cell in the campaign of
/// the
///   session.
/// A run is in the file as a whole or not at all, whenever the process ends. The memory for a run
/// is 24 bytes, in addition to the run in its cell.
class RunFile {
 public:
  enum class Mode {
    fresh,  ///< the file must not contain runs yet
    /// The file must belong to this campaign, or not exist. The cells receive its runs, without
    /// their texts (`RunTrimmer`).
    resume,
  };

  /// Opens or creates the file. Only one process can have it open at a time. A last line that was
  /// not written whole is cut off. @pre the campaign outlives this object.
  /// @param cells the cells that `cellsOf` returns. @param jobs the number of runs at a time, which
  /// is recorded with the session.
  /// @throws InputError, with the file's name, in these cases:
  /// - The file can't be created, read or written, or is in use.
  /// - It is not a file of runs, or a line of it is damaged.
  /// - It contains runs already (only with `fresh`).
  /// - It contains runs of cells or seeds that the campaign doesn't have, or a run twice.
  /// - It contains runs of a cell whose `specOf` has changed.
  /// - It contains runs of another shard than the campaign's.
  RunFile(const std::filesystem::path& file, Mode mode, const Campaign& campaign,
          std::vector<CampaignCell>& cells, std::size_t jobs = 1);
  ~RunFile();

  /// Appends a run. Afterwards it has reached the disk. @param cell the index of its cell in the
  /// campaign's cells. @throws InputError if it can't be written; the runs that were stored before
  /// remain.
  void add(std::size_t cell, const BenchmarkRun& run);

  /// Appends the sessions and runs of another file of the same campaign. The cells receive the
  /// runs, without their texts. @param first the file that gave the campaign, for error messages.
  /// @throws InputError for the faults of a file that can't be resumed.
  void take(const std::filesystem::path& source, const std::filesystem::path& first,
            std::vector<CampaignCell>& cells);
  /// Ends a merge: this object's campaign becomes that of the file, which is renamed.
  void finish(const std::filesystem::path& file);

  /// Returns a source of the stored runs, with their texts. The source reads one run at a time, and
  /// throws InputError if the file can't be read. @pre this object outlives the source.
  RunSource runs() const;
  /// Returns the sessions that made at least one run, in the order of the file.
  std::vector<CampaignSession> sessions() const;
  /// What users should know about the file: lines that were cut off.
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  struct Place;
  void read(LineFile& from, std::uint64_t base, const std::string& campaign,
            std::vector<CampaignCell>& cells, const std::function<void(const std::string&)>& copy);
  void note(const LineFile& file);

  const Campaign& campaign_;
  LineFile lines_;
  std::vector<std::vector<Place>> places_;  ///< the runs of each cell, by seed
  std::vector<nlohmann::json> setups_;      ///< of all sessions
  std::vector<CampaignSession> sessions_;
  std::vector<std::string> notes_;
  // The session of this object begins in the file with its first run.
  CampaignSession session_;
  std::string sessionLine_;                       ///< empty: it is written
  std::map<std::string, std::size_t> ownSetups_;  ///< their numbers, by their JSON
  std::size_t firstSetup_ = 0;                    ///< the index in `setups_` of number 0
};

/// Returns the campaign of the last session in a file of runs. It can't be run
/// (campaign_record.h). @throws InputError if the file can't be read, or has no runs.
Campaign campaignIn(const std::filesystem::path& file);

}  // namespace corridor
