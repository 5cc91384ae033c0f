#include "planner/benchmark/campaign_yaml.h"

#include <algorithm>
#include <map>
#include <set>

#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "planner/benchmark/competitors.h"
#include "planner/import/set_range.h"
#include "planner/problem/checker_yaml.h"
#include "planner/problem/format_key.h"
#include "planner/problem/keys.h"
#include "planner/solve/planner_factory.h"

namespace corridor {
namespace {

constexpr const char* kFormat = "corridor-campaign-1";
constexpr std::size_t kMostVariants = 1000;
constexpr WholeRange kRuns{1, 1'000'000, "1 to 1,000,000"};
constexpr WholeRange kSeeds{1, 0xffffffff, "1 to 2^32 - 1"};  // OMPL's seeds have 32 bits

/// One variant of a checker in the file, with one value chosen from each list.
struct Expanded {
  std::string suffix;  ///< the chosen values, " 0.01"; "" if the checker has no list
  YamlValue map;
};

/// Returns one variant of a checker for each combination of the values in the checker's lists, in
/// the order of the file.
std::vector<Expanded> expanded(const YamlValue& checker) {
  std::vector<Expanded> all{{"", checker}};
  for (std::size_t i = 0; i < checker.entries.size(); ++i) {
    const YamlValue& value = checker.entries[i].value;
    if (value.kind != YamlValue::Kind::List) continue;
    std::vector<Expanded> next;
    for (const Expanded& one : all)
      for (const YamlValue& item : value.items) {
        next.push_back(one);
        next.back().suffix += " " + item.text;
        next.back().map.entries[i].value = item;
      }
    all = std::move(next);
  }
  return all;
}

/// Returns the number of variants that `expanded` would return, but at most `kMostVariants` + 1.
std::size_t countExpanded(const YamlValue& checker) {
  std::size_t count = 1;
  for (const YamlValue::Entry& entry : checker.entries)
    if (entry.value.kind == YamlValue::Kind::List)
      count = std::min(count * std::min(entry.value.items.size(), kMostVariants + 1),
                       kMostVariants + 1);
  return count;
}

/// Returns whether a text can be a name in tables, plots and logs: one line, not empty.
bool isName(const std::string& text) {
  return !text.empty() && std::none_of(text.begin(), text.end(),
                                       [](unsigned char c) { return c < 0x20 || c == 0x7f; });
}

/// Returns a text of the keys of a checker that have an effect, with their values. A resolution has
/// no effect on edges that are proved; a tolerance has no effect on sampled edges. Keys that choose
/// trees have no effect on a competitor. Without the key `edges` the problem's method applies, so
/// both resolution and tolerance count.
std::string effectOf(const YamlValue& checker) {
  std::map<std::string, std::string> keys;
  for (const YamlValue::Entry& entry : checker.entries) keys[entry.key] = entry.value.text;
  if (const auto edges = keys.find("edges"); edges != keys.end())
    keys.erase(edges->second == "discrete" ? "tolerance" : "resolution");
  if (keys.count("peer"))
    for (const char* key : {"volume", "overlap", "fit", "build", "tolerance"}) keys.erase(key);
  std::string text;
  for (const auto& [key, value] : keys) text += key + ": " + value + "\n";
  return text;
}

/// Returns the map without `peer`, which problem files don't have.
YamlValue withoutCompetitor(YamlValue map) {
  std::erase_if(map.entries, [](const YamlValue::Entry& entry) { return entry.key == "peer"; });
  return map;
}

class CampaignReader {
 public:
  explicit CampaignReader(const std::filesystem::path& path)
      : path_(path), faults_(path.string()), source_{path.string(), faults_, {}} {}

  Campaign read() {
    const YamlValue document = parseYaml(
        path_.string(), readTextFile(path_, std::string("a campaign (format: ") + kFormat + ")"));
    if (!acceptsFormat(document, kFormat, source_)) faults_.throwIfAny();
    const YamlMap map(document, "", &campaignKeys().at(""), source_);
    campaign_.name = nameOfFile(path_, "campaign");
    readProblems(map);
    readPlanners(map);
    readCheckers(map);
    campaign_.runs = map.wholeNumber("runs", kRuns).value_or(campaign_.runs);
    campaign_.seed = map.wholeNumber("seed", kSeeds).value_or(campaign_.seed);
    readLimits(map);
    campaign_.simplify = readSimplifier(map);
    campaign_.verify = map.boolean("verify").value_or(true);
    campaign_.trajectories =
        readTrajectories(map, path_.parent_path(), campaign_.problems, campaign_.notes);
    faults_.throwIfAny();
    identifyProblems(campaign_);
    for (const char* key : {"planners", "runs", "trajectories"}) place(key, key);
    place("variants", "checkers");
    return std::move(campaign_);
  }

