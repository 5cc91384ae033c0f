#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <iostream>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/quantiles.h"
#include "collision/core/simd_target.h"
#include "collision/course/cost_model.h"
#include "collision/course/query_timing.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/output.h"
#include "planner/app/read_mesh.h"
#include "planner/query/commands.h"
#include "planner/query/query_batch.h"
#include "planner/query/query_poses.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

struct CostArguments {
  std::string file, against;
  std::optional<std::string> poses, unit, up;
  bool json = false;
};

/// The time of a pose is the median of this many passes.
constexpr int kPasses = 5;

/// One line of the table: the cost of queries with one bounding volume. The model is T = N_v·C_v +
/// N_p·C_p (cost_model.h): N_v tests of volumes and N_p tests of triangle pairs, at C_v and C_p
/// nanoseconds per test. Poses at which the root boxes are separate are left out. N_v and N_p are
/// means over the other poses. T is the mean time over one half of these poses. The predicted T
/// uses the costs that were measured and fitted at the other half.
struct CostRow {
  std::string volume;
  double boxTests = 0, primitiveTests = 0;  ///< N_v, N_p
  double callNs = 0;                        ///< time of a query that is decided by its first test
  TestCosts tests;                          ///< C_v, C_p, measured test by test
  std::optional<double> traversalNs;        ///< for each volume test; empty: part of C_v
  double measuredNs = 0, predictedNs = 0;   ///< T
  double low = 0, middle = 0, high = 0;     ///< predicted/measured: quantiles 0.05, 0.5, 0.95
  double buildMs = 0;                       ///< both trees
  std::size_t bytes = 0;                    ///< both trees
};

/// Computes the line of one volume.
///
/// C_v and C_p are measured test by test (test_costs.h). Only a volume test's share of the
/// traversal is fitted to whole queries. The 4-wide OBB tree tests up to sixteen node pairs at
/// once, so its C_v and C_p are fitted, and its C_v includes the traversal. A prediction must not
/// be fitted to the times that it predicts: costs are measured and fitted at one half of the poses,
/// and the other half is predicted.
///
/// A query also has a fixed cost, which the model does not contain. The fixed cost is measured with
/// B far away, subtracted before the fit, and reported as `callNs`.
/// @param count the number of poses; the answers after the first `count` are those of the poses
/// with B far away.
/// @param kept the indices of the poses at which the root boxes overlap.
CostRow costRow(const VolumeKind& volume, const BatchResult& result, std::size_t count,
                const std::vector<std::size_t>& kept) {
  CostRow row;
  row.volume = volume.name;
  row.buildMs = result.buildMsA + result.buildMsB;
  row.bytes = result.bytesA + result.bytesB;
  std::vector<QueryCost> seen, unseen;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    const Answer& answer = result.answers[kept[i]];
    const QueryCost cost{static_cast<double>(answer.boxTests),
                         static_cast<double>(answer.primitiveTests), answer.ns};
    row.boxTests += cost.boxTests / static_cast<double>(kept.size());
    row.primitiveTests += cost.primitiveTests / static_cast<double>(kept.size());
    (i % 2 ? unseen : seen).push_back(cost);
  }
  std::vector<double> calls;
  for (std::size_t i = count; i < result.answers.size(); ++i) calls.push_back(result.answers[i].ns);
  row.callNs = medianOf(calls);
  row.tests = result.tests;
  CostModel model;
  if (row.tests.box) {
    model.box = *row.tests.box;
    model.triangle = row.tests.triangle.value_or(0);
    row.traversalNs = traversalShare(seen, model, row.callNs);
    model.box += *row.traversalNs;
  } else {
    model = fittedCosts(seen, row.callNs);
    if (model.boxKnown) row.tests.box = model.box;
    if (model.triangleKnown) row.tests.triangle = model.triangle;
  }
  std::vector<double> ratios;
  for (const QueryCost& c : unseen) {
    row.measuredNs += c.ns / static_cast<double>(unseen.size());
    row.predictedNs += model.predicted(c) / static_cast<double>(unseen.size());
    ratios.push_back(model.predicted(c) / c.ns);
  }
  row.low = quantileOf(ratios, 0.05);
  row.middle = medianOf(ratios);
  row.high = quantileOf(ratios, 0.95);
  return row;
}

std::string twoDecimals(double x) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", x);
  return text;
}

/// Returns the poses, followed by copies of the first few with B so far away that the first test
/// separates the meshes.
std::vector<Transform> withFarPoses(std::vector<Transform> poses, const TriangleMesh& a,
                                    const TriangleMesh& b) {
  double far = 1;
  for (const TriangleMesh* mesh : {&a, &b})
    for (const Vec3& v : mesh->vertices) far = std::max(far, 8 * v.cwiseAbs().maxCoeff());
  const std::size_t count = std::min<std::size_t>(poses.size(), 9);
  for (std::size_t i = 0; i < count; ++i) poses.push_back({poses[i].m, Vec3::Constant(far)});
  return poses;
}

/// Returns every second index of `kept`, in random order: the poses at which costs are measured and
/// fitted.
std::vector<std::size_t> measuredPoses(const std::vector<std::size_t>& kept) {
  std::vector<std::size_t> poses;
  for (std::size_t i = 0; i < kept.size(); i += 2) poses.push_back(kept[i]);
  std::shuffle(poses.begin(), poses.end(), std::mt19937_64(1));
  return poses;
}

