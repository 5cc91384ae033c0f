#include "planner/checker/fixed_pairs.h"

#include <optional>

#include "collision/core/floating_point.h"
#include "collision/core/spelling.h"
#include "collision/hierarchy/box_tree.h"
#include "collision/world/body_queries.h"

namespace corridor {
namespace {

/// Returns a box around the points of a model body in the world, rounded.
BoundingBox boxOf(const ModelBody& body, const Transform& X_WF) {
  BoundingBox box;
  for (const PlacedShape& shape : body.shapes)
    forEachPoint(shape, [&](const Vec3& p, double radius) {
      const Vec3 p_W = X_WF * p;
      box.lower = box.lower.cwiseMin(p_W - Vec3::Constant(radius));
      box.upper = box.upper.cwiseMax(p_W + Vec3::Constant(radius));
    });
  return box;
}

/// Tests two bodies against each other at one configuration: whether they touch, or are not farther
/// apart than margin and padding.
class FixedPairTest {
 public:
  FixedPairTest(const Checker& checker, const Configuration& q)
      : checker_(checker),
        X_WF_(framePoses(checker.model().tree, q)),
        boxes_(checker.model().bodies.size()) {
    firstShape_.push_back(0);
    for (const ModelBody& body : checker.model().bodies)
      firstShape_.push_back(firstShape_.back() + body.shapes.size());
  }

  std::optional<FixedPair> operator()(std::size_t a, std::size_t b) {
    const double margin = checker_.marginOf(a, b);
    const BoundingBox &boxA = boxAround(a), &boxB = boxAround(b);
    // The addition of 2^-40 times the coordinates covers the rounding of the boxes.
    const double size =
                     boxA.lower.norm() + boxA.upper.norm() + boxB.lower.norm() + boxB.upper.norm(),
                 within = margin + 0x1p-40 * size;
    if ((boxA.lower - boxB.upper).maxCoeff() > within ||
        (boxB.lower - boxA.upper).maxCoeff() > within)
      return std::nullopt;
    bool close = false;
    for (std::size_t s = firstShape_[a]; s < firstShape_[a + 1]; ++s)
      for (std::size_t t = firstShape_[b]; t < firstShape_[b + 1]; ++t) {
        if (interference(posed(s), posed(t), context_)) return FixedPair{a, b, true};
        close = close || (margin > 0 && closerThan(posed(s), posed(t), margin, context_));
      }
    return close ? std::optional(FixedPair{a, b, false}) : std::nullopt;
  }

 private:
  const BoundingBox& boxAround(std::size_t body) {
    std::optional<BoundingBox>& box = boxes_[body];
    const ModelBody& modelBody = checker_.model().bodies[body];
    if (!box) box = boxOf(modelBody, X_WF_[modelBody.frame]);
    return *box;
  }
  Posed<Body> posed(std::size_t shape) const {
    const Scene::Placed& placed = checker_.scene().bodies()[shape];
    return Posed(placed.body, X_WF_[placed.frame]);
  }

  const Checker& checker_;
  std::vector<Transform> X_WF_;
  std::vector<std::optional<BoundingBox>> boxes_;
  std::vector<std::size_t> firstShape_;  // for each body, its first shape in the scene
  QueryContext context_;
};

}  // namespace

bool hasFixedPairs(const Model& model) {
  bool has = false;
  forEachPair(model, Required::beyondProofs(),
              [&](std::size_t a, std::size_t b, std::string_view why) {
                has = has || (why == kNeverMove && model.bodies[a].robot != model.bodies[b].robot);
              });
  return has;
}

std::vector<FixedPair> closeFixedPairs(const Checker& checker, const Configuration& q) {
  requireStandardFloatingPoint();
  const Model& model = checker.model();
  FixedPairTest test(checker, q);
  std::vector<FixedPair> found;
  forEachPair(model, checker.required(), [&](std::size_t a, std::size_t b, std::string_view why) {
    if (why != kNeverMove || model.bodies[a].robot == model.bodies[b].robot) return;
    if (const auto pair = test(a, b)) found.push_back(*pair);
  });
  return found;
}

std::vector<Note> notesOnFixedPairs(const Checker& checker, const Configuration& q) {
  const Model& model = checker.model();
  const std::vector<FixedPair> pairs = closeFixedPairs(checker, q);
  constexpr std::size_t kShown = 6;
  std::vector<Note> notes;
  for (const bool touches : {true, false}) {
    std::vector<std::string> names;
    const FixedPair* first = nullptr;
    for (const FixedPair& pair : pairs)
      if (pair.touches == touches) {
        if (!first) first = &pair;
        names.push_back(model.bodies[pair.a].name + " ~ " + model.bodies[pair.b].name);
      }
    if (!first) continue;
    notes.push_back(
        {"in every state, these bodies " +
             std::string(touches                         ? "touch"
                         : checker.options().pairMargins ? "are closer than margin and padding"
                                                         : "are closer than the margin") +
             ": " + joinedFirst(names, kShown) +
             "; no proof covers these pairs, because only fixed joints are between their bodies "
             "(allow: [[" +
             model.bodies[first->a].name + ", " + model.bodies[first->b].name +
             "]] if this is intended)",
         NoteWeight::coverage});
  }
  return notes;
}

}  // namespace corridor