 private:
  static std::optional<Simplifier> readSimplifier(const YamlMap& map) {
    const auto word = map.choice("simplify", wordsFor<Simplifier>());
    return word ? choiceNamed<Simplifier>(*word) : std::nullopt;
  }

  void place(const std::string& what, const std::string& key) {
    const auto line = source_.lines.find(key);
    const std::string at = line == source_.lines.end() ? "" : ":" + std::to_string(line->second);
    campaign_.places[what] = path_.string() + at + ": " + key;
  }

  void readProblems(const YamlMap& file) {
    const YamlValue* value = file.require("problems", "a list, such as [../thin_plate, ../piano]");
    if (!value) return;
    const auto words = readWords(*value, "[../thin_plate, ../piano]", "problems", source_);
    if (!words) return;
    if (words->empty()) file.fault("problems", "at least one is needed");
    for (const std::string& word : *words)
      faults_.collect([&] {
        for (const std::string& name : problemsOf(word)) {
          // Only here is the line of the campaign file known; readProblem could not name it.
          const std::filesystem::path at = path_.parent_path() / name.substr(0, name.find('#'));
          std::error_code ignored;
          if (!std::filesystem::exists(at, ignored))
            file.fault("problems", "no such file or folder: " + at.string());
          else
            campaign_.problems.push_back(readProblem(path_.parent_path() / name));
        }
      });
  }

  void readPlanners(const YamlMap& file) {
    const YamlValue* value = file.find("planners");
    if (!value) return;
    if (value->kind == YamlValue::Kind::List && value->items.empty()) {
      file.fault("planners", "at least one is needed; without this key each problem uses its own");
      return;
    }
    if (value->kind != YamlValue::Kind::List) {
      file.fault("planners",
                 "a list is needed, such as [RRTConnect, {name: RRT, label: short "
                 "RRT, params: {range: 0.2}}], not " +
                     described(*value));
      return;
    }
    for (const YamlValue& item : value->items) {
      if (item.kind == YamlValue::Kind::Scalar) {
        addPlanner({item.text, item.text, {}}, item.line);
        continue;
      }
      const YamlMap map(item, "planners[]", &campaignKeys().at("planners[]"), source_);
      const auto name = map.text("name");
      map.require("name", "OMPL's name of a planner, such as RRTConnect");
      if (!name) continue;
      CampaignPlanner planner{map.text("label").value_or(*name), *name, {}};
      if (!isName(planner.label)) map.fault("label", "must be one line of text, not empty");
      if (const YamlValue* params = map.find("params")) {
        planner.params.emplace();
        const YamlMap values(*params, "planners[].params", nullptr, source_);
        for (const YamlValue::Entry* entry : values.entries())
          if (const auto text = values.text(entry->key)) (*planner.params)[entry->key] = *text;
      }
      planner.simplify = readSimplifier(map);
      addPlanner(std::move(planner), item.line);
    }
  }

  void addPlanner(CampaignPlanner planner, int line) {
    planner.place = path_.string() + ":" + std::to_string(line) + ": planners";
    if (const auto unknown = unknownPlanner(planner.name))
      source_.fault(line, "planners: " + *unknown);
    campaign_.planners.push_back(std::move(planner));
  }

  void readCheckers(const YamlMap& file) {
    const YamlValue* value =
        file.require("checkers",
                     "named checkers, such as {certified: {edges: certified}, one pct: "
                     "{edges: discrete, resolution: 0.01}}");
    if (!value) return;
    const YamlMap map(*value, "checkers", nullptr, source_);
    if (map.empty() && value->kind == YamlValue::Kind::Map)
      file.fault("checkers", "at least one is needed");
    for (const YamlValue::Entry* entry : map.entries()) {
      if (entry->value.kind != YamlValue::Kind::Map) {
        map.fault(entry->key,
                  "a map is needed, such as {edges: certified}, not " + described(entry->value));
        continue;
      }
      readChecker(*entry);
    }
  }

