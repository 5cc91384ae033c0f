#include "planner/benchmark/peers.h"

#include <dlfcn.h>
#include <filesystem>
#include <mutex>
#include <stdexcept>

#include <ompl/base/StateValidityChecker.h>

#include "planner/checker/problem_state_space.h"

namespace corridor {
namespace {

struct Module {
  decltype(&corridorFclScene) scene = nullptr;
  std::string version;
  std::string why;  ///< there is none
};

/// The one beside the program, else the one that was built.
Module openModule() {
#ifdef CORRIDOR_FCL_MODULE
  std::error_code error;
  const auto program = std::filesystem::read_symlink("/proc/self/exe", error);
  const std::string name = CORRIDOR_FCL_MODULE;
  for (const auto& file : {(program.parent_path() / name).string(),
                           (std::filesystem::path(CORRIDOR_FCL_DIR) / name).string()})
    if (void* const module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL)) {
      void* const scene = dlsym(module, "corridorFclScene");
      void* const version = dlsym(module, "corridorFclVersion");
      if (scene && version)
        return {reinterpret_cast<decltype(&corridorFclScene)>(scene),
                reinterpret_cast<decltype(&corridorFclVersion)>(version)(), ""};
    }
  const char* const reason = dlerror();
  return {nullptr, "", std::string("its module can't be opened: ") + (reason ? reason : "unknown")};
#else
  return {nullptr, "", "Corridor was built without it (Debian's libfcl-dev)"};
#endif
}

const Module& fclModule() {
  static const Module module = openModule();
  return module;
}

class PeerStates final : public ompl::base::StateValidityChecker {
 public:
  PeerStates(const ompl::base::SpaceInformationPtr& si, const Checker& checker,
             std::unique_ptr<PeerScene> scene)
      : StateValidityChecker(si), checker_(checker), scene_(std::move(scene)) {}
  bool isValid(const ompl::base::State* state) const override {
    const Configuration q = configurationOf(*si_, state);
    if (!checker_.inBounds(q)) return false;
    const std::lock_guard lock(mutex_);  // some planners have threads
    return !scene_->touches(framePoses(checker_.problem().tree, q));
  }

 private:
  const Checker& checker_;
  mutable std::mutex mutex_;
  std::unique_ptr<PeerScene> scene_;
};

}  // namespace

const std::vector<std::string>& peerNames() {
  static const std::vector<std::string> names{"fcl"};
  return names;
}

std::string whyNoPeer(const std::string&) {
  return fclModule().why;
}

BenchmarkPeer peerNamed(const std::string& name) {
  const auto makeScene = fclModule().scene;
  if (!makeScene) throw std::logic_error(name + " can't take part: " + fclModule().why);
  BenchmarkPeer peer{name, [makeScene](const auto& si, const Checker& checker) {
                       return std::make_shared<PeerStates>(
                           si, checker, std::unique_ptr<PeerScene>(makeScene(checker)));
                     }};
  peer.version = fclModule().version;
  return peer;
}

std::vector<BenchmarkPeer> peersHere() {
  std::vector<BenchmarkPeer> peers;
  for (const std::string& name : peerNames())
    if (whyNoPeer(name).empty()) peers.push_back(peerNamed(name));
  return peers;
}

}  // namespace corridor
