#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tests/stress/audit/judge.h"

namespace corridor::audit {

/// Makes cases, runs the checker and the verifier on them, compares their answers with the true
/// verdicts, and counts the answers.
class Audit {
 public:
  struct Options {
    bool states = false;     ///< make states: edges of zero length
    bool curves = false;     ///< make pieces of curves instead of edges
    bool ofModels = false;   ///< only chains of single joints, asked by a `Checker` of a model
    bool fine = false;       ///< only gaps and tolerances of the size of rounding errors
    std::size_t verify = 6;  ///< the verifier runs on one case in this many, the checker on every
                             ///< case
    std::optional<Family> family = {};  ///< the only family of edges; unset: all families in turn
    Mode mode = Mode::usual;            ///< floating-point mode while a query runs
  };
  Audit(std::uint64_t seed, const Options& options);

  /// Makes edges until the checker has run on at least `count` cases. Each edge with a usable
  /// construction gives six cases, with different gaps. If CORRIDOR_AUDIT_CASE is set to a number
  /// that a failure printed, runs only the six cases of the edge with this number.
  void run(long count);
  /// Prints the tables. Fails the test if an answer was wrong.
  void report(const std::string& title) const;
  /// Fails the test if the true verdict is known for too few cases, if too few cases are decided,
  /// or if too many reach the work limit: an audit in which every case is undecided would find no
  /// fault. Does nothing if CORRIDOR_AUDIT_CASE is set.
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

/// Returns the generator of the random numbers for one construction. Each construction has a
/// generator of its own, so it can be repeated alone.
Dice diceOf(std::uint64_t seed, long number);

/// Returns the number of cases of a test: `normally`, or `stress` if CORRIDOR_STRESS is set. If
/// CORRIDOR_AUDIT_COUNT is set, returns that number instead.
long countOf(long normally, long stress);

}  // namespace corridor::audit
