#include "collision/geometry/column_names.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "collision/core/spelling.h"
#include "collision/geometry/mesh_text.h"

namespace corridor {
namespace {

/// Bytes of UTF-8 beyond ASCII count as letters, because of the micro sign.
bool isLetter(char c) {
  return (c >= 'a' && c <= 'z') || static_cast<unsigned char>(c) >= 0x80;
}

bool isAxis(std::string_view word) {
  return word == "x" || word == "y" || word == "z";
}

/// Returns whether the word is "xyz", or another order of these letters.
bool isXyz(std::string word) {
  std::sort(word.begin(), word.end());
  return word == "xyz";
}

bool isInWord(char c) {
  return isLetter(c) || (c >= '0' && c <= '9') || c == '.';
}

/// A word of a line, in lower case.
struct Word {
  std::string text;
  std::string marks;  ///< between the word before and this word

  bool isInBrackets() const { return marks.ends_with('[') || marks.ends_with('('); }
  bool isOnUnits() const {
    return text.starts_with("unit") && !text.starts_with("unite") && !text.starts_with("unity");
  }
};

std::vector<Word> wordsOf(const std::string& text) {
  std::vector<Word> words;
  for (std::size_t at = 0; at < text.size();) {
    const auto begin = std::find_if(text.begin() + std::ptrdiff_t(at), text.end(), isInWord);
    const auto end = std::find_if_not(begin, text.end(), isInWord);
    if (begin == end) break;
    Word word{{begin, end}, text.substr(at, std::size_t(begin - text.begin()) - at)};
    at = std::size_t(end - text.begin());
    // A full stop ends a sentence.
    while (word.text.size() > 1 && word.text.back() == '.') word.text.pop_back();
    words.push_back(std::move(word));
  }
  return words;
}

/// Reads a word as a factor, which is above 0.
std::optional<double> factorOf(std::string_view word) {
  double value = 0;
  if (parseCoordinate(word, value) || !(value > 0)) return std::nullopt;
  return value;
}

/// Returns whether the number that is `words[k]`, or with which it begins, may be a factor: it
/// follows "=", or a word on units without a comma, semicolon, number or unit between them. (Other
/// numbers are lengths: "Unit 7, 12 m above ground".)
bool isFactor(const std::vector<Word>& words, std::size_t k) {
  if (words[k].marks.find('=') != std::string::npos) return true;
  for (; k > 0 && words[k].marks.find_first_of(",;") == std::string::npos; --k) {
    const Word& before = words[k - 1];
    if (before.isOnUnits()) return true;
    if (factorOf(before.text) || metresOfUnit(before.text) > 0) return false;
  }
  return false;
}

/// Returns whether the unit `words[i]`, or its factor, comes right after a word on units: "units:
/// m", "unit = 1 m", "units are m".
bool isRightAfterUnit(const std::vector<Word>& words, std::size_t i) {
  if (i > 0 && factorOf(words[i - 1].text)) --i;
  if (i > 0 && (words[i - 1].text == "is" || words[i - 1].text == "are")) --i;
  return i > 0 && words[i - 1].isOnUnits();
}

/// Returns the metres that `words[i]` names, or 0. @param isOnUnits a word before begins with
/// "unit".
double metresAt(const std::vector<Word>& words, std::size_t i, bool isOnUnits) {
  const auto& [text, marks] = words[i];
  // "in" is a unit in brackets and at the end: "units: in".
  const bool isInches =
      text == "in" && (words[i].isInBrackets() || (isOnUnits && i + 1 == words.size()));
  if (const double metres = isInches ? 0.0254 : metresOfUnit(text); metres > 0) {
    if (i + 3 < words.size() && words[i + 1].text == "per" && words[i + 2].isOnUnits())
      return metres * factorOf(words[i + 3].text).value_or(1);
    if (!isOnUnits || i == 0 || marks.find_first_not_of(" \t") != marks.npos) return metres;
    return metres * (isFactor(words, i - 1) ? factorOf(words[i - 1].text).value_or(1) : 1);
  }
  if (!isOnUnits) return 0;
  const std::size_t digits = std::min(text.find_first_not_of("0123456789."), text.size());
  const double factor = factorOf(text.substr(0, digits)).value_or(0);
  return metresOfUnit(text.substr(digits)) * (factor > 0 && !isFactor(words, i) ? 1 : factor);
}

}  // namespace

double metresOfUnit(std::string_view name) {
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
  if (name.size() > 4 && name.back() == 's' && name != "inches") name.remove_suffix(1);
  for (const auto& [known, metres] : units)
    if (name == known) return metres;
  return 0;
}

ColumnNames columnNamesIn(std::string_view line) {
  ColumnNames result;
  const std::vector<Word> words = wordsOf(lowered(line));
  std::vector<std::string> names;  // words other than units
  std::size_t axes = 0;            // the number of words up to the last one that names axes
  for (std::size_t i = 0; i < words.size(); ++i)
    if (isAxis(words[i].text) || isXyz(words[i].text)) axes = i + 1;
  // A list of units right after "units" states those of the columns, and later units are of
  // something else: "units: m; accuracy 5 mm". If an axis follows, they may be the axis's unit.
  bool isStated = false, isClosed = false;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto& [text, marks] = words[i];
    if (marks.find(':') != marks.npos && std::none_of(names.begin(), names.end(), isAxis))
      names.clear();
    result.hasWords |= std::any_of(text.begin(), text.end(), isLetter);
    result.isOnUnits |= words[i].isOnUnits();
    if (words[i].isOnUnits()) isStated = isClosed = false;
    const double metres = metresAt(words, i, result.isOnUnits);
    isClosed |= isStated && (metres == 0 || !isLetter(text.front()));
    if (metres > 0) {
      isStated |= i >= axes && isRightAfterUnit(words, i);
      if (!isClosed && result.metresPerUnit.value_or(1) == 1) result.metresPerUnit = metres;
      continue;
    }
    if (isXyz(text))
      for (const char axis : text) names.emplace_back(1, axis);
    else
      names.push_back(text);
  }
  const std::set<std::string_view> known(names.begin(), names.end());
  if (known.contains("x") && known.contains("y") && known.contains("z"))
    result.order = names[0] == "x" && names[1] == "y" && names[2] == "z"
                       ? ColumnNames::Order::xyz
                       : ColumnNames::Order::other;
  else if (!result.isOnUnits)
    result.metresPerUnit.reset();
  return result;
}

}  // namespace corridor
