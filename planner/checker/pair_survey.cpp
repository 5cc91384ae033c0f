#include "planner/checker/pair_survey.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <queue>
#include <random>
#include <thread>
#include <tuple>
#include <utility>

#include "collision/core/parallel.h"
namespace corridor {
namespace {

using Verdict = NeverInContactResult::Verdict;

/// The first attempt to prove a pair gets at most `kFirstBoxes` boxes, and each further attempt
/// `kMoreBoxes` times as many as the one before, up to `kMostBoxes`. All attempts at a pair
/// together take at most 4/3 of the boxes of the last attempt, unless the work limit shortens that
/// last attempt.
constexpr std::uint64_t kFirstBoxes = 80, kMoreBoxes = 4, kMostBoxes = 20480;
/// This many tests of volumes and triangles count as one box. The test of a box also has a cost
/// that is not counted, such as making the motion of the box. This cost is about that of
/// `kTestsPerBox` tests.
constexpr std::uint64_t kTestsPerBox = 100;
/// An attempt may take this many tests for each of its boxes, on average.
constexpr std::uint64_t kMostTestsPerBox = 1000;

bool isSet(const std::atomic<bool>* flag) {
  return flag && *flag;
}

/// An attempt to prove a pair.
struct Attempt {
  double cost = 0;  ///< the attempt with the smallest cost comes first
  std::size_t pair = 0;
  std::uint64_t boxes = 0;

  bool operator>(const Attempt& other) const {
    return std::tie(cost, pair) > std::tie(other.cost, other.pair);
  }
};

NeverInContactOptions limitsOf(const PairSurveyOptions& options, std::uint64_t boxes,
                               std::uint64_t left) {
  NeverInContactOptions proof{.margin = options.margin,
                              .beyondLimits = options.beyondLimits,
                              .interrupted = options.interrupted};
  proof.boxes = std::min(boxes, left);
  proof.tests = kTestsPerBox * std::min(kMostTestsPerBox / kTestsPerBox * proof.boxes, left);
  return proof;
}

/// Makes the first attempts at all wanted pairs, in several threads. They don't depend on each
/// other as long as the work limit is far.
std::vector<NeverInContactResult> firstAttempts(const NeverInContact& prover,
                                                const PairSurveyOptions& options,
                                                const std::vector<std::size_t>& wanted,
                                                std::uint64_t boxes,
                                                const std::vector<SurveyedPair>& pairs) {
  std::vector<NeverInContactResult> results(wanted.size());
  std::atomic<std::size_t> next = 0;
  const auto work = [&] {
    QueryContext context;
    for (std::size_t i = next++; i < wanted.size() && !isSet(options.interrupted); i = next++)
      results[i] = prover.prove(pairs[wanted[i]].a, pairs[wanted[i]].b,
                                limitsOf(options, boxes, UINT64_MAX / kMostTestsPerBox), context);
  };
  onThreads(static_cast<unsigned>(
                std::min<std::size_t>(std::thread::hardware_concurrency(), wanted.size())),
            work);
  return results;
}

/// Tries to prove pairs within one work limit. See surveyPairs.
void proveWithin(const Checker& checker, const PairSurveyOptions& options,
                 const std::vector<std::size_t>& wanted, PairSurveyProgress& progress,
                 std::vector<SurveyedPair>& pairs) {
  if (wanted.empty()) return;
  std::priority_queue<Attempt, std::vector<Attempt>, std::greater<>> attempts;
  const auto firstBoxes = std::clamp<std::uint64_t>(options.work / wanted.size(), 1, kFirstBoxes);
  const NeverInContact prover(checker.model(), checker.scene());
  std::vector<NeverInContactResult> first =
      firstAttempts(prover, options, wanted, firstBoxes, pairs);
  QueryContext context;
  const auto goesOn = [&] { return progress.work < options.work && !isSet(options.interrupted); };
  // Counts the work of a pair's newest attempt, and adds a repeated attempt if it may decide more.
  const auto finish = [&](std::size_t index, std::uint64_t boxes, std::size_t waiting) {
    const NeverInContactResult& proof = *pairs[index].proof;
    progress.work +=
        std::min(options.work - progress.work, proof.boxes + proof.tests / kTestsPerBox);
    progress.proved += proof.verdict == Verdict::proved;
    if (proof.verdict == Verdict::workLimit && !proof.exhausted && boxes <= kMostBoxes / kMoreBoxes)
      attempts.push({static_cast<double>(kMoreBoxes * boxes) * std::max(0.0, 1 - proof.provedShare),
                     index, kMoreBoxes * boxes});
    progress.undecided = waiting + attempts.size();
    if (options.progress) options.progress(progress);
  };
  const auto prove = [&](std::size_t index, std::uint64_t boxes, std::uint64_t left) {
    return prover.prove(pairs[index].a, pairs[index].b, limitsOf(options, boxes, left), context);
  };
  for (std::size_t i = 0; i < wanted.size() && goesOn(); ++i) {
    const std::uint64_t left = options.work - progress.work;
    const bool isAsAlone = kMostTestsPerBox / kTestsPerBox * firstBoxes <= left;
    pairs[wanted[i]].proof = isAsAlone ? std::move(first[i]) : prove(wanted[i], firstBoxes, left);
    finish(wanted[i], firstBoxes, wanted.size() - 1 - i);
  }
  while (!attempts.empty() && goesOn()) {
    const Attempt attempt = attempts.top();
    attempts.pop();
    std::optional<NeverInContactResult>& proof = pairs[attempt.pair].proof;
    const std::uint64_t left = options.work - progress.work;
    // An attempt with no more boxes than the previous attempt at this pair would decide nothing.
    if (left <= proof->boxes) continue;
    proof = prove(attempt.pair, attempt.boxes, left);
    finish(attempt.pair, attempt.boxes, 0);
  }
}

}  // namespace

Configuration randomConfiguration(const ConfigurationSpace& space,
                                  const std::function<std::uint64_t()>& next) {
  Configuration q = Configuration::Zero(static_cast<Eigen::Index>(space.size()));
  for (const Coordinate& c : space.coordinates()) {
    const auto i = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation) {
      q[i + 3] = 1;
      continue;
    }
    // 53 random bits make a double in [0, 1).
    const double share = static_cast<double>(next() >> 11) * 0x1p-53;
    const bool circle = c.kind == Coordinate::Kind::circle;
    const double lower = circle ? -std::numbers::pi : c.lower,
                 upper = circle ? std::numbers::pi : c.upper;
    // `min` keeps the value at most `upper`, even if the product is rounded up.
    if (std::isfinite(upper - lower)) q[i] = std::min(lower + share * (upper - lower), upper);
  }
  return q;
}

