#include "planner/import/omplapp_planners.h"

#include <algorithm>
#include <map>

#include "collision/core/spelling.h"

namespace corridor {
namespace {

/// OMPL's names of planners, by the names in OMPL.app.
const std::map<std::string, std::string>& omplNames() {
  static const std::map<std::string, std::string> names{{"rrt", "RRT"},
                                                        {"rrtconnect", "RRTConnect"},
                                                        {"lazyrrt", "LazyRRT"},
                                                        {"rrtstar", "RRTstar"},
                                                        {"lbtrrt", "LBTRRT"},
                                                        {"trrt", "TRRT"},
                                                        {"est", "EST"},
                                                        {"biest", "BiEST"},
                                                        {"projest", "ProjEST"},
                                                        {"sbl", "SBL"},
                                                        {"kpiece", "KPIECE1"},
                                                        {"bkpiece", "BKPIECE1"},
                                                        {"lbkpiece", "LBKPIECE1"},
                                                        {"prm", "PRM"},
                                                        {"prmstar", "PRMstar"},
                                                        {"lazyprm", "LazyPRM"},
                                                        {"lazyprmstar", "LazyPRMstar"},
                                                        {"spars", "SPARS"},
                                                        {"spars2", "SPARStwo"},
                                                        {"stride", "STRIDE"},
                                                        {"pdst", "PDST"},
                                                        {"fmt", "FMT"},
                                                        {"bfmt", "BFMT"},
                                                        {"bitstar", "BITstar"},
                                                        {"cforest", "CForest"},
                                                        {"sst", "SST"},
                                                        {"bitrrt", "BiTRRT"},
                                                        {"informedrrtstar", "InformedRRTstar"},
                                                        {"sorrtstar", "SORRTstar"}};
  return names;
}

struct Instance {
  std::string name;  ///< the planner's name in OMPL.app
  int line = 0;
  std::map<std::string, const IniFile::Entry*> params;  ///< the planner's parameters
  /// Entries in the planner's part of the file that replace entries of the section `problem`. The
  /// map's keys are the names of the replaced entries.
  std::map<std::string, const IniFile::Entry*> problem;
};

}  // namespace

void readSampler(const IniFile& ini, const IniFile::Entry& entry, Problem& problem) {
  const std::vector<std::string>& words = wordsFor<ValidSampler>();
  problem.source.lines["sampler"] = entry.line;
  if (const auto sampler = choiceNamed<ValidSampler>(entry.value))
    problem.settings.sampler = *sampler;
  else
    ini.fault(entry, notOneOf(entry.value, words));
}

void readOmplAppPlanners(const IniFile& ini, Problem& problem) {
  std::vector<Instance> instances;
  std::vector<std::string> unknown;
  for (const IniFile::Entry& entry : ini.entries()) {
    const std::string key = lowered(entry.key);
    constexpr std::string_view section = "planner.";
    if (!key.starts_with(section)) continue;
    const auto dot = key.find('.', section.size());
    const std::string name =
        key.substr(section.size(), dot == key.npos ? dot : dot - section.size());
    const std::string param = dot == key.npos ? "" : key.substr(dot + 1);
    if (name == "problem") {
      if (!instances.empty()) instances.back().problem[param] = &entry;
      continue;
    }
    if (!omplNames().contains(name)) {
      if (std::find(unknown.begin(), unknown.end(), name) == unknown.end()) unknown.push_back(name);
      continue;
    }
    auto instance = std::find_if(instances.rbegin(), instances.rend(),
                                 [&](const Instance& i) { return i.name == name; });
    if (param.empty() || instance == instances.rend()) {
      instances.push_back({name, entry.line, {}, {}});
      instance = instances.rbegin();
    }
    if (!param.empty() && param != "name") instance->params[param] = &entry;
  }
  if (!unknown.empty())
    problem.source.notes.push_back({"planners with unknown names are skipped: " + joined(unknown)});
  if (instances.size() > 1) {
    std::vector<std::string> names;
    for (const Instance& instance : instances) names.push_back(instance.name);
    problem.source.notes.push_back({"planner: " + problem.settings.planner.name +
                                    ", since the file lists several (" + joined(names) + ")"});
  }
  if (instances.size() != 1) return;
  const Instance& only = instances.front();
  problem.settings.planner.name = omplNames().at(only.name);
  problem.source.lines["planner.name"] = only.line;
  for (const auto& [key, entry] : only.params) {
    problem.settings.planner.params[key] = entry->value;
    problem.source.lines["planner.params." + key] = entry->line;
  }
  if (const auto sampler = only.problem.find("sampler"); sampler != only.problem.end())
    readSampler(ini, *sampler->second, problem);
  if (const auto fraction = only.problem.find("longest_valid_segment_fraction");
      fraction != only.problem.end())
    problem.settings.checker.resolution = ini.number(*fraction->second, Range::Resolution)
                                              .value_or(problem.settings.checker.resolution);
}

}  // namespace corridor
