#include "collision/course/linear_program.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "collision/core/rounding.h"
#include "collision/course/exact_program-inl.h"

/// Up to three linear programs answer whether a linear program is infeasible, unbounded or neither.
/// The first two are over cones. Each of these two programs allows the origin, and has the bounds
/// |y_i| ≤ 1 and s ≤ 1. So each has an optimum.
/// * Is there a point of all half-spaces? Maximise s subject to normal·y − offset·s ≤ 0 for all
///   half-spaces. If s > 0, y/s is a point of all half-spaces. If s = 0, duality gives weights of
///   half-spaces that sum up to (0, …, 0, 1), which is Farkas' lemma.
/// * Is the goal unbounded? Maximise goal·y subject to normal·y ≤ 0. If the maximum is above 0, y
///   is a ray. If the maximum is 0, duality gives weights of normals that sum up to the goal.
/// * If there is a point and no ray, there is an optimum. It is found within bounds, which are
///   enlarged until no bound has a weight in the proof. The weights then prove that the point is
///   optimal without bounds, too.
namespace corridor {
namespace {

using seidel::Point;
using seidel::Rational;
using seidel::Row;

template <int D>
class Program {
 public:
  static constexpr std::size_t kD = D, kM = D + 1;

  Program(std::span<const HalfSpace<D>> list, const Eigen::Vector<double, D>& goal,
          std::uint64_t seed)
      : list_(list), goal_(goal), seed_(seed) {
    bool finite = goal.allFinite();
    for (const HalfSpace<D>& each : list)
      finite = finite && each.normal.allFinite() && std::isfinite(each.offset);
    if (!finite)
      throw std::invalid_argument("linear program: a normal, an offset or the goal is not finite");
  }

  LinearProgramAnswer<D> solve() {
    // The goal is tested by its bits, because under denormals-are-zero a comparison takes a
    // subnormal goal for 0.
    const bool hasGoal = std::any_of(goal_.data(), goal_.data() + D,
                                     [](double x) { return exact::dyadic(x).mantissa != 0; });
    if (!findPoint() || !hasGoal) return std::move(answer_);
    answer_.exact = true;
    if (!findRay()) findOptimum();
    return std::move(answer_);
  }

 private:
  /// Returns row i of the program over (y, s): normal·y − offset·s ≤ 0.
  Row<kM> lifted(std::uint32_t i) const {
    Row<kM> row{{}, 0, i};
    for (std::size_t k = 0; k < kD; ++k) row.normal[k] = list_[i].normal[k];
    row.normal[kD] = -list_[i].offset;
    return row;
  }
  /// Returns row i, with its offset if `withOffset` is true, else with an offset of 0.
  Row<kD> plain(std::uint32_t i, bool withOffset) const {
    Row<kD> row{{}, withOffset ? list_[i].offset : 0, i};
    for (std::size_t k = 0; k < kD; ++k) row.normal[k] = list_[i].normal[k];
    return row;
  }

  template <std::size_t M>
  void keep(const seidel::Optimum<M>& optimum) {
    answer_.proof.clear();
    for (const auto& [i, weight] : optimum.weights)
      answer_.proof.push_back({i, static_cast<double>(weight)});
  }

  /// Finds a point of all half-spaces and returns true, or finds the proof that there is none and
  /// returns false.
  bool findPoint() {
    answer_.status = LinearProgramStatus::optimal;
    if (list_.empty()) return true;
    const auto rows = [this](std::uint32_t i) { return lifted(i); };
    Point<double, kM> up{};
    up[kD] = 1;
    const auto first = seidel::candidate<kM>(list_.size(), rows, up, 1, seed_);
    if (first.x[kD] > 0 && isInside(first)) return true;
    if (isProvedEmpty(first, up)) return false;
    answer_.exact = true;
    Point<Rational, kM> exactUp{};
    exactUp[kD] = 1;
    const auto best = seidel::exactOptimum<kM>(list_.size(), rows, exactUp, 1, first.tight);
    if (best.value > 0) {
      for (std::size_t k = 0; k < kD; ++k)
        answer_.x[k] = static_cast<double>(Rational(best.x[k] / best.x[kD]));
      return true;
    }
    answer_.status = LinearProgramStatus::infeasible;
    keep(best);
    return false;
  }

  /// Sets `answer_.x` to a point inside all half-spaces: the middle between the candidate, which is
  /// on the planes of the tight rows, and the point for which the sum of the distances from these
  /// planes is largest. Returns false if this middle point is not proved to be inside.
  bool isInside(const seidel::Candidate<kM>& first) {
    Point<double, kM> away{};
    for (std::size_t i = 0; i < first.tight.count; ++i) {
      if (first.tight.name[i] >= list_.size()) continue;
      const Row<kM> row = lifted(first.tight.name[i]);
      const double size = std::sqrt(seidel::dot(row.normal, row.normal));
      for (std::size_t k = 0; k < kM && size > 0; ++k) away[k] -= row.normal[k] / size;
    }
    const auto second = seidel::candidate<kM>(
        list_.size(), [this](std::uint32_t i) { return lifted(i); }, away, 1, seed_);
    const double s = first.x[kD] + second.x[kD];
    Eigen::Vector<double, D> x;
    for (std::size_t k = 0; k < kD; ++k) x[k] = (first.x[k] + second.x[k]) / s;
    if (!x.allFinite()) return false;
    for (const HalfSpace<D>& each : list_) {
      // D products and D sums, each rounded: (D + 1)u ≤ 7u of the sum of magnitudes. Underflow adds
      // at most 2^-1022 times the larger of 1 and the largest factor, for each of these operations.
      const double size = each.normal.cwiseAbs().dot(x.cwiseAbs()) + std::abs(each.offset);
      const double tiny =
          0x1p-1018 * std::max({1.0, x.cwiseAbs().maxCoeff(), each.normal.cwiseAbs().maxCoeff()});
      if (!(each.normal.dot(x) - each.offset < -(8 * kUnit * size + tiny))) return false;
    }
    answer_.x = x;
    return true;
  }

