#include <algorithm>
#include <filesystem>
#include <iostream>

#include <nlohmann/json.hpp>

#include "collision/geometry/mesh_health.h"
#include "planner/app/commands.h"
#include "planner/app/output.h"
#include "planner/checker/problem_scene.h"
#include "planner/checker/rigid_checker.h"
#include "planner/problem/problem.h"
#include "planner/solve/endpoint_help.h"

namespace corridor::app {
namespace {

using nlohmann::ordered_json;

ordered_json numbers(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

ordered_json jsonOf(const MeshFile& file) {
  const MeshHealth health = inspectMesh(file.mesh);
  ordered_json j = {{"format", file.format},
                    {"unit", file.unitRule},
                    {"up", file.upRule},
                    {"float_vertices", file.floatVertices},
                    {"vertices", file.mesh.vertices.size()},
                    {"triangles", health.triangles},
                    {"min", numbers(health.min)},
                    {"max", numbers(health.max)},
                    {"components", health.components},
                    {"watertight", health.watertight},
                    {"distinct_triangles", health.distinctTriangles},
                    {"degenerate_triangles", health.degenerateTriangles},
                    {"sliver_triangles", health.sliverTriangles},
                    {"boundary_edges", health.boundaryEdges},
                    {"non_manifold_edges", health.nonManifoldEdges}};
  if (health.volume) j["volume_m3"] = *health.volume;
  return j;
}

int inspectMeshFile(const InspectArguments& a) {
  MeshFileOptions options;
  if (a.unit)
    options.metresPerUnit = *a.unit == "m"    ? 1
                            : *a.unit == "cm" ? 0.01
                            : *a.unit == "mm" ? 0.001
                                              : 0.0254;
  if (a.up) options.up = a.up->front();
  const MeshFile file = readMeshFile(a.file, options);
  if (a.json) {
    ordered_json j = {{"format", "corridor-inspect-mesh-1"}, {"file", a.file}};
    j["mesh"] = jsonOf(file);
    std::cout << j.dump(2) << '\n';
    return kDone;
  }
  const MeshHealth health = inspectMesh(file.mesh);
  const Lines out(false);
  out.line("mesh", a.file);
  out.line("format", file.format);
  out.line("unit", file.unitRule);
  out.line("up-axis", file.upRule);
  if (file.floatVertices) out.line("precision", "float: read by assimp");
  out.line("vertices", grouped(file.mesh.vertices.size()));
  out.line("triangles", grouped(health.triangles));
  out.line("bounds", rounded(health.min) + " to " + rounded(health.max) + " m");
  out.line("components", grouped(health.components));
  out.line("watertight", health.watertight ? "yes" : "no");
  if (health.volume) out.line("volume", rounded(*health.volume) + " m³");
  out.line("repeated triangles", grouped(health.triangles - health.distinctTriangles));
  out.line("degenerate triangles", grouped(health.degenerateTriangles));
  out.line("slivers", grouped(health.sliverTriangles));
  out.line("boundary edges", grouped(health.boundaryEdges));
  out.line("non-manifold edges", grouped(health.nonManifoldEdges));
  return kDone;
}

/// Why no pose in the bounds brings the robot near a fixed body, or "". (What each query skips on
/// its own comes on top.)
std::string whyOutOfReach(const Problem& problem, const Scene& scene, const Body& body) {
  const double pad = problem.margin + motionOptions(problem, scene).tube.position;
  if (problem.space == RigidSpace::SE2) {
    double low = scene.moving()[0].lower().z(), high = scene.moving()[0].upper().z();
    for (const Body& moving : scene.moving()) {
      low = std::min(low, moving.lower().z());
      high = std::max(high, moving.upper().z());
    }
    if (body.lower().z() > high + pad || body.upper().z() < low - pad)
      return "above or below everything that moves";
  }
  Vec3 away =
      (body.lower() - problem.upper).cwiseMax(problem.lower - body.upper()).cwiseMax(Vec3::Zero());
  if (problem.space == RigidSpace::SE2) away.z() = 0;
  return away.norm() > scene.movingRadius() * (1 + 1e-9) + pad
             ? "farther from the bounds than the robot reaches"
             : "";
}

int inspectProblem(const InspectArguments& a) {
  const Problem problem = readProblem(a.file);
  const Scene scene = makeScene(problem);
  const RigidChecker checker(scene, problem.space, problem.lower, problem.upper,
                             motionOptions(problem, scene));
  const std::size_t pairs = problem.robot.size() * problem.world.size();
  std::size_t far = 0;
  ordered_json j = {{"format", "corridor-inspect-problem-1"},
                    {"file", a.file},
                    {"name", problem.name},
                    {"digest", problem.digest},
                    {"space", problem.space == RigidSpace::SE3 ? "SE3" : "SE2"},
                    {"lower", numbers(problem.lower)},
                    {"upper", numbers(problem.upper)},
                    {"tolerance_m", checker.options().tolerance},
                    {"margin_m", problem.margin},
                    {"tube",
                     {{"position_m", checker.options().tube.position},
                      {"rotation_rad", checker.options().tube.rotation}}},
                    {"notes", problem.notes},
                    {"robot", ordered_json::array()},
                    {"world", ordered_json::array()}};
  const int dimension = problem.space == RigidSpace::SE3 ? 3 : 2;
  const Lines out(a.json);
  out.line("problem", a.file);
  out.line("name", problem.name);
  out.line("space", problem.space == RigidSpace::SE3 ? "SE3" : "SE2");
  out.line("bounds",
           rounded(problem.lower, dimension) + " to " + rounded(problem.upper, dimension) + " m");
  out.line("tolerance", rounded(checker.options().tolerance) + " m");
  out.line("margin", rounded(problem.margin) + " m");
  out.line("tube", rounded(checker.options().tube.position) + " m, " +
                       rounded(checker.options().tube.rotation) + " rad");
  const auto tell = [&](const char* key, const ProblemMesh& mesh, const Body& body,
                        const std::string& skipped) {
    ordered_json m = jsonOf(mesh.source);
    m["name"] = mesh.name;
    m["file"] = mesh.file.string();
    m["skipped"] = skipped;
    j[key].push_back(m);
    out.line(key, "\"" + mesh.name +
                      "\": " + counted(mesh.source.mesh.triangles.size(), "triangle") + ", " +
                      rounded(body.lower()) + " to " + rounded(body.upper()) + " m, " +
                      mesh.file.string() + (skipped.empty() ? "" : "; skipped: " + skipped));
  };
  for (std::size_t i = 0; i < problem.robot.size(); ++i)
    tell("robot", problem.robot[i], scene.moving()[i], "");
  for (std::size_t i = 0; i < problem.world.size(); ++i) {
    const std::string why = whyOutOfReach(problem, scene, scene.fixed()[i]);
    if (!why.empty()) far += problem.robot.size();
    tell("world", problem.world[i], scene.fixed()[i], why);
  }
  j["pairs"] = {{"tested", pairs - far}, {"out_of_reach", far}};
  out.line("pairs tested",
           grouped(pairs - far) + (pairs == far ? ": nothing can be in the robot's way" : ""),
           pairs == far ? Tone::bad : Tone::plain);
  out.line(
      "pairs skipped",
      counted(far, "pair") +
          " out of reach; robot with itself (one rigid body); world with itself (it stands still)");
  for (const std::string& note : problem.notes) out.line("note", note);
  bool ends = true;
  for (const auto& [name, state] :
       {std::pair{"start", startState(problem)}, std::pair{"goal", goalState(problem)}}) {
    const auto why = whyNotFree(name, state, checker);
    if (why) ends = false;
    j[name] = why.value_or("free");
    out.line(name, why ? *why : "free", why ? Tone::bad : Tone::plain);
  }
  std::size_t built = 0;
  for (const auto* bodies : {&scene.moving(), &scene.fixed()})
    for (const Body& body : *bodies) built += body.treeBuilt();
  j["trees_built"] = built;
  out.line("trees built", std::to_string(built) + " of " +
                              std::to_string(problem.robot.size() + problem.world.size()) +
                              ", for start and goal; the others at first need");
  if (a.json) std::cout << j.dump(2) << '\n';
  return ends ? kDone : kNo;
}

}  // namespace

int inspectCommand(const InspectArguments& a) {
  const std::string extension = std::filesystem::path(a.file).extension().string();
  const bool problem = std::filesystem::is_directory(a.file) || extension == ".yaml" ||
                       extension == ".yml" || extension == ".cfg";
  return problem ? inspectProblem(a) : inspectMeshFile(a);
}

}  // namespace corridor::app
