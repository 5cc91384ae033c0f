#include "planner/checker/never_in_contact.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <stdexcept>

#include "collision/core/rounding.h"
#include "collision/motion/certify_motion.h"
#include "collision/queries/surface_distance.h"
#include "planner/checker/chain_between.h"
#include "planner/robot/edge_motion.h"

namespace corridor {
namespace {

using Verdict = NeverInContactResult::Verdict;
using VariableRange = ChainBetween::Range;

/// A box of joint values that is not proved yet.
struct Box {
  std::vector<VariableRange> ranges;
  std::vector<MotionPair> open;  // the pairs of shapes that are not separated yet
  double share = 1;              // volume, as a fraction of the box of all joint values
};

/// Tries to prove that pairs of shapes keep the margin for all joint values, by halving boxes of
/// joint values until each box is proved.
class Subdivision {
 public:
  Subdivision(const ChainBetween& between, const NeverInContactOptions& options,
              QueryContext& context)
      : between_(between), options_(options), context_(context) {}

  NeverInContactResult run(std::vector<MotionPair> pairs) {
    setQuery(pairs);
    constexpr std::size_t kMostHeld = 2'000'000;  // pairs of shapes in the queue: about 150 MB
    std::size_t held = pairs.size();
    std::deque<Box> boxes;
    boxes.push_back({between_.box, std::move(pairs), 1});
    while (!boxes.empty()) {
      if (held > kMostHeld) return exhausted();
      if (result_.boxes >= options_.boxes || context_.counters.work() >= workEnd_ ||
          (options_.interrupted && *options_.interrupted))
        return answer(Verdict::workLimit);
      ++result_.boxes;
      Box box = std::move(boxes.front());
      boxes.pop_front();
      held -= box.open.size();
      const std::size_t widest = test(box);
      if (tooClose_) return answer(Verdict::tooClose);
      if (box.open.empty()) {
        result_.provedShare += box.share;
        continue;
      }
      // Both halves have the same middle value as a limit, so they cover the whole box.
      const auto [lower, upper] = box.ranges[widest];
      const double middle = lower + (upper - lower) / 2;
      if (!(lower < middle && middle < upper)) return exhausted();
      box.share /= 2;
      boxes.push_back(box);
      boxes.back().ranges[widest].upper = middle;
      box.ranges[widest].lower = middle;
      held += 2 * box.open.size();
      boxes.push_back(std::move(box));
    }
    return answer(Verdict::proved);
  }

 private:
  NeverInContactResult answer(Verdict verdict) {
    result_.verdict = verdict;
    result_.tests = context_.counters.work() - workBegin_;
    return result_;
  }

  NeverInContactResult exhausted() {
    result_.exhausted = true;
    return answer(Verdict::workLimit);
  }

  void setQuery(const std::vector<MotionPair>& pairs) {
    workBegin_ = context_.counters.work();
    workEnd_ = workBegin_ +
               std::min(options_.tests, std::numeric_limits<std::uint64_t>::max() - workBegin_);
    // The tolerance decides only when a time interval is no longer halved. In these queries nothing
    // moves, so no interval is ever halved. Any positive tolerance is therefore sufficient; the
    // code takes the usual 1e-7 of the radius of the smallest shape.
    double radius = std::numeric_limits<double>::infinity();
    for (const MotionPair& pair : pairs)
      radius = std::min({radius, pair.a->sphereRadius(), pair.b->sphereRadius()});
    query_.tolerance = std::max(1e-7 * radius, std::numeric_limits<double>::min());
    query_.margin = options_.margin;
  }

