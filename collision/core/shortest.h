#pragma once

#include <string>

namespace corridor {

/// Returns the shortest decimal digits that read back as this double, for messages and files.
std::string shortest(double value);

}  // namespace corridor
