#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace corridor::app {

/// Exit status (documented by --help and in the README): the same for all commands. One that is
/// stopped by a signal has 128 and its number (`interruptedStatus`).
enum Exit { kDone = 0, kNo = 1, kBadInput = 2, kInternal = 3 };

struct SolveArguments {
  std::vector<std::string> problems;
  std::optional<std::string> planner, sampler, stop, edges;
  std::optional<double> time, resolution;
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;  ///< key=value
  std::optional<std::string> output, picture;
  bool json = false, quiet = false, noSimplify = false;
};
int solveCommand(const SolveArguments& arguments);

struct BenchmarkArguments {
  std::vector<std::string> files;  ///< a campaign, or problems
  /// Of problems, each comma separated; none: the defaults.
  std::vector<std::string> variants, planners;
  std::optional<std::uint64_t> runs, seed;
  std::optional<double> time;    ///< seconds a run
  std::optional<double> memory;  ///< MB a run
  std::uint64_t jobs = 1;
  std::optional<std::string> output;
  bool resume = false, json = false;
};
int benchmarkCommand(const BenchmarkArguments& arguments);

struct VerifyArguments {
  std::string problem, solution;
  bool ignoreDigest = false;  ///< verify a solution that was made for other files
  bool json = false, quiet = false;
};
int verifyCommand(const VerifyArguments& arguments);

struct ViewArguments {
  std::string problem;
  std::optional<std::string> solution;
  std::optional<std::string> output, image, size;
  bool ignoreDigest = false;  ///< as of verify
  bool quiet = false;
};
int viewCommand(const ViewArguments& arguments);

struct CheckArguments {
  std::string problem;
  std::optional<std::string> states;  ///< a file of states, one a line
  bool json = false;
};
int checkCommand(const CheckArguments& arguments);

struct InspectArguments {
  std::string file;
  std::optional<std::string> unit, up;  ///< of a mesh file
  bool selfIntersections = false;       ///< of a mesh file: look for them
  bool pairs = false;                   ///< of a problem: every pair
  std::optional<std::string> against;   ///< another mesh file: what queries of the two cost
  std::optional<std::string> poses;     ///< of `against`: a file of poses, one a line
  bool json = false;
};
int inspectCommand(const InspectArguments& arguments);

struct QueryArguments {
  std::string meshA, meshB;
  std::optional<std::string> poses;               ///< a file of poses, one a line
  std::optional<std::string> grid, lower, upper;  ///< "10x10x5", "x,y,z"
  std::optional<std::uint64_t> rotations, seed;   ///< of a grid
  std::optional<std::string> savePoses;           ///< of a grid: a file for its poses
  std::optional<std::string> motions;        ///< instead of poses: a file of motions, one a line
  std::optional<std::string> edges;          ///< of motions: the method; unset: the first
  std::optional<std::string> query, volume;  ///< of poses; unset: the first
  std::optional<std::string> fit, overlap;   ///< unset: the volume's first
  std::optional<double> tolerance;           ///< metres, of the tolerance query and of motions
  std::uint64_t repeat = 1;
};
int queryCommand(const QueryArguments& arguments);

}  // namespace corridor::app
