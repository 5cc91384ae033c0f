/// Compares our queries with FCL's (Debian's), in one run on one core:
/// `query_benchmark [--data DIR] [--workload TEXT]… [--query interference|distance|tolerance]
///                  [--rounds N] [--fit NAME] [--cpu N] [--csv]`.
///
/// Runs every workload of DIR/collision whose name contains a TEXT (DIR defaults to
/// $CORRIDOR_DATA). All competitors build their trees once. Then there are N rounds. In each round
/// every competitor in turn answers all poses in one pass. So no pose is repeated immediately,
/// except by queries that are too short for the clock (collision/course/query_timing.h). Other
/// programs on the machine disturb all competitors alike. The time of a pose is its least time over
/// the rounds, because other programs can only add time. The time of a workload is the median over
/// its poses. competitors.h describes how each competitor is called.
///
/// Prints three tables. The first has the poses at which the root boxes of the reference tree
/// overlap. The second has the other poses, where the overhead of a call counts. The third has the
/// time to build trees. Ratios are the time of the quickest FCL tree of the row, divided by ours:
/// above 1, ours is quicker. *Wrong* counts verdicts that are not exact. For distance it counts
/// results that are off by more than 1e-12·d + 4·2^-53·S, where S is the largest |v| of the
/// vertices plus the largest coordinate of the translations.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "collision/core/quantiles.h"
#include "collision/core/simd_target.h"
#include "collision/course/query_timing.h"
#include "collision/queries/interference.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/competitors.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

using namespace bench;

struct Options {
  std::filesystem::path folder;
  Query query;
  ObbFit fit;
  int rounds;
};

using Field = std::vector<std::unique_ptr<Competitor>>;

template <class Library, class... Params>
void enter(Field& field, const std::string& name, const test::Workload& w, const Options& o,
           double tolerance, const Params&... params) {
  field.push_back(std::make_unique<Timed<Library>>(name, w, o.rounds, [&] {
    return std::make_unique<Library>(o.query, tolerance, w, params...);
  }));
}

/// Returns the competitors: our 4-wide tree first, because ratios are relative to it, and FCL's
/// last.
Field competitors(const test::Workload& w, const Options& o, double tolerance) {
  Field field;
  enter<Ours<Obb4Tree>>(field, "ours", w, o, tolerance, o.fit);
#ifdef CORRIDOR_WITH_FCL
  if (o.query == Query::interference)
    enter<Fcl<fcl::OBB<double>>>(field, "FCL OBB", w, o, tolerance);
  else
    enter<Fcl<fcl::RSS<double>>>(field, "FCL RSS", w, o, tolerance);
  enter<Fcl<fcl::OBBRSS<double>>>(field, "FCL OBBRSS", w, o, tolerance);
#endif
  return field;
}

/// A table, in Markdown or CSV.
class Table {
 public:
  Table(const std::string& title, bool csv) : csv_(csv) {
    std::cout << (csv ? "\n# " : "\n### ") << title << "\n" << (csv ? "" : "\n");
  }
  void row(const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i)
      std::cout << (csv_ ? (i ? "," : "") : "| ") << cells[i] << (csv_ ? "" : " ");
    std::cout << (csv_ ? "\n" : "|\n");
    if (first_ && !csv_) {
      for (std::size_t i = 0; i < cells.size(); ++i) std::cout << (i ? "|--:" : "|---");
      std::cout << "|\n";
    }
    first_ = false;
    std::cout << std::flush;
  }

 private:
  bool csv_, first_ = true;
};

std::string number(double x, int digits = 4) {
  std::ostringstream out;
  if (!(std::abs(x) < 1e4))
    out << std::fixed << std::setprecision(0) << x;
  else
    out << std::setprecision(digits) << x;
  return out.str();
}

struct Ratios {
  std::vector<double> all;
  void add(double ratio) {
    if (ratio > 0) all.push_back(ratio);
  }
  std::string text() const {
    if (all.empty()) return "none";
    double logs = 0;
    for (const double r : all) logs += std::log(r);
    return "geometric mean " + number(std::exp(logs / static_cast<double>(all.size())), 3) +
           ", least " + number(*std::min_element(all.begin(), all.end()), 3) + ", of " +
           std::to_string(all.size()) + " workloads";
  }
};