  /// Removes from `box.open` the pairs that are separated throughout the box. Sets `tooClose_` if a
  /// pair that is left is not farther apart than the margin at the middle of the box, since such a
  /// pair can't be proved.
  /// @returns the variable along which the box should be halved, if pairs are left; else 0.
  std::size_t test(Box& box) {
    const auto count = static_cast<Eigen::Index>(box.ranges.size());
    Configuration middle(count), halfWidths(count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const auto [lower, upper] = box.ranges[static_cast<std::size_t>(i)];
      middle[i] = lower + (upper - lower) / 2;
      halfWidths[i] = roundedUp(std::max(upper - middle[i], middle[i] - lower));
    }
    EdgeMotion motion(between_.tree, between_.space, {&between_.pair, 1}, halfWidths);
    motion.set(middle, middle);
    std::erase_if(box.open, [&](const MotionPair& pair) {
      if (context_.counters.work() >= workEnd_) return false;
      query_.workLimit = workEnd_ - context_.counters.work();
      return certifyMotion(motion, {&pair, 1}, query_, context_).verdict == MotionVerdict::free;
    });
    std::vector<double> displacements(box.ranges.size(), 0.0);
    if (box.open.empty()) return 0;
    const RelativeMotion relative = motion.relativeMotion(0, 0.5, 0);
    for (const MotionPair& pair : box.open) {
      tooClose_ = tooClose_ || surfacesCloserThan(Posed(*pair.a), Posed(*pair.b, relative.X_AB),
                                                  options_.margin, context_);
      addDisplacements(relative, *pair.b, displacements);
    }
    return static_cast<std::size_t>(std::max_element(displacements.begin(), displacements.end()) -
                                    displacements.begin());
  }

  /// Adds to the entry of each variable an estimate of how far this variable can displace points of
  /// b within the box, metres. The estimate decides only along which variable the box is halved. No
  /// verdict depends on it.
  void addDisplacements(const RelativeMotion& relative, const Body& b,
                        std::vector<double>& displacements) const {
    const Vec3 center = relative.X_AB.m * b.sphereCenter() + relative.X_AB.t;
    // `screws[i]` belongs to `variables[i]` if the half width of each moving frame is positive.
    // (For a mimic of multiplier 0, the half width is 0. Then a poor variable may be chosen.)
    for (std::size_t i = 0; i < std::min(relative.screws.size(), between_.variables.size()); ++i) {
      const ScrewMotion& screw = relative.screws[i];
      const bool turns = screw.kind == ScrewMotion::Kind::revolute;
      const double lever =
          turns ? screw.axis.cross(center - screw.point).norm() + b.sphereRadius() : 1;
      displacements[between_.variables[i]] += screw.tube * lever;
    }
  }

  const ChainBetween& between_;
  const NeverInContactOptions& options_;
  QueryContext& context_;
  MotionOptions query_;
  std::uint64_t workBegin_ = 0, workEnd_ = 0;
  NeverInContactResult result_;
  bool tooClose_ = false;
};

}  // namespace

NeverInContact::NeverInContact(const Model& model, const Scene& scene)
    : model_(model), scene_(scene) {
  std::size_t shapes = 0;
  for (const ModelBody& body : model.bodies) {
    firstShape_.push_back(shapes);
    shapes += body.shapes.size();
  }
  firstShape_.push_back(shapes);
  if (shapes != scene.bodies().size())
    throw std::invalid_argument("NeverInContact: the scene is not made from the model");
}

NeverInContactResult NeverInContact::prove(std::size_t a, std::size_t b,
                                           const NeverInContactOptions& options,
                                           QueryContext& context) const {
  for (const double x : {options.margin, options.beyondLimits})
    if (!(x >= 0 && std::isfinite(x)))
      throw std::invalid_argument(
          "NeverInContactOptions: margin and beyondLimits must be finite and not negative");
  const auto between =
      chainBetween(model_, model_.bodies[a].frame, model_.bodies[b].frame, options.beyondLimits);
  if (!between) return {};
  std::vector<MotionPair> pairs;
  for (std::size_t i = firstShape_[a]; i < firstShape_[a + 1]; ++i)
    for (std::size_t k = firstShape_[b]; k < firstShape_[b + 1]; ++k) {
      const Body &first = scene_.bodies()[i].body, &second = scene_.bodies()[k].body;
      if (first.isSolidMesh() || second.isSolidMesh()) return {};
      pairs.push_back({&first, &second, 0, i, k});
    }
  return Subdivision(*between, options, context).run(std::move(pairs));
}

bool movesFreely(const Model& model, std::size_t a, std::size_t b) {
  const std::size_t first = model.bodies[a].frame, second = model.bodies[b].frame,
                    top = model.tree.commonAncestor(first, second);
  for (const std::size_t end : {first, second})
    for (std::size_t f = end; f != top; f = model.tree.frames[f].parent) {
      const Frame& frame = model.tree.frames[f];
      if (frame.moves() &&
          (frame.joint == Frame::Joint::translation || frame.joint == Frame::Joint::rotation))
        return true;
    }
  return false;
}

}  // namespace corridor
