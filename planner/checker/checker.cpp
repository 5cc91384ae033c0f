#include "planner/checker/checker.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <deque>
#include <map>
#include <mutex>
#include <numeric>
#include <stdexcept>
#include <thread>

#include "collision/core/rounding.h"
#include "collision/motion/motion_answer.h"
#include "planner/checker/default_tolerance.h"
#include "planner/checker/edge_filter.h"
#include "planner/problem/problem.h"
#include "planner/robot/edge_motion.h"

namespace corridor {
namespace {

/// Returns the model's body of each shape, in the order of the scene that `makeScene` returns.
std::vector<std::size_t> bodiesOfShapes(const Model& model) {
  std::vector<std::size_t> owner;
  for (std::size_t b = 0; b < model.bodies.size(); ++b)
    owner.insert(owner.end(), model.bodies[b].shapes.size(), b);
  return owner;
}

/// Returns the result of a query that proves nothing. By default, the reason is a floating-point
/// mode that makes the bounds invalid.
MotionResult refused(UndecidedReason reason = UndecidedReason::floatingPoint) {
  MotionResult result;
  result.verdict = MotionVerdict::undecided;
  result.reason = reason;
  result.certifiedUntil = 0;
  return result;
}

/// Checks the options of a checker.
/// @throws std::invalid_argument if an option is invalid.
void requireValid(const CheckerOptions& options, const ConfigurationSpace& space) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("CheckerOptions: ") + what);
  };
  require(options.margin >= 0 && std::isfinite(options.margin), "margin must be 0 or more");
  const auto requirePadding = [&](const auto& metres) {
    for (const auto& [bodies, each] : metres)
      require(each >= 0 && std::isfinite(each), "every padding must be 0 or more");
  };
  requirePadding(options.padding.bodies);
  requirePadding(options.padding.pairs);
  requirePadding(options.padding.beyond.pairs);
  for (const double each : {options.padding.beyond.self, options.padding.beyond.world})
    require(each >= 0 && std::isfinite(each), "every margin must be 0 or more");
  require(!options.tolerance || (*options.tolerance > 0 && std::isfinite(*options.tolerance)),
          "tolerance must be above 0");
  require(
      options.tube.size() == 0 || (options.tube.size() == static_cast<Eigen::Index>(space.size()) &&
                                   (options.tube.array() >= 0).all()),
      "tube must have a half width of 0 or more for each number of a configuration");
  require(proves(options.method), "method must prove edges");
  require(options.method == EdgeMethod::certified || hasDefaultOverlap(options.trees.trees),
          "trees must have the default overlap test of their volume if method is adaptive or "
          "advancement, which measure distances");
}

void requireConfiguration(const ConfigurationSpace& space, const Configuration& q) {
  if (!space.isFinite(q))
    throw std::invalid_argument("Checker: a configuration must be finite, and no quaternion zero");
}

}  // namespace

Scene makeScene(const Model& model, const Required& need, const TreeParams& params,
                std::span<const Body> earlier) {
  requireObstaclesAtRest(model);
  std::vector<Scene::Placed> placed;
  std::vector<std::size_t> firstShape;
  // For each pair of a mesh and `solid`, the index in `placed` of the first body made of it.
  std::map<std::pair<const MeshFile*, bool>, std::size_t> known;
  std::map<std::pair<const TriangleMesh*, bool>, const Body*> made;  // by `earlier`
  for (const Body& body : earlier)
    if (body.isMesh()) made.try_emplace({&body.mesh(), body.solid()}, &body);
  const auto bodyOf = [&](const PlacedShape& shape) {
    if (!shape.mesh) return Body(shape.name, shape.parts);
    const auto same = made.find({&shape.mesh->mesh, shape.solid});
    if (same != made.end()) return same->second->renamed(shape.name);
    const auto [first, isNew] = known.try_emplace({shape.mesh.get(), shape.solid}, placed.size());
    if (!isNew) return placed[first->second].body.renamed(shape.name);
    return Body(shape.name, {shape.mesh, &shape.mesh->mesh}, shape.solid, params, model.cache);
  };
  const std::vector<Transform> X_WF = staticFramePoses(model);
  for (const ModelBody& body : model.bodies) {
    firstShape.push_back(placed.size());
    const bool ownFrame = !body.robot && body.frame != 0;
    for (const PlacedShape& shape : body.shapes)
      placed.push_back(
          {bodyOf(shape), body.frame, ownFrame ? std::optional(X_WF[body.frame]) : std::nullopt});
  }
  firstShape.push_back(placed.size());
  std::vector<Scene::Pair> pairs;
  forEachTestedPair(model, need, [&](std::size_t i, std::size_t j) {
    for (std::size_t a = firstShape[i]; a < firstShape[i + 1]; ++a)
      for (std::size_t b = firstShape[j]; b < firstShape[j + 1]; ++b) pairs.push_back({a, b});
  });
  return Scene(std::move(placed), std::move(pairs));
}

