#include "planner/solve/outside_bounds.h"

#include <algorithm>

#include "planner/verify/polynomial_range.h"

namespace corridor {

using Real = long double;

std::vector<OutsideBounds> outsideBounds(const ConfigurationSpace& space,
                                         std::span<const CurvePiece> pieces) {
  std::vector<OutsideBounds> all;
  for (std::size_t k = 0; k < space.coordinates().size(); ++k) {
    const Coordinate& c = space.coordinates()[k];
    if (c.kind != Coordinate::Kind::line) continue;
    const auto row = static_cast<Eigen::Index>(c.first);
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      const Eigen::VectorXd values = pieces[p].coefficients.row(row);
      const auto last = values.size() - 1;
      const auto isOutside = [&](double value) { return value < c.lower || value > c.upper; };
      if (isOutside(values[0]) || isOutside(values[last])) {
        const double t = isOutside(values[0]) ? 0 : 1;
        all.push_back({k, p, t, t == 0 ? values[0] : values[last]});
        break;
      }
      const Real slack =
          std::min<Real>(pieces[p].error[row], 0x1p-42L * Real(values.cwiseAbs().maxCoeff()));
      const verify::RangeAnswer answer =
          verify::rangeOf(verify::Bernstein(std::span(values.data(), std::size_t(values.size()))),
                          c.lower - slack, c.upper + slack);
      if (answer.verdict == verify::RangeAnswer::Verdict::within) continue;
      all.push_back({k, p, static_cast<double>(answer.at), static_cast<double>(answer.value)});
      break;
    }
  }
  return all;
}

}  // namespace corridor
