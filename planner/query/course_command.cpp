// `corridor course`: algorithms of the course whose input is not two meshes at poses.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "collision/convex/convex_polygon.h"
#include "collision/core/error.h"
#include "collision/core/spelling.h"
#include "collision/course/dobkin_kirkpatrick.h"
#include "collision/course/linear_program.h"
#include "collision/course/plane_separation.h"
#include "collision/course/polygon_intersection.h"
#include "collision/course/query_timing.h"
#include "collision/course/separating_plane.h"
#include "collision/course/sweep_and_prune.h"
#include "collision/geometry/mesh_file.h"
#include "planner/app/commands.h"
#include "planner/app/options.h"
#include "planner/app/other_program.h"
#include "planner/app/output.h"
#include "planner/app/read_mesh.h"
#include "planner/app/standard_streams.h"
#include "planner/query/commands.h"
#include "planner/query/number_lines.h"

namespace corridor::app {
namespace {

using Numbers = std::vector<double>;

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}
std::string nanoseconds(const std::function<void()>& ask) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.1f", nanosecondsOf(ask, ask));
  return buffer;
}
std::string row(const std::vector<std::string>& cells) {
  std::string text;
  for (const std::string& cell : cells) text += (text.empty() ? "" : ",") + cell;
  return text + '\n';
}
int print(const std::string& csv) {
  std::cout << csv;
  requireResultsWritten();
  return kDone;
}

/// Returns "" if a line has this many numbers, else what is wrong.
std::string wrongCount(const Numbers& line, std::size_t count, const char* what) {
  return line.size() == count ? "" : what + (", not " + std::to_string(line.size()));
}

/// Returns compute(). If it throws std::invalid_argument, the fault is one of the file.
template <class Compute>
auto checked(const std::string& file, const Compute& compute) {
  try {
    return compute();
  } catch (const std::invalid_argument& error) {
    throw InputError(Fault{file, 0, error.what()});
  }
}

/// Computes the separation of a mesh's hull from planes, by the hierarchy, and times the same
/// question to every vertex.
int separatePlanes(const std::string& meshFile, const std::string& planeFile) {
  std::vector<HalfSpace<3>> planes;
  readNumberLines(planeFile, "planes", [&](const Numbers& line) {
    std::string wrong = wrongCount(line, 4, "a plane has 4 numbers (nx ny nz d)");
    if (!wrong.empty()) return wrong;
    planes.push_back({Vec3(line[0], line[1], line[2]), line[3]});
    return std::string(planes.back().normal.isZero(0) ? "the normal is 0" : "");
  });
  const TriangleMesh mesh = readMeshAndPrintNotes(meshFile).mesh;
  const DobkinKirkpatrick hull =
      checked(meshFile, [&] { return DobkinKirkpatrick(Polytope(mesh.vertices)); });
  const Polytope& polytope = hull.polytope();
  std::string csv = "plane,side,lower,upper,witness,innermost,outermost,ns,every_vertex_ns\n";
  volatile double most = 0;  // keeps the compiler from removing the loop over every vertex
  for (std::size_t i = 0; i < planes.size(); ++i) {
    PlaneSeparation found;
    const std::string ns = nanoseconds([&] { found = planeSeparation(hull, planes[i]); });
    const std::string everyVertexNs = nanoseconds([&] {
      double least = HUGE_VAL, largest = -HUGE_VAL;
      for (const Vec3& vertex : polytope.vertices()) {
        const double height = planes[i].normal.dot(vertex);
        least = std::min(least, height), largest = std::max(largest, height);
      }
      most = largest - least;
    });
    csv += row({std::to_string(i), std::to_string(found.side), text(found.lower), text(found.upper),
                std::to_string(polytope.source(found.witness)),
                std::to_string(polytope.source(found.innermost)),
                std::to_string(polytope.source(found.outermost)), ns, everyVertexNs});
  }
  return print(csv);
}

ConvexPolygon readPolygon(const std::string& file) {
  std::vector<Vec2> points;
  readNumberLines(file, "points", [&](const Numbers& line) {
    std::string wrong = wrongCount(line, 2, "a point has 2 numbers (x y)");
    if (wrong.empty()) points.emplace_back(line[0], line[1]);
    return wrong;
  });
  return checked(file, [&] { return ConvexPolygon(points); });
}

/// Returns the half-planes to the left of the edges, with rounded normals and offsets.
std::vector<HalfSpace<2>> halfPlanesOf(const ConvexPolygon& polygon) {
  std::vector<HalfSpace<2>> halfPlanes;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 edge = polygon[i + 1] - polygon[i], normal(edge.y(), -edge.x());
    halfPlanes.push_back({normal, normal.dot(polygon[i])});
  }
  return halfPlanes;
}

