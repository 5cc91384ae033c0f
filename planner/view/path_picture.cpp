#include "planner/view/path_picture.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <set>

#include <Eigen/Geometry>

#include "planner/view/raster.h"
#include "planner/view/tessellate.h"
#include "planner/view/tip_frames.h"

namespace corridor {
namespace {

using view::Camera;
using view::Palette;
using view::Surface;
using view::Triangle3;

constexpr double kWidth = 1000, kBorder = 20;  // sizes of the picture, pixels
/// Limits of the number of copies of the robots that are drawn between start and goal. The more
/// triangles a copy has, the fewer copies are drawn.
constexpr int kMostGhosts = 14, kFewestGhosts = 4;
/// The number of triangles of all copies between start and goal, apart from `kFewestGhosts`.
constexpr std::size_t kGhostTriangles = 160'000;
/// A moving shape with more than `kFewTriangles` triangles is drawn coarser, on a grid of cells.
/// The cells are enlarged, up to `kLargestCell`, until one copy of all moving bodies has at most
/// `kMostTriangles` triangles. Edge lengths of cells are fractions of the scene's diagonal.
constexpr std::size_t kFewTriangles = 500, kMostTriangles = 20'000;
constexpr double kCell = 1.0 / 500, kLargestCell = 1.0 / 60;

const Palette kWorld{{112, 118, 130}, {233, 232, 226}}, kHeld{{74, 96, 132}, {186, 202, 226}},
    kStart{{22, 110, 50}, {92, 214, 128}}, kGoal{{150, 28, 28}, {246, 108, 92}},
    kBetween{{150, 96, 20}, {255, 196, 84}};
/// The layers of a picture (view::Surface::layer) and their opacities. The copies of the robots
/// between start and goal have one layer each, from `kFirstGhost` on.
constexpr std::size_t kSolid = 0, kGlass = 1, kHalo = 2, kCurve = 3, kFirstGhost = 4;
constexpr double kGlassOpacity = 0.2, kHaloOpacity = 0.7, kGhostOpacity = 0.5;
/// Pixels by which robots are drawn nearer to the viewer than they are. So one that lies on the
/// ground is visible, and where links of several copies coincide, as shoulders do, the start is
/// seen. The surfaces of such links differ by up to a cell (`kCell`), because they are polyhedra.
constexpr double kNearer = 0.5, kGoalNearer = 2.5, kStartNearer = 4.5;

/// Returns the triangles of a body, in the coordinates of its frame. Triangles with the same
/// corners are returned once: many mesh files have both sides of every face.
/// @param cell the cell for view::coarsened, metres; 0: the mesh is not coarsened.
std::vector<Triangle3> distinctTriangles(const ModelBody& body, double cell) {
  std::set<std::array<std::array<double, 3>, 3>> seen;
  std::vector<Triangle3> triangles;
  for (const PlacedShape& shape : body.shapes) {
    TriangleMesh mesh = shape.mesh ? shape.mesh->mesh : view::partsSurface(shape);
    if (cell > 0 && mesh.triangles.size() > kFewTriangles) mesh = view::coarsened(mesh, cell);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      std::array<std::array<double, 3>, 3> key;
      Triangle3 triangle;
      for (int i = 0; i < 3; ++i) {
        triangle[i] = mesh.corner(t, i);
        key[i] = {triangle[i].x(), triangle[i].y(), triangle[i].z()};
      }
      std::sort(key.begin(), key.end());
      if (seen.insert(key).second) triangles.push_back(triangle);
    }
  }
  return triangles;
}

/// The triangles of all moving bodies, and for each triangle the frame that it is fixed to.
struct Moving {
  std::vector<Triangle3> triangles;
  std::vector<std::size_t> frames;
};

/// Returns the triangles of all moving bodies: at most `kMostTriangles`, if cells up to
/// `kLargestCell` are enough for that.
/// @param size the scene's diagonal, metres.
Moving movingBodies(const Problem& problem, double size) {
  const std::vector<std::size_t> movers = moversOf(problem.model.tree);
  for (double cell = kCell * size;; cell *= 1.25) {
    Moving moving;
    for (const ModelBody& body : problem.model.bodies) {
      if (movers[body.frame] == 0) continue;
      const std::vector<Triangle3> triangles = distinctTriangles(body, cell);
      moving.triangles.insert(moving.triangles.end(), triangles.begin(), triangles.end());
      moving.frames.insert(moving.frames.end(), triangles.size(), body.frame);
    }
    if (moving.triangles.size() <= kMostTriangles || !(cell < kLargestCell * size)) return moving;
  }
}

std::vector<Triangle3> placedAt(const Problem& problem, const Moving& moving,
                                const Configuration& q) {
  const std::vector<Transform> poses = framePoses(problem.model.tree, q);
  std::vector<Triangle3> placed = moving.triangles;
  for (std::size_t i = 0; i < placed.size(); ++i)
    for (Vec3& p : placed[i]) p = poses[moving.frames[i]] * p;
  return placed;
}

/// The triangles of all bodies that stand still, in world coordinates, and for each triangle its
/// body.
struct Standing {
  std::vector<Triangle3> triangles;
  std::vector<std::size_t> bodies;
};

/// @param size the scene's diagonal, metres.
Standing standingBodies(const Problem& problem, double size, const Configuration& q) {
  const std::vector<std::size_t> movers = moversOf(problem.model.tree);
  const std::vector<Transform> poses = framePoses(problem.model.tree, q);
  Standing standing;
  for (std::size_t b = 0; b < problem.model.bodies.size(); ++b) {
    const ModelBody& body = problem.model.bodies[b];
    if (movers[body.frame] != 0) continue;
    for (Triangle3 triangle : distinctTriangles(body, body.robot ? kCell * size : 0)) {
      for (Vec3& p : triangle) p = poses[body.frame] * p;
      standing.triangles.push_back(triangle);
      standing.bodies.push_back(b);
    }
  }
  return standing;
}

/// Returns the length of the diagonal of the box around all bodies in configuration q, metres.
double sceneSize(const Problem& problem, const Configuration& q) {
  const std::vector<Transform> poses = framePoses(problem.model.tree, q);
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const ModelBody& body : problem.model.bodies)
    for (const PlacedShape& shape : body.shapes)
      forEachPoint(shape, [&](const Vec3& p, double) {
        const Vec3 x = poses[body.frame] * p;
        low = low.cwiseMin(x);
        high = high.cwiseMax(x);
      });
  return (high - low).norm();
}

