// A module of its own: see peers.h. It uses nothing of Corridor's that isn't in headers.
#include <fcl/config.h>

#include "planner/benchmark/fcl_scene.h"
#include "planner/benchmark/peers.h"

namespace {

class FclPeer final : public corridor::PeerScene {
 public:
  explicit FclPeer(const corridor::Checker& checker) : scene_(checker) {}
  bool touches(const std::vector<corridor::Transform>& X_WF) override {
    return scene_.touches(X_WF);
  }

 private:
  corridor::bench::FclScene scene_;
};

}  // namespace

corridor::PeerScene* corridor::corridorFclScene(const Checker& checker) {
  return std::make_unique<FclPeer>(checker).release();
}

const char* corridor::corridorFclVersion() {
  return "FCL " FCL_VERSION;
}
