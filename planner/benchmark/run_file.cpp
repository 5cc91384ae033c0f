#include "planner/benchmark/run_file.h"

#include <algorithm>
#include <ctime>
#include <stdexcept>

#include <nlohmann/json.hpp>

#include "collision/core/error.h"
#include "planner/benchmark/build_commit.h"
#include "planner/benchmark/campaign_record.h"
#include "planner/benchmark/campaign_spec.h"
#include "planner/benchmark/run_record.h"

namespace corridor {

/// Where a run is.
struct RunFile::Place {
  std::uint64_t offset, seed;
  std::uint32_t length, setup;
};

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using nlohmann::ordered_json;

constexpr const char* kRunsFormat = "corridor-runs-2";
constexpr const char* kKept = "finished runs are kept; continue with --resume";

[[noreturn]] void refuse(const fs::path& file, const std::string& why, int line = 0) {
  throw InputError(Fault{file.string(), line, why});
}

/// Does a step with a line. Its exceptions on damaged or unknown content become InputErrors with
/// the line's number.
template <class Step>
void withLineInErrors(const fs::path& file, int line, const Step& step) {
  try {
    step();
  } catch (const json::exception& error) {
    refuse(file, "is damaged: " + std::string(error.what()), line);
  } catch (const std::invalid_argument& error) {
    refuse(file, error.what(), line);
  }
}

std::string sessionLine(const Campaign& campaign, const CampaignSession& session) {
  const ordered_json line{{"format", kRunsFormat},
                          {"started", session.started},
                          {"commit", session.commit},
                          {"jobs", session.jobs},
                          {"shard", campaign.shard ? text(*campaign.shard) : ""},
                          {"campaign", recordOf(campaign)}};
  return line.dump(-1, ' ', false, json::error_handler_t::replace) + "\n";
}
bool beginsSession(const std::string& line) {
  return line.rfind("{\"format\":", 0) == 0;
}

/// A line that begins a session.
struct SessionLine {
  CampaignSession session;
  std::string shard;  ///< "2/3"; "": all runs
  Campaign campaign;
};
SessionLine readSession(const std::string& line) {
  const ordered_json all = ordered_json::parse(line);
  if (const std::string format = all.at("format"); format != kRunsFormat)
    throw std::invalid_argument("its format is " + format + "; this program reads " + kRunsFormat);
  return {{all.at("started"), all.at("commit"), all.at("jobs"), 0},
          all.at("shard"),
          campaignOfRecord(all.at("campaign"))};
}

/// What a file has, as far as the beginnings of its lines show it.
struct Overview {
  std::size_t runs = 0;
  std::optional<SessionLine> last;  ///< set if the file has runs
  bool isCut = false;               ///< whether the last line was not written whole
};
/// @throws InputError if the file has something else than runs.
Overview overviewOf(LineFile& file) {
  Overview has;
  std::string last;
  int number = 0;
  const std::string rest = file.forEachLine([&](const std::string& line, std::uint64_t, int at) {
    if (beginsSession(line)) last = line, number = at;
    if (last.empty())
      refuse(file.path(), "is not a file of runs (" + std::string(kRunsFormat) + ")");
    has.runs += line.rfind("{\"cell\":", 0) == 0;
  });
  if (last.empty() && !rest.empty() && rest[0] != '{')
    refuse(file.path(), "is not a file of runs (" + std::string(kRunsFormat) + ")");
  has.isCut = !rest.empty();
  if (has.runs > 0) withLineInErrors(file.path(), number, [&] { has.last = readSession(last); });
  return has;
}

std::string timeNow() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  ::gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d %H:%M:%S", &utc);
  return text;
}

}  // namespace

RunFile::RunFile(const fs::path& file, Mode mode, const Campaign& campaign,
                 std::vector<CampaignCell>& cells, std::size_t jobs)
    : campaign_(campaign),
      lines_(file, LineFile::Use::append),
      places_(cells.size()),
      session_{timeNow(), buildCommit(), jobs, 0},
      sessionLine_(sessionLine(campaign, session_)) {
  const Overview has = overviewOf(lines_);
  if (mode == Mode::fresh && has.runs > 0)
    refuse(file, "contains " + std::to_string(has.runs) + (has.runs == 1 ? " run" : " runs") +
                     " already; name another folder, or call benchmark CAMPAIGN --resume, which "
                     "continues them");
  if (has.isCut) note(lines_);
  if (has.runs == 0) {
    lines_.cut(0);
    return;
  }
  const std::string shard = campaign.shard ? text(*campaign.shard) : "", &was = has.last->shard;
  if (was.empty() && !shard.empty())
    refuse(file, "contains runs of the whole campaign, not of shard " + shard +
                     " only; leave out --shard, or name another folder");
  if (was != shard)
    refuse(file, "contains shard " + was + " of the runs; continue with --shard " + was +
                     ", or name another folder");
  read(lines_, 0, "this campaign", cells, [](const std::string&) {});
  if (has.isCut) lines_.cut(lines_.size());
  firstSetup_ = setups_.size();
}
RunFile::~RunFile() = default;

void RunFile::note(const LineFile& file) {
  notes_.push_back(file.path().string() +
                   ": the last line was not written whole; its run is left out");
}

