#pragma once

#include <string>

namespace corridor {

/// Returns the text in double quotes, with its own ones doubled, as in CSV (RFC 4180) and for names
/// in SQL.
std::string inDoubleQuotes(const std::string& text);

/// Returns the text as a field of a CSV line: quoted if it has a comma, a quote or a line break.
std::string csvField(const std::string& text);

}  // namespace corridor
