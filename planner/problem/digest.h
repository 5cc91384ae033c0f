#pragma once

#include <string>

#include "planner/problem/problem.h"

namespace corridor {

/// Returns the digest of a problem, 64 hexadecimal digits: the SHA-256 of the SHA-256 digests of
/// its files (32 bytes each, one after the other). In a shell: sha256sum FILES | cut -c-64 | xxd -r
/// -p | sha256sum.
///
/// For a xacro file, the digests are those of the texts that xacro made of the file when the
/// problem was read. There is one text for each different set of arguments. These texts contain the
/// files that the xacro file includes, and depend on the arguments of xacro.
///
/// The function reads all other files again. If no file has changed since `readProblem`, the digest
/// is that of the problem that was read. Callers should therefore compute the digest directly after
/// `readProblem`, and not at the end of their work, when a file may have changed.
/// @throws InputError if a file can't be read.
std::string digestOf(const Problem& problem);

}  // namespace corridor
