#include "planner/benchmark/ompl_database.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <set>
#include <sqlite3.h>

#include <ompl/base/PlannerStatus.h>
#include <ompl/config.h>

#include "collision/core/csv_text.h"
#include "collision/core/error.h"
#include "collision/core/shortest.h"
#include "planner/benchmark/rows.h"
#include "planner/benchmark/trajectory_rows.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

namespace fs = std::filesystem;

/// Values of a row, by OMPL's words for the name and the type of their column: "graph states
/// INTEGER" is the column graph_states.
using Properties = std::map<std::string, std::string>;

/// "corr" and the version mark the databases of this program (PRAGMA application_id and
/// user_version). Versions 2 and 3 had the runs themselves in tables of their own.
constexpr std::uint32_t kApplication = 0x636f7272, kVersion = 4;

/// OMPL's tables, word for word as `ompl_benchmark_statistics` 1.5.2 creates them. Other columns
/// are added when a row first has a value for them.
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
)";

/// The line of a run's setup text that begins its part on the planner.
constexpr const char* kPlannersBegin = "Properties of benchmarked planners:\n";

/// Replaces whitespace by underscores, as OMPL's logs need it.
std::string oneWord(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return std::isspace(c); }, '_');
  return text;
}

/// Returns whether OMPL's script stores a value as NULL.
bool isNull(const std::string& value) {
  return value.empty() || value == "nan" || value == "inf" || value == "-nan" || value == "-inf";
}

void addVerdict(const std::string& prefix, const std::string& is, Properties& properties) {
  if (is.empty()) return;
  for (const char* verdict : {"proved", "refuted", "undecided"})
    properties[prefix + verdict + " BOOLEAN"] = is == verdict ? "1" : "0";
}

Properties propertiesOf(const Campaign& campaign, const CampaignCell& cell,
                        const BenchmarkRun& run) {
  Properties properties = run.ompl->properties;
  for (const auto& [name, value] : runRow(campaign, cell, run)) {
    if (const auto* yes = std::get_if<bool>(&value))
      properties.emplace(name + " BOOLEAN", *yes ? "1" : "0");
    if (const auto* count = std::get_if<std::uint64_t>(&value))
      properties.emplace(name + " INTEGER", std::to_string(*count));
    if (const auto* number = std::get_if<double>(&value))
      properties.emplace(name + " REAL", shortest(*number));
  }
  addVerdict("", run.verdict, properties);
  for (std::size_t set = 0; set < run.trajectories.size(); ++set)
    for (std::size_t maker = 0; maker < run.trajectories[set].makers.size(); ++maker)
      addVerdict(trajectoryPrefix(campaign.trajectories, set, maker),
                 run.trajectories[set].makers[maker].verdict, properties);
  if (run.result == "failed") {
    properties["status ENUM"] = std::to_string(ompl::base::PlannerStatus::CRASH);
    properties["solved BOOLEAN"] = "0";
  }
  return properties;
}

/// Returns the settings of a variant, such as "resolution REAL" → "0.01".
Properties parametersOf(const Campaign& campaign, const CampaignCell& cell) {
  const Variant& variant = campaign.variants[cell.variant];
  CheckerSettings checker = campaign.problems[cell.problem].settings.checker;
  variant.apply(checker);
  Properties parameters;
  parameters["edges TEXT"] = variant.competitor ? variant.competitor->name : wordOf(checker.edges);
  if (checker.edges == EdgeMethod::discrete)
    parameters["resolution REAL"] = shortest(checker.resolution);
  else if (checker.tolerance)
    parameters["tolerance REAL"] = shortest(*checker.tolerance);
  for (const YamlValue::Entry& entry : variant.checker.entries)
    if (entry.key != "edges" && entry.key != "resolution" && entry.key != "tolerance")
      parameters[entry.key + " TEXT"] = entry.value.text;
  return parameters;
}

/// Writes OMPL's tables. Methods throw SQLite::Exception.
class OmplTables {
 public:
  OmplTables(SQLite::Database& base, const Campaign& campaign) : base_(base), campaign_(campaign) {
    base_.exec(kTables);
    base_.exec("PRAGMA application_id = " + std::to_string(kApplication));
    base_.exec("PRAGMA user_version = " + std::to_string(kVersion));
    using ompl::base::PlannerStatus;
    for (int i = 0; i < PlannerStatus::TYPE_COUNT; ++i)
      addRow("enums", {{"name TEXT", "status"},
                       {"value INTEGER", std::to_string(i)},
                       {"description TEXT",
                        PlannerStatus(static_cast<PlannerStatus::StatusType>(i)).asString()}});
  }

