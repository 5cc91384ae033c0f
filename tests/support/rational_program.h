#pragma once

#include <vector>

#include "tests/support/integer.h"

namespace corridor::test {

/// A system of equations M x = r, row by row: the entries of a row of M, then the entry of r, which
/// must be ≥ 0.
using IntegerSystem = std::vector<std::vector<Integer>>;

/// The oracle for linear programs: returns whether there is an x ≥ 0 with M x = r. Method: phase
/// one of the simplex method with Bland's rule, by integer pivoting (Edmonds). The method is exact,
/// and always ends.
bool hasSolution(IntegerSystem system);

/// Returns, exactly, whether there is an x ≥ 0 with M x = `right`, where `columns[j][i]` is the
/// entry of M in row i and column j. Entries of `right` may be negative.
bool hasSolution(const std::vector<std::vector<double>>& columns, const std::vector<double>& right);

/// Returns the rank of the matrix with these rows, exactly.
std::size_t rankOf(const std::vector<std::vector<double>>& rows);

}  // namespace corridor::test
