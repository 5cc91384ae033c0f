#include "planner/benchmark/campaign_merge.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <algorithm>
#include <set>
#include <sqlite3.h>
#include <string>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "planner/benchmark/campaign_database.h"
#include "planner/benchmark/campaign_record.h"
#include "planner/benchmark/campaign_spec.h"
#include "planner/benchmark/database_file.h"
#include "planner/benchmark/ompl_log.h"
#include "planner/solve/csv_text.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

fs::path databaseIn(const fs::path& source) {
  std::error_code none;
  fs::path file = fs::is_directory(source, none) ? source / "campaign.db" : source;
  if (!fs::exists(file, none))
    refuseFile(file,
               "there is no such database; a folder of results, or its campaign.db, is needed");
  return file;
}

Campaign recordedIn(SQLite::Database& base, int version, const fs::path& file) {
  SQLite::Statement table(
      base, "SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = 'corridor_campaign'");
  if (version == kCampaignVersion && table.executeStep()) {
    SQLite::Statement record(base, "SELECT value FROM corridor_campaign WHERE key = 'record'");
    if (record.executeStep()) return campaignOfRecord(record.getColumn(0).getString());
  }
  refuseFile(file,
             "was written by an earlier version, without its campaign; call `corridor benchmark` "
             "once with --resume for it");
}

/// Tests that a file has all cells of the campaign, with the same settings, and no runs of other
/// cells.
void requireSameCells(SQLite::Database& base, const fs::path& file, const Campaign& campaign,
                      const fs::path& first) {
  const std::string refusal = file == first
                                  ? "is damaged: its cells are not those of its record: "
                                  : "is not of the same campaign as " + first.string() + ": ";
  std::set<std::int64_t> ids;
  for (const CampaignCell& cell : cellsOf(campaign)) {
    const std::string &problem = campaign.problemNames[cell.problem],
                      &variant = campaign.variants[cell.variant].name;
    const std::string name = cellName(campaign, cell);
    SQLite::Statement known(base,
                            "SELECT id, spec FROM corridor_cells WHERE problem = ? AND variant = ? "
                            "AND planner = ?");
    SQLite::bind(known, problem, variant, cell.planner.label);
    if (!known.executeStep()) refuseFile(file, refusal + "it does not have " + name);
    ids.insert(known.getColumn(0).getInt64());
    const std::string here = known.getColumn(1).getString(), there = specOf(campaign, cell);
    if (here == there) continue;
    const auto [key, has, had] = specDifference(here, there);
    refuseFile(file, refusal + name + " has " + key + " " + has + ", there " + had);
  }
  SQLite::Statement others(
      base,
      "SELECT id, problem || ', ' || variant || ', ' || planner FROM "
      "corridor_cells c WHERE EXISTS (SELECT 1 FROM corridor_runs WHERE cellid = c.id)");
  while (others.executeStep())
    if (!ids.count(others.getColumn(0).getInt64()))
      refuseFile(file, refusal + "it has runs of " + others.getColumn(1).getString() +
                           ", which are not in that one");
}

/// The new database while the files are copied into it, one after the other. The file that is being
/// copied is attached as `source`. The id of a copied row is its id in the source plus an offset.
/// Cells, experiments and planners that several files have are stored only once.
class Merger {
 public:
  Merger(const CampaignMerge& merge, const fs::path& file)
      : merge_(merge), base_(file.string(), SQLite::OPEN_READWRITE) {
    base_.exec("PRAGMA synchronous = OFF");  // a crash costs nothing: the file does not have its
                                             // final name yet
    base_.exec("PRAGMA locking_mode = EXCLUSIVE");
  }

