#include "planner/model/reach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

namespace corridor {
namespace {

/// The box in which a frame's origin may be, and the orientations that the frame may have: R alone,
/// R followed by any rotation about the world's z axis, or all orientations.
struct FrameReach {
  ReachBox origin;
  Mat3 R = Mat3::Identity();
  enum class Turned { no, aboutZ, any } turned = Turned::no;
};

/// Returns a box that contains all possible positions of the points of `box`. `box` is in the
/// frame's coordinates. The result is relative to the frame's origin, along the world's axes.
ReachBox around(const FrameReach& frame, const ReachBox& box) {
  const Vec3 c = frame.R * (box.lower + box.upper) / 2,
             h = frame.R.cwiseAbs() * (box.upper - box.lower) / 2;
  ReachBox out{c - h, c + h};
  if (frame.turned == FrameReach::Turned::no) return out;
  const Vec3 far = out.lower.cwiseAbs().cwiseMax(out.upper.cwiseAbs());
  const double r = frame.turned == FrameReach::Turned::any ? far.norm() : far.head<2>().norm();
  out.lower.head<2>().setConstant(-r);
  out.upper.head<2>().setConstant(r);
  if (frame.turned == FrameReach::Turned::any) {
    out.lower.z() = -r;
    out.upper.z() = r;
  }
  return out;
}

ReachBox operator+(const ReachBox& a, const ReachBox& b) {
  return {a.lower + b.lower, a.upper + b.upper};
}

/// Returns the bounds of one number of a configuration, infinite if the number is not a line.
std::pair<double, double> rangeOf(const ConfigurationSpace& space, std::size_t number) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  for (const Coordinate& c : space.coordinates())
    if (c.kind == Coordinate::Kind::line && c.first == number) return {c.lower, c.upper};
  return {-infinity, infinity};
}

/// Returns where a frame may be, given where its parent may be.
FrameReach childOf(const Model& model, const FrameReach& parent, const Frame& frame) {
  using Turned = FrameReach::Turned;
  FrameReach reach = parent;
  reach.origin = parent.origin + around(parent, {frame.fixed.p, frame.fixed.p});
  reach.R = parent.R * frame.fixed.q.normalized().toRotationMatrix();
  const Vec3 axis = frame.axis.stableNormalized();
  switch (frame.joint) {
    case Frame::Joint::none:
      break;
    case Frame::Joint::revolute:
      if (frame.variable == Frame::noVariable)
        reach.R = reach.R * Eigen::AngleAxisd(frame.offset, axis).toRotationMatrix();
      else if (reach.turned == Turned::any || (reach.R * axis).head<2>().norm() > 1e-9)
        reach.turned = Turned::any;
      else
        reach.turned = Turned::aboutZ;
      break;
    case Frame::Joint::prismatic: {
      double low = frame.offset, high = frame.offset;
      if (frame.variable != Frame::noVariable) {
        const auto [lower, upper] = rangeOf(model.space, frame.variable);
        low += std::min(frame.multiplier * lower, frame.multiplier * upper);
        high += std::max(frame.multiplier * lower, frame.multiplier * upper);
      }
      const Vec3 a = low * axis, b = high * axis;
      reach.origin = reach.origin + around(reach, {a.cwiseMin(b), a.cwiseMax(b)});
      break;
    }
    case Frame::Joint::translation: {
      ReachBox box;
      for (std::size_t k = 0; k < frame.count; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        std::tie(box.lower[i], box.upper[i]) = rangeOf(model.space, frame.variable + k);
      }
      reach.origin = reach.origin + around(reach, box);
      break;
    }
    case Frame::Joint::rotation:
      reach.turned = Turned::any;
      break;
  }
  return reach;
}

/// Returns a box around the shapes of a body, in the coordinates of the body's frame.
ReachBox boundsOf(const ModelBody& body) {
  ReachBox box{Vec3::Constant(std::numeric_limits<double>::infinity()),
               Vec3::Constant(-std::numeric_limits<double>::infinity())};
  for (const PlacedShape& shape : body.shapes) {
    forEachPoint(shape, [&](const Vec3& p, double radius) {
      box.lower = box.lower.cwiseMin(p - Vec3::Constant(radius));
      box.upper = box.upper.cwiseMax(p + Vec3::Constant(radius));
    });
  }
  return box;
}

}  // namespace

std::vector<ReachBox> reachOf(const Model& model) {
  std::vector<FrameReach> frames(1);
  for (std::size_t i = 1; i < model.tree.frames.size(); ++i)
    frames.push_back(childOf(model, frames[model.tree.frames[i].parent], model.tree.frames[i]));
  std::vector<ReachBox> boxes;
  for (const ModelBody& body : model.bodies)
    boxes.push_back(frames[body.frame].origin + around(frames[body.frame], boundsOf(body)));
  return boxes;
}

bool outOfReach(const Task& task, const ReachBox& a, const ReachBox& b) {
  const Vec3 gap = (a.lower - b.upper).cwiseMax(b.lower - a.upper).cwiseMax(Vec3::Zero());
  const double size = (a.upper - a.lower).norm() + (b.upper - b.lower).norm();
  // The tube displaces a point by at most the sum of the tube's lengths, plus the sum of the tube's
  // angles times `size`.
  const double pad =
      task.margin + task.padding.largest() + task.tube.sum() * (1 + size) + 1e-9 * size;
  return gap.norm() > pad;
}

}  // namespace corridor
