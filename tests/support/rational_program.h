#pragma once

#include <vector>

#include "tests/support/integer.h"

namespace corridor::test {

/// Rows of a system of equations M x = r: the entries of a row of M, then that of r, which is ≥ 0.
using IntegerSystem = std::vector<std::vector<Integer>>;

/// The oracle for linear programs: returns whether there is an x ≥ 0 with M x = r. Phase one of the
/// simplex method with Bland's rule, by integer pivoting (Edmonds): exact, and it always ends.
bool hasSolution(IntegerSystem system);

/// The same for doubles, in the order of `columns[j][i]`, exactly.
bool hasSolution(const std::vector<std::vector<double>>& columns, const std::vector<double>& right);

/// Returns the rank of the matrix with these rows, exactly.
std::size_t rankOf(const std::vector<std::vector<double>>& rows);

}  // namespace corridor::test