std::vector<SurveyedPair> surveyPairs(
    const Checker& checker, const PairSurveyOptions& options,
    const std::function<bool(std::size_t, std::size_t)>& wantsProof) {
  const Model& model = checker.model();
  std::vector<SurveyedPair> pairs;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> indexOf;
  forEachTestedPair(model, checker.required(), [&](std::size_t a, std::size_t b) {
    indexOf[{a, b}] = pairs.size();
    pairs.push_back({a, b, 0, movesFreely(model, a, b), std::nullopt});
  });
  PairSurveyProgress progress;
  std::mt19937_64 random(options.seed);
  while (progress.samples < options.samples && !isSet(options.interrupted)) {
    const Configuration q = randomConfiguration(model.space, [&] { return random(); });
    for (const Checker::PairNotFree& pair : checker.pairsNotFree(q))
      if (const auto index = indexOf.find({pair.a, pair.b}); index != indexOf.end())
        ++pairs[index->second].contacts;  // not found: a pair of held joints (notFreeAtRest)
    ++progress.samples;
    if (options.progress) options.progress(progress);
  }
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < pairs.size(); ++i)
    if (pairs[i].contacts == 0 && !pairs[i].movesFreely && wantsProof(pairs[i].a, pairs[i].b))
      wanted.push_back(i);
  if (options.work > 0) proveWithin(checker, options, wanted, progress, pairs);
  return pairs;
}

}  // namespace corridor
