#include "planner/robot/edge_motion.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "collision/core/rounding.h"
#include "planner/robot/moving_joint.h"

namespace corridor {
namespace {

/// An error, metres, that is added to every error bound. Squares below 2^-1022 underflow, so
/// lengths below 2^-500 may be computed as 0. For levers below 2^99 m, this constant covers all
/// errors by underflow.
constexpr double kLeastError = 0x1p-400;

constexpr std::size_t kItself = SIZE_MAX;  // in place of a view: the frame is the ancestor

}  // namespace

/// Poses are cached in *views*. A view is the pose of a frame in the coordinates of one of its
/// ancestors. A view is computed once per t, as the product of the view of the parent frame and one
/// pose. All pairs of frames with this ancestor as their lowest common ancestor share the view. So
/// for these pairs the joints between the world and the ancestor are not evaluated, and their
/// rounding is not counted. If one frame of a pair is the ancestor itself, the view of the other
/// frame is the relative pose.
struct EdgeMotion::Impl {
  struct LeverError {  // metres, for a point at lever y from frame b's origin: fixed + reach·|y|
    double fixed = 0, reach = 0;
  };
  struct Place {  // pose of a kept frame in its nearest kept ancestor
    MovingJoint joint;
    Transform X;
    std::uint64_t stamp = 0;  // identifies the t that X was computed for
  };
  struct View {
    std::size_t parent = kItself;  // the parent frame's view; kItself: that frame is the ancestor
    std::size_t place = 0;
    Transform X;
    Vec3 axis = Vec3::UnitX();  // axis of the frame's joint, in the ancestor's coordinates
    std::uint64_t stamp = 0;
    // The following members are valid for the edge numbered `edge`: bounds on the errors of X.m
    // (operator norm) and of X.t (metres).
    std::uint64_t edge = 0;
    double rotationError = 0, shiftError = 0, reach = 0;  // reach: upper bound of |X.t|
  };
  struct Step {
    std::size_t view;
    bool up;  // whether the step leads towards the ancestor; the joint is then inverted
  };
  struct Path {
    std::size_t a = kItself, b = kItself;  // views of frames A and B from their common ancestor
    // From frame A to frame B. Stored when the motion is first queried: a chain of n frames has
    // n²/2 paths of up to n steps, and the motions of most pairs are never queried.
    std::vector<Step> steps;
    std::vector<ScrewMotion> screws;
    // The following members are valid for the edge numbered `edge`, and are computed when the
    // motion is first queried. `poseError`: the error of the pose and of the axes. `twistError`:
    // the error of the twist per unit of h.
    std::uint64_t edge = 0;
    LeverError poseError, twistError;
  };

  const ConfigurationSpace& space;
  std::vector<Place> places;
  std::vector<std::size_t> movingPlaces;  // the places whose joints move
  std::vector<View> views;                // a parent's view comes first
  std::vector<Path> paths;
  std::uint64_t stamp = 0;
  double t = 0;  // the t that `stamp` stands for
  std::uint64_t edge = 0;
  bool ambiguous = false, still = false;

  Impl(const KinematicTree& tree, const ConfigurationSpace& moved,
       std::span<const Scene::FramePair> pairs, const Configuration& tube);

