#pragma once

#include <optional>
#include <string_view>

namespace corridor {

/// What a comment, or the header, of a table of points says about its columns.
struct ColumnNames {
  enum class Order {
    none,  ///< it does not name x, y and z
    xyz,   ///< its first names are x, y and z, in this order
    other
  };
  Order order = Order::none;
  bool hasWords = false;   ///< it has letters
  bool isOnUnits = false;  ///< it has a word that begins with "unit"
  /// The first unit other than metres that it names; without one, 1 if it names metres. Set only if
  /// the line is about x, y and z, or about units. In a line about units, a number before the
  /// unit's name is a factor if it follows "=" or the word on units: `1 unit = 10 mm`; so is the
  /// number in `metres per unit: 0.01`. Units behind those that follow "units" are of
  /// something else, as in `units: m; accuracy 5 mm`, unless an axis follows too.
  std::optional<double> metresPerUnit = {};
};

/// Reads a line such as `//X Y Z R G B`, `# x[mm] y[mm] z[mm]` or `# units: mm`. Upper and lower
/// case count as equal. What comes before a colon is a title, and names no column.
ColumnNames columnNamesIn(std::string_view line);

/// Returns the metres of a unit's name, such as "mm" or "inches", in lower case; 0 for other words.
/// "in" is no name, because comments have this word.
double metresOfUnit(std::string_view name);

}  // namespace corridor
