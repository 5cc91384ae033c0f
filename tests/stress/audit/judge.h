#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "collision/motion/check_certificate.h"
#include "collision/motion/edge_method.h"
#include "collision/world/scene.h"
#include "planner/robot/edge_motion.h"
#include "planner/verify/verify_path.h"
#include "tests/stress/audit/families.h"
#include "tests/stress/audit/graze.h"
#include "tests/stress/audit/surroundings.h"

namespace corridor::audit {

/// The options with which a case is queried.
struct Question {
  MotionOptions options;
  EdgeMethod method = EdgeMethod::directional;
  bool rigidMotion = false;  ///< use `RigidMotion` instead of `EdgeMotion`
  bool inTube = false;  ///< the facts are about one curve in the tube, not about the edge itself
  Mode mode = Mode::usual;
};

/// One case: two bodies on an edge, the facts known about them, and the query.
struct Case {
  const Edge& edge;
  const Graze& graze;
  const Shape& rest;
  Truth truth;
  Question question;
  std::string name;  ///< how to repeat it

  Body body(bool tip) const;
  Scene scene() const;
  PathProblem problem() const;
  /// Returns the clearance, beyond margin and `clearanceSlack`, above which the answer must not be
  /// `undecided`: twice the tolerance, or twice the clearance that doubles resolve, if that is
  /// larger.
  double largestUndecidedClearance() const;
};

/// Sets the edge or the piece.
void setMotion(EdgeMotion& motion, const Edge& edge);

/// Return the answers of the checker and of the verifier; nullopt if they refuse by an exception,
/// which is allowed only in an unusual floating-point mode.
std::optional<MotionResult> askChecker(const Case& c);
std::optional<PathReport> askVerifier(const Case& c);
/// An answer of the method `certified`, and whether `checkCertificate` accepts its certificate.
struct Certificate {
  MotionResult result;
  bool accepted = false;
};
Certificate certifiedAnswer(const Case& c);
/// Returns whether `checkCertificate` accepts a forged certificate: it claims this clearance along
/// the whole edge, in this many intervals.
bool acceptsForged(const Case& c, double clearance, int intervals);

/// Returns how far the edge is from a half turn, in radians: π minus the largest rotation of a
/// circle or an orientation along the edge, minus the rounding of large values.
double leftToHalfTurn(const Edge& edge);

/// Return what is wrong with an answer, or "".
std::string faultOf(const Case& c, const MotionResult& answer);
std::string faultOf(const Case& c, const PathReport& answer);

/// Returns all data of a case as text, numbers in hexadecimal: exact.
std::string describe(const Case& c);

/// Counts answers, one row per family, and prints them as a table.
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
