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
  const auto word = map.choice("smooth", wordsFor<Smoothing>());
  if (word) settings.smooth = *choiceNamed<Smoothing>(*word);
  settings.deviation =
      within("deviation", TrajectorySettings::kDeviations).value_or(settings.deviation);
  settings.cornerDeviation = within("corner_deviation", TrajectorySettings::kCornerDeviations);
  if (word && settings.cornerDeviation && settings.smooth != Smoothing::corners)
    map.source().notes.push_back(
        {"trajectory: with corner_deviation only corners are rounded; "
         "smooth: " +
             *word + " is not used",
         NoteWeight::motion});
  settings.rate = within("rate", TrajectorySettings::kRates);
}

}  // namespace corridor
