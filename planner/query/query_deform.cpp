#include "planner/query/query_deform.h"

#include <optional>
#include <utility>

#include "collision/core/error.h"
#include "collision/geometry/mesh_file.h"
#include "planner/app/output.h"
#include "planner/app/read_mesh.h"
#include "planner/query/query_output.h"
#include "planner/query/query_trees.h"

namespace corridor::app {

void requireFrames(const NamedQuery& query, const TreeNames& trees) {
  if (query.kind == QueryKind::contacts)
    throw InputError(Fault{"--query", 0,
                           "contacts can't be used with --deform; use interference, distance or "
                           "tolerance"});
  if (trees.volume == kOctree)
    throw InputError(Fault{"--volume", 0,
                           "an octree can't be refitted, as --deform needs; choose another volume, "
                           "such as aabb"});
}

AllFrames queryFrames(const NamedQuery& query, const Batch& batch, const std::string& nameA,
                      const std::vector<std::string>& files) {
  const std::size_t triangles = batch.a.triangles.size();
  auto file = files.begin();
  const auto next = [&]() -> std::optional<TriangleMesh> {
    if (file == files.end()) return std::nullopt;
    const std::string& name = *file++;
    MeshFile shape = readMeshAndPrintNotes(name);
    if (shape.mesh.triangles.size() != triangles)
      throw InputError(Fault{name, 0,
                             "has " + counted(shape.mesh.triangles.size(), "triangle") + ", but " +
                                 nameA + " has " + grouped(triangles) +
                                 "; --deform needs the same triangles, with moved vertices"});
    return std::move(shape.mesh);
  };
  std::vector<FrameResult> frames = runFrames(batch, next);
  printFrames(query, frames);
  AllFrames all;
  for (const FrameResult& frame : frames)
    all.refitMs += frame.refitMs / static_cast<double>(files.size());
  all.result = std::move(frames.front().result);
  for (std::size_t f = 1; f < frames.size(); ++f) {
    const std::vector<Answer>& answers = frames[f].result.answers;
    all.result.answers.insert(all.result.answers.end(), answers.begin(), answers.end());
  }
  return all;
}

}  // namespace corridor::app
