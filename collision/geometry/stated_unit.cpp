#include "collision/geometry/stated_unit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "collision/geometry/column_names.h"
#include "collision/geometry/mesh_text.h"

namespace corridor {
namespace {

constexpr std::array<std::pair<std::string_view, double>, 4> kUnits{
    {{"m", 1}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}}};

}  // namespace

void addStatedUnit(std::string_view text, int line, std::vector<StatedUnit>& units) {
  constexpr std::string_view unit = "unit";
  const auto isUnit = [](char a, char b) { return (a | 0x20) == b; };
  const auto found = std::search(text.begin(), text.end(), unit.begin(), unit.end(), isUnit);
  if (found == text.end() || units.size() == 10) return;
  const ColumnNames names = columnNamesIn(text);
  if (!names.isOnUnits || !names.metresPerUnit) return;
  for (const StatedUnit& other : units)
    if (isSameUnit(other.metresPerUnit, *names.metresPerUnit)) return;
  // A long text is quoted from its word "unit" on.
  const auto at = static_cast<std::size_t>(found - text.begin());
  std::string_view words = text.substr(text.size() > 32 ? at : 0);
  words = words.substr(0, words.find('\0'));
  const auto isSpace = [](char c) { return static_cast<unsigned char>(c) <= ' '; };
  const auto isNoPart = [&](char c) { return isSpace(c) || c == '#' || c == '/'; };
  while (!words.empty() && isNoPart(words.front())) words.remove_prefix(1);
  while (!words.empty() && isSpace(words.back())) words.remove_suffix(1);
  units.push_back({line, std::string(words), *names.metresPerUnit});
}

bool isSameUnit(double metres, double otherMetres) {
  // A unit of ten digits is off by 5e-10 of its size at most; the rounding of products is far less.
  return std::abs(metres - otherMetres) <= 1e-9 * std::max(metres, otherMetres);
}

std::optional<std::string> noteOnUnits(const std::vector<StatedUnit>& stated,
                                       double metresPerUnit) {
  for (const StatedUnit& unit : stated)
    if (!isSameUnit(unit.metresPerUnit, metresPerUnit))
      return (unit.line > 0 ? "line " + std::to_string(unit.line) : "the header") + " says " +
             inQuotes(unit.words) + ", but coordinates are read with a unit of " +
             shortest(metresPerUnit) + " m";
  return std::nullopt;
}

double metresPerUnitNamed(std::string_view name) {
  for (const auto& [known, metres] : kUnits)
    if (name == known) return metres;
  return 0;
}

std::string howToState(double metresPerUnit) {
  for (const auto& [name, metres] : kUnits)
    if (isSameUnit(metres, metresPerUnit)) return " (unit: " + std::string(name) + ')';
  return "";
}

}  // namespace corridor
