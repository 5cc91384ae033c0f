#include "planner/benchmark/variant.h"

#include <algorithm>

#include "collision/core/error.h"
#include "collision/core/shortest.h"
#include "collision/core/spelling.h"
#include "planner/problem/checker_yaml.h"
#include "planner/problem/keys.h"
#include "planner/problem/yaml_reader.h"

namespace corridor {
namespace {

[[noreturn]] void refuse(const std::string& why) {
  throw InputError(Fault{"--variants", 0, why});
}

}  // namespace

void Variant::apply(CheckerSettings& spec) const {
  FaultList faults;
  YamlSource source{"variant " + name, faults, {}};
  readCheckerKeys(YamlMap(checker, "checker", &problemKeys().at("checker"), source), spec);
  faults.throwIfAny();
}

YamlValue checkerMap(const std::vector<std::pair<std::string, std::string>>& keys) {
  YamlValue map;
  map.kind = YamlValue::Kind::Map;
  for (const auto& [key, text] : keys)
    map.entries.push_back({key, 0, {YamlValue::Kind::Scalar, 0, text, true, false, {}, {}}});
  return map;
}

Variant readVariant(const std::string& text, const std::vector<BenchmarkCompetitor>& competitors) {
  const auto colon = text.find(':');
  const std::string name = text.substr(0, colon);
  std::vector<std::string> names = problemChoices().at("checker.edges");
  Variant variant{text, {}, {}};
  std::string edges = name;
  bool known = std::find(names.begin(), names.end(), name) != names.end();
  for (const BenchmarkCompetitor& competitor : competitors) {
    names.push_back(competitor.name);
    if (competitor.name != name) continue;
    known = true;
    edges = competitor.edges;
    variant.competitor = competitor;
  }
  if (!known)
    refuse("unknown variant " + quotedWord(name) + didYouMean(name, names) + "; there are: " +
           joined(names) + "; a resolution or tolerance may follow: discrete:0.01");
  if (colon == std::string::npos) {
    variant.checker = checkerMap({{"edges", edges}});
    return variant;
  }
  const std::string knob = text.substr(colon + 1);
  double value = 0;
  const bool number = parseNumber(knob, Range::Any, value).empty(), samples = edges == "discrete";
  if (samples && !(number && isResolution(value)))
    refuse(quotedWord(text) + ": a resolution from " + shortest(kFinestResolution) +
           " to below 1 is needed, not " + quotedWord(knob));
  if (!samples && !(number && value > 0))
    refuse(quotedWord(text) + ": a tolerance above 0, in metres, is needed, not " +
           quotedWord(knob));
  variant.checker = checkerMap({{"edges", edges}, {samples ? "resolution" : "tolerance", knob}});
  return variant;
}

}  // namespace corridor
