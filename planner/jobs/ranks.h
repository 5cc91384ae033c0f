#pragma once

#include <memory>
#include <optional>
#include <string>

namespace corridor {

struct RankMessage {
  int from = 0;
  std::string text;
};

/// The processes (ranks) of a job under `mpirun`, and messages between them. Rank 0 is the first.
/// Between two ranks, messages arrive in the order in which they were sent.
class Ranks {
 public:
  /// Waits until every rank destroys its object of this class. No message can be sent afterwards.
  virtual ~Ranks() = default;
  Ranks() = default;
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  virtual int rank() const = 0;
  virtual int size() const = 0;
  /// Begins to send a message; does not wait for its arrival. Long messages leave only while this
  /// rank calls `receive` or `send`.
  virtual void send(int to, std::string text) = 0;
  /// Returns the next message, or nullopt if none has arrived. Never waits.
  virtual std::optional<RankMessage> receive() = 0;
};

extern "C" {
/// The function that the MPI module exports under this name. The module is opened only under
/// `mpirun`, so that the program does not depend on MPI. The caller owns the returned object. A
/// process may call this function only once. @throws std::exception if MPI can't be started.
Ranks* corridorRanks();
}

/// Returns whether `mpirun`, or `srun --mpi=pmix`, started this process.
bool startedByMpirun();

/// Returns the rank of this process from the environment variables that Open MPI's `mpirun` and
/// Slurm's `srun --mpi=pmix` set. Returns 0 for a process that neither of them started.
int rankInEnvironment();

/// Joins the job of `mpirun`. @returns null if this process was not started by `mpirun` or `srun
/// --mpi=pmix`, or is the only one in its job.
/// @throws InputError if Corridor was built without MPI, or MPI can't be started.
std::unique_ptr<Ranks> joinRanks();

}  // namespace corridor