Required requiredBy(const CheckerOptions& options, const ConfigurationSpace& space) {
  return {options.margin, options.padding, options.tube.size() == 0 ? tubeOf(space) : options.tube};
}

CheckerOptions checkerOptions(const Task& task, const CheckerSettings& settings) {
  if (const auto wrong = invalidNameIn(settings))
    throw std::invalid_argument("checker." + wrong->key + ": " + wrong->text);
  return {task.margin, task.padding, task.tube, settings.tolerance,
          // Beside the samples of `discrete` edges, paths and states are still proved.
          proves(settings.edges) ? settings.edges : EdgeMethod::certified,
          treesNamed(settings.trees)};
}

/// The memory that the queries of one thread write to.
struct Checker::Workspace {
  explicit Workspace(const Checker& checker)
      : motion(checker.model_.tree, checker.model_.space, checker.scene_.framePairs(),
               checker.required_.tube),
        poses(checker.model_),
        filter(checker.filter_.get()) {}

  QueryContext context;
  EdgeMotion motion;
  FramePoses poses;
  EdgeFilter::Workspace filter;
  std::thread::id thread = std::this_thread::get_id();
  Workspace* next = nullptr;  // the workspace that was added just before this one; not owned
};

/// One workspace per thread, created by the thread's first query. Later queries find it without a
/// lock, in a list that only grows at its head. If a new thread gets the id of a thread that has
/// ended, the new thread reuses that thread's workspace.
class Checker::Pool {
 public:
  Workspace& workspaceOfThread(const Checker& checker) {
    const std::thread::id thread = std::this_thread::get_id();
    for (Workspace* w = head_.load(std::memory_order_acquire); w; w = w->next)
      if (w->thread == thread) return *w;
    const std::lock_guard lock(mutex_);
    Workspace& added = workspaces_.emplace_back(checker);
    added.next = head_.load(std::memory_order_relaxed);
    head_.store(&added, std::memory_order_release);
    return added;
  }

  Counters total() const {
    const std::lock_guard lock(mutex_);
    Counters sum;
    for (const Workspace& workspace : workspaces_) sum += workspace.context.counters;
    return sum;
  }

 private:
  mutable std::mutex mutex_;          // held while a workspace is added
  std::deque<Workspace> workspaces_;  // a deque, so that workspaces never move
  std::atomic<Workspace*> head_{};    // the workspace that was added last; not owned
};

Checker::Checker(const Model& model, const CheckerOptions& options, std::span<const Body> earlier)
    : model_(model),
      required_(requiredBy(options, model.space)),
      scene_(makeScene(model, required_, options.trees.params, earlier)),
      proved_(provedBox(model, required_)),
      bodyOf_(bodiesOfShapes(model)),
      method_(options.method),
      pool_(std::make_unique<Pool>()) {
  requireValid(options, model.space);
  options_.tolerance =
      options.tolerance.value_or(defaultTolerance(model, required_, scene_.defaultTolerance()));
  options_.clearanceSlack = options_.tolerance;
  options_.margin = options.margin;
  options_.trees = options.trees.trees;
  notFreeAtRest_ = heldPairsNotFree(model, scene_, required_, options_);
  if (!notFreeAtRest_.empty()) scene_ = withPairs(model, scene_, notFreeAtRest_);
  if (!required_.padding.empty()) {
    paddings_.emplace(paddingsOf(model, required_.padding, scene_));
    options_.pairMargins = &*paddings_;
  }
  if (options_.trees == TreeKind::obb4 && options_.hulls)
    filter_ = EdgeFilter::make(model, scene_, required_.tube);
}

Checker::Checker(const Problem& problem, std::span<const Body> earlier)
    : Checker(problem.model, checkerOptions(problem.task, problem.settings.checker), earlier) {}

Checker::~Checker() = default;

