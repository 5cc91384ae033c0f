#include "planner/verify/path_problem.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace corridor::verify {
namespace {

/// Bounds of bodies and chains are minima and maxima, which may drop a NaN.
bool isFinite(const VerifyBody& body) {
  const auto finite = [](const Vec3& p) { return p.allFinite(); };
  if (body.mesh) return std::all_of(body.mesh->vertices.begin(), body.mesh->vertices.end(), finite);
  return std::all_of(body.parts.begin(), body.parts.end(), [&](const ConvexPart& part) {
    return std::isfinite(part.radius) && part.radius >= 0 &&
           std::all_of(part.points.begin(), part.points.end(), finite);
  });
}

bool isFinite(const Frame& frame) {
  return frame.fixed.p.allFinite() && frame.fixed.q.coeffs().allFinite() &&
         !frame.fixed.q.coeffs().isZero(0) && frame.axis.allFinite() &&
         std::isfinite(frame.multiplier) && std::isfinite(frame.offset);
}

}  // namespace

void refuse(const std::string& what) {
  throw std::invalid_argument("verifyPath: " + what);
}

void requireValid(const PathProblem& problem) {
  if (!problem.tree || !problem.space) refuse("tree and space must not be null");
  if (!(problem.margin >= 0 && std::isfinite(problem.margin)))
    refuse("margin must be finite and not negative");
  if (!(problem.wantedClearance >= 0 && std::isfinite(problem.wantedClearance)))
    refuse("wantedClearance must be finite and not negative");
  if (!(problem.tolerance > 0 && std::isfinite(problem.tolerance)))
    refuse("tolerance must be finite and positive");
  if (static_cast<std::size_t>(problem.tube.size()) != problem.space->size())
    refuse("tube must have as many numbers as a configuration");
  if (!problem.tube.allFinite() || (problem.tube.array() < 0).any())
    refuse("tube must be finite and not negative");
  const Eigen::Index limits = problem.provedLower.size();
  if (limits != problem.provedUpper.size() || (limits != 0 && limits != problem.tube.size()))
    refuse("provedLower and provedUpper must be empty or have the size of a configuration");
  for (const VerifyBody& body : problem.bodies)
    if ((body.mesh == nullptr) == body.parts.empty() ||
        (body.mesh && body.mesh->triangles.empty()) ||
        std::any_of(body.parts.begin(), body.parts.end(),
                    [](const ConvexPart& part) { return part.points.empty(); }))
      refuse("body " + body.name + " needs a mesh or parts");
  for (const VerifyBody& body : problem.bodies)
    if (!isFinite(body)) refuse("body " + body.name + " has a number that is not finite");
  for (const Frame& frame : problem.tree->frames)
    if (!isFinite(frame)) refuse("frame " + frame.name + " has a number that is not finite");
  for (const std::vector<VerifyPair>* pairs : {&problem.pairs, &problem.heldPairs})
    for (const VerifyPair& pair : *pairs) {
      if (pair.a >= problem.bodies.size() || pair.b >= problem.bodies.size())
        refuse("a pair names a body that does not exist");
      if (!(pair.padding >= 0 && std::isfinite(pair.padding)))
        refuse("padding must be finite and not negative");
    }
}

void requireValid(const PathProblem& problem, const CurvePiece& piece) {
  const auto size = static_cast<Eigen::Index>(problem.space->size());
  if (piece.coefficients.rows() != size)
    refuse("a piece must have one row for each number of a configuration");
  if (piece.degree() < 1 || piece.degree() > CurvePiece::kLargestDegree)
    refuse("the degree of a piece must be from 1 to 9");
  if (piece.error.size() != size) refuse("error must have as many numbers as a configuration");
  if (!piece.error.allFinite() || (piece.error.array() < 0).any())
    refuse("error must be finite and not negative");
}

}  // namespace corridor::verify
