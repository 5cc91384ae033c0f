#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#ifdef CORRIDOR_WITH_FCL
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/math/bv/OBB.h>
#include <fcl/math/bv/OBBRSS.h>
#include <fcl/math/bv/RSS.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>
#endif

#include "collision/course/query_timing.h"
#include "collision/queries/distance_obb4.h"
#include "collision/queries/interference_obb4.h"
#include "tests/support/workload.h"

/// The competitors in query_benchmark: our trees, and FCL. FCL is called in its fastest way:
/// BVHModels are built once, transforms are prepared, and only the first contact is requested,
/// without contact points or nearest points.
namespace corridor::bench {

enum class Query { interference, distance, tolerance };

struct Answer {
  bool hit = false;
  double distance = 0;
  std::uint64_t boxTests = 0, primitiveTests = 0;
};

/// The results of one competitor on one workload.
struct Record {
  std::string name;
  double buildMs = 0, bytesPerTriangle = 0;
  std::vector<double> ns;       ///< per pose: the shortest time over all passes
  std::vector<Answer> answers;  ///< per pose
};

/// A library that is measured on a pair of meshes. It holds its trees of these meshes.
class Competitor {
 public:
  virtual ~Competitor() = default;
  /// Runs the query once at each pose.
  virtual void pass() = 0;
  Record record;
};

/// Measures the times of a `Library`: a class with the functions prepare(poses), answer(i), which
/// returns the `Answer` at pose i, forget() and bytes().
template <class Library>
class Timed : public Competitor {
 public:
  template <class Build>
  Timed(const std::string& name, const test::Workload& w, int rounds, const Build& build)
      : poses_(w.poses.size()) {
    record.name = name;
    std::vector<double> ms;
    for (int i = 0; i < rounds; ++i) {
      library_.reset();
      const auto start = std::chrono::steady_clock::now();
      library_ = build();
      ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
    }
    record.buildMs = *std::min_element(ms.begin(), ms.end());
    record.bytesPerTriangle = static_cast<double>(library_->bytes()) /
                              static_cast<double>(w.a.triangles.size() + w.b.triangles.size());
    library_->prepare(w.poses);
    record.ns.assign(poses_, HUGE_VAL);
    record.answers.resize(poses_);
  }
  void pass() override {
    for (std::size_t i = 0; i < poses_; ++i) {
      Answer answer;
      const double ns = nanosecondsOf([&] { answer = library_->answer(i); },
                                      [&] {
                                        library_->forget();
                                        library_->answer(i);
                                      });
      record.ns[i] = std::min(record.ns[i], ns);
      record.answers[i] = answer;
    }
  }

 private:
  std::size_t poses_;
  std::unique_ptr<Library> library_;
};

/// One of our trees: any type with an overload of `interference`, and of `distance` and
/// `closerThan` if these are measured.
template <class Tree>
class Ours {
 public:
  template <class... Params>
  Ours(Query query, double tolerance, const test::Workload& w, const Params&... params)
      : query_(query), tolerance_(tolerance), a_(w.a, params...), b_(w.b, params...) {}
  std::size_t bytes() const { return a_.bytes() + b_.bytes(); }
  void prepare(const std::vector<Transform>& poses) { poses_ = poses; }
  /// Clears the pair from which the next query would start. Otherwise a repeated query would be
  /// cheap, because it would start at the answer of the previous one.
  void forget() { last_ = {}; }
  Answer answer(std::size_t i) {
    Answer answer;
    context_.counters = {};
    const Transform& X = poses_[i];
    switch (query_) {
      case Query::interference:
        answer.hit = touching(X).has_value();
        break;
      case Query::distance:
        if constexpr (requires { distance(Posed(a_), Posed(b_, X), {}, context_).distance; }) {
          if constexpr (requires { distance(Posed(a_), Posed(b_, X), {}, context_, &last_); })
            answer.distance = distance(Posed(a_), Posed(b_, X), {}, context_, &last_).distance;
          else
            answer.distance = distance(Posed(a_), Posed(b_, X), {}, context_).distance;
          answer.hit = answer.distance == 0;
          break;
        }
        throw std::runtime_error("this tree has no distance query");
      case Query::tolerance:
        if constexpr (requires { closerThan(Posed(a_), Posed(b_, X), tolerance_, context_); }) {
          if constexpr (requires { closerThan(Posed(a_), Posed(b_, X), 1.0, context_, &last_); })
            answer.hit = closerThan(Posed(a_), Posed(b_, X), tolerance_, context_, &last_);
          else
            answer.hit = closerThan(Posed(a_), Posed(b_, X), tolerance_, context_);
          break;
        }
        throw std::runtime_error("this tree has no tolerance query");
    }
    answer.boxTests = context_.counters.boxTests;
    answer.primitiveTests = context_.counters.primitiveTests;
    return answer;
  }

