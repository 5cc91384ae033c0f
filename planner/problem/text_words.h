#pragma once

#include <string>
#include <vector>

namespace corridor {

/// Returns the words of a line of numbers or names. Words are separated by blanks or commas. A
/// comment (from `#` on) and double quotes around a word are removed.
std::vector<std::string> wordsOfLine(std::string line);

/// Returns the text in double quotes, escaped for YAML.
std::string yamlText(const std::string& text);

}  // namespace corridor