  void add(const fs::path& file) {
    SQLite::Statement attach(base_, "ATTACH DATABASE ? AS source");
    attach.bind(1, file.string());
    attach.exec();
    SQLite::Transaction transaction(base_);
    base_.exec(R"(
      CREATE TEMP TABLE cellOf AS SELECT s.id AS was, m.id AS now FROM source.corridor_cells s
        JOIN main.corridor_cells m USING (problem, variant, planner);
      CREATE TEMP TABLE experimentOf (was INTEGER PRIMARY KEY, now INTEGER);
      CREATE TEMP TABLE plannerOf (was INTEGER PRIMARY KEY, now INTEGER);
      CREATE TEMP TABLE setupOf (was INTEGER PRIMARY KEY, now INTEGER);
      INSERT OR IGNORE INTO main.corridor_setups (setup) SELECT setup FROM source.corridor_setups
        ORDER BY id;
      INSERT INTO setupOf SELECT s.id, m.id FROM source.corridor_setups s JOIN
        main.corridor_setups m USING (setup);)");
    refuseDamagedRecords(file);
    refuseRepeatedRuns(file);
    addColumns();
    copied_.clear();
    addExperiments();
    const std::int64_t runs = largest("runs"), sessions = largest("corridor_sessions");
    const auto by = [](std::int64_t offset) { return " + " + std::to_string(offset); };
    base_.exec(R"(
      INSERT INTO main.plannerConfigs (name, settings) SELECT name, settings
        FROM source.plannerConfigs s WHERE NOT EXISTS (SELECT 1 FROM main.plannerConfigs m
          WHERE m.name = s.name AND m.settings IS s.settings) ORDER BY id;
      INSERT INTO plannerOf SELECT s.id, min(m.id) FROM source.plannerConfigs s JOIN
        main.plannerConfigs m ON m.name = s.name AND m.settings IS s.settings GROUP BY s.id;)");
    const std::string columns = listOf("runs", {"id", "experimentid", "plannerid"});
    base_.exec("INSERT INTO main.runs (id, experimentid, plannerid" + columns + ") SELECT id" +
               by(runs) +
               ", (SELECT now FROM experimentOf WHERE was = experimentid),"
               " (SELECT now FROM plannerOf WHERE was = plannerid)" +
               columns + " FROM source.runs ORDER BY id");
    const std::string samples = listOf("progress", {"runid"});
    base_.exec("INSERT INTO main.progress (runid" + samples + ") SELECT runid" + by(runs) +
               samples + " FROM source.progress");
    base_.exec(
        "INSERT INTO main.corridor_sessions (id, started, version, \"commit\", jobs) "
        "SELECT id" +
        by(sessions) +
        ", started, version, \"commit\", jobs FROM source.corridor_sessions WHERE id IN "
        "(SELECT sessionid FROM source.corridor_runs)");
    base_.exec(
        "INSERT INTO main.corridor_runs (cellid, seed, runid, sessionid, record, ompl, setupid) "
        "SELECT now, seed, runid" +
        by(runs) + ", sessionid" + by(sessions) +
        ", record, ompl, (SELECT now FROM setupOf WHERE was = setupid) FROM source.corridor_runs "
        "JOIN cellOf ON was = cellid");
    base_.exec(
        "DROP TABLE cellOf; DROP TABLE experimentOf; DROP TABLE plannerOf; DROP TABLE setupOf");
    transaction.commit();
    base_.exec("DETACH DATABASE source");
  }

  /// Ends the merge. Afterwards the new database has reached the disk.
  void finish() {
    base_.exec("PRAGMA synchronous = FULL");
    SQLite::Statement seeds(base_, "UPDATE experiments SET seed = ?, runcount = ?");
    SQLite::bind(seeds, std::to_string(merge_.campaign.seed),
                 static_cast<std::int64_t>(merge_.campaign.runs));
    seeds.exec();
  }

 private:
  void refuseDamagedRecords(const fs::path& file) {
    SQLite::Statement damaged(
        base_,
        "SELECT seed FROM source.corridor_runs WHERE NOT json_valid(record) OR "
        "NOT json_valid(ifnull(ompl, '{}')) OR (setupid IS NOT NULL AND "
        "setupid NOT IN (SELECT was FROM setupOf)) LIMIT 1");
    if (damaged.executeStep())
      refuseFile(file,
                 "is damaged: the record of a run of seed " + damaged.getColumn(0).getString());
  }

  void refuseRepeatedRuns(const fs::path& file) {
    SQLite::Statement twice(
        base_,
        "SELECT m.seed, c.problem || ', ' || c.variant || ', ' || c.planner FROM "
        "source.corridor_runs s JOIN cellOf ON "
        "was = s.cellid JOIN main.corridor_runs m ON m.cellid = now AND m.seed = s.seed JOIN "
        "main.corridor_cells c ON c.id = now LIMIT 1");
    if (twice.executeStep())
      refuseFile(file, "has runs that another of these databases has, too: seed " +
                           twice.getColumn(0).getString() + " of " +
                           twice.getColumn(1).getString() +
                           "; name each folder once, or repeat one with another --seed");
  }

  std::vector<std::pair<std::string, std::string>> columnsOf(const std::string& schema,
                                                             const std::string& table) {
    std::vector<std::pair<std::string, std::string>> columns;
    SQLite::Statement rows(base_, "PRAGMA " + schema + ".table_info(" + table + ")");
    while (rows.executeStep())
      columns.emplace_back(rows.getColumn(1).getString(), rows.getColumn(2).getString());
    return columns;
  }

