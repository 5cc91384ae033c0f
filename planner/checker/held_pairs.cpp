#include "planner/checker/held_pairs.h"

#include <algorithm>
#include <optional>

#include "collision/core/floating_point.h"
#include "planner/robot/edge_motion.h"

namespace corridor {
namespace {

/// Returns for each body of the model, and past the last one, its first shape in a scene.
std::vector<std::size_t> firstShapes(const Model& model) {
  std::vector<std::size_t> first{0};
  for (const ModelBody& body : model.bodies) first.push_back(first.back() + body.shapes.size());
  return first;
}

/// Returns a scene with the bodies of another one, and with these pairs of shapes.
Scene sceneOf(const Scene& scene, std::vector<Scene::Pair> pairs) {
  std::vector<Scene::Placed> placed;
  for (const Scene::Placed& body : scene.bodies())
    placed.push_back({body.body.renamed(body.body.name()), body.frame, body.restX_WF});
  return Scene(std::move(placed), std::move(pairs));
}

void addShapes(const HeldPair& pair, const std::vector<std::size_t>& first,
               std::vector<Scene::Pair>& pairs) {
  for (std::size_t s = first[pair.a]; s < first[pair.a + 1]; ++s)
    for (std::size_t t = first[pair.b]; t < first[pair.b + 1]; ++t) pairs.push_back({s, t});
}

}  // namespace

Configuration zeroConfiguration(const ConfigurationSpace& space) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  for (const Coordinate& c : space.coordinates())
    if (c.kind == Coordinate::Kind::rotation) q[static_cast<Eigen::Index>(c.first) + 3] = 1;
  return q;
}

std::vector<HeldPair> heldPairsNotFree(const Model& model, const Scene& scene, const Required& need,
                                       MotionOptions options) {
  std::vector<HeldPair> all;
  forEachPair(model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
    if (why == kTestedAtRest) all.push_back({a, b});
  });
  if (all.empty() || !standardFloatingPoint()) return all;
  const std::vector<std::size_t> first = firstShapes(model);
  std::vector<Scene::Pair> pairs;
  for (const HeldPair& pair : all) addShapes(pair, first, pairs);
  const Scene atRest = sceneOf(scene, std::move(pairs));
  std::optional<PairMargins> paddings;
  options.pairMargins = nullptr;
  if (!need.padding.empty()) {
    paddings = paddingsOf(model, need.padding, atRest);
    options.pairMargins = &*paddings;
  }
  // The bodies of each pair have the same relative pose in every configuration.
  EdgeMotion motion(model.tree, model.space, atRest.framePairs(), need.tube);
  const Configuration q = zeroConfiguration(model.space);
  motion.set(q, q);
  QueryContext context;
  if (atRest.certify(motion, options, context).verdict == MotionVerdict::free) return {};
  const std::vector<MotionResult> results = atRest.certifyEachPair(motion, options, context);
  const auto bodyOf = [&](std::size_t shape) {
    return static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), shape) -
                                    first.begin()) -
           1;
  };
  std::vector<HeldPair> notFree;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].verdict == MotionVerdict::free) continue;
    const auto [a, b] = std::minmax({bodyOf(atRest.pairs()[i].a), bodyOf(atRest.pairs()[i].b)});
    notFree.push_back({a, b});
  }
  const auto before = [](const HeldPair& x, const HeldPair& y) {
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  };
  std::sort(notFree.begin(), notFree.end(), before);
  const auto same = [](const HeldPair& x, const HeldPair& y) { return x.a == y.a && x.b == y.b; };
  notFree.erase(std::unique(notFree.begin(), notFree.end(), same), notFree.end());
  return notFree;
}

Scene withPairs(const Model& model, const Scene& scene, const std::vector<HeldPair>& more) {
  std::vector<Scene::Pair> pairs = scene.pairs();
  const std::vector<std::size_t> first = firstShapes(model);
  for (const HeldPair& pair : more) addShapes(pair, first, pairs);
  return sceneOf(scene, std::move(pairs));
}

PairMargins paddingsOf(const Model& model, const Padding& padding, const Scene& scene) {
  std::vector<std::size_t> bodyOf;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    bodyOf.insert(bodyOf.end(), model.bodies[b].shapes.size(), b);
  std::vector<double> metres;
  for (const MotionPair& pair : scene.motionPairs())
    metres.push_back(paddingOf(model, padding, bodyOf[pair.bodyA], bodyOf[pair.bodyB]));
  return PairMargins(std::move(metres));
}

}  // namespace corridor
