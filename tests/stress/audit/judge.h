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
  EdgeMethod method = EdgeMethod::certified;
  bool rigidMotion = false;  ///< use `RigidMotion` instead of `EdgeMotion`
  bool ofModel = false;      ///< ask a `Checker`, which asks its `EdgeFilter` first
  bool inTube = false;       ///< the true verdict is that of one curve in the tube, not of the edge
                             ///< itself
  Mode mode = Mode::usual;
};

/// One case: two bodies on an edge, the facts from which their true verdict follows, and the query.
struct Case {
  const Edge& edge;
  const Graze& graze;
  const Shape& rest;
  Truth truth;
  Question question;
  std::string name;  ///< how to repeat the case

  Body body(bool tip) const;
  Scene scene() const;
  PathProblem problem() const;
  /// Returns the clearance, beyond margin and `clearanceSlack`, above which the answer must not be
  /// `undecided`: twice the tolerance, or twice the clearance that doubles resolve, if that is
  /// larger.
  double largestUndecidedClearance() const;
};

/// Sets the motion to the edge, or to the edge's piece of a curve if it has one.
void setMotion(EdgeMotion& motion, const Edge& edge);

/// Return the answers of the checker and of the verifier; nullopt if they refuse by an exception in
/// an unusual floating-point mode. In the usual mode, exceptions are passed on.
std::optional<MotionResult> askChecker(const Case& c);
std::optional<PathReport> askVerifier(const Case& c);
/// Returns the answer of `Checker::certifyEdge`, or of `Checker::certifyCurve` for a piece, for a
/// model made of the case's plain data.
MotionResult answerOfModel(const Case& c);
/// An answer of the method `certified`, and whether `checkCertificate` accepts the certificate of
/// that answer.
struct Certificate {
  MotionResult result;
  bool accepted = false;
};
Certificate certifiedAnswer(const Case& c);
/// Returns whether `checkCertificate` accepts a forged certificate, which claims `clearance`
/// (metres) along the whole edge, in `intervals` equal intervals.
bool acceptsForged(const Case& c, double clearance, int intervals);

/// Returns how far the edge is from a half turn, in radians: π minus the largest angle by which a
/// circle or rotation coordinate changes along the edge, minus the rounding of large angles. Circle
/// coordinates of a piece of a curve are left out.
double leftToHalfTurn(const Edge& edge);

/// Return what is wrong with an answer, or "" for a right answer.
std::string faultOf(const Case& c, const MotionResult& answer);
std::string faultOf(const Case& c, const PathReport& answer);

/// Returns all data of a case as text. Numbers are hexadecimal, so that they are exact.
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