double Checker::marginOf(std::size_t a, std::size_t b) const {
  return sumRoundedUp(options_.margin, paddingOf(model_, required_.padding, a, b));
}

Checker::Workspace& Checker::workspaceOfThread() const {
  return pool_->workspaceOfThread(*this);
}

Counters Checker::counters() const {
  return pool_->total();
}

bool Checker::isCovered(const Configuration& q) const {
  // A configuration that is no data is refused for that reason.
  return !proved_ || !q.allFinite() || proved_->contains(q);
}

bool Checker::inBounds(const Configuration& q) const {
  return space().isFinite(q) && space().inBounds(q);
}

MotionResult Checker::certifyState(const Configuration& q) const {
  if (!standardFloatingPoint()) return refused();
  if (!isCovered(q)) return refused(UndecidedReason::beyondProofs);
  Workspace& workspace = workspaceOfThread();
  workspace.motion.set(q, q);
  return decide(q, q, options_, workspace, true);
}

namespace {

/// Tests pairs of a scene in the motion that is set, and keeps the contact found.
class SceneTouchTest final : public TouchTest {
 public:
  SceneTouchTest(const Scene& scene, EdgeMotion& motion, const MotionOptions& options,
                 QueryContext& context)
      : scene_(scene),
        motion_(motion),
        options_(options),
        context_(context),
        workEnd_(context.counters.work() +
                 std::min(options.workLimit, kNoWorkLimit - context.counters.work())) {}

  bool touches(std::uint32_t number, double t) override {
    contact = scene_.contactAt(motion_, number, t, options_, workEnd_, context_);
    return contact.has_value();
  }

  std::optional<MotionResult> contact;

 private:
  const Scene& scene_;
  EdgeMotion& motion_;
  const MotionOptions& options_;
  QueryContext& context_;
  const std::uint64_t workEnd_;
};

}  // namespace

MotionResult Checker::decide(const Configuration& from, const Configuration& to,
                             MotionOptions options, Workspace& workspace,
                             bool findsContacts) const {
  requireValid(options, scene_.pairs().size());
  const Counters& counters = workspace.context.counters;
  const std::uint64_t before = counters.work();
  SceneTouchTest test(scene_, workspace.motion, options, workspace.context);
  const bool isFiltered = filter_ && filter_->prove(from, to, options, workspace.filter,
                                                    findsContacts ? &test : nullptr);
  if (isFiltered) options.only = &workspace.filter.left;
  if (test.contact) {
    count(workspace.motion, *test.contact, workspace.context.counters);
    return *test.contact;
  }
  options.workLimit -= std::min(options.workLimit, counters.work() - before);
  return scene_.certify(workspace.motion, options, workspace.context);
}

MotionResult Checker::certifyEdge(const Configuration& from, const Configuration& to,
                                  const EdgeQuery& query) const {
  if (query.margins && query.certificate)
    throw std::invalid_argument("EdgeQuery: a certificate is for the checker's own margins");
  const bool isPlain = !query.margins && !query.certificate;
  return certify(from, to, query, isPlain ? method_ : EdgeMethod::certified);
}

std::optional<CertificateFault> Checker::faultOf(const MotionCertificate& certificate,
                                                 const Configuration& from, const Configuration& to,
                                                 double until) const {
  if (until > 0 && !(isCovered(from) && isCovered(to)))
    return CertificateFault{CertificateFault::Kind::unproved, 0, 0};
  Workspace& workspace = workspaceOfThread();
  workspace.motion.set(from, to);
  return checkCertificate(workspace.motion, scene_.motionPairs(), options_, until, certificate,
                          workspace.context);
}

MotionResult Checker::certify(const Configuration& from, const Configuration& to,
                              const EdgeQuery& query, EdgeMethod method) const {
  if (query.certificate) *query.certificate = {};
  if (!standardFloatingPoint()) return refused();
  if (!isCovered(from) || !isCovered(to)) return refused(UndecidedReason::beyondProofs);
  MotionOptions options = options_;
  options.earliest = query.earliest;
  if (query.margins) options.pairMargins = query.margins;
  Workspace& workspace = workspaceOfThread();
  workspace.motion.set(from, to);
  // A certificate has an entry for every pair, and the other methods measure distances.
  if (query.certificate)
    return scene_.certify(workspace.motion, options, workspace.context, *query.certificate);
  if (method != EdgeMethod::certified)
    return scene_.certify(workspace.motion, options, workspace.context, method);
  return decide(from, to, options, workspace, !query.earliest && !query.margins);
}

