#include "planner/problem/text_words.h"

#include <algorithm>
#include <sstream>

namespace corridor {

std::vector<std::string> wordsOfLine(std::string line) {
  line.resize(std::min(line.size(), line.find('#')));
  std::replace(line.begin(), line.end(), ',', ' ');
  std::istringstream words(line);
  std::vector<std::string> all;
  for (std::string word; words >> word;) {
    if (word.size() > 2 && word.front() == '"' && word.back() == '"')
      word = word.substr(1, word.size() - 2);
    all.push_back(word);
  }
  return all;
}

std::string yamlText(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if ((c >= 0 && c < ' ') || c == 0x7f) {
      constexpr const char* digits = "0123456789abcdef";
      quoted += std::string("\\x") + digits[c / 16] + digits[c % 16];
      continue;
    }
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}

}  // namespace corridor
