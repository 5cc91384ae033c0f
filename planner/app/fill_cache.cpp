#include "planner/app/fill_cache.h"

#include <cstdlib>

#include "collision/core/fault_list.h"
#include "planner/checker/checker.h"
#include "planner/checker/pair_grids.h"
#include "planner/problem/user_cache.h"

namespace corridor::app {

std::shared_ptr<FileCache> requireCache() {
  auto cache = userCache();
  const char* const value =
      std::getenv("CORRIDOR_CACHE");  // NOLINT(concurrency-mt-unsafe): only read
  if (!cache)
    throw InputError(Fault{
        "corridor", 0,
        value && *value
            ? "there is no cache, since the variable CORRIDOR_CACHE turns it off"
            : "there is no cache, since neither CORRIDOR_CACHE nor XDG_CACHE_HOME nor HOME names a "
              "folder"});
  if (!cache->whyUnusable().empty()) throw InputError(Fault{"corridor", 0, cache->whyUnusable()});
  return cache;
}

void fillCache(const Model& model) {
  const Checker checker(model);
  for (const Scene::Placed& placed : checker.scene().bodies()) {
    if (!placed.body.isMesh()) continue;
    placed.body.tree();
    placed.body.hull();
  }
  PairGrids::compute(model, checker.scene());
  const auto failed = model.cache->counts().failed;
  model.cache->save();
  if (model.cache->counts().failed > failed) requireNoNotes(*model.cache);
}

void requireNoNotes(FileCache& cache) {
  FaultList faults;
  for (const std::string& note : cache.takeNotes()) faults.add("corridor", 0, note);
  faults.throwIfAny();
}

}  // namespace corridor::app
