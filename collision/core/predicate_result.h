#pragma once

namespace corridor {

/// The answer of a geometric predicate.
struct PredicateResult {
  bool holds = false;
  bool exact = false;  ///< true: double precision could not decide, so more digits were used

  // Implicit, so that a function that returns bool can return a `PredicateResult`.
  operator bool() const { return holds; }
};

}  // namespace corridor