  void addRuns(const CampaignCell& cell, std::size_t index, const RunSource& runs) {
    const auto [known, isNew] =
        experimentOf_.try_emplace({cell.problem, cell.variant}, experiments_.size());
    if (isNew) experiments_.push_back({&cell, 0, {}});
    Experiment& experiment = experiments_[known->second];
    const std::string experimentId = std::to_string(known->second + 1);
    std::shared_ptr<const OmplRecord> described;  // of a run that did not crash
    std::vector<std::int64_t> crashed;
    runs(index, [&](const BenchmarkRun& run) {
      Properties row = propertiesOf(campaign_, cell, run);
      row["experimentid INTEGER"] = experimentId;
      const bool isCrash = run.ompl->planner.empty();
      if (!isCrash) row["plannerid INTEGER"] = plannerOf(cell, *run.ompl);
      const std::int64_t id = addRow("runs", row);
      if (isCrash)
        crashed.push_back(id);
      else if (!described)
        described = run.ompl;
      experiment.seconds += run.time + run.verificationTime;
      addProgress(*run.ompl, id);
    });
    // OMPL keeps no record of a run that crashed. Its planner is that of the other runs of the
    // cell.
    for (const std::int64_t id : crashed)
      execute("UPDATE runs SET plannerid = ? WHERE id = ?",
              {plannerOf(cell, described ? *described : *noOmplRecord()), std::to_string(id)});
    if (!described) return;
    // Each planner adds its part to the text on the problem.
    const std::string& setup = described->setup;
    const auto at = setup.find(kPlannersBegin);
    const auto planner =
        at == std::string::npos ? setup.size() : at + std::string(kPlannersBegin).size();
    if (experiment.machine.setup.empty()) {
      experiment.machine.host = oneWord(described->host);
      experiment.machine.cpu = described->cpu;
      experiment.machine.setup = setup.substr(0, planner);
    }
    experiment.machine.setup += setup.substr(planner);
  }

  /// Adds the experiments of all runs that were added before.
  void addExperiments(std::chrono::system_clock::time_point start) {
    std::set<std::string> taken;
    const auto date = std::chrono::duration_cast<std::chrono::seconds>(start.time_since_epoch());
    for (const auto& [cell, seconds, machine] : experiments_) {
      Properties row = parametersOf(campaign_, *cell);
      // OMPL's readers take the names "one pct" and "one_pct" for the same.
      const std::string name = oneWord(campaign_.problemNames[cell->problem] + "/" +
                                       campaign_.variants[cell->variant].name);
      std::string& free = row["name TEXT"] = name;
      for (int i = 2; !taken.insert(free).second; ++i) free = name + "-" + std::to_string(i);
      row["totaltime REAL"] = shortest(seconds);
      row["timelimit REAL"] = shortest(
          campaign_.time.value_or(campaign_.problems[cell->problem].settings.planner.time));
      row["memorylimit REAL"] = shortest(campaign_.limits.memory);
      row["runcount INTEGER"] = std::to_string(campaign_.runs);
      row["version TEXT"] = "OMPL " + versionOfOmpl();
      row["hostname TEXT"] = machine.host;
      row["cpuinfo TEXT"] = machine.cpu;
      row["seed TEXT"] = std::to_string(campaign_.seed);
      row["setup TEXT"] = machine.setup;
      const std::int64_t id = addRow("experiments", row);
      execute("UPDATE experiments SET date = datetime(?, 'unixepoch') WHERE id = ?",
              {std::to_string(date.count()), std::to_string(id)});
    }
  }

 private:
  struct Experiment {
    const CampaignCell* cell;
    double seconds;
    OmplRecord machine;  ///< only `setup`, `host` and `cpu`
  };

