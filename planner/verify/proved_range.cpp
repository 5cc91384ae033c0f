#include "planner/verify/proved_range.h"

#include <limits>
#include <vector>

#include "planner/verify/polynomial_range.h"

namespace corridor::verify {

std::optional<double> outsideProved(const PathProblem& problem, const Configuration& from,
                                    const Configuration& to) {
  const Configuration &lower = problem.provedLower, &upper = problem.provedUpper;
  for (const auto& [t, q] : {std::pair{0.0, &from}, std::pair{1.0, &to}})
    if (lower.size() > 0 && q->size() == lower.size() && q->allFinite() &&
        !((q->array() >= lower.array()).all() && (q->array() <= upper.array()).all()))
      return t;
  return std::nullopt;
}

std::optional<double> outsideProved(const PathProblem& problem, const CurvePiece& piece) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!piece.coefficients.allFinite()) return std::nullopt;  // refuted for another reason
  for (Eigen::Index i = 0; i < problem.provedLower.size(); ++i) {
    const double lower = problem.provedLower[i], upper = problem.provedUpper[i];
    if (lower == -infinity && upper == infinity) continue;
    const auto row = piece.coefficients.row(i);
    Bernstein polynomial(std::vector<double>(row.begin(), row.end()));
    polynomial.error += piece.error[i];
    const RangeAnswer answer = rangeOf(polynomial, lower, upper);
    if (answer.verdict != RangeAnswer::Verdict::within) return static_cast<double>(answer.at);
  }
  return std::nullopt;
}

}  // namespace corridor::verify
