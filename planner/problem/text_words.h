#pragma once

#include <string>
#include <vector>

namespace corridor {

/// Returns the words of a line of numbers or names: without a comment (`#`), separated by blanks or
/// commas, and without double quotes around a word.
std::vector<std::string> wordsOfLine(std::string line);

/// Returns the text in double quotes, escaped for YAML.
std::string yamlText(const std::string& text);

}  // namespace corridor
