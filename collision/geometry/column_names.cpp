#include "collision/geometry/column_names.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

/// Bytes of UTF-8 beyond ASCII count as letters, because of the micro sign.
bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
}

/// Returns the metres of a unit's name, or 0.
double metresIn(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, double>, 23> units{{
      {"m", 1},           {"meter", 1},         {"metre", 1},
      {"mm", 1e-3},       {"millimeter", 1e-3}, {"millimetre", 1e-3},
      {"cm", 1e-2},       {"centimeter", 1e-2}, {"centimetre", 1e-2},
      {"dm", 0.1},        {"km", 1e3},          {"kilometer", 1e3},
      {"kilometre", 1e3}, {"um", 1e-6},         {"\u00b5m", 1e-6},
      {"\u03bcm", 1e-6},  {"micron", 1e-6},     {"inch", 0.0254},
      {"inches", 0.0254}, {"ft", 0.3048},       {"foot", 0.3048},
      {"feet", 0.3048},   {"yard", 0.9144},
  }};
  if (word.size() > 4 && word.back() == 's' && word != "inches") word.remove_suffix(1);
  for (const auto& [name, metres] : units)
    if (word == name) return metres;
  return 0;
}

bool isAxis(std::string_view word) {
  return word == "x" || word == "y" || word == "z";
}

}  // namespace

ColumnNames columnNamesIn(std::string_view line) {
  const std::string text = lowered(line);
  ColumnNames result;
  std::vector<std::string> words;  // other than units
  bool isOnUnits = false;
  for (std::size_t at = 0; at < text.size();) {
    const auto isOfWord = [&](char c) { return isLetter(c) || (c >= '0' && c <= '9') || c == '.'; };
    if (text[at] == ':' && std::none_of(words.begin(), words.end(), isAxis)) words.clear();
    if (!isOfWord(text[at])) {
      ++at;
      continue;
    }
    const std::size_t from = at;
    while (at < text.size() && isOfWord(text[at])) ++at;
    std::string word = text.substr(from, at - from);
    result.hasWords |= std::any_of(word.begin(), word.end(), isLetter);
    isOnUnits |= word.starts_with("unit");
    // "in" is a unit in brackets only.
    const bool isInches =
        word == "in" && from > 0 && (text[from - 1] == '[' || text[from - 1] == '(');
    if (const double metres = isInches ? 0.0254 : metresIn(word); metres > 0) {
      if (result.metresPerUnit.value_or(1) == 1) result.metresPerUnit = metres;
      continue;
    }
    std::string sorted = word;
    std::sort(sorted.begin(), sorted.end());
    if (sorted == "xyz")
      for (const char axis : word) words.emplace_back(1, axis);
    else
      words.push_back(std::move(word));
  }
  const std::set<std::string_view> known(words.begin(), words.end());
  if (known.contains("x") && known.contains("y") && known.contains("z"))
    result.order = words[0] == "x" && words[1] == "y" && words[2] == "z"
                       ? ColumnNames::Order::xyz
                       : ColumnNames::Order::other;
  else if (!isOnUnits)
    result.metresPerUnit.reset();
  return result;
}

}  // namespace corridor
