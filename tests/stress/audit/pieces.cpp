#include "tests/stress/audit/pieces.h"

#include <algorithm>
#include <cmath>

namespace corridor::audit {
namespace {

/// Fills a row with the coefficients of one component of the configuration. In kinds 1 to 4 the
/// component goes from `a` to `b`. In the other kinds it stays at `a`, reverses at the middle, or
/// has large coefficients that cancel.
/// @param unit rad or m. If a and b are equal, the scale of the motion is 10^-3 to 1 times this
/// distance in a third of the cases, and 0 in the others.
void fillRow(Dice& dice, Eigen::MatrixXd::RowXpr row, double a, double b, double unit) {
  const Eigen::Index n = row.size() - 1;
  double way = std::abs(b - a);
  if (way == 0 && dice.oneIn(3)) way = unit * dice.power(-3, 0);
  const std::size_t kind = dice.index(7);
  const double large = way * dice.power(0, 2);
  for (Eigen::Index i = 0; i <= n; ++i) {
    const double chord = i == n ? b : a + (b - a) * static_cast<double>(i) / static_cast<double>(n);
    const bool inner = i > 0 && i < n;
    switch (kind) {
      case 0:
        row[i] = a;
        break;
      case 1:
        row[i] = chord;
        break;
      case 2:
      case 3:
        row[i] = inner ? chord + 0.05 * way * dice.real() : chord;
        break;
      case 4:
        row[i] = inner ? chord + way * dice.real() : chord;
        break;
      case 5:  // stops and reverses at the middle
        row[i] = a + std::abs(static_cast<double>(2 * i - n)) * way / static_cast<double>(n);
        break;
      default:  // a + large·(1 − 2τ)^n
        row[i] = a + (i % 2 ? -large : large);
    }
  }
}

}  // namespace

bool isAngle(const Edge& edge, const Coordinate& c) {
  return c.kind != Coordinate::Kind::line ||
         std::any_of(edge.tree.frames.begin(), edge.tree.frames.end(), [&](const Frame& frame) {
           return frame.joint == Frame::Joint::revolute && frame.variable == c.first;
         });
}

void bendEdge(Dice& dice, Edge& edge, double size) {
  const auto degree = static_cast<Eigen::Index>(dice.oneIn(8) ? 1 : 2 + dice.index(8));
  CurvePiece piece;
  piece.coefficients.resize(edge.from.size(), degree + 1);
  piece.error = Configuration::Zero(edge.from.size());
  for (const Coordinate& c : edge.space.coordinates()) {
    const auto first = static_cast<Eigen::Index>(c.first);
    if (c.kind == Coordinate::Kind::rotation) {
      for (Eigen::Index i = 1; i < degree; ++i)
        for (Eigen::Index k = 0; k < 4; ++k) piece.coefficients(first + k, i) = dice.real();
      piece.coefficients.col(0).segment<4>(first) = edge.from.segment<4>(first);
      piece.coefficients.col(degree).segment<4>(first) = edge.to.segment<4>(first);
      continue;
    }
    const double a = edge.from[first];
    double b = edge.to[first];
    if (c.kind == Coordinate::Kind::circle) b = a + static_cast<double>(circleDifference(a, b));
    fillRow(dice, piece.coefficients.row(first), a, b, isAngle(edge, c) ? 1 : size);
  }
  edge.from = piece.coefficients.col(0);
  edge.to = piece.coefficients.col(degree);
  edge.piece = std::move(piece);
}

}  // namespace corridor::audit
