#include "planner/solve/planner_factory.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include <ompl/base/Planner.h>
#include <ompl/base/SpaceInformation.h>
#include <ompl/base/samplers/BridgeTestValidStateSampler.h>
#include <ompl/base/samplers/GaussianValidStateSampler.h>
#include <ompl/base/samplers/MaximizeClearanceValidStateSampler.h>
#include <ompl/base/samplers/ObstacleBasedValidStateSampler.h>
#include <ompl/base/samplers/UniformValidStateSampler.h>
#include <ompl/geometric/planners/AnytimePathShortening.h>
#include <ompl/geometric/planners/cforest/CForest.h>
#include <ompl/geometric/planners/est/BiEST.h>
#include <ompl/geometric/planners/est/EST.h>
#include <ompl/geometric/planners/est/ProjEST.h>
#include <ompl/geometric/planners/fmt/BFMT.h>
#include <ompl/geometric/planners/fmt/FMT.h>
#include <ompl/geometric/planners/informedtrees/ABITstar.h>
#include <ompl/geometric/planners/informedtrees/AITstar.h>
#include <ompl/geometric/planners/informedtrees/BITstar.h>
#include <ompl/geometric/planners/kpiece/BKPIECE1.h>
#include <ompl/geometric/planners/kpiece/KPIECE1.h>
#include <ompl/geometric/planners/kpiece/LBKPIECE1.h>
#include <ompl/geometric/planners/pdst/PDST.h>
#include <ompl/geometric/planners/prm/LazyPRM.h>
#include <ompl/geometric/planners/prm/LazyPRMstar.h>
#include <ompl/geometric/planners/prm/PRM.h>
#include <ompl/geometric/planners/prm/PRMstar.h>
#include <ompl/geometric/planners/prm/SPARS.h>
#include <ompl/geometric/planners/prm/SPARStwo.h>
#include <ompl/geometric/planners/rlrt/BiRLRT.h>
#include <ompl/geometric/planners/rlrt/RLRT.h>
#include <ompl/geometric/planners/rrt/BiTRRT.h>
#include <ompl/geometric/planners/rrt/InformedRRTstar.h>
#include <ompl/geometric/planners/rrt/LBTRRT.h>
#include <ompl/geometric/planners/rrt/LazyRRT.h>
#include <ompl/geometric/planners/rrt/RRT.h>
#include <ompl/geometric/planners/rrt/RRTConnect.h>
#include <ompl/geometric/planners/rrt/RRTXstatic.h>
#include <ompl/geometric/planners/rrt/RRTsharp.h>
#include <ompl/geometric/planners/rrt/RRTstar.h>
#include <ompl/geometric/planners/rrt/SORRTstar.h>
#include <ompl/geometric/planners/rrt/TRRT.h>
#include <ompl/geometric/planners/sbl/SBL.h>
#include <ompl/geometric/planners/sst/SST.h>
#include <ompl/geometric/planners/stride/STRIDE.h>

#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "planner/solve/portfolio.h"
#include "planner/solve/sliding_connect.h"