  /// Begins an edge or a piece of a curve. `setJoint` sets the edge or piece in one joint.
  template <class SetJoint>
  void begin(bool hasNoCurve, const SetJoint& setJoint);
  void fillSteps(Path& path) const;
  const View& viewAt(std::size_t index);
  const View& viewWithErrors(std::size_t index);
  void setErrors(Path& path);
};

namespace {

bool turns(Frame::Joint joint) {
  return joint == Frame::Joint::revolute || joint == Frame::Joint::rotation;
}

}  // namespace

EdgeMotion::Impl::Impl(const KinematicTree& tree, const ConfigurationSpace& moved,
                       std::span<const Scene::FramePair> pairs, const Configuration& tube)
    : space(moved) {
  requireStandardFloatingPoint();
  if (tube.size() != static_cast<Eigen::Index>(moved.size()) || !(tube.array() >= 0).all())
    throw std::invalid_argument(
        "EdgeMotion: the tube must have a half width of 0 or more for each number of a "
        "configuration");
  const std::size_t count = tree.frames.size();
  // Keep the world, the frames of pairs, their common ancestors, and all frames whose joint moves.
  // The constant poses of the other frames are multiplied into those of their descendants.
  std::vector<char> kept(count);
  for (std::size_t f = 0; f < count; ++f) kept[f] = f == 0 || tree.frames[f].moves();
  std::vector<std::size_t> ancestors;
  for (const Scene::FramePair& pair : pairs) {
    ancestors.push_back(tree.commonAncestor(pair.a, pair.b));
    kept[pair.a] = kept[pair.b] = kept[ancestors.back()] = true;
  }
  std::vector<std::size_t> parents(count), placeOf(count);
  for (std::size_t f = 1; f < count; ++f) {
    const std::size_t parent = tree.frames[f].parent;
    parents[f] = kept[parent] ? parent : parents[parent];
    if (!kept[f]) continue;
    std::vector<std::size_t> folded;
    for (std::size_t g = f; g != parents[f]; g = tree.frames[g].parent) folded.push_back(g);
    LongPose fixed;
    for (; !folded.empty(); folded.pop_back()) fixed = fixed.then(tree.frames[folded.back()]);
    const Frame& frame = tree.frames[f];
    placeOf[f] = places.size();
    if (frame.moves()) movingPlaces.push_back(places.size());
    places.push_back({frame.moves()
                          ? MovingJoint(frame, fixed, space.kindOfNumber(frame.variable), tube)
                          : MovingJoint(fixed),
                      {},
                      0});
    places.back().X = places.back().joint.at(0);
  }
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> known;  // by ancestor and frame
  // Returns the view of frame f from its ancestor. Adds the view, and those of the frames between,
  // if they are missing.
  const auto viewOf = [&](const auto& self, std::size_t ancestor, std::size_t f) -> std::size_t {
    if (f == ancestor) return kItself;
    if (const auto found = known.find({ancestor, f}); found != known.end()) return found->second;
    View view;
    view.parent = self(self, ancestor, parents[f]);
    view.place = placeOf[f];
    views.push_back(view);
    return known[{ancestor, f}] = views.size() - 1;
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    Path path;
    path.a = viewOf(viewOf, ancestors[i], pairs[i].a);
    path.b = viewOf(viewOf, ancestors[i], pairs[i].b);
    paths.push_back(std::move(path));
  }
}

void EdgeMotion::Impl::fillSteps(Path& path) const {
  for (std::size_t v = path.b; v != kItself; v = views[v].parent) path.steps.push_back({v, false});
  std::vector<Step> up;
  for (std::size_t v = path.a; v != kItself; v = views[v].parent) up.push_back({v, true});
  path.steps.insert(path.steps.end(), up.rbegin(), up.rend());
  std::reverse(path.steps.begin(), path.steps.end());
  path.screws.reserve(2 * path.steps.size());
}

template <class SetJoint>
void EdgeMotion::Impl::begin(bool hasNoCurve, const SetJoint& setJoint) {
  ++stamp;
  t = 0;
  ambiguous = hasNoCurve || !standardFloatingPoint();
  still = true;
  for (const std::size_t moving : movingPlaces) {
    Place& place = places[moving];
    setJoint(place.joint);
    if (place.joint.still())
      place.X = place.joint.at(0);
    else
      still = false;
    ambiguous = ambiguous || place.joint.ambiguous();
  }
  ++edge;
}

const EdgeMotion::Impl::View& EdgeMotion::Impl::viewAt(std::size_t index) {
  View& view = views[index];
  if (view.stamp == stamp) return view;
  Place& place = places[view.place];
  if (place.stamp != stamp && !place.joint.still()) {
    place.X = place.joint.at(t);
    place.stamp = stamp;
  }
  if (view.parent == kItself)
    view.X = place.X;
  else
    view.X = viewAt(view.parent).X * place.X;
  view.axis = view.X.m * place.joint.axis();
  view.stamp = stamp;
  return view;
}

const EdgeMotion::Impl::View& EdgeMotion::Impl::viewWithErrors(std::size_t index) {
  View& view = views[index];
  if (view.edge == edge) return view;
  view.edge = edge;
  const MovingJoint& joint = places[view.place].joint;
  view.rotationError = joint.rotationError();
  view.shiftError = joint.shiftError();
  view.reach = joint.length();
  if (view.parent == kItself) return view;
  const View& parent = viewWithErrors(view.parent);
  view.rotationError += parent.rotationError + 10 * kUnit;
  view.reach += parent.reach;
  view.shiftError += parent.shiftError + parent.rotationError * joint.length() +
                     kUnit * (7 * joint.length() + 4 * view.reach);
  return view;
}

/// Computes the error bounds of a path, which leads from one frame of a pair to the other, for the
/// current edge. Notation: u is the unit roundoff, ρ the error of a rotation (operator norm), τ the
/// error of a position. Every computed matrix is within 2^-20 of norm 1. Products of errors are
/// left out here; `relativeMotion` covers them by a factor.
///
/// Poses. Each entry of a product is a sum of three products.
/// - A view X·Y: ρ_X + ρ_Y + 3u·√3·√3, and τ_X + τ_Y + ρ_X·|Y.t| + 4u(√3|Y.t| + |X.t + …|).
/// - The relative pose X_CA⁻¹·X_CB of frames A and B on two branches from their common ancestor C,
///   with |t| < T, the length of the path: ρ_A + ρ_B + 9u, and τ_A + τ_B + ρ_A·T + 7uT.
///
/// Screws. An axis is off by ρ, by the joint's own 32u, and by 6u for the product. The point on the
/// axis is off by τ. If A and B are on two branches, axis and point are also transformed into A's
/// frame. Consider a point at lever y from the origin of frame B, and an axis at distance L from
/// that origin. The point is off by pose(y), the error of the pose. Its lever from the axis is off
/// by e(y) = pose(y) + τ + axis error·(|y| + L). The bound e(y) also holds for the distance of the
/// point from the axis, which `motionBound` uses.
///
/// Twist. From the middle of the interval, a joint turns or slides by at most w = h·rate. So the
/// displacement of the point by the joints is off by Σ w·e(y), by the errors of the rates, and, for
/// the arithmetic, by about (16 + steps)·u·Σ w(|y| + L). The sums run over the joints of the path,
/// and `steps` is their number. `relativeMotion` returns the largest e(y) plus the error of the
/// twist.
void EdgeMotion::Impl::setErrors(Path& path) {
  if (path.edge == edge) return;
  path.edge = edge;
  double length = 0;
  for (const Step& step : path.steps) length += places[views[step.view].place].joint.length();
  LeverError turned;  // error of points transformed into A's frame, if A is not the ancestor
  LeverError pose, axes;
  if (path.b != kItself) {
    const View& b = viewWithErrors(path.b);
    pose = {b.shiftError, b.rotationError};
  }
  if (path.a != kItself) {
    const View& a = viewWithErrors(path.a);
    turned = {a.shiftError + (a.rotationError + 8 * kUnit) * length, a.rotationError + 10 * kUnit};
    pose.fixed += turned.fixed;
    pose.reach += turned.reach;
  }
  path.twistError = {};
  const double arithmetic = (16 + static_cast<double>(path.steps.size())) * kUnit;
  double lever = 0;  // L, an upper bound of the distance from the joint's origin to b's origin
  for (auto step = path.steps.rbegin(); step != path.steps.rend(); ++step) {
    const View& view = viewWithErrors(step->view);
    const MovingJoint& joint = places[view.place].joint;
    if (step->up) lever += joint.length();
    if (joint.joint() != Frame::Joint::none) {
      const double rate = joint.largestRate();
      const double axisError = view.rotationError + turned.reach + 40 * kUnit + arithmetic;
      if (turns(joint.joint())) {
        const double pointError = view.shiftError + turned.fixed + axisError * lever;
        axes.fixed = std::max(axes.fixed, pointError);
        axes.reach = std::max(axes.reach, axisError);
        path.twistError.fixed += rate * (pose.fixed + pointError) + joint.rateError() * lever;
        path.twistError.reach += rate * (pose.reach + axisError) + joint.rateError();
      } else {
        path.twistError.fixed += rate * axisError + joint.rateError();
      }
    }
    if (!step->up) lever += joint.length();
  }
  path.poseError = {pose.fixed + axes.fixed, pose.reach + axes.reach};
}

EdgeMotion::EdgeMotion(const KinematicTree& tree, const ConfigurationSpace& space,
                       std::span<const Scene::FramePair> pairs, const Configuration& tube)
    : impl_(std::make_unique<Impl>(tree, space, pairs, tube)) {}

EdgeMotion::~EdgeMotion() = default;

void EdgeMotion::set(const Configuration& from, const Configuration& to) {
  const ConfigurationSpace& space = impl_->space;
  const bool defined = space.isFinite(from) && space.isFinite(to) && !space.ambiguous(from, to);
  impl_->begin(!defined, [&](MovingJoint& joint) { joint.set(from, to); });
}

void EdgeMotion::set(const CurvePiece& piece) {
  const auto hasRotations = [&](Eigen::Index column) {  // in each rotation: no zero quaternion
    const auto& coordinates = impl_->space.coordinates();
    return std::all_of(coordinates.begin(), coordinates.end(), [&](const Coordinate& c) {
      const auto first = static_cast<Eigen::Index>(c.first);
      return c.kind != Coordinate::Kind::rotation ||
             !piece.coefficients.col(column).segment<4>(first).isZero(0);
    });
  };
  const bool defined = piece.coefficients.allFinite() && hasRotations(0) &&
                       hasRotations(piece.degree()) && piece.error.allFinite() &&
                       (piece.error.array() >= 0).all();
  impl_->begin(!defined, [&](MovingJoint& joint) { joint.set(piece); });
}

RelativeMotion EdgeMotion::relativeMotion(std::size_t pair, double t, double h) {
  Impl& m = *impl_;
  if (t != m.t) {
    m.t = t;
    ++m.stamp;
  }
  Impl::Path& path = m.paths[pair];
  if (path.steps.empty()) m.fillSteps(path);
  m.setErrors(path);
  RelativeMotion w;
  if (path.b != kItself) w.X_AB = m.viewAt(path.b).X;
  Transform X_LA;
  const bool branches = path.a != kItself;
  if (branches) {
    X_LA = m.viewAt(path.a).X;
    w.X_AB = {X_LA.m.transpose() * w.X_AB.m, X_LA.m.transpose() * (w.X_AB.t - X_LA.t)};
  }
  path.screws.clear();
  for (const Impl::Step& step : path.steps) {
    const Impl::View& view = m.views[step.view];
    const MovingJoint& joint = m.places[view.place].joint;
    const double rate = std::abs(joint.rate()) + joint.rateError();
    const bool rests = rate == 0 || h == 0;
    ScrewMotion screw;
    screw.deviation = joint.deviation(h);
    if (joint.joint() == Frame::Joint::none || (rests && screw.deviation == 0 && joint.tube() == 0))
      continue;
    screw.axis = view.axis;
    screw.point = view.X.t;
    if (branches) {
      screw.axis = X_LA.m.transpose() * screw.axis;
      screw.point = X_LA.m.transpose() * (screw.point - X_LA.t);
    }
    const Vec3 motion = (h * (step.up ? -joint.rate() : joint.rate())) * screw.axis;
    screw.amount = rests ? 0 : roundedUp(h * rate);
    screw.tube = joint.tube();
    if (turns(joint.joint())) {
      w.angular += motion;
      w.linear += motion.cross(w.X_AB.t - screw.point);
    } else {
      screw.kind = ScrewMotion::Kind::prismatic;
      w.linear += motion;
    }
    if (joint.joint() == Frame::Joint::rotation) {
      ScrewMotion ball = screw;
      ball.kind = ScrewMotion::Kind::spherical;
      ball.amount = 0;
      screw.tube = 0;
      if (ball.tube != 0) path.screws.push_back(ball);
    }
    if (screw.amount != 0 || screw.deviation != 0 || screw.tube != 0) path.screws.push_back(screw);
  }
  w.screws = path.screws;
  w.speed = lengthFromAbove(w.linear);
  w.angle = lengthFromAbove(w.angular);
  // This factor covers the products of errors, which are below 2^-20 times the errors.
  constexpr double more = 1 + 0x1p-20;
  w.fixedError = roundedUp(more * (path.poseError.fixed + h * path.twistError.fixed)) + kLeastError;
  w.reachError = roundedUp(more * (path.poseError.reach + h * path.twistError.reach)) + kLeastError;
  return w;
}

bool EdgeMotion::ambiguous() const {
  return impl_->ambiguous;
}

bool EdgeMotion::still() const {
  return impl_->still;
}

}  // namespace corridor
