#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "collision/core/posed.h"
#include "collision/core/quantiles.h"
#include "collision/core/query_context.h"
#include "collision/course/query_timing.h"
#include "collision/hierarchy/volume_tree.h"
#include "collision/queries/touching_pairs.h"

/// The costs of single tests: C_v and C_p of T = N_v·C_v + N_p·C_p (Gottschalk, Lin, Manocha 1996,
/// eq. 1), without the traversal. The tests of whole queries are recorded, and then run again in
/// the same order. So the processor's caches contain much the same data as during the queries.
namespace corridor {

/// Nanoseconds of one test of each kind, the mean over the recorded tests. A cost is empty if the
/// queries make no such test.
struct TestCosts {
  std::optional<double> box, triangle;
};

/// One test of a recorded query: the index of the query's pose, and the indices of two nodes, or of
/// two leaf primitives in leaf order.
struct RecordedTest {
  std::uint32_t pose, a, b;
};

/// The tests that interference queries make, query by query, in the order in which they make them.
struct RecordedTests {
  std::vector<RecordedTest> boxes, leaves;
};

namespace internal {

/// Runs a `TouchingPairs` query, and records its tests until there are `most` of them.
template <class Query>
class RecordingQuery {
 public:
  RecordingQuery(Query& query, std::uint32_t pose, std::size_t most, RecordedTests& tests)
      : query_(query), pose_(pose), most_(most), tests_(tests) {}

  template <class NodeA, class NodeB>
  bool enter(const NodePair& pair, const NodeA& na, const NodeB& nb) {
    if (full()) return false;
    tests_.boxes.push_back({pose_, pair.a, pair.b});
    return query_.enter(pair, na, nb);
  }
  template <class NodeA, class NodeB>
  bool leaves(const NodeA& na, const NodeB& nb) {
    for (std::uint32_t s = na.first; s < na.first + na.count; ++s)
      for (std::uint32_t t = nb.first; t < nb.first + nb.count; ++t) {
        if (full()) return true;
        tests_.leaves.push_back({pose_, s, t});
        if (query_.touch(s, t)) return true;
      }
    return false;
  }
  void push(NodePairs& stack, std::uint32_t i, std::uint32_t k) { query_.push(stack, i, k); }
  void opened(NodePairs& stack, std::size_t first) { query_.opened(stack, first); }

 private:
  bool full() const { return tests_.boxes.size() + tests_.leaves.size() >= most_; }
  Query& query_;
  const std::uint32_t pose_;
  const std::size_t most_;
  RecordedTests& tests_;
};

}  // namespace internal

/// Records the tests of the interference queries of a, at the identity, and b, at each of the
/// poses. Records no more than `most` tests in all.
template <class Overlap, BoundingVolume Volume>
RecordedTests recordedTests(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b,
                            std::span<const Transform> poses, std::size_t most) {
  RecordedTests tests;
  QueryContext context;
  const auto first = [](std::uint32_t, std::uint32_t) { return true; };
  for (std::uint32_t i = 0; i < poses.size(); ++i) {
    const Posed posedA(a), posedB(b, poses[i]);
    const auto test = pairTestOf<Volume, Overlap>(posedA, posedB);
    TouchingPairs query(posedA, posedB, test, context.counters, first);
    internal::RecordingQuery recording(query, i, most, tests);
    traverse(a, b, NodePair{0, 0}, *context.scratch.use<NodePairs>(), recording);
  }
  return tests;
}

/// Measures the tests of interference queries without the traversal: runs all recorded box tests
/// in a row, then all leaf tests.
/// @param poses the poses of b; a is at the identity. The poses should be in random order, because
/// only the first `most` tests of the queries are run.
/// @returns the medians over `rounds` rounds.
template <class Overlap, BoundingVolume Volume>
TestCosts testCosts(const VolumeTree<Volume>& a, const VolumeTree<Volume>& b,
                    std::span<const Transform> poses, std::size_t most = 1 << 18, int rounds = 5) {
  const RecordedTests tests = recordedTests<Overlap>(a, b, poses, most);
  const Posed posedA(a);
  std::vector<Posed<VolumeTree<Volume>>> posedB;
  std::vector<PairTest<Volume, Overlap>> overlap;
  for (const Transform& X_WB : poses) posedB.emplace_back(b, X_WB);
  for (const auto& posed : posedB) overlap.push_back(pairTestOf<Volume, Overlap>(posedA, posed));
  QueryContext context;
  std::uint64_t separated = 0, touching = 0;  // results that are used, so that no test is left out
  const auto nanoseconds = [&](const std::vector<RecordedTest>& all, const auto& run) {
    std::vector<double> ns;
    for (int i = 0; i < rounds && !all.empty(); ++i) {
      const auto runAll = [&] {
        for (const RecordedTest& test : all) run(test);
      };
      ns.push_back(nanosecondsOf(runAll, runAll) / static_cast<double>(all.size()));
    }
    return ns.empty() ? std::optional<double>() : medianOf(ns);
  };
  TestCosts costs;
  costs.box = nanoseconds(tests.boxes, [&](const RecordedTest& t) {
    separated += overlap[t.pose].separated(a.node(t.a).box, b.node(t.b).box, 0);
  });
  const auto never = [](std::uint32_t, std::uint32_t) { return false; };
  costs.triangle = nanoseconds(tests.leaves, [&](const RecordedTest& t) {
    const TouchingPairs query(posedA, posedB[t.pose], overlap[t.pose], context.counters, never);
    touching += query.touch(t.a, t.b);
  });
  volatile std::uint64_t used = separated + touching;
  static_cast<void>(used);
  return costs;
}

}  // namespace corridor
