#pragma once

#include <string>

namespace corridor {

/// Returns the text in double quotes, as in CSV (RFC 4180) and for names in SQL: its own double
/// quotes are doubled.
std::string inDoubleQuotes(const std::string& text);

/// Returns the text as a field of a CSV line: quoted if it has a comma, a double quote or a line
/// break.
std::string csvField(const std::string& text);

}  // namespace corridor