using PlaneKey = std::array<long, 5>;

/// Returns a key that is usually equal for triangles of one body in about the same plane. The key
/// is rounded: the unit normal to 0.01, the offset of the plane to 2 pixels.
PlaneKey planeOf(std::size_t body, const Triangle3& triangle, double pixel) {
  Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).stableNormalized();
  int largest = 0;
  normal.cwiseAbs().maxCoeff(&largest);
  if (normal[largest] < 0) normal = -normal;
  const Vec3 n = 100 * normal;
  return {static_cast<long>(body), std::lround(n.x()), std::lround(n.y()), std::lround(n.z()),
          std::lround(normal.dot(triangle[0]) / (2 * pixel))};
}

/// Returns `count` configurations that are evenly spaced along the path, start and end included.
/// The length of an edge is estimated: the largest distance that a corner moves, for some of the
/// triangles.
Path poses(const Problem& problem, const Moving& moving, const Path& path, int count) {
  Moving sample;
  const std::size_t stride = moving.triangles.size() / 64 + 1;
  for (std::size_t i = 0; i < moving.triangles.size(); i += stride) {
    sample.triangles.push_back(moving.triangles[i]);
    sample.frames.push_back(moving.frames[i]);
  }
  std::vector<double> at{0};
  for (std::size_t i = 1; i < path.size(); ++i) {
    const auto from = placedAt(problem, sample, path[i - 1]),
               to = placedAt(problem, sample, path[i]);
    double farthest = 0;
    for (std::size_t k = 0; k < from.size(); ++k)
      farthest = std::max(farthest, (to[k][0] - from[k][0]).norm());
    at.push_back(at.back() + farthest);
  }
  Path chosen{path.front()};
  for (int k = 1; k < count; ++k) {
    const double s = at.back() * k / count;
    const auto i = static_cast<std::size_t>(std::upper_bound(at.begin(), at.end(), s) - at.begin());
    if (i == 0 || i >= path.size()) continue;
    chosen.push_back(problem.model.space.interpolate(path[i - 1], path[i],
                                                     (s - at[i - 1]) / (at[i] - at[i - 1])));
  }
  chosen.push_back(path.back());
  return chosen;
}