  void readChecker(const YamlValue::Entry& entry) {
    const std::string path = "checkers." + entry.key;
    const MapKeys& keys = campaignKeys().at("checkers.*");
    for (const YamlValue::Entry& key : entry.value.entries)
      if (key.value.kind == YamlValue::Kind::List && !listOfWords(key.value)) {
        source_.fault(key.line,
                      path + "." + key.key + ": a list must have one or more single values");
        return;
      }
    if (!isName(entry.key)) {
      source_.fault(entry.line, "checkers: a checker's name must be one line of text, not empty");
      return;
    }
    expanded_ = std::min(expanded_ + countExpanded(entry.value), kMostVariants + 1);
    if (expanded_ > kMostVariants) {
      source_.fault(entry.line, path + ": the lists of the checkers make more than " +
                                    std::to_string(kMostVariants) + " variants");
      return;
    }
    std::set<std::string> seenFaults;         // faults of the variants of this checker so far
    std::map<std::string, std::string> same;  // `effectOf` a variant → its suffix
    for (const Expanded& one : expanded(entry.value)) {
      FaultList faults;
      YamlSource source{path_.string(), faults, {}};
      const YamlMap map(one.map, path, &keys, source);
      Variant variant{entry.key + one.suffix, withoutCompetitor(one.map), {}};
      CheckerSettings checker;
      readCheckerKeys(map, checker);
      const auto peer = map.text("peer");
      const bool takesPart = !peer || resolveCompetitor(*peer, variant, map, checker);
      if (faults.size() == 0) {
        const auto [other, unlike] = same.insert({effectOf(one.map), one.suffix});
        if (!unlike) {
          source_.fault(entry.line, path + ": \"" + entry.key + other->second + "\" and \"" +
                                        entry.key + one.suffix +
                                        "\" would be the same checker: what differs has no effect");
          return;
        }
        if (takesPart) campaign_.variants.push_back(std::move(variant));
        continue;
      }
      try {
        faults.throwIfAny();
      } catch (const InputError& error) {
        for (const Fault& fault : error.faults())
          if (seenFaults.insert(fault.str()).second)
            faults_.add(fault.file, fault.line, fault.text);
      }
    }
  }

  static bool listOfWords(const YamlValue& value) {
    return !value.items.empty() &&
           std::all_of(value.items.begin(), value.items.end(),
                       [](const YamlValue& item) { return item.kind == YamlValue::Kind::Scalar; });
  }

  bool resolveCompetitor(const std::string& name, Variant& variant, const YamlMap& map,
                         const CheckerSettings& checker) {
    if (std::find(competitorNames().begin(), competitorNames().end(), name) ==
        competitorNames().end()) {
      map.fault("peer", "unknown competitor " + quotedWord(name) +
                            didYouMean(name, competitorNames()) +
                            "; there are: " + joined(competitorNames()));
      return false;
    }
    if (checker.edges != EdgeMethod::discrete) {
      map.fault("peer", name + " tests states only; set edges: discrete");
      return false;
    }
    if (const std::string why = whyUnavailable(name); !why.empty()) {
      campaign_.notes.push_back(variant.name + " is left out: " + name +
                                " is not available: " + why);
      return false;
    }
    variant.competitor = competitorNamed(name);
    return true;
  }

  void readLimits(const YamlMap& file) {
    const YamlValue* value = file.find("limits");
    if (!value) return;
    const YamlMap map(*value, "limits", &campaignKeys().at("limits"), source_);
    campaign_.time = map.number("time", Range::Positive);
    const auto memory = map.number("memory_mb", Range::Positive);
    if (memory && !(*memory >= 1 && *memory <= 1e9)) map.fault("memory_mb", "1 to 1e9 are needed");
    campaign_.limits.memory = memory.value_or(campaign_.limits.memory);
  }

  std::filesystem::path path_;
  FaultList faults_;
  YamlSource source_;
  std::size_t expanded_ = 0;  // variants so far, including those left out
  Campaign campaign_;
};

}  // namespace

bool isCampaignFile(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored) ||
      (file.extension() != ".yaml" && file.extension() != ".yml"))
    return false;
  try {
    const YamlValue document = parseYaml(file.string(), readTextFile(file, "a campaign"));
    return std::any_of(document.entries.begin(), document.entries.end(), [](const auto& entry) {
      return (entry.key == "format" && entry.value.text.rfind("corridor-campaign", 0) == 0) ||
             entry.key == "checkers";  // if the key `format` is missing, readCampaign reports this
    });
  } catch (const InputError&) {
    return false;
  }
}

Campaign readCampaign(const std::filesystem::path& file) {
  return CampaignReader(file).read();
}

const std::map<std::string, MapKeys>& campaignKeys() {
  static const std::map<std::string, MapKeys> keys = [] {
    std::vector<std::string> checker = problemKeys().at("checker").legal;
    checker.push_back("peer");
    std::map<std::string, MapKeys> all{
        {"",
         {{"format", "problems", "planners", "checkers", "runs", "seed", "limits", "simplify",
           "verify", "trajectories"},
          {}}},
        {"planners[]", {{"name", "label", "params", "simplify"}, {}}},
        {"checkers.*", {checker, {}}},
        {"limits", {{"time", "memory_mb"}, {}}},
    };
    addTrajectoryKeys(all);
    return all;
  }();
  return keys;
}

}  // namespace corridor
