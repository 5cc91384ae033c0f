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
  bool hasWords = false;  ///< it has letters
  /// The first unit other than metres that it names; without one, 1 if it names metres. Set only if
  /// the line is about x, y and z, or about units.
  std::optional<double> metresPerUnit = {};
};

/// Reads a line such as `//X Y Z R G B`, `# x[mm] y[mm] z[mm]` or `# units: mm`. Upper and lower
/// case count as equal. What comes before a colon is a title, and names no column.
ColumnNames columnNamesIn(std::string_view line);

}  // namespace corridor
