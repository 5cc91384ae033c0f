#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tests/stress/audit/judge.h"

namespace corridor::audit {

/// Makes cases, runs the checker and the verifier on them, compares the answers with the true
/// verdicts, and counts them.
class Audit {
 public:
  struct Options {
    bool states = false;     ///< make states: edges of zero length
    bool curves = false;     ///< make pieces of curves instead of edges
    bool fine = false;       ///< only gaps and tolerances of the size of rounding errors
    std::size_t verify = 6;  ///< the verifier runs on one of this many cases, the checker on all
    std::optional<Family> family = {};  ///< only this family; unset: all in turn
    Mode mode = Mode::usual;            ///< floating-point mode while a query runs
  };
  Audit(std::uint64_t seed, const Options& options);

  /// Runs the checker on `count` cases. If CORRIDOR_AUDIT_CASE is set to a number that a failure
  /// printed, runs only the six cases (gaps) that are made of the edge with this number.
  void run(long count);
  /// Prints the tables. Fails the test if an answer was wrong.
  void report(const std::string& title) const;
  /// Fails the test if the true verdict is known for too few cases, if too few cases are decided,
  /// or if too many reach the work limit: an audit in which everything is undecided would find
  /// nothing.
  void expectDecided() const;

 private:
  void make(long number);
  void setTube(Dice& dice, Edge& edge, double size, bool rigid) const;
  void ask(const Case& c, const std::string& row);
  void verify(const Case& c, const std::string& row);
  void complain(const char* who, const std::string& fault, const Case& c);

  std::uint64_t seed_;
  Options options_;
  std::optional<long> only_;
  Table checker_, verifier_;
  long constructions_ = 0, usable_ = 0;
  int complaints_ = 0;
};

/// Returns the random numbers of one construction. Each construction has its own, so it can be
/// repeated alone.
Dice diceOf(std::uint64_t seed, long number);

/// Returns the number of cases of a test: `normally`, or `stress` if CORRIDOR_STRESS is set,
/// divided by the slowdown of sanitizers. If CORRIDOR_AUDIT_COUNT is set, returns that number
/// instead.
long countOf(long normally, long stress);

}  // namespace corridor::audit