/// Returns points of the curve on which the origin of a frame moves, in picture coordinates.
std::vector<Vec3> curveOf(const Camera& camera, const Problem& problem, const Path& path,
                          std::size_t frame) {
  constexpr int parts = 12;
  std::vector<Vec3> points;
  const auto add = [&](const Configuration& q) {
    points.push_back(camera.project(framePoses(problem.model.tree, q)[frame].t));
  };
  add(path.front());
  for (std::size_t i = 1; i < path.size(); ++i)
    for (int k = 1; k <= parts; ++k)
      add(problem.model.space.interpolate(path[i - 1], path[i], double(k) / parts));
  return points;
}

/// Returns a number with one decimal, in every locale.
std::string inTenths(double x) {
  const long tenths = std::lround(10 * x);
  return (tenths < 0 ? "-" : "") + std::to_string(std::abs(tenths) / 10) + '.' +
         std::to_string(std::abs(tenths) % 10);
}

/// Returns the SVG elements of a curve: a blue line with a white halo.
std::string polyline(const std::vector<Vec3>& curve) {
  std::string points;
  for (const Vec3& p : curve) {
    points += inTenths(p.x()) + ',' + inTenths(p.y()) + ' ';
  }
  return "<polyline points=\"" + points +
         "\" fill=\"none\" stroke=\"#fff\" stroke-width=\"5\" opacity=\".7\"/>\n" +
         "<polyline points=\"" + points +
         "\" fill=\"none\" stroke=\"#1f4e9e\" stroke-width=\"2\"/>\n";
}

/// Returns a number with four significant digits, in every locale.
std::string fourDigits(double x) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, x, std::chars_format::general, 4).ptr};
}

/// Returns an SVG text that states the duration, in the lower left corner of the picture.
std::string caption(const Camera& camera, double seconds) {
  char text[160];
  std::snprintf(text, sizeof text,
                "<text x=\"%.0f\" y=\"%.0f\" font-family=\"sans-serif\" font-size=\"20\" "
                "fill=\"#1f2730\">duration %s s</text>\n",
                kBorder, camera.height() - kBorder, fourDigits(seconds).c_str());
  return text;
}

/// Returns whether the problem plans only for the pose of one planar body. Such a problem is drawn
/// as seen from above.
bool isSeenFromAbove(const Problem& problem) {
  return problem.model.space.groups().size() == 1 &&
         problem.model.space.groups()[0].kind == CoordinateGroup::Kind::planar;
}

/// A picture of a path before it is drawn.
struct Drawing {
  Camera camera;
  std::vector<Surface> surfaces = {};
  std::vector<double> opacities = {};          ///< of the layers
  std::vector<std::vector<Vec3>> curves = {};  ///< in picture coordinates
};

/// For each sample of the picture, the depth of the nearest robot.
struct RobotDepths {
  explicit RobotDepths(const Camera& camera)
      : grid{static_cast<int>(camera.width() * kScale) + 1, 0,
             static_cast<int>(camera.height() * kScale) + 1},
        depths(grid.size(), -std::numeric_limits<double>::infinity()) {}

  template <class Visit>
  void cover(const Surface& surface, const Visit& visit) const {
    view::Corners corners = surface.corners;
    for (Vec3& corner : corners) corner.head<2>() *= kScale;
    grid.cover(corners, visit);
  }
  void add(const Surface& robot) {
    cover(robot, [&](std::size_t i, double depth) { depths[i] = std::max(depths[i], depth); });
  }
  /// Returns the number of samples in which a surface hides a robot.
  int hiddenBy(const Surface& surface) const {
    int count = 0;
    cover(surface, [&](std::size_t i, double depth) {
      count += std::isfinite(depths[i]) && depth > depths[i] + 1;
    });
    return count;
  }

  static constexpr double kScale = 0.5;  // samples along one pixel
  view::PixelGrid grid;
  std::vector<double> depths;
};

/// Adds the bodies that stand still. All triangles of a plane that hides robots are drawn like
/// glass.
/// @param above the height above which the picture of a plan is dark, metres; unset: no plan.
void addStanding(const Problem& problem, const Standing& standing, const RobotDepths& robots,
                 const std::optional<double>& above, Drawing& drawing) {
  std::vector<Surface> surfaces;
  std::map<PlaneKey, int> hides;  // for each plane, the samples in which it hides a robot
  const auto planeOfTriangle = [&](std::size_t i) {
    return planeOf(standing.bodies[i], standing.triangles[i], drawing.camera.worldPixel());
  };
  for (std::size_t i = 0; i < standing.triangles.size(); ++i) {
    const Triangle3& triangle = standing.triangles[i];
    const bool isHeld = problem.model.bodies[standing.bodies[i]].robot.has_value();
    Surface surface = makeSurface(drawing.camera, triangle, isHeld ? kHeld : kWorld);
    // Seen from above, the sides of walls are not visible, so walls look like the ground. Therefore
    // every triangle that reaches above the robot's lowest point is drawn dark.
    if (above)
      surface.colour = std::max({triangle[0].z(), triangle[1].z(), triangle[2].z()}) > *above
                           ? kWorld.dark
                           : kWorld.light;
    hides[planeOfTriangle(i)] += robots.hiddenBy(surface);
    surfaces.push_back(surface);
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    if (hides[planeOfTriangle(i)] > 3) surfaces[i].layer = kGlass;
    drawing.surfaces.push_back(surfaces[i]);
  }
}

