#include "planner/checker/checker.h"

#include <algorithm>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <unordered_map>

#include "planner/checker/default_tolerance.h"
#include "planner/robot/edge_motion.h"

namespace corridor {
namespace {

/// Returns the body of each shape of `makeScene`.
std::vector<std::size_t> bodiesOfShapes(const Problem& problem) {
  std::vector<std::size_t> owner;
  for (std::size_t b = 0; b < problem.bodies.size(); ++b)
    owner.insert(owner.end(), problem.bodies[b].shapes.size(), b);
  return owner;
}

/// The answer where the floating-point mode makes the bounds invalid; nothing is computed.
MotionResult refused() {
  MotionResult result;
  result.verdict = MotionVerdict::undecided;
  result.reason = UndecidedReason::floatingPoint;
  result.certifiedUntil = 0;
  return result;
}

}  // namespace

Scene makeScene(const Problem& problem) {
  TreeParams params;
  params.fit = treesNamed(problem.checker.trees()).fit;
  std::vector<Scene::Placed> placed;
  std::vector<std::size_t> firstShape;
  for (const ProblemBody& body : problem.bodies) {
    firstShape.push_back(placed.size());
    for (const PlacedShape& shape : body.shapes)
      placed.push_back({shape.part ? Body(shape.name, *shape.part)
                                   : Body(shape.name, shape.mesh->mesh, shape.solid, params),
                        body.frame});
  }
  firstShape.push_back(placed.size());
  std::vector<Scene::Pair> pairs;
  for (const ProblemPair& pair : problem.pairs) {
    if (!pair.skipped.empty()) continue;
    for (std::size_t a = firstShape[pair.a]; a < firstShape[pair.a + 1]; ++a)
      for (std::size_t b = firstShape[pair.b]; b < firstShape[pair.b + 1]; ++b)
        pairs.push_back({a, b});
  }
  return Scene(std::move(placed), std::move(pairs));
}

/// The memory that one thread's queries write to.
struct Checker::Workspace {
  QueryContext context;
  EdgeMotion motion;
};

/// One workspace per thread, created by the thread's first query.
class Checker::Pool {
 public:
  Workspace& mine(const Checker& checker) {
    const std::lock_guard lock(mutex_);
    std::unique_ptr<Workspace>& workspace = workspaces_[std::this_thread::get_id()];
    if (!workspace) {
      const Problem& problem = checker.problem_;
      workspace.reset(new Workspace{
          {}, EdgeMotion(problem.tree, problem.space, checker.scene_.framePairs(), problem.tube)});
    }
    return *workspace;
  }

  Counters total() const {
    const std::lock_guard lock(mutex_);
    Counters sum;
    for (const auto& [thread, workspace] : workspaces_) sum += workspace->context.counters;
    return sum;
  }

 private:
  mutable std::mutex mutex_;
  std::unordered_map<std::thread::id, std::unique_ptr<Workspace>> workspaces_;
};

Checker::Checker(const Problem& problem)
    : problem_(problem),
      scene_(makeScene(problem)),
      bodyOf_(bodiesOfShapes(problem)),
      method_(edgeMethodNamed(problem.checker.edges).value_or(EdgeMethod::directional)),
      pool_(std::make_unique<Pool>()) {
  if (const auto wrong = invalidNameIn(problem.checker))
    throw std::invalid_argument("checker." + wrong->key + ": " + wrong->text);
  options_.tolerance =
      problem.checker.tolerance.value_or(defaultTolerance(problem, scene_.defaultTolerance()));
  options_.clearanceSlack = options_.tolerance;
  options_.margin = problem.margin;
  options_.trees = treesNamed(problem.checker.trees()).trees;
}

Checker::~Checker() = default;

Checker::Workspace& Checker::mine() const {
  return pool_->mine(*this);
}

Counters Checker::counters() const {
  return pool_->total();
}

bool Checker::inBounds(const Configuration& q) const {
  return space().isFinite(q) && space().inBounds(q);
}

MotionResult Checker::state(const Configuration& q) const {
  if (!standardFloatingPoint()) return refused();
  Workspace& workspace = mine();
  workspace.motion.set(q, q);
  return scene_.certify(workspace.motion, options_, workspace.context);
}

MotionResult Checker::edge(const Configuration& from, const Configuration& to,
                           bool earliest) const {
  return edge(from, to, earliest, method_);
}

MotionResult Checker::edge(const Configuration& from, const Configuration& to, bool earliest,
                           EdgeMethod method) const {
  if (!standardFloatingPoint()) return refused();
  Workspace& workspace = mine();
  MotionOptions options = options_;
  options.earliest = earliest;
  workspace.motion.set(from, to);
  return scene_.certify(workspace.motion, options, workspace.context, method);
}

std::optional<Contact> Checker::interference(const Configuration& q) const {
  requireStandardFloatingPoint();
  return scene_.interference(framePoses(problem_.tree, q), mine().context, options_.trees);
}

double Checker::clearance(const Configuration& q) const {
  requireStandardFloatingPoint();
  return scene_.clearance(framePoses(problem_.tree, q), mine().context, options_.trees) -
         options_.margin;
}

std::vector<Checker::PairNotFree> Checker::pairsNotFree(const Configuration& q) const {
  requireStandardFloatingPoint();
  Workspace& workspace = mine();
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

bool Checker::certifiedState(const Configuration& q) const {
  return inBounds(q) && state(q).verdict == MotionVerdict::free;
}

bool Checker::certifiedEdge(const Configuration& from, const Configuration& to) const {
  return inBounds(from) && inBounds(to) &&
         edge(from, to, false, EdgeMethod::directional).verdict == MotionVerdict::free;
}

}  // namespace corridor
