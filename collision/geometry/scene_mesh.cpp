#include "collision/geometry/scene_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SVD>

#include "collision/core/rounding.h"
#include "collision/core/shortest.h"
#include "collision/geometry/mesh_health.h"
#include "collision/geometry/vertex_welder.h"

namespace corridor {
namespace {

constexpr int kMostDepth = 500;
constexpr std::uint64_t kMostVisits = 1'000'000, kMostChildren = 2'000'000;
/// Above the loss of a product that is too small for a double, also where the processor flushes
/// such products to 0.
constexpr double kLeastNormal = std::numeric_limits<double>::min();

TriangleMesh welded(const TriangleMesh& mesh) {
  VertexWelder welder(mesh.vertices.size());
  TriangleMesh result;
  result.triangles = mesh.triangles;
  for (auto& triangle : result.triangles)
    for (std::uint32_t& corner : triangle) corner = welder.addOrFind(mesh.vertices[corner]);
  result.vertices = welder.takePoints();
  return result;
}

}  // namespace

void ScenePart::addFace(std::initializer_list<std::uint32_t> indices, int line) {
  corners.insert(corners.end(), indices);
  faces.push_back({static_cast<std::uint32_t>(indices.size()), line});
}

NodePath NodePath::below(const Eigen::Affine3d& step, double turn) const {
  NodePath path;
  path.map_ = map_ * step;
  const double stretch = Eigen::JacobiSVD<Mat3>(step.linear()).singularValues()[0];
  const double length = step.translation().stableNorm();
  path.scale_ = scale_ * stretch;
  path.length_ = length_ + scale_ * length;
  // An error e of each entry is one of less than 2e‖step‖ of each entry of the product, which
  // loses at most the least normal number in each of three products.
  path.lost_ = 2 * lost_ * stretch + scale_ * turn + 4 * kLeastNormal;
  path.lostLength_ = lostLength_ + 2 * lost_ * length + 4 * kLeastNormal;
  path.steps_ = steps_ + 1;
  return path;
}

/// Each entry of a product of maps is a sum of four products, which rounds by at most 4u of the sum
/// of their magnitudes; as a map, by 4u·√12 < 16u of the stretch. The entries of a step are rounded
/// themselves: an angle, its sine and cosine, and a normalised axis have less than 16u. The map of
/// a point adds 16u more.
double NodePath::rounding(double farthest) const {
  if (steps_ == 0) return 0;
  const double largest = map_.linear().cwiseAbs().maxCoeff();
  if (!(scale_ < kMostMagnitude && length_ < kMostMagnitude && largest > kLeastMagnitude))
    return HUGE_VAL;
  return (32.0 * steps_ + 16) * kUnit * (scale_ * farthest + length_) +
         4 * (lost_ * farthest + lostLength_) + 8 * kLeastNormal;
}

bool NodePath::isMirrored() const {
  Mat3 map = map_.linear();
  for (int k = 0; k < 3; ++k) map.col(k) /= map.col(k).cwiseAbs().maxCoeff();  // against underflow
  for (int k = 0; k < 3; ++k)
    if (const double largest = map.row(k).cwiseAbs().maxCoeff(); largest > 0) map.row(k) /= largest;
  return map.determinant() < 0;
}

bool isRoundedToZero(std::string_view text, double number) {
  return number == 0 && text.substr(0, text.find_first_of("eE")).find_first_of("123456789") !=
                            std::string_view::npos;
}

std::string wrongMagnitude(double number) {
  const double size = std::abs(number);
  if (number == 0 || (size >= kLeastMagnitude && size <= kMostMagnitude)) return "";
  return "the number " + shortest(number) + " is not 0 or from 1e-250 to 1e250";
}

void SceneMesh::visit(int depth, std::size_t children) {
  if (depth > kMostDepth)
    faults_.fail(
        0, "nodes nest deeper than " + std::to_string(kMostDepth) + ", or a node contains itself");
  if (++visits_ > kMostVisits)
    faults_.fail(0, "has more than " + std::to_string(kMostVisits) +
                        " instances of nodes; save the mesh as one");
  children_ += children;
  if (children_ > kMostChildren)
    faults_.fail(0, "the instances of nodes have more than " + std::to_string(kMostChildren) +
                        " children; save the mesh as one");
}

void SceneMesh::add(const ScenePart& part, const NodePath& path) {
  placesMesh_ = true;
  TriangleMesh& mesh = read_.mesh;
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3& vertex : part.vertices) mesh.vertices.push_back(path.map() * vertex);
  faults_.requireFew(mesh, 0);
  const std::uint32_t* corner = part.corners.data();
  Vec3 lower = Vec3::Constant(HUGE_VAL), upper = -lower;
  bool isPoint = true;  // in the part's own frame
  double farthest = 0;
  const bool mirrored = path.isMirrored();  // then the other order keeps the outside outside
  for (const ScenePart::Face& face : part.faces) {
    if (face.corners > 3)
      polygons_.push_back(
          {static_cast<std::uint32_t>(mesh.triangles.size()), face.corners - 2, 0, face.line});
    const auto at = [&](std::uint32_t k) {
      return corner[mirrored && k > 0 ? face.corners - k : k];
    };
    for (std::uint32_t k = 0; k < face.corners; ++k) {
      const Vec3& vertex = mesh.vertices[first + at(k)];
      lower = lower.cwiseMin(vertex), upper = upper.cwiseMax(vertex);
      farthest = std::max(farthest, part.vertices[at(k)].stableNorm());
      isPoint &= part.vertices[at(k)] == part.vertices[part.corners.front()];
      if (k >= 2) mesh.triangles.push_back({first + at(0), first + at(k - 1), first + at(k)});
    }
    faults_.requireFew(mesh, face.line);
    corner += face.corners;
  }
  if (part.faces.empty()) return;
  const double error = path.rounding(farthest), extent = (upper - lower).stableNorm();
  if (farthest == 0 && path.length() == 0) return;  // all are the origin
  if (!std::isfinite(farthest)) return;             // `take` reports it
  if (error == 0) return;
  if (error == HUGE_VAL)
    faults_.fail(
        0, "the transforms of its nodes shrink a mesh to nothing, or stretch it beyond 1e250");
  if (isPoint)
    return note("a mesh whose vertices are one point may be " + withDigits(error, 2) +
                " units off, by the rounding of the transforms of its nodes");
  if (extent == 0)
    faults_.fail(part.faces.front().line,
                 "the transforms of its nodes make a mesh a single point; correct them, or remove "
                 "the mesh");
  if (error / extent > share_) error_ = error, share_ = error / extent;
}

ReadMesh SceneMesh::take(std::string format) {
  faults_.throwIfAny();
  read_.format = std::move(format);
  if (!placesMesh_) {
    std::string why = "no node of its scene places a mesh";
    for (const std::string& text : read_.notes) why += "; " + text;
    faults_.fail(0, why);
  }
  if (read_.mesh.triangles.empty()) return std::move(read_);
  if (const auto complaint = checkMesh(read_.mesh)) faults_.fail(0, *complaint);
  const std::string moves = "the transforms of its nodes may round a mesh by " +
                            withDigits(error_, 2) + " units of the file, more than ";
  if (!(share_ <= 1e-2))
    faults_.fail(0, moves + "a hundredth of its size; move it to the origin of its file");
  if (share_ > 1e-4) note(moves + "1e-4 of its size");
  cutPolygons(read_.mesh, polygons_, faults_, read_.notes);
  read_.mesh = welded(read_.mesh);
  return std::move(read_);
}

}  // namespace corridor
