#include <algorithm>

#include "collision/geometry/point_readers.h"

namespace corridor {
namespace {

/// Returns the next word of the line. Commas and semicolons separate words, too.
std::string_view nextWord(std::string_view& line) {
  constexpr std::string_view separators = " \t\r\v\f,;";
  const std::size_t begin = std::min(line.find_first_not_of(separators), line.size());
  line.remove_prefix(begin);
  const std::size_t end = std::min(line.find_first_of(separators), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

}  // namespace

PointCloud readXyz(std::string_view text, MeshFaults& faults) {
  PointCloud cloud{{}, "text"};
  int number = 0;
  while (!text.empty()) {
    ++number;
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::string_view first = nextWord(line);
    if (first.empty() || first.front() == '#' || first.starts_with("//")) continue;
    const std::string_view second = nextWord(line), third = nextWord(line);
    if (second.empty() && cloud.points.empty()) {
      std::int64_t count = 0;
      if (parseInteger(first, count)) continue;  // .pts: the number of points comes first
    }
    if (third.empty()) {
      faults.add(number,
                 "a point has 3 coordinates, found " + std::to_string(second.empty() ? 1 : 2));
      continue;
    }
    Vec3& point = cloud.points.emplace_back();
    for (const auto& [word, axis] :
         {std::pair(first, 0), std::pair(second, 1), std::pair(third, 2)})
      if (const auto why = parseCoordinate(word, point[axis], true)) {
        faults.add(number, *why);
        break;
      }
    faults.requireFew(cloud.points.size(), "points", number);
  }
  return cloud;
}

}  // namespace corridor