namespace corridor {

namespace ob = ompl::base;
namespace og = ompl::geometric;

namespace {

/// Properties of a planner; the defaults are those of most planners.
struct Traits {
  bool optimises = false;
  bool repeatable = true;
  bool restarts = false;
};

struct Entry {
  PlannerInfo info;
  std::function<ob::PlannerPtr(const ob::SpaceInformationPtr&, const Checker*)> make;
};

template <class Planner>
Entry entry(const char* name, const char* about, Traits traits = {}) {
  return {{name, about, traits.repeatable, traits.optimises, traits.restarts},
          [](const ob::SpaceInformationPtr& si, const Checker*) -> ob::PlannerPtr {
            return std::make_shared<Planner>(si);
          }};
}

/// For our own planners, which take the checker. (Not found out from the constructors: a pointer is
/// also a `bool`, which RRTConnect takes.)
template <class Planner>
Entry ownEntry(const char* name, const char* about, Traits traits = {}) {
  return {{name, about, traits.repeatable, traits.optimises, traits.restarts},
          [](const ob::SpaceInformationPtr& si, const Checker* checker) -> ob::PlannerPtr {
            return std::make_shared<Planner>(si, checker);
          }};
}

// These planners of OMPL are left out:
// - TSRRT, VFRRT, XXL, QRRT, Lightning, Thunder: they need more input than a problem has.
// - pRRT, pSBL: their threads write to one tree, and not all of these writes are under a lock.
// - LazyLBTRRT: a failed assertion of OMPL 1.5.2 (LPAstarOnGraph.h) ends the program, even on easy
//   problems.
const std::vector<Entry>& entries() {
  static const std::vector<Entry> all = {
      entry<og::RRTConnect>("RRTConnect", "two trees that reach for each other; the default"),
      ownEntry<SlidingConnect>("SlidingConnect", "two trees that slide along obstacles"),
      ownEntry<Portfolio>("Portfolio", "RRTConnect and SlidingConnect in turns",
                          {.restarts = true}),
      entry<og::RRT>("RRT", "one tree"),
      entry<og::LazyRRT>("LazyRRT", "one tree, edges checked when needed"),
      entry<og::TRRT>("TRRT", "one tree, prefers low cost"),
      entry<og::BiTRRT>("BiTRRT", "two trees, prefer low cost"),
      entry<og::RLRT>("RLRT", "one tree of long edges in random directions"),
      entry<og::BiRLRT>("BiRLRT", "two trees of long edges in random directions"),
      entry<og::EST>("EST", "one tree, grows where it is sparse"),
      entry<og::BiEST>("BiEST", "two trees, grow where they are sparse"),
      entry<og::ProjEST>("ProjEST", "EST on a grid of positions"),
      entry<og::SBL>("SBL", "two trees on a grid of positions, edges checked when needed"),
      entry<og::KPIECE1>("KPIECE1", "one tree, grows at the border of its cells"),
      entry<og::BKPIECE1>("BKPIECE1", "two trees, grow at the border of their cells"),
      entry<og::LBKPIECE1>("LBKPIECE1", "BKPIECE1, edges checked when needed"),
      entry<og::STRIDE>("STRIDE", "one tree, density by a nearest-neighbour structure"),
      entry<og::PDST>("PDST", "subdivides the space of positions"),
      entry<og::PRM>("PRM", "roadmap", {.repeatable = false}),
      entry<og::LazyPRM>("LazyPRM", "roadmap, edges checked when needed"),
      entry<og::SPARS>("SPARS", "sparse roadmap", {.repeatable = false}),
      entry<og::SPARStwo>("SPARStwo", "sparse roadmap", {.repeatable = false}),
      entry<og::RRTstar>("RRTstar", "optimises: one tree, rewired", {.optimises = true}),
      entry<og::InformedRRTstar>("InformedRRTstar",
                                 "optimises: RRTstar within the ellipse that can help",
                                 {.optimises = true}),
      entry<og::SORRTstar>("SORRTstar", "optimises: RRTstar with ordered samples",
                           {.optimises = true}),
      entry<og::RRTsharp>("RRTsharp", "optimises: RRTstar that replans", {.optimises = true}),
      entry<og::RRTXstatic>("RRTXstatic", "optimises: RRTsharp with lazy replanning",
                            {.optimises = true}),
      entry<og::LBTRRT>("LBTRRT", "optimises up to a constant factor, so it checks fewer edges",
                        {.optimises = true, .repeatable = false}),
      entry<og::PRMstar>("PRMstar", "optimises: roadmap", {.optimises = true, .repeatable = false}),
      entry<og::LazyPRMstar>("LazyPRMstar", "optimises: roadmap, edges checked when needed",
                             {.optimises = true}),
      entry<og::FMT>("FMT", "optimises over a fixed number of samples", {.optimises = true}),
      entry<og::BFMT>("BFMT", "optimises over a fixed number of samples, from both ends",
                      {.optimises = true}),
      entry<og::BITstar>("BITstar", "optimises: batches of samples, best edges first",
                         {.optimises = true}),
      entry<og::ABITstar>("ABITstar", "optimises: BITstar, quick at first", {.optimises = true}),
      entry<og::AITstar>("AITstar", "optimises: BITstar with an adaptive estimate",
                         {.optimises = true}),
      entry<og::SST>("SST", "optimises: a sparse tree", {.optimises = true}),
      entry<og::CForest>("CForest", "optimises: RRTstar in many threads",
                         {.optimises = true, .repeatable = false}),
      entry<og::AnytimePathShortening>("AnytimePathShortening",
                                       "optimises: planners in threads, paths joined",
                                       {.optimises = true, .repeatable = false}),
  };
  return all;
}

std::vector<std::string> plannerNames() {
  std::vector<std::string> names;
  for (const PlannerInfo& info : knownPlanners()) names.push_back(info.name);
  return names;
}

/// Returns the number if the whole text is a finite number, else nullopt.
template <class T>
std::optional<T> parsedAs(const std::string& text) {
  T value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if constexpr (std::is_floating_point_v<T>)
    if (!std::isfinite(value)) return std::nullopt;
  return value;
}

/// Returns whether a negative value of a parameter is a fault.
/// @param range OMPL's suggestion, "0.:.05:1." (smallest, step, largest). Many parameters accept
/// values below the smallest suggestion. But if the smallest suggestion is not negative, a negative
/// value has no meaning.
bool neverNegative(const std::string& range) {
  const auto least = parsedAs<double>(range.substr(0, range.find(':')));
  return least && *least >= 0;
}

/// Returns whether the parameter is a fraction in (0, 1] that OMPL tests only when planning begins.
/// OMPL then throws an exception for other values.
bool isShare(const ob::GenericParam& parameter) {
  return parameter.getRangeSuggestion().empty() &&
         (parameter.getName() == "min_valid_path_fraction" ||
          parameter.getName() == "failed_expansion_score_factor");
}

/// Returns whether the parameter must be at least 1, although OMPL accepts 0. The value 0 would end
/// the program later, by a failed assertion or worse.
bool isAtLeastOne(const std::string& name) {
  return name == "degree" || name == "min_degree" || name == "num_planners" ||
         name == "samples_per_batch";
}

/// Returns why `text` is not a legal value of the parameter ("not a number", "below 0"), or
/// nullopt. Called before OMPL's own conversion, whose error for "0.6abc" does not say what is
/// wrong.
std::optional<std::string> complaint(ob::GenericParam& parameter, const std::string& text) {
  const auto is = [&]<class T>(T) {
    return dynamic_cast<ob::SpecificParam<T>*>(&parameter) != nullptr;
  };
  if (is(bool{})) {
    if (text == "0" || text == "1") return std::nullopt;
    return "neither true nor false";
  }
  if (is(double{}) || is(float{})) {
    const auto value = parsedAs<double>(text);
    if (!value) return "not a number";
    // OMPL itself accepts these values: it replaces a negative range by its default. With a
    // goal_bias above 1, planners sample only goals, or misbehave.
    if (*value < 0 && neverNegative(parameter.getRangeSuggestion())) return "below 0";
    if (*value > 1 && parameter.getName() == "goal_bias") return "above 1";
    if (isShare(parameter) && !(*value >= std::numeric_limits<double>::epsilon() && *value <= 1))
      return "not in (0, 1]";
    return std::nullopt;
  }
  if (is(int{})) {
    if (parsedAs<int>(text)) return std::nullopt;
    return "not a whole number";
  }
  if (is(0u) || is(0ul)) {
    const unsigned least = isAtLeastOne(parameter.getName()) ? 1 : 0;
    const auto value = parsedAs<unsigned>(text);
    if (value && *value >= least) return std::nullopt;
    return "not a whole number of at least " + std::to_string(least);
  }
  return std::nullopt;
}

std::vector<std::string> parameterNames(const ob::ParamSet& set) {
  std::vector<std::string> names;
  set.getParamNames(names);
  return names;
}

}  // namespace

const std::vector<PlannerInfo>& knownPlanners() {
  static const std::vector<PlannerInfo> infos = [] {
    std::vector<PlannerInfo> list;
    for (const Entry& entry : entries()) list.push_back(entry.info);
    return list;
  }();
  return infos;
}

std::optional<std::string> unknownPlanner(const std::string& name) {
  const std::vector<std::string> names = plannerNames();
  if (std::find(names.begin(), names.end(), name) != names.end()) return std::nullopt;
  return "unknown planner " + quotedWord(name) + didYouMean(name, names) +
         "; there are: " + joined(names);
}

ob::PlannerPtr makePlanner(const ob::SpaceInformationPtr& si, const Checker* checker,
                           const std::string& name, const std::vector<PlannerParameter>& parameters,
                           const PlannerParameter& nameAt) {
  if (auto unknown = unknownPlanner(name))
    throw InputError(Fault{nameAt.file, nameAt.line, std::move(*unknown)});
  ob::PlannerPtr planner;
  for (const Entry& entry : entries())
    if (entry.info.name == name) planner = entry.make(si, checker);
  std::vector<Fault> faults;
  for (const PlannerParameter& given : parameters) {
    ob::ParamSet& set = !planner->params().hasParam(given.key) && si->params().hasParam(given.key)
                            ? si->params()
                            : planner->params();
    if (!set.hasParam(given.key)) {
      const std::vector<std::string> names = parameterNames(planner->params());
      faults.push_back({given.file, given.line,
                        name + " has no parameter " + quotedWord(given.key) +
                            didYouMean(given.key, names) + "; it has: " + joined(names)});
      continue;
    }
    const std::string text = given.value == "true"    ? "1"
                             : given.value == "false" ? "0"
                                                      : given.value;
    std::optional<std::string> wrong = complaint(*set.getParam(given.key), text);
    try {
      if (!wrong && !set.setParam(given.key, text)) wrong = "not a value of its type";
    } catch (const std::exception& error) {
      wrong = error.what();
    }
    if (wrong)
      faults.push_back(
          {given.file, given.line,
           name + "'s parameter " + given.key + ": " + quotedWord(given.value) + " is " + *wrong});
  }
  if (!faults.empty()) throw InputError(std::move(faults));
  return planner;
}

void setValidStateSampler(ob::SpaceInformation& si, ValidSampler sampler) {
  const auto use = [&]<class Sampler>(std::type_identity<Sampler>) {
    si.setValidStateSamplerAllocator(
        [](const ob::SpaceInformation* space) -> ob::ValidStateSamplerPtr {
          return std::make_shared<Sampler>(space);
        });
  };
  switch (sampler) {
    case ValidSampler::uniform:
      return use(std::type_identity<ob::UniformValidStateSampler>{});
    case ValidSampler::gaussian:
      return use(std::type_identity<ob::GaussianValidStateSampler>{});
    case ValidSampler::obstacleBased:
      return use(std::type_identity<ob::ObstacleBasedValidStateSampler>{});
    case ValidSampler::bridgeTest:
      return use(std::type_identity<ob::BridgeTestValidStateSampler>{});
    case ValidSampler::maxClearance:
      return use(std::type_identity<ob::MaximizeClearanceValidStateSampler>{});
  }
}

}  // namespace corridor