void printTable(const std::vector<CostRow>& rows) {
  const auto line = [](const std::string& first, const std::vector<std::string>& cells) {
    std::cout << std::left << std::setw(10) << first << std::right;
    for (const std::string& cell : cells) std::cout << ' ' << std::setw(14) << cell;
    std::cout << '\n';
  };
  line("volume", {"N_v", "N_p", "call ns", "C_v ns", "C_p ns", "traversal ns", "predicted ns",
                  "measured ns", "ratio", "5 .. 95 %", "bytes", "build ms"});
  const auto cost = [](const std::optional<double>& ns) { return ns ? rounded(*ns) : "-"; };
  // A prediction from fitted costs may be negative.
  const auto whole = [](double ns) {
    return (ns < 0 ? "-" : "") + grouped(std::llround(std::abs(ns)));
  };
  for (const CostRow& r : rows)
    line(r.volume,
         {rounded(r.boxTests), rounded(r.primitiveTests), rounded(r.callNs), cost(r.tests.box),
          cost(r.tests.triangle), cost(r.traversalNs), whole(r.predictedNs), whole(r.measuredNs),
          twoDecimals(r.predictedNs / r.measuredNs),
          twoDecimals(r.low) + " .. " + twoDecimals(r.high), grouped(r.bytes), rounded(r.buildMs)});
}

ordered_json rowJson(const CostRow& r) {
  const auto cost = [](const std::optional<double>& ns) {
    return ns ? ordered_json(*ns) : ordered_json();
  };
  return {{"volume", r.volume},
          {"bv_tests", r.boxTests},
          {"triangle_tests", r.primitiveTests},
          {"call_ns", r.callNs},
          {"bv_test_ns", cost(r.tests.box)},
          {"triangle_test_ns", cost(r.tests.triangle)},
          {"traversal_ns", cost(r.traversalNs)},
          {"predicted_ns", r.predictedNs},
          {"measured_ns", r.measuredNs},
          {"ratio", r.predictedNs / r.measuredNs},
          {"ratio_p5", r.low},
          {"ratio_median", r.middle},
          {"ratio_p95", r.high},
          {"bytes", r.bytes},
          {"build_ms", r.buildMs}};
}

int inspectCost(const CostArguments& a) {
  const MeshFile meshA = readMeshAs(a.file, a.unit, a.up),
                 meshB = readMeshAs(a.against, a.unit, a.up);
  const std::vector<Transform> poses =
      a.poses ? readPoses(*a.poses) : gridPoses({{6, 6, 6}, 4, 1, {}, {}}, meshA.mesh, meshB.mesh);
  const std::vector<Transform> asked = withFarPoses(poses, meshA.mesh, meshB.mesh);
  const auto run = [&](const VolumeKind& volume, int passes,
                       const std::vector<std::size_t>& measured) {
    return runPoses({meshA.mesh, meshB.mesh, asked, QueryKind::interference,
                     treesNamed({volume.name, "", ""}), 0, passes, measured});
  };
  // If the first test decides a query, the query's time is the cost of the call, not of the tests.
  // So the pose of such a query is left out. All volumes are compared at the same poses: those at
  // which the root boxes of the binary OBB trees overlap.
  const auto& volumes = volumeKinds();
  const auto reference = std::ranges::find(volumes, "obb-binary", &VolumeKind::name);
  const std::vector<Answer> answers = run(*reference, 1, {}).answers;
  std::vector<std::size_t> kept;
  std::size_t hits = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Answer& answer = answers[i];
    hits += answer.hit;
    if (answer.boxTests > 1 || answer.primitiveTests > 0) kept.push_back(i);
  }
  if (kept.size() < 2)
    throw InputError(
        Fault{a.poses.value_or("--against"), 0,
              "at least two poses are needed at which the meshes' bounding boxes overlap; "
              "they overlap at " +
                  std::to_string(kept.size()) + " of " + counted(poses.size(), "pose")});
  std::vector<CostRow> rows;
  for (const VolumeKind& volume : volumes)
    rows.push_back(costRow(volume, run(volume, kPasses, measuredPoses(kept)), poses.size(), kept));
  if (a.json) {
    ordered_json j = {{"format", "corridor-inspect-cost-1"},
                      {"a", a.file},
                      {"b", a.against},
                      {"triangles_a", meshA.mesh.triangles.size()},
                      {"triangles_b", meshB.mesh.triangles.size()},
                      {"poses", poses.size()},
                      {"rejected_by_root", poses.size() - kept.size()},
                      {"hits", hits},
                      {"simd", simdTarget()},
                      {"volumes", ordered_json::array()}};
    for (const CostRow& row : rows) j["volumes"].push_back(rowJson(row));
    std::cout << jsonText(j) << '\n';
    return kDone;
  }
  const ResultPrinter out(false);
  out.line("meshes", a.file + ", " + counted(meshA.mesh.triangles.size(), "triangle") + "; " +
                         a.against + ", " + counted(meshB.mesh.triangles.size(), "triangle"));
  out.line("poses", grouped(poses.size()) + ", " + counted(hits, "contact") + ", " +
                        grouped(poses.size() - kept.size()) +
                        " separated by the root boxes (these don't count below)");
  out.line("simd", std::string(simdTarget()) + ", used by obb");
  out.line("costs",
           "measured at one half of the poses; the other half is predicted; traversal: for each "
           "volume test, fitted; call is not part of predicted; of obb: all fitted, C_v with "
           "traversal; -: no such test, or the "
           "queries do not determine this cost");
  out.blank();
  printTable(rows);
  return kDone;
}

}  // namespace

void addInspectCost(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<CostArguments>();  // the callback keeps it
  CostArguments& a = *arguments;
  CLI::App* command = program.add_subcommand("inspect", "The cost of queries of two meshes");
  command->add_option("FILE", a.file)->required();
  command->add_option("--against", a.against)->required();
  command->add_option("--poses", a.poses);
  command->add_option("--unit", a.unit);
  command->add_option("--up", a.up);
  addJson(*command, a.json);
  command->callback([arguments, &status] { status = inspectCost(*arguments); });
}

}  // namespace corridor::app
