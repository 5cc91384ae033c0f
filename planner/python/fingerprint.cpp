#include "planner/python/fingerprint.h"

#include <cstdint>
#include <random>
#include <type_traits>

#include "planner/problem/sha256.h"

namespace corridor::python {
namespace {

/// Collects the bytes that are hashed.
class Bytes {
 public:
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void add(Number number) { bytes_.append(reinterpret_cast<const char*>(&number), sizeof number); }
  void add(const Vec3& p) {
    for (const double x : p) add(x);
  }
  void add(const Transform& X) {
    for (const double x : X.m.reshaped()) add(x);
    add(X.t);
  }
  void add(std::string_view text) {
    add(text.size());
    bytes_ += text;
  }
  void add(const Configuration& q) {
    add(q.size());
    for (const double number : q) add(number);
  }
  void add(const Task& task) {
    add(task.start);
    add(task.goals.size());
    for (const Configuration& goal : task.goals) add(goal);
    const GoalRegion region = task.goalRegion.value_or(GoalRegion());
    add(region.position), add(region.angle), add(region.joint), add(task.margin);
    add(task.padding.bodies.size());
    for (const auto& [body, padding] : task.padding.bodies) add(body), add(padding);
    for (const auto& [pair, padding] : task.padding.pairs)
      add(pair.first), add(pair.second), add(padding);
    add(task.padding.pairs.size());
    add(task.padding.beyond.self), add(task.padding.beyond.world);
    for (const auto& [pair, margin] : task.padding.beyond.pairs)
      add(pair.first), add(pair.second), add(margin);
    add(task.tube);
  }
  void add(std::span<const PlacedShape> shapes) {
    add(shapes.size());
    for (const PlacedShape& shape : shapes) {
      add(shape.solid);
      forEachPoint(shape, [&](const Vec3& p, double radius) { add(p), add(radius); });
      if (!shape.mesh) continue;
      add(shape.mesh->mesh.triangles.size());
      for (const auto& triangle : shape.mesh->mesh.triangles)
        for (const auto index : triangle) add(index);
    }
  }
  std::string digest() const { return sha256Hex(bytes_); }

 private:
  std::string bytes_;
};

}  // namespace

std::string fingerprintOf(std::span<const PlacedShape> shapes) {
  Bytes bytes;
  bytes.add(shapes);
  return bytes.digest();
}

std::string fingerprintOf(const Problem& problem) {
  const Model& model = problem.model;
  Bytes bytes;
  bytes.add(problem.task);
  for (const ModelBody& body : model.bodies) {
    bytes.add(body.name);
    bytes.add(body.frame);
    bytes.add(std::span(body.shapes));
  }
  const Required need = requiredBy(problem.task);
  forEachPair(model, need, [&](std::size_t a, std::size_t b, std::string_view why) {
    bytes.add(a), bytes.add(b), bytes.add(why.empty());
  });
  bytes.add(model.filter.proofs().size());
  for (const auto& [pair, proof] : model.filter.proofs()) {
    bytes.add(pair.first), bytes.add(pair.second), bytes.add(proof.margin);
    bytes.add(proof.beyondLimits), bytes.add(proof.ranges.size());
    for (const PairProof::Range& range : proof.ranges)
      bytes.add(range.number), bytes.add(range.lower), bytes.add(range.upper);
  }
  for (const std::string& name : model.space.numberNames()) bytes.add(name);
  for (const Coordinate& c : model.space.coordinates()) bytes.add(c.lower), bytes.add(c.upper);
  FramePoses frames(model);
  std::mt19937_64 random(1);
  for (int sample = 0; sample < 3; ++sample) {
    Configuration q(static_cast<Eigen::Index>(model.space.size()));
    for (double& number : q) number = static_cast<double>(random() >> 11) * 0x1p-53;
    for (const Transform& X : frames.at(q)) bytes.add(X);
  }
  return bytes.digest();
}

}  // namespace corridor::python
