#pragma once

namespace corridor {

/// The answer of a geometric predicate.
struct PredicateResult {
  bool holds = false;
  bool exact = false;  ///< double could not decide it: decided with more digits

  // Not explicit: a predicate is used as a condition.
  operator bool() const { return holds; }
};

}  // namespace corridor
