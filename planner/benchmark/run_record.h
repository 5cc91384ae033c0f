#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>

#include <nlohmann/json_fwd.hpp>

#include "planner/benchmark/benchmark_run.h"

/// Runs written as JSON texts, and runs whose own texts are removed to save memory.
namespace corridor {

/// Returns a run as JSON. OMPL's record is its member `ompl`.
nlohmann::json jsonOf(const BenchmarkRun& run);
/// Reads a run. @throws nlohmann::json::exception if a member is missing, or of another type.
BenchmarkRun runIn(const nlohmann::json& run);
/// Returns JSON as one line. Bytes that are not UTF-8 become U+FFFD.
std::string lineOf(const nlohmann::json& json);

/// Write a run as one line of JSON, and read such a line.
std::string text(const BenchmarkRun& run);
BenchmarkRun readRun(const std::string& text);

/// Removes the data of runs that take most of the memory, so that a campaign can keep 10^6 runs.
class RunTrimmer {
 public:
  /// Removes the data that are shown only in rows of single runs and in OMPL's tables: `why`,
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
