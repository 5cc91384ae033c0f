#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "tests/stress/audit/judge.h"

namespace corridor::audit {

/// Makes cases, puts them to the checker and the verifier, judges the answers, and counts them.
class Audit {
 public:
  struct Plan {
    bool states = false;                ///< edges of zero length
    bool fine = false;                  ///< gaps and tolerances of the size of rounding only
    std::size_t verify = 6;             ///< one case in so many is put to the verifier, too
    std::optional<Family> family = {};  ///< only this one; else all by turns
    Mode mode = Mode::usual;            ///< of floating point while a query runs
  };
  Audit(std::uint64_t seed, const Plan& plan);

  /// Puts `count` cases to the checker. With CORRIDOR_AUDIT_CASE, a number that a failure prints,
  /// only the six cases of that construction.
  void run(long count);
  /// Prints the tables, and fails the test where an answer was wrong.
  void report(const std::string& title) const;
  /// Fails the test where too few cases were known or decided: silence is no agreement.
  void expectDecided() const;

 private:
  void make(long number);
  void setTube(Dice& dice, Edge& edge, double size, bool rigid) const;
  void ask(const Case& c, const std::string& row);
  void verify(const Case& c, const std::string& row);
  void complain(const char* who, const std::string& fault, const Case& c);

  std::uint64_t seed_;
  Plan plan_;
  std::optional<long> only_;
  Table checker_, verifier_;
  long constructions_ = 0, usable_ = 0;
  int complaints_ = 0;
};

/// The dice of a case: each has its own, so that it can be repeated alone.
Dice diceOf(std::uint64_t seed, long number);

/// `normally`, or `stress` with CORRIDOR_STRESS; fewer where the build is slow.
/// CORRIDOR_AUDIT_COUNT sets another count for all tests.
long countOf(long normally, long stress);

}  // namespace corridor::audit
