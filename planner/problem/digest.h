#pragma once

#include <string>

#include "planner/problem/problem.h"

namespace corridor {

/// Returns the digest of a problem, 64 hexadecimal digits: the SHA-256 of the SHA-256 digests of
/// its files (32 bytes each, one after the other). In a shell: sha256sum FILES | cut -c-64 | xxd -r
/// -p | sha256sum.
///
/// Reads the files again. The digest is that of the problem that was read if no file has changed
/// since `readProblem`. Callers therefore compute it at once after reading, not at the end of their
/// work, when a file may be another.
/// @throws InputError if a file can't be read.
std::string digestOf(const Problem& problem);

}  // namespace corridor