/// Returns the median over some poses of each pose's least time, or 0 if there is no such pose.
template <class Take>
double medianOver(const Record& r, const Take& take) {
  std::vector<double> ns;
  for (std::size_t i = 0; i < r.ns.size(); ++i)
    if (take(i)) ns.push_back(r.ns[i]);
  return ns.empty() ? 0 : medianOf(ns);
}

/// Returns the time of FCL's quickest tree, divided by the time of our tree; 0 if FCL has no tree
/// in the row, or if our tree has no time.
double ratio(const std::vector<double>& values) {
  if (values.size() < 2 || values[0] <= 0) return 0;
  return *std::min_element(values.begin() + 1, values.end()) / values[0];
}

double largestCoordinate(const test::Workload& w) {
  double reach = 0, shift = 0;
  for (const TriangleMesh* m : {&w.a, &w.b})
    for (const Vec3& v : m->vertices) reach = std::max(reach, v.norm());
  for (const Transform& X : w.poses) shift = std::max(shift, X.t.cwiseAbs().maxCoeff());
  return reach + shift;
}

int wrongAnswers(const Record& r, const test::Workload& w, Query query, double tolerance) {
  const double reach = largestCoordinate(w);
  int wrong = 0;
  for (std::size_t i = 0; i < w.poses.size(); ++i) {
    const double d = w.distance[i];
    switch (query) {
      case Query::interference:
        wrong += r.answers[i].hit != (w.hit[i] == 1);
        break;
      case Query::distance:
        wrong += std::abs(r.answers[i].distance - d) > 1e-12 * d + 4 * 0x1p-53 * reach;
        break;
      case Query::tolerance:
        wrong += !std::isnan(d) && r.answers[i].hit != (d <= tolerance);
        break;
    }
  }
  return wrong;
}

/// Returns, for each pose, whether the root boxes of the reference tree separate it.
std::vector<bool> rejectedByRoot(const test::Workload& w) {
  const ObbTree a(w.a), b(w.b);
  std::vector<bool> rejected;
  for (const Transform& X : w.poses) {
    QueryContext context;
    const bool hit = interference(Posed(a), Posed(b, X), context).has_value();
    rejected.push_back(!hit && context.counters.boxTests == 1);
  }
  return rejected;
}

/// The rows of the three tables, kept until all are known.
struct Rows {
  std::vector<std::vector<std::string>> queries, roots, builds;
  Ratios queryRatios, rootRatios, buildRatios;
  std::vector<std::string> names;
};

void run(const std::string& name, const Options& o, Rows& rows) {
  const test::Workload w = test::loadWorkload(o.folder, name);
  // The tolerance is a hundredth of the smaller mesh's size.
  const double tolerance = 0.01 * std::min(diagonal(w.a), diagonal(w.b));
  const Field field = competitors(w, o, tolerance);
  for (int i = 0; i < o.rounds; ++i)
    for (const auto& competitor : field) competitor->pass();

  const std::vector<bool> rejected = rejectedByRoot(w);
  const auto root = [&](std::size_t i) { return static_cast<bool>(rejected[i]); };
  const auto inner = [&](std::size_t i) { return !rejected[i]; };
  const auto count = std::count(rejected.begin(), rejected.end(), true);
  std::vector<double> all, kept, roots, builds;
  std::vector<std::string> wrong;
  rows.names.clear();
  for (const auto& competitor : field) {
    const Record& r = competitor->record;
    rows.names.push_back(r.name);
    all.push_back(medianOver(r, [](std::size_t) { return true; }));
    kept.push_back(medianOver(r, inner));
    roots.push_back(medianOver(r, root));
    builds.push_back(r.buildMs);
    wrong.push_back(std::to_string(wrongAnswers(r, w, o.query, tolerance)));
  }
  const auto texts = [](const std::vector<double>& values) {
    std::vector<std::string> cells;
    for (const double v : values) cells.push_back(number(v));
    return cells;
  };
  const auto append = [](std::vector<std::string> to, const std::vector<std::string>& more) {
    to.insert(to.end(), more.begin(), more.end());
    return to;
  };
  double boxes = 0, triangles = 0;
  int hits = 0;
  for (std::size_t i = 0; i < w.poses.size(); ++i) {
    const Answer& answer = field[0]->record.answers[i];
    hits += answer.hit;
    boxes += static_cast<double>(answer.boxTests) / static_cast<double>(w.poses.size());
    triangles += static_cast<double>(answer.primitiveTests) / static_cast<double>(w.poses.size());
  }
  if (kept[0] > 0) {
    std::vector<std::string> row = {name, std::to_string(w.poses.size() - std::size_t(count)),
                                    std::to_string(hits), number(all[0])};
    row = append(row, texts(kept));
    row = append(row, {number(ratio(kept), 3), number(boxes), number(triangles)});
    rows.queries.push_back(append(row, wrong));
    rows.queryRatios.add(ratio(kept));
  }
  if (roots[0] > 0) {
    rows.roots.push_back(
        append(append({name, std::to_string(count)}, texts(roots)), {number(ratio(roots), 3)}));
    rows.rootRatios.add(ratio(roots));
  }
  const auto size = static_cast<double>(w.a.triangles.size() + w.b.triangles.size());
  std::vector<std::string> row = append({name, number(size, 7)}, texts(builds));
  row = append(row, {number(ratio(builds), 3), number(size / builds[0] / 1e3, 3)});
  for (const auto& competitor : field) row.push_back(number(competitor->record.bytesPerTriangle));
  rows.builds.push_back(row);
  rows.buildRatios.add(ratio(builds));
}

