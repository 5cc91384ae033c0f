#pragma once

#include <string>

#include "planner/verify/verify_path.h"

/// Internal: checks of the verifier's input.
namespace corridor::verify {

/// @throws std::invalid_argument "verifyPath: what".
[[noreturn]] void refuse(const std::string& what);

/// Refuses a problem as verifyPath() states, except pairs of `heldPairs` with a joint that moves
/// between their bodies. @throws std::invalid_argument
void requireValid(const PathProblem& problem);

/// Refuses a piece that does not fit the problem. Its coefficients may be anything.
/// @throws std::invalid_argument
void requireValid(const PathProblem& problem, const CurvePiece& piece);

}  // namespace corridor::verify
