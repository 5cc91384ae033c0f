// A shared library that is opened at run time (competitors.h). It uses only code of Corridor that
// is in headers, because it does not link Corridor's libraries.
#include <fcl/config.h>

#include "planner/benchmark/competitors.h"
#include "planner/benchmark/fcl_scene.h"

namespace {

class FclCompetitor final : public corridor::CompetitorScene {
 public:
  explicit FclCompetitor(const corridor::Checker& checker) : scene_(checker) {}
  bool touches(const std::vector<corridor::Transform>& X_WF) override {
    return scene_.touches(X_WF);
  }

 private:
  corridor::bench::FclScene scene_;
};

}  // namespace

corridor::CompetitorScene* corridor::corridorFclScene(const Checker& checker) {
  return std::make_unique<FclCompetitor>(checker).release();
}

const char* corridor::corridorFclVersion() {
  return "FCL " FCL_VERSION;
}
