#include "planner/benchmark/campaign_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <map>
#include <optional>
#include <set>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "planner/benchmark/build_commit.h"
#include "planner/benchmark/campaign_record.h"
#include "planner/benchmark/campaign_spec.h"
#include "planner/benchmark/database_file.h"
#include "planner/benchmark/database_statements.h"
#include "planner/benchmark/ompl_log.h"
#include "planner/benchmark/run_record.h"

namespace corridor {
namespace {

/// OMPL's tables, word for word as `ompl_benchmark_statistics` 1.5.2 creates them, and Corridor's
/// tables. A column of OMPL's table `runs` is added when a run first has a value for it.
constexpr const char* kTables = R"(
CREATE TABLE experiments (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512),
  totaltime REAL, timelimit REAL, memorylimit REAL, runcount INTEGER, version VARCHAR(128),
  hostname VARCHAR(1024), cpuinfo TEXT, date DATETIME, seed VARCHAR(24), setup TEXT);
CREATE TABLE plannerConfigs (id INTEGER PRIMARY KEY AUTOINCREMENT, name VARCHAR(512) NOT NULL,
  settings TEXT);
CREATE TABLE enums (name VARCHAR(512), value INTEGER, description TEXT, PRIMARY KEY (name, value));
CREATE TABLE runs (id INTEGER PRIMARY KEY AUTOINCREMENT, experimentid INTEGER, plannerid INTEGER,
  FOREIGN KEY (experimentid) REFERENCES experiments(id) ON DELETE CASCADE,
  FOREIGN KEY (plannerid) REFERENCES plannerConfigs(id) ON DELETE CASCADE);
CREATE TABLE progress (runid INTEGER, time REAL, PRIMARY KEY (runid, time),
  FOREIGN KEY (runid) REFERENCES runs(id) ON DELETE CASCADE);

CREATE TABLE corridor_cells (id INTEGER PRIMARY KEY, problem TEXT, variant TEXT, planner TEXT,
  spec TEXT, experimentid INTEGER, UNIQUE (problem, variant, planner));
CREATE TABLE corridor_runs (cellid INTEGER, seed INTEGER, runid INTEGER UNIQUE, sessionid INTEGER,
  record TEXT, PRIMARY KEY (cellid, seed));
CREATE TABLE corridor_sessions (id INTEGER PRIMARY KEY, started DATETIME, version TEXT,
  "commit" TEXT, jobs INTEGER);
)";
/// The table of the campaign itself. Its keys are `record` (campaign_record.h) and `shard` (such as
/// "2/3", or "" for all runs). Databases of earlier versions don't have this table.
constexpr const char* kCampaignTable =
    "CREATE TABLE IF NOT EXISTS corridor_campaign (key TEXT PRIMARY KEY, value TEXT)";
/// The columns `record`, `ompl` and `setup` are the members `figures`, `ompl` and `setup` of a
/// RunRecord. For runs stored by version 2, `record` holds the whole run, and `setupid` and `ompl`
/// are NULL.
constexpr const char* kSetups = R"(
CREATE TABLE corridor_setups (id INTEGER PRIMARY KEY, setup TEXT UNIQUE);
ALTER TABLE corridor_runs ADD setupid INTEGER;
ALTER TABLE corridor_runs ADD ompl TEXT;
)";

}  // namespace

