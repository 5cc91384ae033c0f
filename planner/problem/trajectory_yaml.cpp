#include "planner/problem/trajectory_yaml.h"

#include "collision/core/shortest.h"
#include "planner/problem/keys.h"

namespace corridor {

void readTrajectoryKeys(const YamlMap& problem, TrajectorySettings& settings) {
  const YamlValue* value = problem.find("trajectory");
  if (!value) return;
  const YamlMap map(*value, "trajectory", &problemKeys().at("trajectory"), problem.source());
  const auto within = [&](const char* key, const ClosedRange& range) {
    std::optional<double> number = map.number(key, Range::Positive);
    if (!number || range.contains(*number)) return number;
    map.fault(key, range.text() + " is needed, not " + shortest(*number));
    return std::optional<double>();
  };
  if (const auto word = map.choice("smooth", wordsFor<Smoothing>()))
    settings.smooth = *choiceNamed<Smoothing>(*word);
  settings.deviation =
      within("deviation", TrajectorySettings::kDeviations).value_or(settings.deviation);
  settings.cornerDeviation = within("corner_deviation", TrajectorySettings::kCornerDeviations);
  settings.rate = within("rate", TrajectorySettings::kRates);
}

}  // namespace corridor
