#pragma once

#include <optional>

#include "planner/verify/verify_path.h"

namespace corridor::verify {

/// The PathFinding::reason of edges and pieces that leave the proved range of a problem.
inline constexpr const char* kBeyondProofs =
    "outside of the joint values for which pairs that are not tested were proved never in contact";

/// Returns an end of the edge, 0 or 1, that is outside of PathProblem::provedLower and provedUpper,
/// or nullopt if the whole edge is inside. An end that is no state counts as inside.
std::optional<double> outsideProved(const PathProblem& problem, const Configuration& from,
                                    const Configuration& to);
/// Returns a τ near which the piece, widened by its error, is outside of PathProblem::provedLower
/// and provedUpper, or could not be shown to be inside; nullopt if the whole piece is inside.
/// @pre the piece is one that verifyCurve() accepts.
std::optional<double> outsideProved(const PathProblem& problem, const CurvePiece& piece);

}  // namespace corridor::verify
