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
  void add(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8)
      bytes_ += static_cast<char>((number >> shift) & 0xff);
  }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const Vec3& p) {
    for (const double x : p) add(x);
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
  std::string bytes_;
};

RobotDigest digestOfShape(const PlacedShape& shape) {
  DigestBytes bytes;
  const auto count = [&](std::size_t number) { bytes.add(std::uint64_t{number}); };
  count(shape.solid);
  count(shape.mesh ? shape.mesh->mesh.vertices.size() : 0);
  if (shape.mesh)
    for (const Vec3& p : shape.mesh->mesh.vertices) bytes.add(p);
  count(shape.mesh ? shape.mesh->mesh.triangles.size() : 0);
  if (shape.mesh)
    for (const auto& triangle : shape.mesh->mesh.triangles)
      for (const auto index : triangle) count(index);
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

RobotDigest digestOfRobot(const RobotModel& robot) {
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
