#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "planner/benchmark/benchmark_run.h"

/// Runs as texts, and runs without their texts.
namespace corridor {

/// Writes a run as one line of JSON, and reads it back.
std::string text(const BenchmarkRun& run);
BenchmarkRun readRun(const std::string& text);

/// A run as the database stores it: three lines of JSON.
struct RunRecord {
  std::string figures;  ///< all of the run except `ompl`
  std::string ompl;     ///< OMPL's properties and progress of this run
  std::string setup;    ///< the rest of OMPL's record, the same in all runs of a cell on a machine
};
RunRecord recordOf(const BenchmarkRun& run);
/// Reads `RunRecord::setup`.
OmplRecord readSetup(const std::string& setup);
/// Reads a run. @param figures as in RunRecord, or as `text` writes it: the other parameters are
/// then unused. @param setup as `readSetup` returns it.
BenchmarkRun readRecord(const std::string& figures, const std::string& ompl,
                        const OmplRecord& setup);

/// Makes runs small, so that a campaign can keep 10^6 of them in memory.
class RunTrimmer {
 public:
  /// Removes what is shown only in rows of single runs and in OMPL's logs: `why`, `finding`, and
  /// OMPL's record except the machine. A trajectory's fault, if it has one, becomes `kFault`.
  /// Afterwards the run takes less than half a kilobyte, and 0.2 kB more for each of its
  /// trajectories.
  void trim(BenchmarkRun& run);
  /// Short enough for a std::string without heap memory.
  static constexpr const char* kFault = "not kept";

 private:
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const OmplRecord>> machines_;
};

}  // namespace corridor