class CampaignDatabase::Tables {
 public:
  Tables(const std::filesystem::path& file, Mode mode, const Campaign& campaign,
         std::vector<CampaignCell>& cells, std::size_t jobs)
      : file_(file), campaign_(campaign), cells_(cellsOf(campaign)) {
    withFileInErrors([&] {
      std::error_code ignored;
      const bool there = std::filesystem::exists(file, ignored);
      base_ = std::make_unique<SQLite::Database>(file.string(),
                                                 SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
      rows_.emplace(*base_);
      base_->exec("PRAGMA locking_mode = EXCLUSIVE");
      base_->exec("PRAGMA foreign_keys = ON");
      // From here on no other process can read or write the file.
      base_->exec("BEGIN EXCLUSIVE");
      if (!there || isEmpty())
        makeTables();
      else
        checkTables(mode);
      storeCampaign();
      matchCells(cells);
      beginSession(jobs);
      base_->exec("COMMIT");
      keepLog();
    });
  }
  Tables(const Tables&) = delete;
  Tables& operator=(const Tables&) = delete;
  /// Makes SQLite merge its log into the database and remove it. Programs can then read the
  /// database without write access to its folder.
  ~Tables() {
    rows_.reset();
    base_->tryExec("PRAGMA journal_mode = DELETE");  // if this fails, the next session does it
  }

  std::vector<CampaignSession> sessions() {
    std::vector<CampaignSession> all;
    withFileInErrors([&] {
      SQLite::Statement rows(*base_,
                             "SELECT started, \"commit\", jobs, count(*) FROM corridor_sessions s "
                             "JOIN corridor_runs ON sessionid = s.id GROUP BY s.id ORDER BY s.id");
      while (rows.executeStep())
        all.push_back({rows.getColumn(0).getString(), rows.getColumn(1).getString(),
                       static_cast<std::size_t>(rows.getColumn(2).getInt64()),
                       static_cast<std::size_t>(rows.getColumn(3).getInt64())});
    });
    return all;
  }

  void add(std::size_t cell, const BenchmarkRun& run) {
    if (together_) return insert(cell, run);
    inTransaction([&] { insert(cell, run); });
  }
  void addTogether(const std::function<void()>& adds) {
    inTransaction([&] {
      together_ = true;
      adds();
    });
  }

  void forEachRun(std::size_t cell, const std::function<void(const BenchmarkRun&)>& visit) {
    withFileInErrors([&] {
      SQLite::Statement runs(*base_,
                             "SELECT record, ompl, setupid FROM corridor_runs WHERE cellid = ? "
                             "ORDER BY seed");
      runs.bind(1, cellIds_[cell]);
      while (runs.executeStep())
        visit(readRecord(runs.getColumn(0).getString(), runs.getColumn(1).getString(),
                         *setup(runs.getColumn(2))));
    });
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const { refuseFile(file_, why); }

  template <class Step>
  void withFileInErrors(const Step& step) const {
    corridor::withFileInErrors(file_, step);
  }

  template <class... Values>
  std::int64_t execute(const std::string& sql, const Values&... values) {
    return rows_->execute(sql, values...);
  }
  /// Executes a step in a transaction: all changes of the step are made, or none if the step
  /// throws.
  template <class Step>
  void inTransaction(const Step& step) {
    withFileInErrors([&] {
      try {
        SQLite::Transaction transaction(*base_);
        step();
        transaction.commit();
      } catch (...) {
        // The rows and columns that the transaction added are gone, but their ids and names may be
        // cached here.
        rows_->forget();
        known_ = {};
        together_ = false;
        throw;
      }
      together_ = false;
    });
  }
  /// Makes SQLite write runs first to a log beside the file. If the process is killed, no run is
  /// lost; if the machine loses power, the last runs may be. The file is consistent in both cases,
  /// and a run does not wait for the disk (https://sqlite.org/pragma.html#pragma_synchronous).
  /// SQLite needs no shared memory for the log, since no other process has the file open. If the
  /// file system does not support such a log, SQLite keeps its usual journal, and each run waits.
  void keepLog() {
    if (base_->execAndGet("PRAGMA journal_mode = WAL").getString() == "wal")
      base_->exec("PRAGMA synchronous = NORMAL");
  }
  void bindNames(SQLite::Statement& statement, const CampaignCell& cell) const {
    SQLite::bind(statement, campaign_.problemNames[cell.problem],
                 campaign_.variants[cell.variant].name, cell.planner.label);
  }
  bool isEmpty() { return base_->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0; }

  void makeTables() {
    base_->exec(kTables);
    base_->exec(kSetups);
    base_->exec("PRAGMA application_id = " + std::to_string(kCampaignApplication));
    base_->exec("PRAGMA user_version = " + std::to_string(kCampaignVersion));
    int value = 0;
    for (const std::string& status : omplStatusNames())
      execute("INSERT INTO enums VALUES ('status', ?, ?)", value++, status);
  }

  void checkTables(Mode mode) {
    const int version = requireCampaignFile(*base_, file_);
    const int runs = base_->execAndGet("SELECT count(*) FROM corridor_runs").getInt();
    if (mode == Mode::fresh && runs > 0)
      refuse("contains " + std::to_string(runs) + (runs == 1 ? " run" : " runs") +
             " already; name another folder, or call benchmark CAMPAIGN --resume, which continues "
             "them");
    if (version == kCampaignVersion) return;
    base_->exec(kSetups);
    base_->exec("PRAGMA user_version = " + std::to_string(kCampaignVersion));
  }

  /// Stores the campaign's shard, and the data on the campaign that reports need. @throws
  /// InputError if the file has runs of another shard.
  void storeCampaign() {
    base_->exec(kCampaignTable);
    const std::string shard = campaign_.shard ? text(*campaign_.shard) : "";
    SQLite::Statement known(*base_, "SELECT value FROM corridor_campaign WHERE key = 'shard'");
    const std::string was = known.executeStep() ? known.getColumn(0).getString() : "";
    const bool empty = base_->execAndGet("SELECT count(*) FROM corridor_runs").getInt() == 0;
    if (!empty && was.empty() && !shard.empty())
      refuse("contains runs of the whole campaign, not of shard " + shard +
             " only; leave out --shard, or name another folder");
    if (!empty && was != shard)
      refuse("contains shard " + was + " of the runs; continue with --shard " + was +
             ", or name another folder");
    known.reset();
    execute("REPLACE INTO corridor_campaign VALUES ('shard', ?), ('record', ?)", shard,
            recordOf(campaign_));
  }

  /// Compares the file's cells with the campaign's, adds missing cells to the file, and copies the
  /// file's runs into `cells`.
  void matchCells(std::vector<CampaignCell>& cells) {
    std::set<std::int64_t> ids;
    RunTrimmer trimmer;
    for (std::size_t index = 0; index < cells.size(); ++index) {
      CampaignCell& cell = cells[index];
      SQLite::Statement known(*base_,
                              "SELECT id, spec FROM corridor_cells WHERE problem = ? AND "
                              "variant = ? AND planner = ?");
      bindNames(known, cell);
      const std::string spec = specOf(campaign_, cell);
      if (!known.executeStep()) {
        cellIds_.push_back(execute(
            "INSERT INTO corridor_cells (problem, variant, planner, spec) VALUES (?, ?, ?, ?)",
            campaign_.problemNames[cell.problem], campaign_.variants[cell.variant].name,
            cell.planner.label, spec));
        ids.insert(cellIds_.back());
        continue;
      }
      const std::int64_t id = known.getColumn(0).getInt64();
      const std::string was = known.getColumn(1).getString();
      ids.insert(id);
      cellIds_.push_back(id);
      readRuns(id, index, cells, trimmer);
      if (was == spec) continue;
      if (!cell.runs.empty())
        refuse(cellName(campaign_, cell) + " was measured with other settings: " +
               changeOf(was, spec) + "; name another folder");
      known.reset();
      execute("UPDATE corridor_cells SET spec = ? WHERE id = ?", spec, id);
    }
    SQLite::Statement others(*base_,
                             "SELECT id, problem, variant, planner FROM corridor_cells c "
                             "WHERE EXISTS (SELECT 1 FROM corridor_runs WHERE cellid = c.id)");
    while (others.executeStep())
      if (!ids.count(others.getColumn(0).getInt64()))
        refuse("contains runs of " + others.getColumn(1).getString() + ", " +
               others.getColumn(2).getString() + ", " + others.getColumn(3).getString() +
               ", which the campaign doesn't have; name another folder");
  }
  void readRuns(std::int64_t id, std::size_t index, std::vector<CampaignCell>& cells,
                RunTrimmer& trimmer) {
    CampaignCell& cell = cells[index];
    SQLite::Statement runs(
        *base_, "SELECT record, setupid FROM corridor_runs WHERE cellid = ? ORDER BY seed");
    runs.bind(1, id);
    while (runs.executeStep()) {
      BenchmarkRun run = readRun(runs.getColumn(0).getString());
      if (!hasRun(campaign_, index, cells.size(), run.seed))
        refuse("contains a run of seed " + std::to_string(run.seed) + " of " +
               cellName(campaign_, cell) + ", which the campaign" +
               (campaign_.shard ? "'s shard" : "") + " doesn't have; name another folder");
      if (!runs.getColumn(1).isNull()) run.ompl = setup(runs.getColumn(1));
      trimmer.trim(run);
      cell.runs.push_back(std::move(run));
    }
  }
  /// Returns the parts of OMPL's record that many runs share. Returns an empty record if the id is
  /// NULL.
  std::shared_ptr<const OmplRecord> setup(const SQLite::Column& id) {
    if (id.isNull()) return noOmplRecord();
    auto& known = setups_[id.getInt64()];
    if (!known) {
      SQLite::Statement row(*base_, "SELECT setup FROM corridor_setups WHERE id = ?");
      row.bind(1, id.getInt64());
      if (!row.executeStep()) refuse("is damaged: a row of corridor_setups is missing");
      known = std::make_shared<const OmplRecord>(readSetup(row.getColumn(0).getString()));
    }
    return known;
  }
  static std::string changeOf(const std::string& spec, const std::string& now) {
    const auto [key, was, is] = specDifference(spec, now);
    return key + " was " + was + " and is now " + is;
  }

  void beginSession(std::size_t jobs) {
    execute("UPDATE experiments SET runcount = ?", static_cast<std::int64_t>(campaign_.runs));
    session_ = execute(
        "INSERT INTO corridor_sessions (started, version, \"commit\", jobs) VALUES "
        "(datetime('now'), ?, ?, ?)",
        std::string(CORRIDOR_VERSION), std::string(buildCommit()), static_cast<std::int64_t>(jobs));
  }

  void insert(std::size_t cell, const BenchmarkRun& run) {
    const CampaignCell& stored = cells_[cell];
    const auto [experiment, isNew] = known_.experiments.try_emplace(cell);
    if (isNew) {
      experiment->second = experimentOf(cell, run);
      execute("UPDATE corridor_cells SET experimentid = ? WHERE id = ?", experiment->second,
              cellIds_[cell]);
    }
    const RunRecord record = recordOf(run);
    const std::int64_t runId = rows_->addRow(
        "runs", omplProperties(campaign_, stored, run),
        {{"experimentid", experiment->second}, {"plannerid", plannerOf(stored, run)}});
    addProgress(run, runId);
    execute("UPDATE experiments SET totaltime = totaltime + ? WHERE id = ?",
            run.time + run.verificationTime, experiment->second);
    execute(
        "INSERT INTO corridor_runs (cellid, seed, runid, sessionid, record, setupid, ompl) VALUES "
        "(?, ?, ?, ?, ?, ?, ?)",
        cellIds_[cell], static_cast<std::int64_t>(run.seed), runId, session_, record.figures,
        setupOf(record.setup), record.ompl);
  }

  /// Returns the id of the cell's experiment. Adds the experiment if the file does not have it.
  std::int64_t experimentOf(std::size_t cell, const BenchmarkRun& run) {
    SQLite::Statement known(*base_,
                            "SELECT experimentid FROM corridor_cells WHERE id = ? AND "
                            "experimentid IS NOT NULL");
    known.bind(1, cellIds_[cell]);
    return known.executeStep() ? known.getColumn(0).getInt64() : addExperiment(cells_[cell], run);
  }
  std::int64_t addExperiment(const CampaignCell& cell, const BenchmarkRun& run) {
    // The experiment of this problem and variant may exist already, added with another planner. It
    // is not looked up by name, since the variants "one pct" and "one_pct" have the same name in
    // OMPL's tables.
    SQLite::Statement known(*base_,
                            "SELECT experimentid FROM corridor_cells WHERE problem = ? AND "
                            "variant = ? AND experimentid IS NOT NULL");
    SQLite::bind(known, campaign_.problemNames[cell.problem],
                 campaign_.variants[cell.variant].name);
    const auto [ofProblem, ofPlanner] = omplSetup(run.ompl->setup);
    if (known.executeStep()) {
      const std::int64_t id = known.getColumn(0).getInt64();
      execute("UPDATE experiments SET setup = setup || ? WHERE id = ?", ofPlanner, id);
      return id;
    }
    const Problem& problem = campaign_.problems[cell.problem];
    const std::int64_t id = execute(
        "INSERT INTO experiments (name, totaltime, timelimit, memorylimit, runcount, version, "
        "hostname, cpuinfo, date, seed, setup) VALUES (?, 0, ?, ?, ?, ?, ?, ?, datetime('now'), ?, "
        "?)",
        freeName(omplExperimentName(campaign_, cell)),
        campaign_.time.value_or(problem.settings.planner.time), campaign_.limits.memory,
        static_cast<std::int64_t>(campaign_.runs), "OMPL " + versionOfOmpl(), run.ompl->host,
        run.ompl->cpu, std::to_string(campaign_.seed), ofProblem + ofPlanner);
    for (const auto& [words, value] : omplParameters(campaign_, cell))
      rows_->setValue("experiments", id, words, value);
    return id;
  }

  /// Returns a name that no experiment has yet: NAME or "NAME-2".
  std::string freeName(const std::string& name) {
    SQLite::Statement taken(*base_, "SELECT 1 FROM experiments WHERE name = ?");
    std::string free = name;
    for (int i = 2;; ++i) {
      taken.bind(1, free);
      if (!taken.executeStep()) return free;
      taken.reset();
      free = name + "-" + std::to_string(i);
    }
  }

  std::int64_t plannerOf(const CampaignCell& cell, const BenchmarkRun& run) {
    const std::string name = omplPlannerName(cell, *run.ompl);
    std::string settings;
    for (const auto& [key, value] : run.ompl->settings) settings += key + " = " + value + "\n;";
    const auto [id, isNew] = known_.planners.try_emplace({name, settings});
    if (!isNew) return id->second;
    SQLite::Statement known(*base_,
                            "SELECT id FROM plannerConfigs WHERE name = ? AND settings = ?");
    SQLite::bind(known, name, settings);
    return id->second = known.executeStep()
                            ? known.getColumn(0).getInt64()
                            : execute("INSERT INTO plannerConfigs (name, settings) VALUES (?, ?)",
                                      name, settings);
  }

  std::int64_t setupOf(const std::string& setup) {
    const auto [id, isNew] = known_.setups.try_emplace(setup);
    if (!isNew) return id->second;
    SQLite::Statement known(*base_, "SELECT id FROM corridor_setups WHERE setup = ?");
    known.bind(1, setup);
    return id->second = known.executeStep()
                            ? known.getColumn(0).getInt64()
                            : execute("INSERT INTO corridor_setups (setup) VALUES (?)", setup);
  }

  void addProgress(const BenchmarkRun& run, std::int64_t runId) {
    // If samples have the same time, only the first is stored, as by OMPL's script.
    std::set<std::string> times;
    for (const auto& sample : run.ompl->progress)
      if (const auto time = sample.find("time REAL");
          time == sample.end() || times.insert(time->second).second)
        rows_->addRow("progress", sample, {{"runid", runId}});
  }

  std::filesystem::path file_;
  const Campaign& campaign_;
  const std::vector<CampaignCell> cells_;  // without runs
  std::unique_ptr<SQLite::Database> base_;
  std::optional<DatabaseStatements> rows_;
  std::int64_t session_ = 0;
  std::vector<std::int64_t> cellIds_;
  /// Ids of rows that the file has, as far as this object has read or added them.
  struct Known {
    std::map<std::size_t, std::int64_t> experiments;  // by cell
    std::map<std::pair<std::string, std::string>, std::int64_t> planners;
    std::map<std::string, std::int64_t> setups;
  } known_;
  std::map<std::int64_t, std::shared_ptr<const OmplRecord>> setups_;  // setups read so far, by id
  bool together_ = false;  // whether a transaction of several runs is under way
};

CampaignDatabase::CampaignDatabase(const std::filesystem::path& file, Mode mode,
                                   const Campaign& campaign, std::vector<CampaignCell>& cells,
                                   std::size_t jobs)
    : tables_(std::make_unique<Tables>(file, mode, campaign, cells, jobs)) {}
CampaignDatabase::~CampaignDatabase() = default;

void CampaignDatabase::add(std::size_t cell, const BenchmarkRun& run) {
  tables_->add(cell, run);
}

void CampaignDatabase::addTogether(const std::function<void()>& adds) {
  tables_->addTogether(adds);
}

RunSource CampaignDatabase::runs() const {
  return [this](std::size_t cell, const std::function<void(const BenchmarkRun&)>& visit) {
    tables_->forEachRun(cell, visit);
  };
}

std::vector<CampaignSession> CampaignDatabase::sessions() const {
  return tables_->sessions();
}

}  // namespace corridor