  /// Adds the columns of `runs` that only the source has. The files may have different columns,
  /// since a column is added when a run first has a value for it.
  void addColumns() {
    for (const char* table : {"experiments", "runs", "progress"}) {
      const auto known = columnsOf("main", table);
      for (const auto& column : columnsOf("source", table))
        if (std::none_of(known.begin(), known.end(),
                         [&](const auto& one) { return one.first == column.first; }))
          base_.exec("ALTER TABLE main." + std::string(table) + " ADD " +
                     inDoubleQuotes(column.first) + " " + column.second);
    }
  }

  /// Returns the names of the columns of a table of the source, in the form ", a, b", without the
  /// columns `except`.
  std::string listOf(const std::string& table, const std::set<std::string>& except) {
    std::string list;
    for (const auto& [name, type] : columnsOf("source", table))
      if (!except.count(name)) list += ", " + inDoubleQuotes(name);
    return list;
  }

  std::int64_t largest(const std::string& table) {
    return base_.execAndGet("SELECT ifnull(max(id), 0) FROM main." + table).getInt64();
  }

  /// Adds the experiments of the source. An experiment has all runs of a problem and variant. Its
  /// setup text ends with the descriptions of its planners.
  void addExperiments() {
    SQLite::Statement cells(
        base_,
        "SELECT s.experimentid, s.id, now FROM source.corridor_cells s JOIN cellOf ON was = "
        "s.id WHERE s.experimentid IS NOT NULL ORDER BY s.id");
    while (cells.executeStep())
      addExperiment(cells.getColumn(0).getInt64(), cells.getColumn(1).getInt64(),
                    cells.getColumn(2).getInt64());
  }
  void addExperiment(std::int64_t was, std::int64_t cellWas, std::int64_t cell) {
    SQLite::Statement mapped(base_, "SELECT now FROM experimentOf WHERE was = ?");
    mapped.bind(1, was);
    const bool isNew = !mapped.executeStep();
    std::int64_t now = isNew ? 0 : mapped.getColumn(0).getInt64();
    mapped.reset();
    if (isNew) {
      SQLite::Statement known(base_,
                              "SELECT o.experimentid FROM main.corridor_cells c JOIN "
                              "main.corridor_cells o USING (problem, variant) WHERE c.id = ? AND "
                              "o.experimentid IS NOT NULL");
      known.bind(1, cell);
      if (known.executeStep()) {
        now = known.getColumn(0).getInt64();
        execute(
            "UPDATE main.experiments SET totaltime = totaltime + (SELECT totaltime FROM "
            "source.experiments WHERE id = ?) WHERE id = ?",
            was, now);
      } else {
        now = copyExperiment(was);
      }
      execute("INSERT INTO experimentOf VALUES (?, ?)", was, now);
    }
    SQLite::Statement stored(base_, "SELECT experimentid FROM main.corridor_cells WHERE id = ?");
    stored.bind(1, cell);
    stored.executeStep();
    if (!stored.getColumn(0).isNull()) return;
    stored.reset();
    // This file is the first that has this planner. If the experiment was copied from an earlier
    // file, the experiment's setup text lacks the planner, so the planner's part is added.
    if (!copied_.count(now)) addPlannerSetup(cellWas, now);
    execute("UPDATE main.corridor_cells SET experimentid = ? WHERE id = ?", now, cell);
  }

  std::int64_t copyExperiment(std::int64_t was) {
    const std::string columns = listOf("experiments", {"id"});
    execute("INSERT INTO main.experiments (id" + columns + ") SELECT NULL" + columns +
                " FROM source.experiments WHERE id = ?",
            was);
    const std::int64_t now = base_.getLastInsertRowid();
    copied_.insert(now);
    const std::string name =
        base_.execAndGet("SELECT name FROM main.experiments WHERE id = " + std::to_string(now))
            .getString();
    for (int i = 2; isTaken(now); ++i)
      execute("UPDATE main.experiments SET name = ? WHERE id = ?", name + "-" + std::to_string(i),
              now);
    return now;
  }

  /// Returns whether another experiment has the same name as this one. (The variants "one pct" and
  /// "one_pct" have the same name in OMPL's tables.)
  bool isTaken(std::int64_t experiment) {
    SQLite::Statement other(base_,
                            "SELECT 1 FROM main.experiments a JOIN main.experiments b USING (name) "
                            "WHERE a.id = ? AND b.id <> a.id");
    other.bind(1, experiment);
    return other.executeStep();
  }

