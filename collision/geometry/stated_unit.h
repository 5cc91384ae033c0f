#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace corridor {

/// A unit that a file states where its format has none: in a comment, a header or a name.
struct StatedUnit {
  int line = 0;       ///< 0: the header of a binary file
  std::string words;  ///< as in the file, for messages
  double metresPerUnit = 1;
};

/// If the text clearly states a unit of length, as in `units: mm` or `1 unit = 1 cm`, adds it to
/// `units`. A name of a unit without a word that begins with "unit" is not clear. Keeps the first
/// ten different units.
void addStatedUnit(std::string_view text, int line, std::vector<StatedUnit>& units);

/// Returns whether the units are equal, up to the rounding of ten digits and of a product of
/// factors.
bool isSameUnit(double metres, double otherMetres);

/// Returns the text of a note on the first of the stated units that is not the unit that is used;
/// nullopt if there is none.
std::optional<std::string> noteOnUnits(const std::vector<StatedUnit>& stated, double metresPerUnit);

/// Returns the metres of a unit by its name in problems: m, cm, mm or in; 0 for another name.
double metresPerUnitNamed(std::string_view name);

/// Returns how to state a unit in a problem, such as " (unit: mm)"; empty for a unit without a name
/// in problems.
std::string howToState(double metresPerUnit);

}  // namespace corridor