MotionResult Checker::certifyCurve(const CurvePiece& piece, bool earliest,
                                   const PairMargins* margins) const {
  const auto size = static_cast<Eigen::Index>(space().size());
  if (piece.coefficients.rows() != size || piece.error.size() != size || piece.degree() < 1 ||
      piece.degree() > CurvePiece::kLargestDegree || !piece.error.allFinite() ||
      (piece.error.array() < 0).any())
    throw std::invalid_argument(
        "certifyCurve: a piece has one row and one error of 0 or more for each number of a "
        "configuration, and a degree from 1 to 9");
  if (!standardFloatingPoint()) return refused();
  if (proved_ && piece.coefficients.allFinite() && !proved_->contains(piece))
    return refused(UndecidedReason::beyondProofs);
  MotionOptions options = options_;
  options.earliest = earliest;
  if (margins) options.pairMargins = margins;
  Workspace& workspace = workspaceOfThread();
  workspace.motion.set(piece);
  return scene_.certify(workspace.motion, options, workspace.context, EdgeMethod::certified);
}

std::optional<Contact> Checker::interference(const Configuration& q) const {
  requireStandardFloatingPoint();
  requireConfiguration(space(), q);
  Workspace& workspace = workspaceOfThread();
  return scene_.interference(workspace.poses.at(q), workspace.context, options_.trees);
}

double Checker::clearance(const Configuration& q) const {
  requireStandardFloatingPoint();
  requireConfiguration(space(), q);
  Workspace& workspace = workspaceOfThread();
  return scene_.clearance(workspace.poses.at(q), workspace.context, options_.trees) -
         options_.margin;
}

std::vector<Scene::NearPair> Checker::pairsWithin(const Configuration& q, const PairMargins& within,
                                                  const Scene::NearSearch& search) const {
  requireStandardFloatingPoint();
  requireConfiguration(space(), q);
  Workspace& workspace = workspaceOfThread();
  return scene_.pairsWithin(workspace.poses.at(q), within, {.relative = 1e-3}, workspace.context,
                            search, options_.trees);
}

std::vector<std::uint32_t> Checker::pairsLeftByHulls(const Configuration& from,
                                                     const Configuration& to,
                                                     const PairMargins& margins) const {
  std::vector<std::uint32_t> all(scene_.pairs().size());
  std::iota(all.begin(), all.end(), std::uint32_t{0});
  if (!isCovered(from) || !isCovered(to)) return all;
  MotionOptions options = options_;
  options.pairMargins = &margins;
  requireValid(options, scene_.pairs().size());
  Workspace& workspace = workspaceOfThread();
  workspace.motion.set(from, to);
  if (filter_ && filter_->prove(from, to, options, workspace.filter, nullptr))
    options.only = &workspace.filter.left;
  return scene_.pairsLeftByHulls(workspace.motion, options, workspace.context);
}

std::vector<Checker::PairNotFree> Checker::pairsNotFree(const Configuration& q) const {
  requireStandardFloatingPoint();
  Workspace& workspace = workspaceOfThread();
  workspace.motion.set(q, q);
  const std::vector<MotionResult> results =
      scene_.certifyEachPair(workspace.motion, options_, workspace.context);
  std::vector<PairNotFree> pairs;
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].verdict == MotionVerdict::free) continue;
    const bool tooLarge = results[i].reason == UndecidedReason::rounding;
    const auto [a, b] = std::minmax(bodyOf_[scene_.pairs()[i].a], bodyOf_[scene_.pairs()[i].b]);
    const auto same = [a = a, b = b](const PairNotFree& p) { return p.a == a && p.b == b; };
    const auto known = std::find_if(pairs.begin(), pairs.end(), same);
    if (known == pairs.end())
      pairs.push_back({a, b, tooLarge});
    else
      known->tooLarge = known->tooLarge && tooLarge;
  }
  return pairs;
}

bool Checker::isProvedFree(const Configuration& q) const {
  return inBounds(q) && certifyState(q).verdict == MotionVerdict::free;
}

bool Checker::isProvedFree(const Configuration& from, const Configuration& to) const {
  return inBounds(from) && inBounds(to) &&
         certify(from, to, {}, EdgeMethod::certified).verdict == MotionVerdict::free;
}

}  // namespace corridor