  void addPlannerSetup(std::int64_t cellWas, std::int64_t now) {
    // Runs of version 2 have OMPL's record within their own record.
    SQLite::Statement run(base_,
                          "SELECT ifnull(json_extract(setup, '$.setup'), json_extract(record, "
                          "'$.ompl.setup')) FROM source.corridor_runs LEFT JOIN "
                          "source.corridor_setups s ON s.id = setupid WHERE cellid = ? ORDER BY "
                          "runid LIMIT 1");
    run.bind(1, cellWas);
    if (run.executeStep())
      execute("UPDATE main.experiments SET setup = setup || ? WHERE id = ?",
              omplSetup(run.getColumn(0).getString()).second, now);
  }

  template <class... Values>
  void execute(const std::string& sql, const Values&... values) {
    SQLite::Statement statement(base_, sql);
    SQLite::bind(statement, values...);
    statement.exec();
  }

  const CampaignMerge& merge_;
  SQLite::Database base_;
  std::set<std::int64_t> copied_;  ///< experiments that were copied from this source
};

/// The seeds of a campaign: `first` to `end` − 1.
struct SeedRange {
  std::uint64_t first, end;
};

/// Returns the smallest range that contains all of the ranges. @pre there is at least one range.
/// @throws InputError if the returned range would contain a seed that none of the ranges has,
/// because the seeds of a campaign have no gap.
SeedRange joinedSeeds(std::vector<SeedRange> ranges, const fs::path& file) {
  std::sort(ranges.begin(), ranges.end(),
            [](const SeedRange& a, const SeedRange& b) { return a.first < b.first; });
  SeedRange all = ranges.front();
  for (const SeedRange& range : ranges) {
    if (range.first > all.end)
      refuseFile(file, "can't be merged with the others: none of them is for the seeds from " +
                           std::to_string(all.end) + " to " + std::to_string(range.first - 1) +
                           ", and a campaign has seeds without a gap");
    all.end = std::max(all.end, range.end);
  }
  return all;
}

/// Does a step of the merge. A fault of reading becomes an InputError that names the source file.
/// All other exceptions are passed on, for the caller to attribute them to the new file.
void withSourceInErrors(const fs::path& source, const std::function<void()>& step) {
  try {
    step();
  } catch (const SQLite::Exception& error) {
    const std::set<int> ofSource{SQLITE_NOTADB, SQLITE_BUSY, SQLITE_LOCKED, SQLITE_CANTOPEN,
                                 SQLITE_CORRUPT};
    if (!ofSource.count(error.getErrorCode())) throw;
    withFileInErrors(source, [&] { throw error; });
  }
}

}  // namespace

CampaignMerge readCampaigns(const std::vector<fs::path>& sources) {
  CampaignMerge merge;
  std::vector<SeedRange> seeds;
  for (const fs::path& source : sources) {
    const fs::path file = databaseIn(source);
    withFileInErrors(file, [&] {
      SQLite::Database base(file.string(), SQLite::OPEN_READWRITE);
      const int version = requireCampaignFile(base, file);
      Campaign campaign = recordedIn(base, version, file);
      if (merge.files.empty()) merge.campaign = campaign;
      requireSameCells(base, file, merge.campaign,
                       merge.files.empty() ? file : merge.files.front());
      seeds.push_back({campaign.seed, campaign.seed + campaign.runs});
      for (const std::string& note : campaign.notes)
        if (std::find(merge.campaign.notes.begin(), merge.campaign.notes.end(), note) ==
            merge.campaign.notes.end())
          merge.campaign.notes.push_back(note);
    });
    merge.files.push_back(file);
  }
  const SeedRange all = joinedSeeds(std::move(seeds), merge.files.front());
  merge.campaign.seed = all.first;
  merge.campaign.runs = all.end - all.first;
  merge.campaign.shard = {};
  return merge;
}

void mergeInto(const CampaignMerge& merge, const fs::path& file) {
  const fs::path part = file.string() + ".part";
  removeDatabase(part);
  try {
    {
      std::vector<CampaignCell> cells = cellsOf(merge.campaign);
      CampaignDatabase(part, CampaignDatabase::Mode::fresh, merge.campaign, cells);
    }
    withFileInErrors(
        file,
        [&] {
          Merger merger(merge, part);
          for (const fs::path& source : merge.files)
            withSourceInErrors(source, [&] { merger.add(source); });
          merger.finish();
        },
        "nothing is merged");
    renameDatabase(part, file);
  } catch (...) {
    removeDatabase(part);
    throw;
  }
}

}  // namespace corridor
