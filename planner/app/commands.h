#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace corridor::app {

/// Exit statuses of all commands, documented by --help and in the README. A command that a signal N
/// stopped ends with 128 + N instead (`interruptedStatus`).
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
  /// Only with problems, not with a campaign. Each string is a comma-separated list; empty: the
  /// defaults.
  std::vector<std::string> variants, planners;
  std::optional<std::uint64_t> runs, seed;
  std::optional<double> time;    ///< limit of a run, seconds
  std::optional<double> memory;  ///< limit of a run, MB
  std::uint64_t jobs = 1;
  std::optional<std::string> output;
  bool resume = false, json = false;
};
int benchmarkCommand(const BenchmarkArguments& arguments);

struct VerifyArguments {
  std::string problem, solution;
  bool ignoreDigest = false;  ///< verify a solution although its digest is not the problem's
  bool json = false, quiet = false;
};
int verifyCommand(const VerifyArguments& arguments);

struct ViewArguments {
  std::string problem;
  std::optional<std::string> solution;
  std::optional<std::string> output, image, size;
  bool ignoreDigest = false;  ///< as in `VerifyArguments`
  bool quiet = false;
};
int viewCommand(const ViewArguments& arguments);

struct CheckArguments {
  std::string problem;
  std::optional<std::string> states;  ///< a file of states, one per line
  bool json = false;
};
int checkCommand(const CheckArguments& arguments);

struct InspectArguments {
  std::string file;
  std::optional<std::string> unit, up;  ///< how to read a mesh file
  bool selfIntersections = false;       ///< mesh files: compute self-intersections
  bool pairs = false;                   ///< problems: list every pair of bodies
  std::optional<std::string> against;   ///< a second mesh file: measure queries of the two
  std::optional<std::string> poses;     ///< file with poses of the second mesh, one per line
  bool json = false;
};
int inspectCommand(const InspectArguments& arguments);

struct QueryArguments {
  std::string meshA, meshB;
  std::optional<std::string> poses;               ///< a file of poses, one per line
  std::optional<std::string> grid, lower, upper;  ///< "10x10x5", "x,y,z"
  std::optional<std::uint64_t> rotations, seed;   ///< with `grid` only
  std::optional<std::string> savePoses;           ///< with `grid` only: write its poses here
  std::optional<std::string> motions;        ///< instead of poses: a file of motions, one per line
  std::optional<std::string> edges;          ///< with `motions` only: the method; unset: the first
  std::optional<std::string> query, volume;  ///< `query` with poses only; unset: the first
  std::optional<std::string> fit, overlap;   ///< unset: the first that the volume has
  std::optional<double> tolerance;           ///< metres; for the tolerance query and for motions
  std::uint64_t repeat = 1;
};
int queryCommand(const QueryArguments& arguments);

}  // namespace corridor::app
