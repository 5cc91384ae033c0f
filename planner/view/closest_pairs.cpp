#include "planner/view/closest_pairs.h"

#include <algorithm>
#include <utility>

#include "collision/world/body_queries.h"

namespace corridor::view {

std::optional<ClosestPair> closestPair(const Checker& checker, const std::vector<Transform>& X_WF,
                                       QueryContext& context) {
  const Scene& scene = checker.scene();
  // For each tested pair: a lower bound of its distance, and the pair's index.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < scene.pairs().size(); ++i) {
    const Scene::Placed &a = scene.bodies()[scene.pairs()[i].a],
                        &b = scene.bodies()[scene.pairs()[i].b];
    const Vec3 between =
        X_WF[b.frame] * b.body.sphereCenter() - X_WF[a.frame] * a.body.sphereCenter();
    order.push_back({between.norm() - a.body.sphereRadius() - b.body.sphereRadius(), i});
  }
  std::sort(order.begin(), order.end());
  std::optional<ClosestPair> closest;
  for (const auto& [bound, i] : order) {
    if (closest && bound >= closest->distance) break;
    const Scene::Pair& pair = scene.pairs()[i];
    const Scene::Placed &a = scene.bodies()[pair.a], &b = scene.bodies()[pair.b];
    if (closest && !closerThan(Posed(a.body, X_WF[a.frame]), Posed(b.body, X_WF[b.frame]),
                               closest->distance, context))
      continue;
    const Distance d =
        distance(Posed(a.body, X_WF[a.frame]), Posed(b.body, X_WF[b.frame]), {}, context);
    if (!closest || d.distance < closest->distance)
      closest = {d.distance, checker.bodyOf(pair.a), checker.bodyOf(pair.b), d.p_WA, d.p_WB};
  }
  return closest;
}

}  // namespace corridor::view