  bool isProvedEmpty(const seidel::Candidate<kM>& found, const Point<double, kM>& up) {
    std::array<Point<double, kM>, kM> normals;
    if (found.tight.count != kM) return false;
    for (std::size_t i = 0; i < kM; ++i) {
      if (found.tight.name[i] >= list_.size()) return false;
      normals[i] = lifted(found.tight.name[i]).normal;
    }
    const auto weights = seidel::provedWeights<kM>(normals, up);
    if (!weights) return false;
    answer_.status = LinearProgramStatus::infeasible;
    for (std::size_t i = 0; i < kM; ++i)
      answer_.proof.push_back({found.tight.name[i], (*weights)[i]});
    return true;
  }

  Point<double, kD> goal() const {
    Point<double, kD> goal;
    for (std::size_t k = 0; k < kD; ++k) goal[k] = goal_[k];
    return goal;
  }
  Point<Rational, kD> exactGoal() const {
    Point<Rational, kD> goal;
    for (std::size_t k = 0; k < kD; ++k) goal[k] = seidel::rational(goal_[k]);
    return goal;
  }

  /// Looks for a ray along which the goal grows without bound. If there is one, stores it and
  /// returns true.
  bool findRay() {
    const auto rows = [this](std::uint32_t i) { return plain(i, false); };
    const auto first = seidel::candidate<kD>(list_.size(), rows, goal(), 1, seed_);
    const auto best = seidel::exactOptimum<kD>(list_.size(), rows, exactGoal(), 1, first.tight);
    if (!(best.value > 0)) return false;
    answer_.status = LinearProgramStatus::unbounded;
    for (std::size_t k = 0; k < kD; ++k) answer_.ray[k] = static_cast<double>(best.x[k]);
    return true;
  }

  /// Finds an optimal point and the weights that prove it, in rationals.
  /// @pre there is an optimum, and `answer_.x` is near a point of all half-spaces.
  void findOptimum() {
    const auto rows = [this](std::uint32_t i) { return plain(i, true); };
    // `answer_.x` is rounded, so it may be outside of some half-spaces. A point of all half-spaces
    // is near it. To include this point, the bounds are more than twice the largest coordinate of
    // `answer_.x`. If a bound is in the proof, the next round squares twice the bounds, so that few
    // rounds are needed. If `answer_.x` overflows in double, other bounds are used. The coordinates
    // of the point are quotients of determinants of at most six rows (Cramer's rule), so they are
    // below 2^65536 by far: a quotient of products of six doubles each is below 2^13000.
    const double size = answer_.x.cwiseAbs().maxCoeff();
    Rational reach = std::isfinite(size) ? 2 * seidel::rational(size) + 1
                                         : Rational(boost::multiprecision::cpp_int(1) << 65536);
    const auto first =
        seidel::candidate<kD>(list_.size(), rows, goal(), std::min(2 * size + 1, 0x1p1000), seed_);
    for (seidel::Tight<kD> start = first.tight;; reach *= reach) {
      const auto best = seidel::exactOptimum<kD>(list_.size(), rows, exactGoal(), reach, start);
      if (best.atBounds) {
        reach *= 2;
        continue;
      }
      for (std::size_t k = 0; k < kD; ++k) answer_.x[k] = static_cast<double>(best.x[k]);
      keep(best);
      return;
    }
  }

  std::span<const HalfSpace<D>> list_;
  Eigen::Vector<double, D> goal_;
  std::uint64_t seed_;
  LinearProgramAnswer<D> answer_;
};

}  // namespace

template <int D>
LinearProgramAnswer<D> solveLinearProgram(std::span<const HalfSpace<D>> halfSpaces,
                                          const Eigen::Vector<double, D>& goal,
                                          std::uint64_t seed) {
  return Program<D>(halfSpaces, goal, seed).solve();
}

template <int D>
LinearProgramAnswer<D> commonPoint(std::span<const HalfSpace<D>> a, std::span<const HalfSpace<D>> b,
                                   std::uint64_t seed) {
  std::vector<HalfSpace<D>> both(a.begin(), a.end());
  both.insert(both.end(), b.begin(), b.end());
  return solveLinearProgram<D>(both, Eigen::Vector<double, D>::Zero(), seed);
}

#define CORRIDOR_LINEAR_PROGRAM(D)                                                       \
  template LinearProgramAnswer<D> solveLinearProgram(                                    \
      std::span<const HalfSpace<D>>, const Eigen::Matrix<double, D, 1>&, std::uint64_t); \
  template LinearProgramAnswer<D> commonPoint(std::span<const HalfSpace<D>>,             \
                                              std::span<const HalfSpace<D>>, std::uint64_t);
CORRIDOR_LINEAR_PROGRAM(2)
CORRIDOR_LINEAR_PROGRAM(3)
CORRIDOR_LINEAR_PROGRAM(4)
CORRIDOR_LINEAR_PROGRAM(5)
CORRIDOR_LINEAR_PROGRAM(6)
#undef CORRIDOR_LINEAR_PROGRAM

}  // namespace corridor
