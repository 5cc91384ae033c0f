#include "planner/model/pair_proofs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "planner/robot/joint_types.h"

namespace corridor {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Returns the joints between two links.
std::vector<std::size_t> jointsBetween(const RobotDescription& robot, std::size_t a,
                                       std::size_t b) {
  std::vector<std::optional<std::size_t>> above(robot.links.size());
  for (std::size_t j = 0; j < robot.joints.size(); ++j) above[robot.joints[j].child] = j;
  const auto pathFrom = [&](std::size_t link) {
    std::vector<std::size_t> path;
    for (; above[link]; link = robot.joints[*above[link]].parent) path.push_back(*above[link]);
    return path;
  };
  std::vector<std::size_t> pathA = pathFrom(a), pathB = pathFrom(b);
  while (!pathA.empty() && !pathB.empty() && pathA.back() == pathB.back()) {
    pathA.pop_back();
    pathB.pop_back();
  }
  pathA.insert(pathA.end(), pathB.begin(), pathB.end());
  return pathA;
}

/// Returns the lowest value that a proof covers which goes `beyond` a limit, rounded up.
double lowestBeyond(double limit, double beyond) {
  return beyond > 0 ? std::min(limit, std::nextafter(limit - beyond, kInfinity)) : limit;
}
double highestBeyond(double limit, double beyond) {
  return -lowestBeyond(-limit, beyond);
}

/// Returns whether a polynomial, given by its Bernstein coefficients, is in [lower, upper] on all
/// of [0, 1].
/// @param halvings how often the polynomial may still be halved to find out.
bool staysWithin(std::vector<double> b, double lower, double upper, int halvings) {
  const auto [least, most] = std::minmax_element(b.begin(), b.end());
  if (lower <= *least && *most <= upper) return true;
  // The polynomial begins and ends at its first and last coefficient.
  if (halvings == 0 || !(lower <= b.front() && b.front() <= upper) ||
      !(lower <= b.back() && b.back() <= upper))
    return false;
  // Each step of de Casteljau's algorithm rounds a mean of two coefficients. The box is narrowed by
  // more than the rounding of all steps, so that no rounding makes the answer `true`.
  const double rounding = 0x1p-48 * std::max(std::abs(*least), std::abs(*most));
  std::vector<double> first;
  for (std::size_t left = b.size(); left > 0; --left) {
    first.push_back(b.front());
    for (std::size_t i = 0; i + 1 < left; ++i) b[i] = b[i] / 2 + b[i + 1] / 2;
  }
  // b now has the coefficients of the second half: those computed last come first.
  return staysWithin(std::move(first), lower + rounding, upper - rounding, halvings - 1) &&
         staysWithin(std::move(b), lower + rounding, upper - rounding, halvings - 1);
}

}  // namespace

std::optional<PairProof> proofBetween(const ModelRobot& robot, const ConfigurationSpace& space,
                                      std::size_t a, std::size_t b,
                                      const AllowedPair::Proof& proof) {
  const std::vector<JointModel>& joints = robot.description.joints;
  PairProof found{proof.margin, proof.beyondLimits, {}};
  for (const std::size_t j : jointsBetween(robot.description, a, b)) {
    const JointModel& joint = joints[j];
    if (joint.type == JointType::fixed) continue;
    if (isPoseJoint(joint.type)) return std::nullopt;
    const double multiplier = joint.mimic ? joint.mimic->multiplier : 1;
    if (multiplier == 0) continue;
    const std::size_t source = joint.mimic ? joint.mimic->joint : j;
    const JointModel& leader = joints[source];
    // A joint with equal limits is not planned for by `corridor new robot`, so the proof is for its
    // only value, and for nothing beyond it.
    const bool anyValue = leader.type == JointType::continuous;
    const bool isRigid = !anyValue && leader.lower == leader.upper;
    if (anyValue && (joint.type == JointType::prismatic || multiplier != std::trunc(multiplier)))
      return std::nullopt;
    const auto planned = std::find_if(
        robot.plannedJoints.begin(), robot.plannedJoints.end(),
        [&](const PlannedJoint& one) { return !leader.name.empty() && one.name == leader.name; });
    if (planned != robot.plannedJoints.end()) {
      if (isRigid) return std::nullopt;
      const std::size_t number = space.coordinates()[planned->coordinate].first;
      found.ranges.push_back(
          {number, anyValue ? -kInfinity : leader.lower, anyValue ? kInfinity : leader.upper});
      continue;
    }
    const auto held = robot.held.find(source);
    if (held == robot.held.end()) return std::nullopt;
    if (isRigid && held->second != leader.lower) return std::nullopt;
    // The pose of a held joint is stored with a rounding of some 2^-52 of the lengths, which only a
    // margin of the proof covers.
    if (!isRigid && !(proof.margin > 0)) return std::nullopt;
    if (anyValue || isRigid) continue;
    // The value of a mimicking joint is rounded if its leader is held (RobotAssembly::drive). As a
    // change of the leader's value, this rounding is at most:
    const double rounding =
        joint.mimic
            ? 0x1p-51 * (std::abs(held->second) + std::abs(joint.mimic->offset / multiplier))
            : 0;
    if (!(held->second - rounding >= lowestBeyond(leader.lower, proof.beyondLimits) &&
          held->second + rounding <= highestBeyond(leader.upper, proof.beyondLimits)))
      return std::nullopt;
  }
  return found;
}

bool ProvedBox::contains(const Configuration& q) const {
  return q.size() == lower.size() && (q.array() >= lower.array()).all() &&
         (q.array() <= upper.array()).all();
}

bool ProvedBox::contains(const CurvePiece& piece) const {
  if (piece.coefficients.rows() != lower.size() || piece.error.size() != lower.size()) return false;
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    if (lower[i] == -kInfinity && upper[i] == kInfinity) continue;
    const double error = piece.error[i];
    const double from = error > 0 ? std::nextafter(lower[i] + error, kInfinity) : lower[i],
                 to = error > 0 ? std::nextafter(upper[i] - error, -kInfinity) : upper[i];
    const auto row = piece.coefficients.row(i);
    if (!row.allFinite() || !staysWithin({row.begin(), row.end()}, from, to, 10)) return false;
  }
  return true;
}

std::optional<ProvedBox> provedBox(const Model& model, const Required& need) {
  std::optional<ProvedBox> box;
  for (const auto& [pair, proof] : model.filter.proofs()) {
    if (model.filter.whyNotTested(pair.first, pair.second, need) != kNeverInContact) continue;
    if (!box) {
      const auto size = static_cast<Eigen::Index>(model.space.size());
      box = {Configuration::Constant(size, -kInfinity), Configuration::Constant(size, kInfinity)};
    }
    for (const PairProof::Range& range : proof.ranges) {
      const auto i = static_cast<Eigen::Index>(range.number);
      // The tube takes its share of what the proof covers beyond the limits.
      const double left = proof.beyondLimits - need.tube[i],
                   beyond = left > 0 ? std::nextafter(left, 0.0) : 0;
      box->lower[i] = std::max(box->lower[i], lowestBeyond(range.lower, beyond));
      box->upper[i] = std::min(box->upper[i], highestBeyond(range.upper, beyond));
    }
  }
  return box;
}

}  // namespace corridor
