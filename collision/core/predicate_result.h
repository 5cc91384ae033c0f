#pragma once

namespace corridor {

/// The answer of a geometric predicate.
struct PredicateResult {
  bool holds = false;
  bool exact = false;  ///< double could not decide, so that more digits were used

  // Not explicit: functions return it as a bool.
  operator bool() const { return holds; }
};

}  // namespace corridor