Drawing drawingOf(const Problem& problem, const Path& path,
                  const std::optional<ViewDirection>& from) {
  constexpr double degree = std::numbers::pi / 180;
  const bool plan = !from && isSeenFromAbove(problem);
  const auto [azimuth, elevation] = from.value_or(plan ? ViewDirection{-90 * degree, 90 * degree}
                                                       : ViewDirection{-60 * degree, 38 * degree});
  Drawing drawing{Camera(azimuth, elevation)};
  const double size = sceneSize(problem, path.front());
  const Standing standing = standingBodies(problem, size, path.front());
  const Moving robot = movingBodies(problem, size);
  const int ghostCount =
      static_cast<int>(std::clamp(kGhostTriangles / (robot.triangles.size() + 1),
                                  std::size_t{kFewestGhosts}, std::size_t{kMostGhosts}));
  std::vector<std::vector<Triangle3>> placed;
  std::vector<Vec3> points;
  double feet = std::numeric_limits<double>::infinity();
  for (const Configuration& q : poses(problem, robot, path, ghostCount))
    for (const Triangle3& triangle : placed.emplace_back(placedAt(problem, robot, q)))
      for (const Vec3& p : triangle) {
        points.push_back(p);
        feet = std::min(feet, p.z());
      }
  for (const Triangle3& triangle : standing.triangles)
    points.insert(points.end(), triangle.begin(), triangle.end());
  drawing.camera.fit(points, kWidth, kBorder);

  drawing.opacities = {1, kGlassOpacity, kHaloOpacity, 1};
  RobotDepths robots(drawing.camera);
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const bool isStart = k == 0, isGoal = k > 0 && k + 1 == placed.size();
    if (!isStart && !isGoal) drawing.opacities.push_back(kGhostOpacity);
    const double nearer = isStart ? kStartNearer : isGoal ? kGoalNearer : kNearer;
    const std::size_t layer = isStart || isGoal ? kSolid : kFirstGhost + k - 1;
    for (const Triangle3& triangle : placed[k]) {
      Surface surface = makeSurface(drawing.camera, triangle,
                                    isStart  ? kStart
                                    : isGoal ? kGoal
                                             : kBetween,
                                    layer);
      robots.add(surface);
      for (Vec3& corner : surface.corners) corner.z() += nearer;
      drawing.surfaces.push_back(surface);
    }
  }
  addStanding(problem, standing, robots, plan ? std::optional(feet) : std::nullopt, drawing);
  for (const std::size_t frame : view::tipFrames(problem.model))
    drawing.curves.push_back(curveOf(drawing.camera, problem, path, frame));
  return drawing;
}

}  // namespace

std::string svgPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from,
                       const std::optional<double>& seconds) {
  const Drawing drawing = drawingOf(problem, path, from);
  std::string svg = svgHead(drawing.camera, drawing.surfaces, drawing.opacities);
  for (const std::vector<Vec3>& curve : drawing.curves) svg += polyline(curve);
  if (seconds) svg += caption(drawing.camera, *seconds);
  return svg + "</svg>\n";
}

std::string pngPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from, int longest) {
  Drawing drawing = drawingOf(problem, path, from);
  double nearest = 0;  // the depth of the nearest surface
  for (const Surface& surface : drawing.surfaces)
    for (const Vec3& corner : surface.corners) nearest = std::max(nearest, corner.z());
  for (const std::vector<Vec3>& curve : drawing.curves) {
    view::addLine(drawing.surfaces, curve, 5, nearest + 1, {255, 255, 255}, kHalo);
    view::addLine(drawing.surfaces, curve, 2, nearest + 2, {31, 78, 158}, kCurve);
  }
  return pngOf(render(drawing.camera, drawing.surfaces, drawing.opacities, longest));
}

}  // namespace corridor
