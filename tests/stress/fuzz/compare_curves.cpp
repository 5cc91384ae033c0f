// Fuzz target: a piece of a curve of a small robot among small bodies. The checker and the verifier
// must not contradict each other.
#include "tests/stress/fuzz/small_robot.h"

namespace corridor::fuzz {
namespace {

/// Returns a piece from the edge's first state to its second. The coefficients between the ends are
/// all near the edge, or all arbitrary.
CurvePiece decodePiece(Decoder& in, const Robot& robot) {
  const auto size = static_cast<Eigen::Index>(robot.space.size());
  const auto degree = 1 + static_cast<Eigen::Index>(in.below(CurvePiece::kLargestDegree));
  const bool near = in.oneIn(2);
  CurvePiece piece{Eigen::MatrixXd(size, degree + 1), Configuration::Zero(size)};
  for (Eigen::Index i = 0; i <= degree; ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(degree);
    piece.coefficients.col(i) = (1 - t) * robot.from + t * robot.to;
    if (i == 0 || i == degree) continue;
    for (double& value : piece.coefficients.col(i))
      value = near ? value + 0.1 * in.real() : in.real();
  }
  // The end coefficients are set to the states exactly: products with 0 and 1 could round, or
  // change the sign of zeros.
  piece.coefficients.col(0) = robot.from;
  piece.coefficients.col(degree) = robot.to;
  if (in.oneIn(4))
    for (const Coordinate& c : robot.space.coordinates())
      piece.error[static_cast<Eigen::Index>(c.first)] = 1e-4 * std::min(std::abs(in.real()), 1.0);
  return piece;
}

void compare(Robot& robot, Decoder& in) {
  const CurvePiece piece = decodePiece(in, robot);
  if (!piece.coefficients.allFinite()) return;
  // The curve may go farther than both states. Its largest magnitudes are needed for the bound of
  // the rounding.
  const Configuration most = piece.coefficients.cwiseAbs().rowwise().maxCoeff();
  Robot wide = robot;
  for (const Coordinate& c : robot.space.coordinates())
    if (c.kind != Coordinate::Kind::rotation)
      wide.from[static_cast<Eigen::Index>(c.first)] = most[static_cast<Eigen::Index>(c.first)];
  wide.size = wide.angle = 0;
  setSize(wide);
  robot.size = (1 + piece.degree()) * wide.size;
  robot.angle = (1 + piece.degree()) * wide.angle;
  if (!std::isfinite(robot.size)) return;
  const auto c = comparisonOf(robot, in);
  if (!c) return;
  EdgeMotion motion(robot.tree, robot.space, c->scene.framePairs(), robot.tube);
  motion.set(piece);
  QueryContext context;
  requireAgreement(*c, c->scene.certify(motion, c->options, context),
                   verifyCurve(c->problem, {&piece, 1}));
}

}  // namespace
}  // namespace corridor::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  fuzz::Decoder in(data, size);
  static constexpr double limits[] = {10, 100, 1e3};
  in.limit(limits[in.below(3)]);
  if (auto robot = fuzz::decodeRobot(in)) fuzz::compare(*robot, in);
  return 0;
}
