#include "planner/view/view_direction.h"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/problem/number_text.h"

namespace corridor {
namespace {

struct Named {
  const char* name;
  double azimuth, elevation;  // degrees
};
constexpr Named kNamed[] = {{"front", 0, 0},   {"back", 180, 0}, {"left", 90, 0},
                            {"right", -90, 0}, {"top", -90, 90}, {"bottom", -90, -90}};

ViewDirection fromDegrees(double azimuth, double elevation) {
  constexpr double degree = std::numbers::pi / 180;
  return {azimuth * degree, elevation * degree};
}

}  // namespace

ViewDirection viewDirection(const std::string& text, const std::string& option) {
  std::vector<std::string> names;
  for (const Named& named : kNamed) {
    if (text == named.name) return fromDegrees(named.azimuth, named.elevation);
    names.push_back(named.name);
  }
  double azimuth = 0, elevation = 0;
  const std::size_t comma = text.find(',');
  if (comma != text.npos && parseNumber(text.substr(0, comma), Range::Any, azimuth).empty() &&
      parseNumber(text.substr(comma + 1), Range::Any, elevation).empty() &&
      std::abs(azimuth) <= 360 && std::abs(elevation) <= 90)
    return fromDegrees(azimuth, elevation);
  throw InputError(Fault{option, 0,
                         "one of " + joined(names) +
                             ", or AZIMUTH,ELEVATION in degrees (-360 to 360, -90 to 90; such as "
                             "-60,38) is needed, not " +
                             quotedWord(text) + didYouMean(text, names)});
}

}  // namespace corridor