  /// Executes a statement that is prepared once. Empty texts, nan and inf become NULL; SQLite
  /// converts the other texts to the types of their columns. @returns the id of the inserted row.
  std::int64_t execute(const std::string& sql, const std::vector<std::string>& values) {
    SQLite::Statement& statement = statements_.try_emplace(sql, base_, sql).first->second;
    statement.reset();
    statement.clearBindings();
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!isNull(values[i])) statement.bindNoCopy(static_cast<int>(i) + 1, values[i]);
    statement.exec();
    return base_.getLastInsertRowid();
  }

  std::int64_t addRow(const std::string& table, const Properties& row) {
    std::string names, marks;
    std::vector<std::string> values;
    for (const auto& [words, value] : row) {
      names += (names.empty() ? "" : ",") + columnOf(table, words);
      marks += marks.empty() ? "?" : ",?";
      values.push_back(value);
    }
    return execute("INSERT INTO " + table + " (" + names + ") VALUES (" + marks + ")", values);
  }

  /// Adds a column if it does not exist. @returns its name in quotes.
  const std::string& columnOf(const std::string& table, const std::string& words) {
    std::string& quoted = names_[{table, words}];
    if (!quoted.empty()) return quoted;
    const auto blank = words.rfind(' ');
    std::string name = words.substr(0, blank);
    std::replace(name.begin(), name.end(), ' ', '_');
    quoted = inDoubleQuotes(name);
    SQLite::Statement known(base_, "SELECT 1 FROM pragma_table_info(?) WHERE name = ?");
    known.bind(1, table);
    known.bind(2, name);
    if (!known.executeStep())
      base_.exec("ALTER TABLE " + table + " ADD " + quoted + " " + words.substr(blank + 1));
    return quoted;
  }

  /// Returns the id of a planner with its settings.
  const std::string& plannerOf(const CampaignCell& cell, const OmplRecord& record) {
    const std::string name = cell.planner.label != cell.planner.name ? oneWord(cell.planner.label)
                             : record.planner.empty() ? "geometric_" + cell.planner.name
                                                      : record.planner;
    std::string settings;
    for (const auto& [key, value] : record.settings) settings += key + " = " + value + "\n;";
    std::string& id = planners_[{name, settings}];
    if (id.empty())
      id = std::to_string(
          addRow("plannerConfigs", {{"name TEXT", name}, {"settings TEXT", settings}}));
    return id;
  }

  void addProgress(const OmplRecord& record, std::int64_t run) {
    // If samples have the same time, only the first is stored, as by OMPL's script.
    std::set<std::string> times;
    for (Properties sample : record.progress)
      if (const auto time = sample.find("time REAL");
          time == sample.end() || times.insert(time->second).second) {
        sample["runid INTEGER"] = std::to_string(run);
        addRow("progress", sample);
      }
  }

  SQLite::Database& base_;
  const Campaign& campaign_;
  std::map<std::string, SQLite::Statement> statements_;
  std::map<std::pair<std::string, std::string>, std::string> names_;  // by table and words
  std::vector<Experiment> experiments_;                               // the first has the id 1
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> experimentOf_;  // problem and variant
  std::map<std::pair<std::string, std::string>, std::string> planners_;  // ids, by name, settings
};

/// A file that is removed, except if it was renamed before.
struct PartialFile {
  fs::path path;
  ~PartialFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

}  // namespace

void writeOmplDatabase(const Campaign& campaign, const CampaignResult& result,
                       const RunSource& runs, const fs::path& file) {
  const PartialFile part{file.string() + ".part"};
  std::error_code failure;
  fs::remove(part.path, failure);
  std::string why;
  try {
    SQLite::Database base(part.path.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
    base.exec("PRAGMA journal_mode = OFF");  // after a crash, the next call begins anew
    base.exec("BEGIN EXCLUSIVE");
    OmplTables tables(base, campaign);
    for (std::size_t c = 0; c < result.cells.size(); ++c)
      if (!result.cells[c].runs.empty()) tables.addRuns(result.cells[c], c, runs);
    tables.addExperiments(result.start);
    base.exec("COMMIT");
  } catch (const SQLite::Exception& error) {
    why = error.what();
    if (error.getErrorCode() == SQLITE_IOERR) why += " (does ulimit -f limit the size of files?)";
  }
  if (why.empty()) {
    fs::rename(part.path, file, failure);
    if (failure) why = failure.message();
  }
  if (!why.empty()) throw InputError(Fault{file.string(), 0, "can't be written: " + why});
}

std::string whyNotReplaced(const fs::path& database) {
  // https://sqlite.org/fileformat.html: the header has both marks as big-endian numbers.
  std::ifstream in(database, std::ios::binary);
  std::string header(100, '\0');
  in.read(header.data(), static_cast<std::streamsize>(header.size()));
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = at; i < at + 4; ++i)
      value = value << 8 | static_cast<unsigned char>(header[i]);
    return value;
  };
  if (in.gcount() == 0) return "";
  if (in.gcount() < 100 || header.rfind("SQLite format 3", 0) != 0 || number(68) != kApplication)
    return "is not a campaign database";
  if (number(60) < kVersion)
    return "is of an older version of Corridor; continue or merge it with commit b384c05c or "
           "earlier";
  return "";
}

std::string versionOfOmpl() {
  return std::to_string(OMPL_MAJOR_VERSION) + "." + std::to_string(OMPL_MINOR_VERSION) + "." +
         std::to_string(OMPL_PATCH_VERSION);
}

}  // namespace corridor
