#pragma once

#include "tests/planner/problem/problem_fixture.h"

namespace corridor::test {

/// Pins the complete text of every message. Users read these messages: change them with care.
class ProblemFaults : public ProblemTest {
 protected:
  /// Returns the faults of a problem in space that has these lines from line 8 on.
  std::string with(const std::string& lines) const { return complaintOf(head + poses + lines); }
};

}  // namespace corridor::test
