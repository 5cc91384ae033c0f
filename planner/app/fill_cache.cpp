#include "planner/app/fill_cache.h"

#include <string>

#include "collision/core/error.h"
#include "planner/checker/checker.h"
#include "planner/checker/pair_grids.h"
#include "planner/problem/user_cache.h"

namespace corridor::app {

std::shared_ptr<FileCache> requireCache() {
  auto cache = userCache();
  if (!cache)
    throw InputError(Fault{"CORRIDOR_CACHE", 0,
                           "there is no cache, since this variable is \"off\", or neither it nor "
                           "XDG_CACHE_HOME nor HOME names a folder"});
  if (const std::string why = cache->complaint(); !why.empty())
    throw InputError(Fault{"CORRIDOR_CACHE", 0, why});
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
  model.cache->save();
}

}  // namespace corridor::app