/// Tests two convex polygons for a common point, by each method.
int intersectPolygons(const std::string& fileP, const std::string& fileQ) {
  const ConvexPolygon p = readPolygon(fileP), q = readPolygon(fileQ);
  std::string csv = "method,hit,steps,exact,ns\n";
  const auto add = [&](const char* method, bool hit, int steps, bool exact, const std::string& ns) {
    csv += row({method, hit ? "1" : "0", std::to_string(steps), exact ? "1" : "0", ns});
  };
  PolygonIntersection byPruning;
  std::string ns = nanoseconds([&] { byPruning = intersection(p, q); });
  add("barba-langerman", byPruning.intersects, byPruning.steps, byPruning.exact, ns);
  SeparatingPlane<2> line;
  ns = nanoseconds([&] { line = separatingPlane<2>(p.vertices(), q.vertices()); });
  add("separating-line", line.relation != HullRelation::disjoint, 0, line.exact, ns);
  const std::vector<HalfSpace<2>> halfPlanesP = halfPlanesOf(p), halfPlanesQ = halfPlanesOf(q);
  LinearProgramAnswer<2> point;
  ns = nanoseconds([&] { point = commonPoint<2>(halfPlanesP, halfPlanesQ); });
  add("half-planes", point.status != LinearProgramStatus::infeasible, 0, point.exact, ns);
  return print(csv);
}

constexpr std::size_t kMostVariables = 6;

/// The lines of a linear program, still of any number of variables.
struct ProgramLines {
  Numbers goal;
  std::vector<Numbers> halfSpaces;
};

template <int D>
int solveProgram(const ProgramLines& lines) {
  const Eigen::Matrix<double, D, 1> goal(lines.goal.data());
  std::vector<HalfSpace<D>> halfSpaces;
  for (const Numbers& line : lines.halfSpaces)
    halfSpaces.push_back({Eigen::Matrix<double, D, 1>(line.data()), line[D]});
  LinearProgramAnswer<D> found;
  const std::string ns = nanoseconds([&] { found = solveLinearProgram<D>(halfSpaces, goal); });
  const auto vectorRow = [](std::string key, const Eigen::Matrix<double, D, 1>& vector) {
    for (const double x : vector) key += ',' + text(x);
    return key + '\n';
  };
  const bool isOptimal = found.status == LinearProgramStatus::optimal;
  const bool isUnbounded = found.status == LinearProgramStatus::unbounded;
  std::string csv = std::string("status,") +
                    (isOptimal     ? "optimal"
                     : isUnbounded ? "unbounded"
                                   : "infeasible") +
                    "\n";
  if (isOptimal) csv += "value," + text(goal.dot(found.x)) + '\n';
  if (isOptimal || isUnbounded) csv += vectorRow("x", found.x);
  if (isUnbounded) csv += vectorRow("ray", found.ray);
  for (const auto& [index, weight] : found.proof)
    csv += "weight," + std::to_string(index) + ',' + text(weight) + '\n';
  return print(csv + "exact," + (found.exact ? "1" : "0") + "\nns," + ns + '\n');
}

int solveProgram(const std::string& file) {
  ProgramLines lines;
  readNumberLines(file, "half-spaces", [&](const Numbers& line) -> std::string {
    if (lines.goal.empty()) {
      lines.goal = line;
      if (line.size() >= 2 && line.size() <= kMostVariables) return "";
      lines.goal.resize(2);
      return "the first line is the goal, with 2 to " + std::to_string(kMostVariables) +
             " numbers, not " + std::to_string(line.size());
    }
    lines.halfSpaces.push_back(line);
    return wrongCount(line, lines.goal.size() + 1,
                      "a half-space has one number more than the goal (a1 … ad b)");
  });
  switch (lines.goal.size()) {
    case 2:
      return solveProgram<2>(lines);
    case 3:
      return solveProgram<3>(lines);
    case 4:
      return solveProgram<4>(lines);
    case 5:
      return solveProgram<5>(lines);
    default:
      return solveProgram<6>(lines);
  }
}

/// One change of a box: box `item` is from now on `box`.
struct BoxMove {
  std::size_t item = 0;
  BoundingBox box;
};

/// Reads steps of moving boxes. Step 0 has boxes 0, 1, 2 … in order.
std::vector<std::vector<BoxMove>> readBoxSteps(const std::string& file) {
  std::vector<std::vector<BoxMove>> steps;
  std::size_t boxes = 0;
  readNumberLines(file, "boxes", [&](const Numbers& line) -> std::string {
    std::string wrong = wrongCount(line, 8, "a box has 8 numbers (step box lx ly lz ux uy uz)");
    if (!wrong.empty()) return wrong;
    const double last = steps.empty() ? 0 : static_cast<double>(steps.size()) - 1;
    if (line[0] != last && line[0] != last + (steps.empty() ? 0 : 1))
      return "the step must be " + rounded(last) + " or one more, not " + rounded(line[0]);
    const bool isFirst = line[0] == 0;
    if (isFirst ? line[1] != static_cast<double>(boxes)
                : !(line[1] >= 0 && line[1] < static_cast<double>(boxes) &&
                    line[1] == std::floor(line[1])))
      return isFirst ? "box " + std::to_string(boxes) + " comes next, not " + rounded(line[1])
                     : "step 0 has no box " + rounded(line[1]);
    BoxMove move{static_cast<std::size_t>(line[1]), {}};
    move.box.lower = Vec3(line[2], line[3], line[4]);
    move.box.upper = Vec3(line[5], line[6], line[7]);
    if (!(move.box.lower.array() <= move.box.upper.array()).all())
      return "an upper bound is below the lower bound of the same axis";
    boxes += isFirst;
    if (line[0] == static_cast<double>(steps.size())) steps.emplace_back();
    steps.back().push_back(move);
    return "";
  });
  return steps;
}

