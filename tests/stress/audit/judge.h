#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/motion/check_evidence.h"
#include "collision/motion/edge_method.h"
#include "collision/world/scene.h"
#include "planner/verify/verify_path.h"
#include "tests/stress/audit/families.h"
#include "tests/stress/audit/graze.h"
#include "tests/stress/audit/surroundings.h"

namespace corridor::audit {

/// How a case is asked.
struct Question {
  MotionOptions options;
  EdgeMethod method = EdgeMethod::certified;
  bool rigidMotion = false;  ///< by `RigidMotion` in place of `EdgeMotion`
  bool inTube = false;       ///< the truth is that of one curve in the tube
  Mode mode = Mode::usual;
};

/// One case: two bodies on an edge, what is true of them, and how it is asked.
struct Case {
  const Edge& edge;
  const Graze& graze;
  const Shape& rest;
  Truth truth;
  Question question;
  std::string name;  ///< what repeats it

  Body body(bool tip) const;
  Scene scene() const;
  PathProblem problem() const;
  /// Clearances above this, beyond margin and reserve, are to be decided: twice the tolerance, or
  /// twice of what doubles resolve where that is more.
  double undecidedBelow() const;
};

/// The answers of the checker and the verifier. Where the mode isn't usual, an exception is a
/// refusal: none.
std::optional<MotionResult> askChecker(const Case& c);
std::optional<PathReport> askVerifier(const Case& c);
/// The answer with evidence, and whether the check of evidence accepts it; by `certified` only.
struct Evidence {
  MotionResult result;
  bool accepted = false;
};
Evidence askForEvidence(const Case& c);
/// Is evidence accepted that claims the margin, and the reserve, all along the edge?
bool acceptsForged(const Case& c, double clearance, int intervals);

/// π less the largest angle that a circle or a rotation turns, and less what the rounding of large
/// values may take of it; radians.
double leftToHalfTurn(const Edge& edge);

/// What is wrong with an answer; empty: nothing.
std::string faultOf(const Case& c, const MotionResult& answer);
std::string faultOf(const Case& c, const PathReport& answer);

/// Everything of a case, as text: numbers are exact.
std::string describe(const Case& c);

/// Counts of answers, a row each, printed as a table.
class Table {
 public:
  enum Column { cases, truthFree, truthContact, free, contact, undecided, atLimit, wrong, columns };
  void count(const std::string& row, const Truth& truth, double keep, Column answer, bool isWrong);
  void print(const std::string& title) const;
  long sum(Column column) const;

 private:
  std::vector<std::string> names_;
  std::map<std::string, std::array<long, columns>> rows_;
};

}  // namespace corridor::audit
