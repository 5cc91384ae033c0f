#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <vector>

#include "collision/core/fault_list.h"
#include "collision/core/spelling.h"
#include "planner/app/benchmark_arguments.h"
#include "planner/app/benchmark_merge.h"
#include "planner/app/benchmark_output.h"
#include "planner/app/benchmark_results.h"
#include "planner/app/commands.h"
#include "planner/app/fill_cache.h"
#include "planner/app/interrupt.h"
#include "planner/app/options.h"
#include "planner/app/other_program.h"
#include "planner/app/output.h"
#include "planner/app/rank_job.h"
#include "planner/benchmark/campaign_spec.h"
#include "planner/benchmark/campaign_yaml.h"
#include "planner/benchmark/competitors.h"
#include "planner/benchmark/run_campaign.h"
#include "planner/benchmark/run_file.h"
#include "planner/benchmark/run_record.h"
#include "planner/benchmark/write_reports.h"
#include "planner/import/set_range.h"
#include "planner/problem/keys.h"
#include "planner/problem/nothing_tested.h"
#include "planner/solve/planner_factory.h"

namespace corridor::app {
namespace {

[[noreturn]] void refuse(const std::string& option, const std::string& why) {
  throw InputError(Fault{option, 0, why});
}

CLI::Validator isShard() {
  return {[](std::string& text) {
            return readShard(text)
                       ? std::string()
                       : "K/N is needed, such as 1/3, with K from 1 to N, not " + quotedWord(text);
          },
          ""};
}

/// Splits the values of an option at commas. CLI11's own delimiter drops empty entries: then
/// "$A,certified" with an unset variable A would silently run another comparison.
/// @throws InputError for an empty entry.
std::vector<std::string> wordsOf(const std::string& option, const std::vector<std::string>& lists) {
  std::vector<std::string> words;
  for (const std::string& list : lists) {
    for (std::size_t from = 0, to = 0; to != list.npos; from = to + 1) {
      to = list.find(',', from);
      const std::string word = list.substr(from, to == list.npos ? to : to - from);
      const auto begin = word.find_first_not_of(' ');
      words.push_back(
          begin == word.npos ? "" : word.substr(begin, word.find_last_not_of(' ') + 1 - begin));
      if (words.back().empty()) refuse(option, "an entry of " + quotedWord(list) + " is empty");
    }
  }
  return words;
}

/// Returns the competitors that are available. Their modules are opened only if a variant names a
/// competitor or something unknown. @throws InputError if a variant names a competitor that is not
/// available.
std::vector<BenchmarkCompetitor> competitorsOf(const std::vector<std::string>& variants) {
  const std::vector<std::string>& edges = problemChoices().at("checker.edges");
  bool needed = false;
  for (const std::string& word : variants) {
    const std::string name = word.substr(0, word.find(':'));
    needed = needed || std::find(edges.begin(), edges.end(), name) == edges.end();
    if (std::find(competitorNames().begin(), competitorNames().end(), name) ==
        competitorNames().end())
      continue;
    if (const std::string why = whyUnavailable(name); !why.empty())
      refuse("--variants", name + " can't take part: " + why);
  }
  return needed ? availableCompetitors() : std::vector<BenchmarkCompetitor>();
}

/// Makes a campaign of the problems and options of the command line. @throws InputError with all
/// faults.
Campaign campaignOfProblems(const BenchmarkArguments& a) {
  Campaign campaign;
  FaultList faults;
  std::vector<std::string> variants = wordsOf("--variants", a.variants);
  if (variants.empty()) variants = {"certified", "discrete:0.01"};
  std::vector<BenchmarkCompetitor> competitors;
  faults.collect([&] { competitors = competitorsOf(variants); });
  faults.throwIfAny();
  for (const std::string& word : variants)
    faults.collect([&] { campaign.variants.push_back(readVariant(word, competitors)); });
  for (const std::string& file : a.files) {
    faults.collect([&] {
      for (const std::string& problem : problemsOf(file))
        faults.collect([&] { campaign.problems.push_back(readProblem(problem)); });
    });
  }
  for (const std::string& name : wordsOf("--planners", a.planners)) {
    if (const auto unknown = unknownPlanner(name)) faults.add("--planners", 0, *unknown);
    campaign.planners.push_back({name, name, {}});
  }
  const std::vector<std::string> makers = wordsOf("--trajectories", a.trajectories);
  faults.collect(
      [&] { campaign.trajectories.makers = trajectoryMakersNamed(makers, "--trajectories"); });
  faults.throwIfAny();
  if (!makers.empty()) {
    campaign.trajectories.limits = {ownLimits(campaign.problems)};
    addOwnNotes(campaign.problems, campaign.notes);
  }
  identifyProblems(campaign);
  return campaign;
}

/// Reads a campaign's file, or makes a campaign of problems. The command's options override values
/// of the campaign.
Campaign campaignOf(const BenchmarkArguments& a) {
  const auto file = std::find_if(a.files.begin(), a.files.end(),
                                 [](const std::string& name) { return isCampaignFile(name); });
  if (file != a.files.end()) {
    if (a.files.size() > 1) refuse(*file, "is a campaign, which names its problems itself");
    if (!a.variants.empty()) refuse("--variants", "a campaign names its checkers itself");
    if (!a.planners.empty()) refuse("--planners", "a campaign names its planners itself");
    if (!a.trajectories.empty())
      refuse("--trajectories", "a campaign names its trajectories itself");
  }
  Campaign campaign = file != a.files.end() ? readCampaign(*file) : campaignOfProblems(a);
  campaign.runs = a.runs.value_or(campaign.runs);
  campaign.seed = a.seed.value_or(campaign.seed);
  if (a.time) campaign.time = a.time;
  if (a.shard) campaign.shard = readShard(*a.shard);
  campaign.limits.memory = a.memory.value_or(campaign.limits.memory);
  campaign.cache = a.cache;
  if (!a.cache) return campaign;
  const auto cache = requireCache();
  for (Problem& problem : campaign.problems) {
    problem.model.cache = cache;
    fillCache(problem.model);
  }
  printCacheNotes(cache->takeNotes());
  campaign.notes.emplace_back(
      "Corridor's checkers find trees, hulls and grids of pairs of links in the cache, which was "
      "filled before the runs (--cache)");
  return campaign;
}

/// Returns the settings of all cells. Ranks compare this text, to test that all of them have the
/// same campaign.
std::string specsOf(const Campaign& campaign) {
  std::string all;
  for (const CampaignCell& cell : cellsOf(campaign)) all += specOf(campaign, cell) + '\n';
  return all;
}

/// Makes the runs that rank 0 hands out to this rank. @returns the exit status.
int serveCampaign(const BenchmarkArguments& a, RankJob& job) {
  Campaign campaign;
  return job.serve([&](const std::string& specs) {
    campaign = campaignOf(a);
    if (specsOf(campaign) != specs)
      throw std::runtime_error(
          "its campaign is not the first rank's; all machines need the same files and packages");
    return std::make_unique<LocalExecutor>(a.jobs, runStarter(campaign));
  });
}

int benchmarkCommand(const BenchmarkArguments& a) {
  RankJob job(a.jobs);
  if (job.serves()) return serveCampaign(a, job);
  if (a.resume && !a.output) refuse("--resume", "needs -o with the folder of the campaign");
  if (a.shard && !a.output) refuse("--shard", "needs -o with a folder for this shard of the runs");
  Campaign campaign = campaignOf(a);
  for (std::size_t i = campaign.problems.size(); i-- > 0;)  // these notes come before all others
    if (nothingIsTested(campaign.problems[i]))
      campaign.notes.insert(campaign.notes.begin(),
                            campaign.problemNames[i] + ": " + kNothingTested);
  for (const std::string& note : campaign.notes) warn(note);
  checkCampaign(campaign);
  // From here on the command creates files. If a signal arrives, it must finish or remove them.
  const std::atomic<bool>& interrupted = job.listen();
  const bool made = a.output && makeReportFolder(*a.output);
  std::vector<CampaignCell> cells = cellsOf(campaign);
  std::optional<RunFile> stored;
  const std::filesystem::path file = std::filesystem::path(a.output.value_or("")) / "runs.jsonl";
  if (a.output)
    stored.emplace(file, a.resume ? RunFile::Mode::resume : RunFile::Mode::fresh, campaign, cells,
                   job.executor() ? job.executor()->places() : a.jobs);
  if (stored)
    for (const std::string& note : stored->notes()) warn(note);
  if (campaign.shard)
    campaign.notes.push_back("this is shard " + text(*campaign.shard) +
                             " of the campaign's runs; benchmark --merge puts the shards together");
  CampaignOptions options;
  options.interrupted = &interrupted;
  options.jobs = a.jobs;
  options.executor = job.executor();
  RunTrimmer trimmer;
  if (stored)
    options.done = [&](std::size_t cell, BenchmarkRun& run) {
      stored->add(cell, run);
      trimmer.trim(run);
    };
  const bool show = ::isatty(STDERR_FILENO) != 0;
  if (show) options.progress = [&](const CampaignProgress& p) { showProgress(campaign, p); };
  // Removes the file of runs if it has none, and the folder if this command made it. With --resume,
  // nothing is removed.
  const auto removeEmpty = [&] {
    std::error_code ignored;
    if (a.resume || !stored || !stored->sessions().empty()) return;
    stored.reset();
    std::filesystem::remove(file, ignored);
    if (made) std::filesystem::remove(*a.output, ignored);
  };
  CampaignResult result;
  try {
    if (job.executor()) job.executor()->begin(specsOf(campaign), interrupted);
    result = runCampaign(campaign, options, std::move(cells));
  } catch (const InputError&) {  // such as the fault of a rank
    removeEmpty();
    throw;
  }
  if (show) std::fputs("\r\033[K", stderr);
  std::exception_ptr fault;
  try {
    giveResults(campaign, result, {a.output, stored ? &*stored : nullptr, a.json});
  } catch (const InputError&) {
    fault = std::current_exception();
  }
  if (!anyRun(result.cells)) removeEmpty();
  if (fault) std::rethrow_exception(fault);
  return result.interrupted ? interruptedStatus() : kDone;
}

}  // namespace

void addBenchmark(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<BenchmarkArguments>();  // the callback keeps it
  BenchmarkArguments& a = *arguments;
  CLI::App* command = program.add_subcommand("benchmark", kBenchmarkHelp);
  command
      ->add_option("CAMPAIGN|PROBLEM", a.files,
                   "a campaign file, or problems as for solve; with --merge: folders of results")
      ->required();
  const char* compared = "Comparison (with problems; a campaign names its own)";
  command
      ->add_option("--variants", a.variants,
                   "comma separated methods of checking edges, each with or without its parameter: "
                   "certified:TOLERANCE (m), adaptive:TOLERANCE, advancement:TOLERANCE, "
                   "discrete:RESOLUTION (OMPL's longest_valid_segment_fraction), fcl:RESOLUTION "
                   "(default: certified,discrete:0.01)")
      ->allow_extra_args(false)
      ->group(compared);
  command
      ->add_option("--planners", a.planners,
                   "comma separated, by OMPL's names (default: each problem's own planner)")
      ->allow_extra_args(false)
      ->group(compared);
  command
      ->add_option(
          "--trajectories", a.trajectories,
          "comma separated makers of trajectories along each path, which are timed, "
          "verified and compared: blends (corners rounded by proved curves), stop (rest at "
          "corners), spline (cubic, through the states), inserted (the spline, with states "
          "inserted where samples touch)")
      ->allow_extra_args(false)
      ->group(compared);
  const char* runs = "Runs (these options replace settings of the campaign or the problems)";
  command
      ->add_option("--runs", a.runs,
                   "runs of each combination of problem, variant and planner (default 10); all "
                   "combinations use the same seeds")
      ->check(isWithin<std::uint64_t>(1, 1'000'000, "a whole number from 1 to 1000000"))
      ->group(runs);
  command
      ->add_option("--seed", a.seed, "seed of the first run; each further run adds 1 (default 1)")
      ->check(isWithin<std::uint64_t>(1, std::numeric_limits<std::uint32_t>::max(),
                                      "a whole number from 1 to 2^32 - 1"))
      ->group(runs);
  command->add_option("--time", a.time, "time limit of a run, seconds")
      ->check(isSeconds())
      ->group(runs);
  command->add_option("--memory", a.memory, "memory limit of a run, MB (default 4096)")
      ->check(isWithin(1.0, 1e9, "a number of MB from 1 to 1e9"))
      ->group(runs);
  command
      ->add_option(
          "--jobs", a.jobs,
          "number of runs at the same time (default 1), under mpirun on each rank except the "
          "first; more than 1 makes measured times longer")
      ->check(isWithin<std::uint64_t>(1, 1024, "a whole number from 1 to 1024"))
      ->group(runs);
  command
      ->add_flag("--cache", a.cache,
                 "fill the cache before the runs (`corridor cache`), so that Corridor's checkers "
                 "find what they otherwise compute in each run")
      ->group(runs);
  command
      ->add_option("--shard", a.shard,
                   "K/N: make only shard K of N of the runs, for several machines without MPI; "
                   "--merge puts the shards together")
      ->check(isShard())
      ->group(runs);
  const char* results = "Results";
  command
      ->add_option(
          "-o,--output", a.output,
          "write to this folder: the runs (runs.jsonl), report.html with its plots, runs.csv, "
          "summary.csv, and campaign.db (SQLite, for Planner Arena)")
      ->group(results);
  command->add_flag("--resume", a.resume, "continue the campaign in the folder where it stopped")
      ->group(results);
  CLI::Option* const merge = command->add_flag(
      "--merge", a.merge,
      "put the results of one campaign in several folders together, in the folder of -o: its "
      "shards, or the same campaign with other seeds");
  merge->group(results);
  for (const char* option : {"--variants", "--planners", "--trajectories", "--runs", "--seed",
                             "--time", "--memory", "--jobs", "--cache", "--shard", "--resume"})
    merge->excludes(std::string(option));
  addJson(*command, a.json, results);
  command->footer(
      std::string(
          "Example: corridor benchmark problems/campaigns/error.yaml -o results --jobs 2\n"
          "Or without a campaign file: corridor benchmark problems/thin_plate problems/piano "
          "--variants "
          "certified,discrete:0.01,discrete:0.001 -o results\n"
          "Three machines: the campaign with --shard 1/3 -o a, 2/3 -o b and 3/3 -o c, and then "
          "corridor benchmark --merge a b c -o results\n"
          "With MPI: mpirun -n 64 ./corridor benchmark CAMPAIGN -o results\n"
          "Each run is a separate process, under OMPL's Benchmark. The independent verifier tests "
          "each path: `refuted` counts the paths that collide, or violate the problem's margin, "
          "bounds, start or goal. Times and counts are medians over the solved runs.\n"
          "Columns: *_s in seconds (time_s: everything except reading files; time_p95_s: its 95 % "
          "quantile; processor_s: processor time of all threads), length_m in metres, rotation_rad "
          "in radians, checking_share: the share of time_s that checking takes. All columns, and "
          "the keys of campaign files: planner/benchmark/README.md.\n") +
      kExitStatus);
  command->callback([arguments, &status] {
    status = arguments->merge ? mergeCampaigns(*arguments) : benchmarkCommand(*arguments);
  });
}

}  // namespace corridor::app
