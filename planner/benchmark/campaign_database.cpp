#include "planner/benchmark/campaign_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <SQLiteCpp/VariadicBind.h>
#include <algorithm>
#include <set>
#include <sqlite3.h>
#include <sys/resource.h>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/benchmark/build_commit.h"
#include "planner/benchmark/csv_text.h"
#include "planner/benchmark/ompl_log.h"

namespace corridor {
namespace {

/// "corr" marks our files (PRAGMA application_id); the second number is the version of our tables.
constexpr int kApplication = 0x636f7272, kVersion = 2;

/// OMPL's tables, word for word as `ompl_benchmark_statistics` 1.5.2 creates them, and ours. OMPL's
/// columns of runs are added when a run first has them.
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

/// The name and the type of a column, from OMPL's words: "graph states INTEGER" is the column
/// graph_states of type INTEGER.
struct ColumnName {
  std::string name, type;
  explicit ColumnName(const std::string& words) {
    const auto blank = words.rfind(' ');
    name = words.substr(0, blank);
    type = blank == std::string::npos ? "TEXT" : words.substr(blank + 1);
    std::replace(name.begin(), name.end(), ' ', '_');
  }
};

/// Returns all limits as a text of numbers.
std::string limitsText(const JointLimits& limits) {
  std::string text;
  for (const Configuration* each : {&limits.velocity, &limits.acceleration, &limits.jerk}) {
    for (const double value : *each) text += shortest(value) + " ";
    text += "| ";
  }
  for (const LinkSpeed& link : limits.links) text += link.link + ": " + shortest(link.speed) + " ";
  text.pop_back();
  return text;
}

/// Reports whether OMPL's script stores a value as NULL.
bool isNull(const std::string& value) {
  return value.empty() || value == "nan" || value == "inf" || value == "-nan" || value == "-inf";
}

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
      base_->exec("PRAGMA locking_mode = EXCLUSIVE");
      base_->exec("PRAGMA foreign_keys = ON");
      // From here on no other process can read or write the file.
      base_->exec("BEGIN EXCLUSIVE");
      if (!there || isEmpty())
        makeTables();
      else
        checkTables(mode);
      matchCells(cells);
      beginSession(jobs);
      base_->exec("COMMIT");
    });
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
    withFileInErrors([&] {
      columns_.clear();  // a failed transaction may have removed columns again
      SQLite::Transaction transaction(*base_);
      const CampaignCell& stored = cells_[cell];
      SQLite::Statement known(*base_,
                              "SELECT id, experimentid FROM corridor_cells WHERE problem = ? "
                              "AND variant = ? AND planner = ?");
      bindNames(known, stored);
      known.executeStep();
      const std::int64_t cellId = known.getColumn(0).getInt64();
      const std::int64_t experiment =
          known.getColumn(1).isNull() ? addExperiment(stored, run) : known.getColumn(1).getInt64();
      known.reset();
      const std::int64_t runId = addRun(stored, run, experiment, plannerOf(stored, run));
      addProgress(run, runId);
      execute("UPDATE corridor_cells SET experimentid = ? WHERE id = ?", experiment, cellId);
      execute("UPDATE experiments SET totaltime = totaltime + ? WHERE id = ?",
              run.time + run.verificationTime, experiment);
      execute("INSERT INTO corridor_runs VALUES (?, ?, ?, ?, ?)", cellId,
              static_cast<std::int64_t>(run.seed), runId, session_, text(run));
      transaction.commit();
    });
  }

 private:
  [[noreturn]] void refuse(const std::string& why) const {
    throw InputError(Fault{file_.string(), 0, why});
  }

  /// Turns SQLite's exceptions into InputError, since users can mend the cause, such as a full disk
  /// or a file of another program.
  template <class Step>
  void withFileInErrors(const Step& step) const {
    try {
      step();
    } catch (const nlohmann::json::exception& error) {  // the stored JSON is damaged
      refuse("is damaged: " + std::string(error.what()));
    } catch (const SQLite::Exception& error) {
      const std::string kept = "finished runs are kept; continue with --resume";
      switch (error.getErrorCode()) {
        case SQLITE_NOTADB:
          refuse("is not a campaign database");
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
          refuse("is in use by another process");
        case SQLITE_CANTOPEN:
          refuse("can't be created or opened");
        case SQLITE_READONLY:
          refuse("can't be written to");
        case SQLITE_FULL:
          refuse("can't be written: the disk is full; " + kept);
        case SQLITE_IOERR:
          refuse("can't be read or written: " + std::string(error.what()) + sizeLimit() + "; " +
                 kept);
        case SQLITE_CORRUPT:
          refuse("is damaged: " + std::string(error.what()));
        default:
          refuse("can't be read or written: " + std::string(error.what()));
      }
    }
  }

  /// Returns a note on the limit of file sizes, or "" if there is no limit. SQLite's error code
  /// does not distinguish this limit from a failing disk.
  static std::string sizeLimit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_FSIZE, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return "";
    return " (no file may be larger than " + std::to_string(limit.rlim_cur) + " bytes: ulimit -f)";
  }

  template <class... Values>
  std::int64_t execute(const std::string& sql, const Values&... values) {
    SQLite::Statement statement(*base_, sql);
    SQLite::bind(statement, values...);
    statement.exec();
    return base_->getLastInsertRowid();
  }
  void bindNames(SQLite::Statement& statement, const CampaignCell& cell) const {
    SQLite::bind(statement, campaign_.problemNames[cell.problem],
                 campaign_.variants[cell.variant].name, cell.planner.label);
  }
  bool isEmpty() { return base_->execAndGet("SELECT count(*) FROM sqlite_master").getInt() == 0; }

  void makeTables() {
    base_->exec(kTables);
    base_->exec("PRAGMA application_id = " + std::to_string(kApplication));
    base_->exec("PRAGMA user_version = " + std::to_string(kVersion));
    int value = 0;
    for (const std::string& status : omplStatusNames())
      execute("INSERT INTO enums VALUES ('status', ?, ?)", value++, status);
  }

  void checkTables(Mode mode) {
    if (base_->execAndGet("PRAGMA application_id").getInt() != kApplication)
      refuse("is a database, but not of a campaign");
    if (const int version = base_->execAndGet("PRAGMA user_version").getInt(); version != kVersion)
      refuse("is a campaign database of version " + std::to_string(version) +
             "; this program needs version " + std::to_string(kVersion) + "; name another folder");
    if (const std::string check = base_->execAndGet("PRAGMA quick_check(1)").getString();
        check != "ok")
      refuse("is damaged: " + check);
    const int runs = base_->execAndGet("SELECT count(*) FROM corridor_runs").getInt();
    if (mode == Mode::fresh && runs > 0)
      refuse("contains " + std::to_string(runs) + (runs == 1 ? " run" : " runs") +
             " already; continue with --resume, or name another folder");
  }

  /// Compares the file's cells with the campaign's, and moves the file's runs into `cells`.
  void matchCells(std::vector<CampaignCell>& cells) {
    std::set<std::int64_t> ids;
    for (CampaignCell& cell : cells) {
      SQLite::Statement known(*base_,
                              "SELECT id, spec FROM corridor_cells WHERE problem = ? AND "
                              "variant = ? AND planner = ?");
      bindNames(known, cell);
      const std::string spec = specOf(campaign_, cell);
      if (!known.executeStep()) {
        ids.insert(execute(
            "INSERT INTO corridor_cells (problem, variant, planner, spec) VALUES (?, ?, ?, ?)",
            campaign_.problemNames[cell.problem], campaign_.variants[cell.variant].name,
            cell.planner.label, spec));
        continue;
      }
      const std::int64_t id = known.getColumn(0).getInt64();
      const std::string was = known.getColumn(1).getString();
      ids.insert(id);
      readRuns(id, cell);
      if (was == spec) continue;
      if (!cell.runs.empty())
        refuse(cellName(cell) + " was measured with other settings: " + difference(was, spec) +
               "; name another folder");
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
  void readRuns(std::int64_t id, CampaignCell& cell) {
    SQLite::Statement runs(*base_,
                           "SELECT record FROM corridor_runs WHERE cellid = ? ORDER BY seed");
    runs.bind(1, id);
    while (runs.executeStep()) {
      BenchmarkRun run = readRun(runs.getColumn(0).getString());
      if (run.seed < campaign_.seed || run.seed >= campaign_.seed + campaign_.runs)
        refuse("contains a run of seed " + std::to_string(run.seed) + " of " + cellName(cell) +
               ", which the campaign doesn't have; name another folder");
      cell.runs.push_back(std::move(run));
    }
  }
  std::string cellName(const CampaignCell& cell) const {
    return campaign_.problemNames[cell.problem] + ", " + campaign_.variants[cell.variant].name +
           ", " + cell.planner.label;
  }
  /// Describes the first key whose values differ.
  static std::string difference(const std::string& was, const std::string& is) {
    const auto a = nlohmann::json::parse(was), b = nlohmann::json::parse(is);
    for (const auto& [key, value] : b.items())
      if (!a.contains(key) || a[key] != value)
        return key + " was " + (a.contains(key) ? a[key].dump() : "not set") + " and is now " +
               value.dump();
    for (const auto& [key, value] : a.items())
      if (!b.contains(key)) return key + " was " + value.dump() + " and is now not set";
    return was;
  }

  void beginSession(std::size_t jobs) {
    execute("UPDATE experiments SET runcount = ?", static_cast<std::int64_t>(campaign_.runs));
    session_ = execute(
        "INSERT INTO corridor_sessions (started, version, \"commit\", jobs) VALUES "
        "(datetime('now'), ?, ?, ?)",
        std::string(CORRIDOR_VERSION), std::string(buildCommit()), static_cast<std::int64_t>(jobs));
  }

  std::int64_t addExperiment(const CampaignCell& cell, const BenchmarkRun& run) {
    // Another planner may have added the experiment of this problem and variant. Experiments are
    // not found by name, since "one pct" and "one_pct" have the same name in OMPL's tables.
    SQLite::Statement known(*base_,
                            "SELECT experimentid FROM corridor_cells WHERE problem = ? AND "
                            "variant = ? AND experimentid IS NOT NULL");
    SQLite::bind(known, campaign_.problemNames[cell.problem],
                 campaign_.variants[cell.variant].name);
    const auto [ofProblem, ofPlanner] = omplSetup(run.ompl.setup);
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
        static_cast<std::int64_t>(campaign_.runs), "OMPL " + versionOfOmpl(), run.ompl.host,
        run.ompl.cpu, std::to_string(campaign_.seed), ofProblem + ofPlanner);
    for (const auto& [words, value] : omplParameters(campaign_, cell)) {
      const ColumnName column(words);
      addColumn("experiments", column);
      execute("UPDATE experiments SET " + inDoubleQuotes(column.name) + " = ? WHERE id = ?", value,
              id);
    }
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
    const std::string name = omplPlannerName(cell, run.ompl);
    std::string settings;
    for (const auto& [key, value] : run.ompl.settings) settings += key + " = " + value + "\n;";
    SQLite::Statement known(*base_,
                            "SELECT id FROM plannerConfigs WHERE name = ? AND settings = ?");
    SQLite::bind(known, name, settings);
    if (known.executeStep()) return known.getColumn(0).getInt64();
    return execute("INSERT INTO plannerConfigs (name, settings) VALUES (?, ?)", name, settings);
  }

  std::int64_t addRun(const CampaignCell& cell, const BenchmarkRun& run, std::int64_t experiment,
                      std::int64_t planner) {
    return addRow("runs", omplProperties(campaign_, cell, run),
                  {{"experimentid", experiment}, {"plannerid", planner}});
  }
  void addProgress(const BenchmarkRun& run, std::int64_t runId) {
    std::set<std::string> times;  // the first sample of each time is kept, as by OMPL's script
    for (const auto& sample : run.ompl.progress)
      if (const auto time = sample.find("time REAL");
          time == sample.end() || times.insert(time->second).second)
        addRow("progress", sample, {{"runid", runId}});
  }

  std::int64_t addRow(const std::string& table,
                      const std::map<std::string, std::string>& properties,
                      const std::vector<std::pair<std::string, std::int64_t>>& ids) {
    std::string names, marks;
    for (const auto& [name, id] : ids) names += "," + name, marks += ",?";
    for (const auto& [words, value] : properties) {
      const ColumnName column(words);
      addColumn(table, column);
      names += "," + inDoubleQuotes(column.name), marks += ",?";
    }
    SQLite::Statement row(*base_, "INSERT INTO " + table + " (" + names.substr(1) + ") VALUES (" +
                                      marks.substr(1) + ")");
    int at = 0;
    for (const auto& [name, id] : ids) row.bind(++at, id);
    for (const auto& [words, value] : properties) {
      ++at;
      if (!isNull(value)) row.bind(at, value);  // SQLite converts it to the column's type
    }
    row.exec();
    return base_->getLastInsertRowid();
  }
  void addColumn(const std::string& table, const ColumnName& column) {
    if (columns_.empty())
      for (const char* name : {"experiments", "runs", "progress"}) {
        SQLite::Statement known(*base_, std::string("PRAGMA table_info(") + name + ")");
        while (known.executeStep()) columns_.insert({name, known.getColumn(1).getString()});
      }
    if (!columns_.insert({table, column.name}).second) return;
    base_->exec("ALTER TABLE " + table + " ADD " + inDoubleQuotes(column.name) + " " + column.type);
  }

  std::filesystem::path file_;
  const Campaign& campaign_;
  const std::vector<CampaignCell> cells_;  // without runs
  std::unique_ptr<SQLite::Database> base_;
  std::int64_t session_ = 0;
  std::set<std::pair<std::string, std::string>> columns_;  // columns that exist, by table
};

