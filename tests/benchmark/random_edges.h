#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "planner/problem/problem.h"

namespace corridor::bench {

/// Draws random states and edges of a problem.
class RandomEdges {
 public:
  struct Edge {
    Configuration from, to;
  };

  RandomEdges(const Problem& problem, std::uint64_t seed) : problem_(problem), random_(seed) {}

  bool rigid() const {
    return problem_.model.space.groups().size() == 1 &&
           problem_.model.space.groups()[0].kind != CoordinateGroup::Kind::joints;
  }
  /// Returns an edge that starts at a random state. The edge may leave the bounds.
  /// @param length for a rigid body, the length of its translation divided by the scene's size (the
  /// diagonal of the bounds of its position); the body also rotates, by at most length·π rad. For
  /// joints, the Euclidean norm of the change of all joint values, in rad and m.
  Edge next(double length) {
    Edge e{uniform(), {}};
    e.to = e.from;
    double size = 0, squares = 0;
    Configuration step = Configuration::Zero(e.from.size());
    for (const Coordinate& c : problem_.model.space.coordinates()) {
      const auto i = static_cast<Eigen::Index>(c.first);
      if (c.kind == Coordinate::Kind::rotation) {
        Eigen::Map<Eigen::Quaterniond> q(e.to.data() + c.first);
        q = Eigen::Quaterniond(Eigen::AngleAxisd(length * 3.14159 * real(),
                                                 Vec3(real(), real(), real()).normalized())) *
            q;
      } else if (rigid() && c.kind == Coordinate::Kind::circle) {
        e.to[i] += length * 3.14159 * real();
      } else {
        step[i] = normal_(random_);
        squares += step[i] * step[i];
        size += (c.upper - c.lower) * (c.upper - c.lower);
      }
    }
    e.to += step / std::sqrt(squares) * length * (rigid() ? std::sqrt(size) : 1);
    return e;
  }

 private:
  double real(double low = -1, double high = 1) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  Configuration uniform() {
    Configuration q(static_cast<Eigen::Index>(problem_.model.space.size()));
    for (const Coordinate& c : problem_.model.space.coordinates()) {
      const auto i = static_cast<Eigen::Index>(c.first);
      if (c.kind == Coordinate::Kind::line)
        q[i] = real(c.lower, c.upper);
      else if (c.kind == Coordinate::Kind::circle)
        q[i] = real(-3.14159, 3.14159);
      else
        for (int k = 0; k < 4; ++k) q[i + k] = normal_(random_);
    }
    return q;
  }

  const Problem& problem_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace corridor::bench
