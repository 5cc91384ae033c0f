#include "planner/jobs/ranks.h"

#include <cstdlib>

#include "collision/core/error.h"
#include "planner/jobs/module_file.h"

namespace corridor {
namespace {

/// Returns the value of an environment variable, or nullopt if it is not set or is not a whole
/// number.
std::optional<int> numberIn(const char* name) {
  const char* const text = std::getenv(name);
  if (!text) return std::nullopt;
  char* end = nullptr;
  const long number = std::strtol(text, &end, 10);
  if (end == text || *end != '\0' || number < 0 || number > 100'000'000) return std::nullopt;
  return static_cast<int>(number);
}

[[noreturn]] void refuseRanks(const std::string& why) {
  throw InputError(Fault{"mpirun", 0, why});
}

}  // namespace

bool startedByMpirun() {
  return std::getenv("OMPI_COMM_WORLD_SIZE") || std::getenv("PMIX_RANK");
}

int rankInEnvironment() {
  for (const char* name : {"OMPI_COMM_WORLD_RANK", "PMIX_RANK"})
    if (const auto rank = numberIn(name)) return *rank;
  return 0;
}

std::unique_ptr<Ranks> joinRanks() {
  const auto size = numberIn("OMPI_COMM_WORLD_SIZE");
  if (size ? *size <= 1 : !std::getenv("PMIX_RANK")) return nullptr;
#ifdef CORRIDOR_MPI_MODULE
  const OpenModule module = openModule(CORRIDOR_MPI_MODULE, CORRIDOR_MPI_DIR);
  if (!module.handle) refuseRanks("the module for MPI can't be opened: " + module.why);
  const auto make = reinterpret_cast<decltype(&corridorRanks)>(functionIn(module, "corridorRanks"));
  if (!make) refuseRanks("the module for MPI is of another version; build Corridor again");
  std::unique_ptr<Ranks> ranks;
  try {
    ranks.reset(make());
  } catch (const std::exception& error) {
    refuseRanks(std::string("MPI can't be started: ") + error.what());
  }
  if (ranks->size() <= 1) return nullptr;
  return ranks;
#else
  refuseRanks(
      "Corridor was built without MPI; install libboost-mpi-dev and libopenmpi-dev, and build "
      "again by calling ./corridor --version without mpirun");
#endif
}

}  // namespace corridor
