#include "planner/view/curve_plots.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <vector>

#include "planner/trajectory/bernstein.h"

namespace corridor::view {
namespace {

// Intervals of all pieces together; each piece has at least one.
constexpr std::size_t kPlotSteps = 800;
constexpr std::size_t kMostPieceSteps = 40;  // intervals of one piece

using Coefficients = std::vector<double>;

/// Returns the value of a polynomial in Bernstein form at t in [0, 1].
double valueAt(const Coefficients& c, double t) {
  Coefficients weights(c.size());
  bernstein::basis(static_cast<int>(c.size()) - 1, t, weights.data());
  return std::inner_product(c.begin(), c.end(), weights.begin(), 0.0);
}

/// Returns the derivative by time of a polynomial that takes `duration`.
Coefficients derivativeOf(const Coefficients& c, double duration) {
  if (c.size() == 1) return {0};
  Coefficients result;
  for (std::size_t i = 0; i + 1 < c.size(); ++i)
    result.push_back(static_cast<double>(c.size() - 1) * (c[i + 1] - c[i]) / duration);
  return result;
}

}  // namespace

CurvePlots curvePlots(const ConfigurationSpace& space, const Curve& curve) {
  CurvePlots plots;
  for (std::size_t k = 0; k < space.coordinates().size(); ++k)
    if (space.coordinates()[k].kind != Coordinate::Kind::rotation)
      plots.numbers.push_back({k, {}, {}, {}});
  const std::size_t most =
      std::clamp<std::size_t>(kPlotSteps / curve.pieces.size(), 1, kMostPieceSteps);
  for (std::size_t p = 0; p < curve.pieces.size(); ++p) {
    const CurvePiece& piece = curve.pieces[p];
    const double begin = curve.knots[p], end = curve.knots[p + 1];
    const double duration = end - begin;
    const std::size_t steps = piece.degree() == 1 ? 1 : most;
    const auto parameter = [&](std::size_t i) {
      return static_cast<double>(i) / static_cast<double>(steps);
    };
    for (std::size_t i = 0; i <= steps; ++i)
      plots.times.push_back(i == steps ? end : begin + parameter(i) * (end - begin));
    for (CurvePlots::Number& number : plots.numbers) {
      const Eigen::VectorXd row = piece.coefficients.row(
          static_cast<Eigen::Index>(space.coordinates()[number.coordinate].first));
      const Coefficients position(row.begin(), row.end());
      const Coefficients velocity = derivativeOf(position, duration);
      const Coefficients acceleration = derivativeOf(velocity, duration);
      for (std::size_t i = 0; i <= steps; ++i) {
        number.position.push_back(valueAt(position, parameter(i)));
        number.velocity.push_back(valueAt(velocity, parameter(i)));
        number.acceleration.push_back(valueAt(acceleration, parameter(i)));
      }
    }
  }
  return plots;
}

double limitOf(const ConfigurationSpace& space, std::size_t coordinate,
               const Configuration& limits) {
  if (limits.size() == 0) return std::numeric_limits<double>::infinity();
  std::size_t k = coordinate;
  for (const CoordinateGroup& group : space.groups()) {
    if (group.kind == CoordinateGroup::Kind::joints) continue;
    // The last coordinate of the group is the yaw or the rotation; the others are the position.
    const auto last = group.coordinates.end() - 1;
    if (std::find(group.coordinates.begin(), last, coordinate) != last)
      k = group.coordinates.front();
  }
  return limits[static_cast<Eigen::Index>(space.coordinates()[k].first)];
}

}  // namespace corridor::view