CampaignDatabase::CampaignDatabase(const std::filesystem::path& file, Mode mode,
                                   const Campaign& campaign, std::vector<CampaignCell>& cells,
                                   std::size_t jobs)
    : tables_(std::make_unique<Tables>(file, mode, campaign, cells, jobs)) {}
CampaignDatabase::~CampaignDatabase() = default;

void CampaignDatabase::add(std::size_t cell, const BenchmarkRun& run) {
  tables_->add(cell, run);
}

std::vector<CampaignSession> CampaignDatabase::sessions() const {
  return tables_->sessions();
}

std::string specOf(const Campaign& campaign, const CampaignCell& cell) {
  const Problem planned = plannedProblem(campaign, cell, 0);
  nlohmann::ordered_json checker = nlohmann::ordered_json::object();
  for (const YamlValue::Entry& entry : campaign.variants[cell.variant].checker.entries)
    checker[entry.key] = entry.value.text;
  if (campaign.variants[cell.variant].competitor)
    checker["peer"] = campaign.variants[cell.variant].competitor->name;
  // In earlier versions `true` was another simplifier. Runs of the two must not be mixed.
  const bool isOwn = planned.settings.simplify == Simplifier::corridor;
  const std::string simplify = isOwn ? "corridor" : wordOf(planned.settings.simplify);
  nlohmann::ordered_json spec{{"problem", campaign.digests[cell.problem]},
                              {"checker", checker},
                              {"planner", planned.settings.planner.name},
                              {"params", planned.settings.planner.params},
                              {"time", planned.settings.planner.time},
                              {"memory_mb", campaign.limits.memory},
                              {"simplify", simplify},
                              {"verify", campaign.verify}};
  // Campaigns without trajectories have the same settings as before there were any.
  if (!campaign.trajectories.makers.empty()) {
    for (const TrajectoryMaker maker : campaign.trajectories.makers)
      spec["trajectories"].push_back(nameOf(maker));
    for (const CampaignLimits& limits : campaign.trajectories.limits)
      spec["limits over time"].push_back(
          {{"name", limits.name}, {"values", limitsText(limits.ofProblem[cell.problem])}});
  }
  return spec.dump();
}

}  // namespace corridor