 private:
  auto touching(const Transform& X) {
    if constexpr (requires { interference(Posed(a_), Posed(b_, X), context_, &last_); })
      return interference(Posed(a_), Posed(b_, X), context_, &last_);
    else
      return interference(Posed(a_), Posed(b_, X), context_);
  }

  Query query_;
  double tolerance_;
  Tree a_, b_;
  std::vector<Transform> poses_;
  QueryContext context_;
  LastPair last_;
};

#ifdef CORRIDOR_WITH_FCL
template <class Volume>
class Fcl {
 public:
  Fcl(Query query, double tolerance, const test::Workload& w)
      : query_(query), tolerance_(tolerance), a_(built(w.a)), b_(built(w.b)) {}
  std::size_t bytes() const { return bytesOf(*a_) + bytesOf(*b_); }
  void prepare(const std::vector<Transform>& poses) {
    for (const Transform& X : poses) {
      poses_.emplace_back(fcl::Transform3d::Identity());
      poses_.back().linear() = X.m;
      poses_.back().translation() = X.t;
    }
  }
  void forget() {}
  Answer answer(std::size_t i) {
    Answer answer;
    if (query_ == Query::interference) {
      const fcl::CollisionRequestd request(1, false);
      fcl::CollisionResultd result;
      answer.hit = fcl::collide(a_.get(), still_, b_.get(), poses_[i], request, result) > 0;
    } else {  // FCL has no tolerance query for meshes; here its distance query stops at the
              // tolerance
      const fcl::DistanceRequestd request(false);
      fcl::DistanceResultd result;
      if (query_ == Query::tolerance) result.min_distance = std::nextafter(tolerance_, HUGE_VAL);
      fcl::distance(a_.get(), still_, b_.get(), poses_[i], request, result);
      answer.distance = std::max(result.min_distance, 0.0);
      answer.hit =
          query_ == Query::tolerance ? result.min_distance <= tolerance_ : result.min_distance <= 0;
    }
    return answer;
  }

 private:
  using Model = fcl::BVHModel<Volume>;
  /// Returns the bytes in use, computed here because FCL's memUsage prints the size and does not
  /// return it.
  static std::size_t bytesOf(const Model& model) {
    return sizeof(fcl::BVNode<Volume>) * static_cast<std::size_t>(model.getNumBVs()) +
           sizeof(fcl::Vector3d) * static_cast<std::size_t>(model.num_vertices) +
           (sizeof(fcl::Triangle) + sizeof(unsigned)) * static_cast<std::size_t>(model.num_tris);
  }
  static std::unique_ptr<Model> built(const TriangleMesh& mesh) {
    std::vector<fcl::Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    auto model = std::make_unique<Model>();
    model->beginModel(static_cast<int>(mesh.triangles.size()),
                      static_cast<int>(mesh.vertices.size()));
    model->addSubModel(mesh.vertices, triangles);
    model->endModel();
    return model;
  }

  Query query_;
  double tolerance_;
  std::unique_ptr<Model> a_, b_;
  const fcl::Transform3d still_ = fcl::Transform3d::Identity();
  std::vector<fcl::Transform3d> poses_;
};
#endif

}  // namespace corridor::bench
