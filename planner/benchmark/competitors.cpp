#include "planner/benchmark/competitors.h"

#include <mutex>
#include <stdexcept>

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/problem_state_space.h"
#include "planner/jobs/module_file.h"

namespace corridor {
namespace {

struct Module {
  decltype(&corridorFclScene) scene = nullptr;
  std::string version;
  std::string why;  ///< why the module is not available
};

Module openFcl() {
#ifdef CORRIDOR_FCL_MODULE
  const OpenModule module = openModule(CORRIDOR_FCL_MODULE, CORRIDOR_FCL_DIR);
  void* const scene = functionIn(module, "corridorFclScene");
  void* const version = functionIn(module, "corridorFclVersion");
  if (scene && version)
    return {reinterpret_cast<decltype(&corridorFclScene)>(scene),
            reinterpret_cast<decltype(&corridorFclVersion)>(version)(), ""};
  if (module.handle) return {nullptr, "", "its module is of another version; build again"};
  return {nullptr, "", "its module can't be opened: " + module.why};
#else
  return {nullptr, "",
          "Corridor was built without it; install Debian's libfcl-dev and build again"};
#endif
}

const Module& fclModule() {
  static const Module module = openFcl();
  return module;
}

class CompetitorStates final : public ompl::base::StateValidityChecker {
 public:
  CompetitorStates(const ompl::base::SpaceInformationPtr& si, const Checker& checker,
                   std::unique_ptr<CompetitorScene> scene)
      : StateValidityChecker(si),
        checker_(checker),
        poses_(checker.model()),
        scene_(std::move(scene)) {}
  bool isValid(const ompl::base::State* state) const override {
    const Configuration q = configurationOf(*si_, state);
    if (!checker_.inBounds(q)) return false;
    const std::lock_guard lock(mutex_);  // for planners with several threads
    return !scene_->touches(poses_.at(q));
  }

 private:
  const Checker& checker_;
  mutable std::mutex mutex_;
  mutable FramePoses poses_;
  std::unique_ptr<CompetitorScene> scene_;
};

}  // namespace

const std::vector<std::string>& competitorNames() {
  static const std::vector<std::string> names{"fcl"};
  return names;
}

std::string whyUnavailable(const std::string&) {
  return fclModule().why;
}

BenchmarkCompetitor competitorNamed(const std::string& name) {
  const auto makeScene = fclModule().scene;
  if (!makeScene) throw std::logic_error(name + " is not available: " + fclModule().why);
  BenchmarkCompetitor competitor{name, [makeScene](const auto& si, const Checker& checker) {
                                   return std::make_shared<CompetitorStates>(
                                       si, checker,
                                       std::unique_ptr<CompetitorScene>(makeScene(checker)));
                                 }};
  competitor.version = fclModule().version;
  return competitor;
}

std::vector<BenchmarkCompetitor> availableCompetitors() {
  std::vector<BenchmarkCompetitor> competitors;
  for (const std::string& name : competitorNames())
    if (whyUnavailable(name).empty()) competitors.push_back(competitorNamed(name));
  return competitors;
}

}  // namespace corridor
