#include <algorithm>
#include <cstdio>
#include <iostream>
#include <utility>

#include "collision/core/error.h"
#include "collision/core/simd_target.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_file.h"
#include "planner/app/commands.h"
#include "planner/app/output.h"
#include "planner/app/query_batch.h"
#include "planner/app/query_poses.h"
#include "planner/app/query_timing.h"
#include "planner/app/standard_streams.h"

namespace corridor::app {
namespace {

/// The maximum number of queries of one command, all passes counted: each stores its time, 8 bytes.
constexpr std::uint64_t kMostQueries = 1'000'000'000;

/// Returns the query of this name, or the first if no name is given.
/// @throws InputError for an unknown name; it lists the names.
const QueryKind& queryNamed(const std::optional<std::string>& name) {
  if (!name) return queryKinds().front();
  std::vector<std::string> names;
  for (const QueryKind& kind : queryKinds()) {
    if (kind.name == *name) return kind;
    names.push_back(kind.name);
  }
  throw InputError(Fault{"--query", 0,
                         "unknown query " + quotedWord(*name) + didYouMean(*name, names) +
                             "; there are: " + joined(names)});
}

/// Returns the volume, fit and overlap test that the arguments name, defaults filled in.
/// @throws InputError for an unknown name; it lists the names.
TreeNames treesAsked(const QueryArguments& a) {
  const TreeNames words{a.volume.value_or(""), a.fit.value_or(""), a.overlap.value_or("")};
  if (const auto wrong = invalidNameIn(words))
    throw InputError(Fault{"--" + wrong->key, 0, wrong->text});
  return withDefaults(words);
}

/// Refuses an --overlap other than the volume's default, for a query that computes distances
/// between volumes and so has no use for it. @throws InputError
/// @param of what takes an overlap test. @param asked the query that does not.
void requireUsualOverlap(const TreeNames& trees, const std::string& of, const std::string& asked) {
  if (trees.overlap == withDefaults({trees.volume, "", ""}).overlap) return;
  throw InputError(Fault{"--overlap", 0,
                         quotedWord(trees.overlap) + " needs " + of + "; " + asked +
                             " computes distances between volumes"});
}

std::vector<Transform> posesOf(const QueryArguments& a, const TriangleMesh& meshA,
                               const TriangleMesh& meshB) {
  if (a.poses) return readPoses(*a.poses);
  PoseGrid grid;
  grid.counts = parseCounts(*a.grid);
  grid.rotations = static_cast<std::size_t>(a.rotations.value_or(1));
  grid.seed = a.seed.value_or(1);
  if (a.lower) grid.lower = parsePoint("--lower", *a.lower);
  if (a.upper) grid.upper = parsePoint("--upper", *a.upper);
  return gridPoses(grid, meshA, meshB);
}

/// Checks which options go together, which CLI11 can't. @throws InputError
void checkOptions(const QueryArguments& a) {
  if (a.motions) {
    const auto ofPoses = [&](const char* option, bool given) {
      if (given)
        throw InputError(Fault{option, 0, "applies to poses, not to --motions; leave it out"});
    };
    ofPoses("--poses", a.poses.has_value());
    ofPoses("--grid", a.grid.has_value());
    ofPoses("--query", a.query.has_value());
    if (a.tolerance && !(*a.tolerance > 0))
      throw InputError(Fault{"--tolerance", 0, "must be above 0 with --motions"});
  }
  if (a.poses && a.grid)
    throw InputError(Fault{"--grid", 0, "can't be used with --poses; give one of the two"});
  if (!a.poses && !a.grid && !a.motions)
    throw InputError(Fault{"--poses", 0, "a file of poses is needed, or --grid, or --motions"});
  const auto ofGrid = [&](const char* option, bool given) {
    if (given && !a.grid) throw InputError(Fault{option, 0, "needs --grid, which is not given"});
  };
  if (a.edges && !a.motions)
    throw InputError(Fault{"--edges", 0, "needs --motions, which is not given"});
  ofGrid("--lower", a.lower.has_value());
  ofGrid("--upper", a.upper.has_value());
  ofGrid("--rotations", a.rotations.has_value());
  ofGrid("--seed", a.seed.has_value());
  ofGrid("--save-poses", a.savePoses.has_value());
}

/// Prints all lines in a single write: quick for millions of lines, and stdout and stderr don't
/// mix.
void printCsv(const QueryKind& kind, const BatchResult& result) {
  std::string text = kind.header + "\n";
  char line[256];
  if (kind.asked == Asked::contacts) {
    for (const ContactRow& c : result.contacts) {
      std::snprintf(line, sizeof line, "%zu,%u,%u,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", c.pose,
                    c.a, c.b, c.p.x(), c.p.y(), c.p.z(), c.q.x(), c.q.y(), c.q.z());
      text += line;
    }
  } else if (kind.asked == Asked::distance) {
    for (std::size_t i = 0; i < result.distances.size(); ++i) {
      const Distance& d = result.distances[i];
      std::snprintf(line, sizeof line, "%zu,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", i,
                    d.distance, d.p_WA.x(), d.p_WA.y(), d.p_WA.z(), d.p_WB.x(), d.p_WB.y(),
                    d.p_WB.z());
      text += line;
    }
  } else if (kind.asked == Asked::tolerance) {
    for (std::size_t i = 0; i < result.answers.size(); ++i)
      text += std::to_string(i) + ',' + (result.answers[i].hit ? "1\n" : "0\n");
  } else {
    for (std::size_t i = 0; i < result.answers.size(); ++i) {
      const Answer& answer = result.answers[i];
      text += std::to_string(i) + ',' + (answer.hit ? '1' : '0') + ',' +
              std::to_string(answer.boxTests) + ',' + std::to_string(answer.triangleTests) + '\n';
    }
  }
  std::cout << text;
  requireResultsWritten();
}

/// Prints the summary on stderr: `words`, which describe the query and count its answers, then
/// times, mean counts, and the trees' build times and sizes.
void printSummary(const BatchResult& result, const std::vector<std::string>& words) {
  std::vector<double> ns;
  double boxTests = 0, triangleTests = 0, sum = 0;
  for (const Answer& answer : result.answers) {
    ns.push_back(answer.ns);
    sum += answer.ns;
    boxTests += static_cast<double>(answer.boxTests);
    triangleTests += static_cast<double>(answer.triangleTests);
  }
  const auto count = static_cast<double>(ns.size());
  // The smallest time that at least 95 % of the times do not exceed.
  const std::size_t rank = (95 * ns.size() + 99) / 100 - 1;
  const double middle = median(ns);
  std::nth_element(ns.begin(), ns.begin() + static_cast<std::ptrdiff_t>(rank), ns.end());
  for (const std::string& word : words) std::cerr << word << '\n';
  std::cerr << "simd=" << simdTarget() << '\n';
  const auto tell = [](const char* key, const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    std::cerr << key << '=' << text << '\n';
  };
  tell("median_ns", "%.1f", middle);
  tell("mean_ns", "%.1f", sum / count);
  tell("p95_ns", "%.1f", ns[rank]);
  tell("bv_tests", "%.6g", boxTests / count);
  tell("triangle_tests", "%.6g", triangleTests / count);
  tell("build_ms_a", "%.4f", result.buildMsA);
  tell("build_ms_b", "%.4f", result.buildMsB);
  tell("bytes_a", "%.0f", static_cast<double>(result.bytesA));
  tell("bytes_b", "%.0f", static_cast<double>(result.bytesB));
  if (!std::cerr) throw InputError(Fault{"standard error", 0, "can't be written"});
}

void printMotions(const BatchResult& result) {
  std::string text =
      "motion,verdict,t0,t1,gap,triangle_a,triangle_b,bv_tests,triangle_tests,splits\n";
  char line[256];
  for (std::size_t i = 0; i < result.motions.size(); ++i) {
    const MotionAnswer& motion = result.motions[i];
    const MotionResult& r = motion.result;
    const char* verdict = r.verdict == MotionVerdict::free      ? "free"
                          : r.verdict == MotionVerdict::contact ? "contact"
                                                                : "undecided";
    std::snprintf(line, sizeof line, "%zu,%s,%.17g,%.17g,%.17g,%d,%d,%llu,%llu,%llu\n", i, verdict,
                  r.certifiedUntil, r.contactTime, r.gap,
                  r.pair ? static_cast<int>(r.pair->triangleA) : -1,
                  r.pair ? static_cast<int>(r.pair->triangleB) : -1,
                  static_cast<unsigned long long>(result.answers[i].boxTests),
                  static_cast<unsigned long long>(result.answers[i].triangleTests),
                  static_cast<unsigned long long>(motion.splits));
    text += line;
  }
  std::cout << text;
  requireResultsWritten();
}

void checkRepeats(const QueryArguments& a, std::size_t count, const char* what) {
  if (a.repeat <= kMostQueries / count) return;
  throw InputError(Fault{"--repeat", 0,
                         grouped(a.repeat) + " passes over " + counted(count, what) +
                             " are more than " + grouped(kMostQueries) + " queries"});
}

/// @throws InputError for an unknown name.
EdgeMethod methodNamed(const std::string& name) {
  if (const auto method = edgeMethodNamed(name)) return *method;
  throw InputError(Fault{"--edges", 0,
                         "unknown method " + quotedWord(name) +
                             didYouMean(name, edgeMethodNames()) +
                             "; there are: " + joined(edgeMethodNames())});
}

int queryMotions(const QueryArguments& a) {
  const std::string edges = a.edges.value_or(edgeMethodNames().front());
  const EdgeMethod method = methodNamed(edges);
  const TreeNames trees = treesAsked(a);
  if (method != EdgeMethod::directional) requireUsualOverlap(trees, "--edges certified", edges);
  MeshFile meshA = readMeshFile(a.meshA), meshB = readMeshFile(a.meshB);
  const std::vector<PoseMotion> motions = readMotions(*a.motions);
  checkRepeats(a, motions.size(), "motion");
  const BatchResult result =
      runMotions(std::move(meshA.mesh), std::move(meshB.mesh), motions, treesNamed(trees),
                 a.tolerance, static_cast<int>(a.repeat), method);
  printMotions(result);
  const auto number = [&](MotionVerdict verdict) {
    return std::to_string(std::count_if(
        result.motions.begin(), result.motions.end(),
        [&](const MotionAnswer& motion) { return motion.result.verdict == verdict; }));
  };
  printSummary(
      result,
      {"edges=" + edges, "volume=" + trees.volume, "fit=" + trees.fit, "overlap=" + trees.overlap,
       "tolerance=" + rounded(result.tolerance), "motions=" + std::to_string(motions.size()),
       "free=" + number(MotionVerdict::free), "hits=" + number(MotionVerdict::contact),
       "undecided=" + number(MotionVerdict::undecided)});
  return kDone;
}

}  // namespace

int queryCommand(const QueryArguments& a) {
  checkOptions(a);
  requireFolderFor(a.savePoses, "--save-poses");
  if (a.motions) return queryMotions(a);
  const QueryKind& query = queryNamed(a.query);
  const TreeNames trees = treesAsked(a);
  if (query.asked == Asked::tolerance && !a.tolerance)
    throw InputError(
        Fault{"--tolerance", 0, "is needed with --query tolerance: a distance in metres"});
  if (query.asked != Asked::tolerance && a.tolerance)
    throw InputError(Fault{"--tolerance", 0, "needs --query tolerance or --motions"});
  if (!testsOverlap(query.asked))
    requireUsualOverlap(trees, "--query interference or contacts", query.name);
  const MeshFile meshA = readMeshFile(a.meshA), meshB = readMeshFile(a.meshB);
  const std::vector<Transform> poses = posesOf(a, meshA.mesh, meshB.mesh);
  checkRepeats(a, poses.size(), "pose");
  requireNotRead(a.savePoses, "--save-poses", {a.meshA, a.meshB}, "the query");
  if (a.savePoses) writePoses(*a.savePoses, poses);
  const BatchResult result =
      runPoses({meshA.mesh, meshB.mesh, poses, query.asked, treesNamed(trees),
                a.tolerance.value_or(0), static_cast<int>(a.repeat)});
  printCsv(query, result);
  const auto hits = std::count_if(result.answers.begin(), result.answers.end(),
                                  [](const Answer& answer) { return answer.hit; });
  printSummary(result, {"query=" + query.name, "volume=" + trees.volume, "fit=" + trees.fit,
                        "overlap=" + trees.overlap, "poses=" + std::to_string(poses.size()),
                        "hits=" + std::to_string(hits)});
  return kDone;
}

}  // namespace corridor::app
