#include "planner/problem/proof_digest.h"

#include <algorithm>
#include <bit>
#include <string_view>

#include "planner/problem/sha256.h"

namespace corridor {
namespace {

/// Collects the bytes of a digest, as proof_digest.h describes them.
class DigestBytes {
 public:
  void add(std::uint64_t number) { addRaw(&number, sizeof number); }
  void add(double number) { addRaw(&number, sizeof number); }
  void add(const Vec3& p) { addRaw(p.data(), 3 * sizeof(double)); }
  void add(const TriangleMesh& mesh) {
    static_assert(sizeof(Vec3) == 24 && sizeof mesh.triangles[0] == 12);
    add(std::uint64_t{mesh.vertices.size()});
    addRaw(mesh.vertices.data(), 24 * mesh.vertices.size());
    add(std::uint64_t{mesh.triangles.size()});
    addRaw(mesh.triangles.data(), 12 * mesh.triangles.size());
  }
  void add(std::string_view text) {
    add(std::uint64_t{text.size()});
    bytes_ += text;
  }
  void addDigest(const RobotDigest& digest) {
    for (const std::uint8_t byte : digest) bytes_ += static_cast<char>(byte);
  }
  const std::string& str() const { return bytes_; }

 private:
  static_assert(std::endian::native == std::endian::little);
  void addRaw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }

  std::string bytes_;
};

RobotDigest digestOfShape(const PlacedShape& shape) {
  DigestBytes bytes;
  const auto count = [&](std::size_t number) { bytes.add(std::uint64_t{number}); };
  count(shape.solid);
  bytes.add(shape.mesh ? shape.mesh->mesh : TriangleMesh());
  count(shape.parts.size());
  for (const ConvexPart& part : shape.parts) {
    count(part.points.size());
    for (const Vec3& p : part.points) bytes.add(p);
    bytes.add(part.radius);
    count(part.flatEnds);
  }
  return sha256(bytes.str());
}

}  // namespace

RobotDigest digestOfRobot(const RobotDescription& robot) {
  DigestBytes bytes;
  const auto count = [&](std::size_t number) { bytes.add(std::uint64_t{number}); };
  count(robot.links.size());
  for (const LinkModel& link : robot.links) {
    bytes.add(link.name);
    count(link.shapes.size());
    for (const PlacedShape& shape : link.shapes) bytes.addDigest(digestOfShape(shape));
  }
  count(robot.joints.size());
  for (const JointModel& joint : robot.joints) {
    bytes.add(joint.name);
    count(static_cast<std::size_t>(joint.type));
    count(joint.parent);
    count(joint.child);
    bytes.add(joint.X_PJ.p);
    for (const double x : joint.X_PJ.q.coeffs()) bytes.add(x);
    bytes.add(joint.axis);
    bytes.add(joint.lower);
    bytes.add(joint.upper);
    count(joint.mimic.has_value());
    if (!joint.mimic) continue;
    count(joint.mimic->joint);
    bytes.add(joint.mimic->multiplier);
    bytes.add(joint.mimic->offset);
  }
  return sha256(bytes.str());
}

std::string proofDigest(const RobotDigest& robot, const AllowedPair::Proof& proof,
                        std::vector<std::array<std::string, 2>> pairs) {
  for (auto& [a, b] : pairs)
    if (b < a) a.swap(b);
  std::sort(pairs.begin(), pairs.end());
  DigestBytes bytes;
  bytes.add(std::string_view("corridor-never-in-contact-1"));
  bytes.addDigest(robot);
  bytes.add(proof.margin);
  bytes.add(proof.beyondLimits);
  bytes.add(std::uint64_t{pairs.size()});
  for (const auto& [a, b] : pairs) {
    bytes.add(std::string_view(a));
    bytes.add(std::string_view(b));
  }
  return sha256Hex(bytes.str());
}

}  // namespace corridor