/// Keeps the pairs of boxes that overlap by sweep and prune, and times a test of every pair.
int sweepBoxes(const std::string& file) {
  const std::vector<std::vector<BoxMove>> steps = readBoxSteps(file);
  std::vector<BoundingBox> boxes;
  for (const BoxMove& move : steps[0]) boxes.push_back(move.box);
  SweepAndPrune sweep(boxes);
  std::string csv = "step,moved,pairs,swaps,ns,every_pair_ns\n";
  for (std::size_t step = 0; step < steps.size(); ++step) {
    const std::uint64_t before = sweep.swaps();
    const auto start = std::chrono::steady_clock::now();
    if (step > 0)
      for (const BoxMove& move : steps[step]) sweep.move(move.item, move.box);
    const std::chrono::duration<double, std::nano> ns = std::chrono::steady_clock::now() - start;
    for (const BoxMove& move : steps[step]) boxes[move.item] = move.box;
    std::size_t pairs = 0;
    const std::string everyPairNs = nanoseconds([&] {
      pairs = 0;
      for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = a + 1; b < boxes.size(); ++b)
          pairs += (boxes[a].lower.array() <= boxes[b].upper.array()).all() &&
                   (boxes[b].lower.array() <= boxes[a].upper.array()).all();
    });
    if (pairs != sweep.pairCount())
      throw std::logic_error("sweep and prune has other pairs than a test of every pair");
    csv += row({std::to_string(step), std::to_string(steps[step].size()), std::to_string(pairs),
                std::to_string(sweep.swaps() - before), step > 0 ? rounded(ns.count()) : "",
                everyPairNs});
  }
  return print(csv);
}

/// The arguments of a topic: two files, or one.
struct Files {
  std::string first, second;
};

}  // namespace

void addCourse(CLI::App& program, int& status) {
  CLI::App* const course = program.add_subcommand("course", kCourseHelp);
  course->require_subcommand(1);
  course->footer(std::string("Numbers of a line are blank or comma separated; # starts a comment. "
                             "CSV on stdout, times in nanoseconds.\n") +
                 kExitStatus);
  const auto add = [&](const char* name, const char* help, const char* first, const char* firstHelp,
                       const char* second, const char* secondHelp, int (*run)(const Files&)) {
    const auto files = std::make_shared<Files>();  // the callback keeps it
    CLI::App* const topic = course->add_subcommand(name, help);
    topic->add_option(first, files->first, firstHelp)->required();
    if (second) topic->add_option(second, files->second, secondHelp)->required();
    topic->callback([=, &status] { status = run(*files); });
  };
  add("plane",
      "The signed separation of a mesh's hull from planes, by the hierarchy of projections", "MESH",
      "a mesh file; its convex hull is taken", "PLANES",
      "a file of planes n·x = d, one per line: nx ny nz d. Column side: -1 if the hull is inside "
      "(n·x < d), 1 outside, 0 if it meets the plane. lower and upper bound the separation in "
      "metres, which is minus the depth if they meet. witness is the vertex that decides it",
      [](const Files& f) { return separatePlanes(f.first, f.second); });
  add("polygons",
      "Do two convex polygons share a point: by Barba and Langerman, and by linear programs", "P",
      "a file of points x y, one per line; their convex hull is taken", "Q",
      "likewise. half-planes is exact for the half-planes of the edges, whose normals are rounded; "
      "the other methods are exact for the points",
      [](const Files& f) { return intersectPolygons(f.first, f.second); });
  add("program", "A linear program in 2 to 6 variables, by Seidel, with its proof", "FILE",
      "first line: the goal g1 … gd, to be maximised; then a half-space a·x <= b per line: a1 … ad "
      "b. Rows weight: half-spaces (from 0) whose weighted sum proves the answer",
      nullptr, nullptr, [](const Files& f) { return solveProgram(f.first); });
  add("boxes", "The pairs of moving boxes that overlap, by sweep and prune", "FILE",
      "a box per line: step box lx ly lz ux uy uz. Step 0 gives boxes 0, 1, 2 …; each later step "
      "gives the boxes that move",
      nullptr, nullptr, [](const Files& f) { return sweepBoxes(f.first); });
}

}  // namespace corridor::app