void RunFile::read(LineFile& from, std::uint64_t base, const std::string& campaign,
                   std::vector<CampaignCell>& cells,
                   const std::function<void(const std::string&)>& copy) {
  const std::string otherCampaign = "is not of " + campaign + ": ";
  std::vector<CellMatch> matches;  // the cells of the session
  std::size_t firstSetup = 0;
  RunTrimmer trimmer;
  const auto readRun = [&](json& line, std::uint64_t offset, std::size_t length) {
    const std::size_t cell = line.at("cell"),
                      setup = firstSetup + line.at("setup").get<std::size_t>();
    if (cell >= matches.size() || setup >= setups_.size())
      throw std::invalid_argument("the session has no such cell or setup");
    const auto& [index, fault] = matches[cell];
    if (!fault.empty()) refuse(from.path(), otherCampaign + fault + "; name another folder");
    line.at("run").at("ompl").update(setups_[setup]);
    BenchmarkRun run = runIn(line["run"]);
    if (!hasRun(campaign_, *index, cells.size(), run.seed))
      refuse(from.path(), otherCampaign + "it has a run of seed " + std::to_string(run.seed) +
                              " of " + cellName(campaign_, cells[*index]) +
                              "; name another folder");
    places_[*index].push_back({base + offset, run.seed, static_cast<std::uint32_t>(length),
                               static_cast<std::uint32_t>(setup)});
    ++sessions_.back().runs;
    trimmer.trim(run);
    cells[*index].runs.push_back(std::move(run));
  };
  from.forEachLine([&](const std::string& line, std::uint64_t offset, int number) {
    withLineInErrors(from.path(), number, [&] {
      if (beginsSession(line)) {
        SessionLine begun = readSession(line);
        sessions_.push_back(std::move(begun.session));
        matches = matchCells(begun.campaign, campaign_);
        firstSetup = setups_.size();
      } else if (json all = json::parse(line); all.contains("run")) {
        readRun(all, offset, line.size());
      } else {
        setups_.push_back(std::move(all.at("setup")));
      }
    });
    copy(line);
  });
  const auto bySeed = [](const auto& a, const auto& b) { return a.seed < b.seed; };
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::vector<Place>& places = places_[c];
    std::sort(cells[c].runs.begin(), cells[c].runs.end(), bySeed);
    std::sort(places.begin(), places.end(), bySeed);
    const auto twice =
        std::adjacent_find(places.begin(), places.end(),
                           [](const Place& a, const Place& b) { return a.seed == b.seed; });
    if (twice != places.end())
      refuse(from.path(), "has a run that is there already: seed " + std::to_string(twice->seed) +
                              " of " + cellName(campaign_, cells[c]) +
                              "; name each folder once, or repeat one with another --seed");
  }
}

void RunFile::add(std::size_t cell, const BenchmarkRun& run) {
  json record = jsonOf(run), setup = std::move(record["ompl"]);
  record["ompl"] = {{"properties", std::move(setup["properties"])},
                    {"progress", std::move(setup["progress"])}};
  setup.erase("properties");
  setup.erase("progress");
  const std::string shared = lineOf(setup);
  const auto known = ownSetups_.find(shared);
  const std::size_t number = known != ownSetups_.end() ? known->second : ownSetups_.size();
  std::string lines = sessionLine_;
  if (known == ownSetups_.end()) lines += "{\"setup\":" + shared + "}\n";
  const std::uint64_t offset = lines_.size() + lines.size();
  const std::string line = "{\"cell\":" + std::to_string(cell) +
                           ",\"setup\":" + std::to_string(number) + ",\"run\":" + lineOf(record) +
                           "}";
  lines_.append(lines + line + "\n", kKept);
  if (!sessionLine_.empty()) sessions_.push_back(session_);
  sessionLine_.clear();
  ++sessions_.back().runs;
  if (ownSetups_.emplace(shared, number).second) setups_.push_back(std::move(setup));
  std::vector<Place>& places = places_[cell];
  const auto later = [](std::uint64_t seed, const Place& place) { return seed < place.seed; };
  places.insert(std::upper_bound(places.begin(), places.end(), run.seed, later),
                {offset, run.seed, static_cast<std::uint32_t>(line.size()),
                 static_cast<std::uint32_t>(firstSetup_ + number)});
}

void RunFile::take(const fs::path& source, const fs::path& first,
                   std::vector<CampaignCell>& cells) {
  constexpr std::size_t kTogether = 16'000'000;  // bytes that are written at a time
  constexpr const char* kNothing = "nothing is merged";
  LineFile from(source, LineFile::Use::read);
  if (overviewOf(from).isCut) note(from);
  std::string lines;
  const auto copy = [&](const std::string& line) {
    lines += line + '\n';
    if (lines.size() < kTogether) return;
    lines_.append(lines, kNothing);
    lines.clear();
  };
  read(from, lines_.size(), "the campaign of " + first.string(), cells, copy);
  lines_.append(lines, kNothing);
}

void RunFile::finish(const fs::path& file) {
  lines_.append(sessionLine_, "nothing is merged");
  sessionLine_.clear();
  sessions_.push_back(session_);
  firstSetup_ = setups_.size();
  lines_.rename(file);
}

RunSource RunFile::runs() const {
  return [this](std::size_t cell, const std::function<void(const BenchmarkRun&)>& visit) {
    for (const Place& place : places_[cell]) {
      json line = json::parse(lines_.at(place.offset, place.length));
      line["run"]["ompl"].update(setups_[place.setup]);
      visit(runIn(line["run"]));
    }
  };
}

std::vector<CampaignSession> RunFile::sessions() const {
  std::vector<CampaignSession> all = sessions_;
  std::erase_if(all, [](const CampaignSession& session) { return session.runs == 0; });
  return all;
}

Campaign campaignIn(const fs::path& file) {
  LineFile lines(file, LineFile::Use::read);
  Overview has = overviewOf(lines);
  if (!has.last) refuse(file, "has no runs");
  return std::move(has.last->campaign);
}

}  // namespace corridor
