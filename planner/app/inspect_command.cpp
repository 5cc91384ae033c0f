#include <algorithm>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "collision/core/fault_list.h"
#include "collision/core/read_file.h"
#include "collision/core/spelling.h"
#include "collision/geometry/mesh_health.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/obb_tree.h"
#include "collision/queries/self_intersections.h"
#include "planner/app/commands.h"
#include "planner/app/inspect.h"
#include "planner/app/options.h"
#include "planner/app/other_program.h"
#include "planner/app/output.h"
#include "planner/app/read_mesh.h"
#include "planner/app/robot_argument.h"
#include "planner/problem/yaml_reader.h"
#include "planner/problem/yaml_value.h"
#include "planner/robot/urdf_file.h"

namespace corridor::app {

using nlohmann::ordered_json;

ordered_json meshJson(const MeshFile& file) {
  const MeshHealth health = inspectMesh(file.mesh);
  ordered_json j = {{"format", file.format},
                    {"unit_rule", file.unitRule},
                    {"up_rule", file.upRule},
                    {"vertices", file.mesh.vertices.size()},
                    {"triangles", health.triangles},
                    {"min", numbersJson(health.min)},
                    {"max", numbersJson(health.max)},
                    {"components", health.components},
                    {"watertight", health.watertight},
                    {"distinct_triangles", health.distinctTriangles},
                    {"degenerate_triangles", health.degenerateTriangles},
                    {"sliver_triangles", health.sliverTriangles},
                    {"boundary_edges", health.boundaryEdges},
                    {"non_manifold_edges", health.nonManifoldEdges},
                    {"turned_edges", health.misorientedEdges}};
  if (!health.watertight) j["why_not_watertight"] = health.whyNotWatertight;
  if (health.volume) j["volume_m3"] = *health.volume;
  if (!file.notes.empty()) j["notes"] = file.notes;
  return j;
}

namespace {

/// Figures of a mesh's 4-wide OBB tree, which queries use by default, and the depth of its binary
/// OBB tree.
struct TreeFigures {
  std::size_t nodes = 0, bytes = 0, depth = 0;
  double buildMs = 0;
};
std::optional<TreeFigures> treeOf(const TriangleMesh& mesh) {
  if (mesh.triangles.empty()) return std::nullopt;
  const auto start = std::chrono::steady_clock::now();
  const Obb4Tree tree(mesh);
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
  return TreeFigures{tree.nodes().size(), tree.bytes(), ObbTree(mesh).depth(), took.count()};
}

std::vector<PrimitivePair> selfIntersectionsOf(const MeshFile& file) {
  QueryContext context;
  return selfIntersections(file.mesh, context);
}

int inspectMeshFile(const InspectArguments& a) {
  const MeshFile file = readMeshAs(a.file, a.unit, a.up);
  if (a.json) {
    ordered_json j = {{"format", "corridor-inspect-mesh-2"}, {"file", a.file}};
    j["unit"] = a.unit ? ordered_json(*a.unit) : ordered_json();
    j["up"] = a.up ? ordered_json(*a.up) : ordered_json();
    j["mesh"] = meshJson(file);
    if (const auto tree = treeOf(file.mesh))
      j["tree"] = {{"nodes", tree->nodes},
                   {"bytes", tree->bytes},
                   {"build_ms", tree->buildMs},
                   {"binary_depth", tree->depth}};
    if (a.selfIntersections) {
      ordered_json& all = j["mesh"]["self_intersections"] = ordered_json::array();
      for (const PrimitivePair& pair : selfIntersectionsOf(file)) all.push_back({pair.a, pair.b});
    }
    std::cout << jsonText(j) << '\n';
    return kDone;
  }
  const MeshHealth health = inspectMesh(file.mesh);
  const ResultPrinter out(false);
  out.line("mesh", a.file);
  out.line("format", file.format);
  out.line("unit", file.unitRule);
  out.line("up-axis", file.upRule);
  for (const std::string& note : file.notes) out.line("note", note);
  out.line("vertices", grouped(file.mesh.vertices.size()));
  out.line("triangles", grouped(health.triangles));
  out.line("bounds", rounded(health.min) + " to " + rounded(health.max) + " m");
  out.line("components", grouped(health.components));
  out.line("watertight", !health.watertight              ? "no: " + health.whyNotWatertight
                         : health.volume.value_or(0) < 0 ? "yes, its triangles face inwards"
                                                         : "yes");
  if (health.volume) out.line("volume", rounded(*health.volume) + " m³");
  out.line("repeated triangles", grouped(health.triangles - health.distinctTriangles));
  out.line("degenerate triangles", grouped(health.degenerateTriangles));
  out.line("slivers", grouped(health.sliverTriangles));
  out.line("boundary edges", grouped(health.boundaryEdges));
  out.line("non-manifold edges", grouped(health.nonManifoldEdges));
  out.line("turned edges", grouped(health.misorientedEdges));
  if (const auto tree = treeOf(file.mesh))
    out.line("tree",
             counted(tree->nodes, "node") + " of four boxes, " +
                 rounded(static_cast<double>(tree->bytes) / static_cast<double>(health.triangles)) +
                 " bytes per triangle, built in " + rounded(tree->buildMs) +
                 " ms; a binary tree has depth " + grouped(tree->depth));
  if (a.selfIntersections) {
    const std::vector<PrimitivePair> pairs = selfIntersectionsOf(file);
    std::string text = grouped(pairs.size());
    if (!pairs.empty())
      text += ", the first between triangles " + std::to_string(pairs[0].a) + " and " +
              std::to_string(pairs[0].b) + " (counted from 0)";
    out.line("self-intersections", text);
  }
  return kDone;
}

/// @param inFolder true if `a.file` is the robot that `robotInFolder` found.
int inspectFile(const InspectArguments& a, bool inFolder) {
  const InputKind is = inFolder ? InputKind::robot : inputKindOf(a.file);
  const bool robot = is == InputKind::robot, problem = is == InputKind::problem;
  if (a.poses && !a.against)
    throw InputError(Fault{"--poses", 0, "needs --against, which is not given"});
  if (a.against) {
    if (robot || problem)
      throw InputError(
          Fault{"--against", 0,
                "needs two meshes, and " + a.file + " is a " + (robot ? "robot" : "problem")});
  }
  const std::string kind = robot ? "robot" : problem ? "problem" : "mesh";
  const auto requireKind = [&](const char* option, bool given, const std::string& what) {
    if (given && kind != what)
      throw InputError(Fault{option, 0, "needs a " + what + ", and " + a.file + " is a " + kind});
  };
  requireKind("--pairs", a.pairs, "problem");
  requireKind("--unit", a.unit.has_value(), "mesh");
  requireKind("--up", a.up.has_value(), "mesh");
  requireKind("--self-intersections", a.selfIntersections, "mesh");
  if (a.against && a.selfIntersections)
    throw InputError(Fault{"--self-intersections", 0, "can't be used with --against"});
  if (a.against) {
    std::vector<std::string> arguments{"inspect", "--against=" + *a.against};
    for (const auto& [name, value] :
         {std::pair{"--poses", a.poses}, std::pair{"--unit", a.unit}, std::pair{"--up", a.up}})
      if (value) arguments.push_back(std::string(name) + "=" + *value);
    if (a.json) arguments.emplace_back("--json");
    arguments.insert(arguments.end(), {"--", a.file});
    return becomeProgram("corridor_query", arguments);
  }
  return robot ? inspectRobot(a) : problem ? inspectProblem(a) : inspectMeshFile(a);
}

int inspectCommand(const InspectArguments& a) {
  InspectArguments resolved = a;
  const std::string robot = robotInFolder(a.file);
  if (!robot.empty()) resolved.file = robot;
  return inspectFile(resolved, !robot.empty());
}

}  // namespace

void addInspect(CLI::App& program, int& status) {
  const auto arguments = std::make_shared<InspectArguments>();  // the callback keeps it
  InspectArguments& a = *arguments;
  CLI::App* command = program.add_subcommand(
      "inspect", "Describe a mesh, a robot or a problem, with the pairs that are never tested");
  command
      ->add_option("FILE", a.file,
                   "a mesh file, a URDF or robot.yaml, a problem, or a folder that contains a "
                   "problem or a robot")
      ->required();
  command->add_option("--unit", a.unit, "for a mesh file: the unit of its coordinates")
      ->check(isOneOf({"m", "cm", "mm", "in"}));
  command->add_option("--up", a.up, "for a mesh file: its up-axis, which is rotated to z")
      ->check(isOneOf({"x", "y", "z"}));
  command->add_flag(
      "--self-intersections", a.selfIntersections,
      "for a mesh file: count the pairs of its triangles that intersect elsewhere than in the "
      "corners and edges that they share (takes seconds for a million triangles; each pair "
      "of coincident triangles counts)");
  command->add_flag("--pairs", a.pairs,
                    "for a problem: list every pair of bodies: tested, or the reason why not");
  const char* cost = "Cost of queries of two meshes";
  command
      ->add_option(
          "--against", a.against,
          "a second mesh file. Reports for every bounding volume: the mean numbers of volume and "
          "triangle tests of an interference query (N_v, N_p), the costs of one test (C_v, C_p), "
          "and how well T = N_v C_v + N_p C_p predicts the time")
      ->group(cost);
  command
      ->add_option("--poses", a.poses,
                   "with --against: poses of the second mesh, as for corridor query (default: "
                   "864 poses, like --grid 6x6x6 --rotations 4)")
      ->group(cost);
  addJson(*command, a.json);
  command->footer(
      std::string("Example: corridor inspect robots/piano/piano.obj\n"
                  "         corridor inspect a.obj --against b.obj --poses poses.txt\n") +
      kExitStatus);
  command->callback([arguments, &status] { status = inspectCommand(*arguments); });
}

}  // namespace corridor::app
