#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include "planner/benchmark/benchmark_run.h"

/// Runs written as JSON texts, and runs whose own texts are removed to save memory.
namespace corridor {

/// Write a run as one line of JSON, and read such a line.
std::string text(const BenchmarkRun& run);
BenchmarkRun readRun(const std::string& text);

/// A run as the database stores it: three lines of JSON.
struct RunRecord {
  std::string figures;  ///< all of the run except `ompl`
  std::string ompl;     ///< OMPL's properties and progress of this run
  /// The other parts of OMPL's record, the same in all runs of a cell on a machine.
  std::string setup;
};
RunRecord recordOf(const BenchmarkRun& run);
/// Reads `RunRecord::setup`.
OmplRecord readSetup(const std::string& setup);
/// Reads a run. @param figures,ompl the texts of RunRecord. `figures` may also be a line that
/// `text` has written; then `ompl` and `setup` are not used. @param setup the result of
/// `readSetup`.
BenchmarkRun readRecord(const std::string& figures, const std::string& ompl,
                        const OmplRecord& setup);

/// Removes the data of runs that take most of the memory, so that a campaign can keep 10^6 runs.
class RunTrimmer {
 public:
  /// Removes the data that are shown only in rows of single runs and in OMPL's logs: `why`,
  /// `finding`, the findings of trajectories, and OMPL's record except the machine (`host` and
  /// `cpu`). A trajectory's fault, if it has one, is replaced by `kFault`. Afterwards the run takes
  /// less than half a kilobyte, and 0.2 kB more for each of its trajectories.
  void trim(BenchmarkRun& run);
  /// Short enough for a std::string without heap memory.
  static constexpr const char* kFault = "not kept";

 private:
  std::map<std::pair<std::string, std::string>, std::shared_ptr<const OmplRecord>> machines_;
};

}  // namespace corridor