std::string processor() {
  std::ifstream in("/proc/cpuinfo");
  for (std::string line; std::getline(in, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

template <class Value>
Value chosen(const Arguments& arguments, const std::string& option,
             const std::vector<std::pair<std::string, Value>>& values) {
  const std::string word = arguments.text(option, values[0].first);
  std::string known;
  for (const auto& [name, value] : values) {
    if (name == word) return value;
    known += " " + name;
  }
  throw std::runtime_error(option + ": one of" + known + " is needed, not " + word);
}

void report(const Arguments& arguments) {
  const std::vector<std::string> workloads = arguments.workloads();
  const Options o{arguments.data() / "collision",
                  chosen<Query>(arguments, "--query",
                                {{"interference", Query::interference},
                                 {"distance", Query::distance},
                                 {"tolerance", Query::tolerance}}),
                  chosen<ObbFit>(arguments, "--fit",
                                 {{"triangles", ObbFit::triangles},
                                  {"vertices", ObbFit::vertices},
                                  {"hull", ObbFit::hull}}),
                  arguments.rounds(5)};
  const int cpu = pin(arguments);
  std::cout << "processor: " << processor() << ", core " << cpu
            << "\ninstruction set: ours: " << simdTarget()
            << " (Highway's name); FCL: that of the installed library\nrounds: " << o.rounds
            << "\n";
  Rows rows;
  for (const std::string& name : workloads) {
    std::cerr << name << "\n";
    run(name, o, rows);
  }
  const auto header = [&](std::vector<std::string> first, const std::string& unit,
                          const std::vector<std::string>& last) {
    for (const std::string& name : rows.names) first.push_back(name + " " + unit);
    first.insert(first.end(), last.begin(), last.end());
    return first;
  };
  const auto print = [&](const std::string& title, const std::vector<std::string>& head,
                         const std::vector<std::vector<std::string>>& lines) {
    Table table(title, arguments.has("--csv"));
    table.row(head);
    for (const auto& line : lines) table.row(line);
  };
  std::vector<std::string> last = {"ratio", "N_v", "N_p"};
  for (const std::string& name : rows.names) last.push_back("wrong: " + name);
  print("Queries (poses that the root boxes don't separate)",
        header({"workload", "poses", "hits", "ours ns, all poses"}, "ns", last), rows.queries);
  std::cout << "\nratio: " << rows.queryRatios.text() << "\n";
  print("Poses that the root boxes separate", header({"workload", "poses"}, "ns", {"ratio"}),
        rows.roots);
  std::cout << "\nratio: " << rows.rootRatios.text() << "\n";
  last = {"ratio", "ours, 10^6 triangles/s"};
  for (const std::string& name : rows.names) last.push_back("bytes a triangle: " + name);
  print("Building both trees", header({"workload", "triangles"}, "ms", last), rows.builds);
  std::cout << "\nratio: " << rows.buildRatios.text() << "\n";
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv,
                                  {"--data", "--workload", "--query", "--rounds", "--fit", "--cpu"},
                                  corridor::report, {"--csv"});
}
