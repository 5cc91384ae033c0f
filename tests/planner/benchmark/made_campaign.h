#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "planner/benchmark/report.h"
#include "tests/planner/checker/hall.h"
#include "tests/support/support.h"

namespace corridor::test {

/// A campaign of two problems, three variants, one planner and ten seeds. No run is made: formulas
/// give the figures of the runs.
class MadeCampaign : public testing::Test {
 protected:
  MadeCampaign() {
    campaign_.name = "made";
    campaign_.problems = {hallProblem(Rigid::SE3), hallProblem(Rigid::SE3)};
    for (const char* name : {"certified", "discrete:0.1", "discrete:0.01"})
      campaign_.variants.push_back(readVariant(name));
    identifyProblems(campaign_);
    cells_ = cellsOf(campaign_);
    for (CampaignCell& cell : cells_)
      for (std::uint64_t seed = 1; seed <= 10; ++seed) cell.runs.push_back(run(cell, seed));
  }
  ~MadeCampaign() override { std::filesystem::remove_all(folder_); }

  /// Returns a run of a cell. discrete:0.1 is twice as fast as certified, and half of the paths of
  /// discrete:0.1 are refuted. discrete:0.01 is ten times slower than certified, and a tenth of the
  /// paths of discrete:0.01 is refuted.
  static BenchmarkRun run(const CampaignCell& cell, std::uint64_t seed) {
    BenchmarkRun run;
    const double factor = cell.variant == 0 ? 1 : cell.variant == 1 ? 0.5 : 10;
    run.seed = seed;
    run.result = "solved";
    run.solved = true;
    run.certified = cell.variant == 0;
    run.processorTime = run.time = 0.1 * static_cast<double>(seed) * factor;
    const bool refuted = cell.variant == 1 ? seed > 5 : cell.variant == 2 && seed == 10;
    run.verdict = refuted ? "refuted" : "proved";
    run.closestFound = refuted ? 0 : 0.01 * static_cast<double>(seed);
    run.counters.boxTests = 1000 * seed;
    run.counters.primitiveTests = 10 * seed * seed;
    // 100 ns per box test, 1000 ns per pair of triangles.
    run.checkingTime = 1e-9 * (100.0 * static_cast<double>(run.counters.boxTests) +
                               1000.0 * static_cast<double>(run.counters.primitiveTests));
    run.rawLength.metres = 4;
    run.length.metres = 3;
    return run;
  }
  static std::shared_ptr<const OmplRecord> onMachine(const std::string& host,
                                                     const std::string& cpu) {
    OmplRecord record;
    record.host = host;
    record.cpu = cpu;
    return std::make_shared<const OmplRecord>(record);
  }
  std::string page() const {
    writeReport(campaign_, cells_, folder_);
    return contents(folder_ / "report.html");
  }

  Campaign campaign_;
  std::vector<CampaignCell> cells_;
  std::filesystem::path folder_ = newFolder();
};

}  // namespace corridor::test
