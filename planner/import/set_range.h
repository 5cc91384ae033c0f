#pragma once

#include <string>
#include <vector>

namespace corridor {

/// Expands a range of problems: "set.json#3-5" gives three names. Any other text, such as
/// "set.json#3", is returned unchanged, as the only name.
/// @throws InputError for a range that ends before it begins, or has more than 1,000 problems.
std::vector<std::string> problemsOf(const std::string& text);

}  // namespace corridor
