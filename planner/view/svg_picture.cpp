#include "planner/view/svg_picture.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "planner/view/projection.h"
#include "planner/view/svg_faces.h"
#include "planner/view/tessellate.h"
#include "planner/view/tip_frames.h"

namespace corridor {
namespace {

using view::Camera;
using view::DepthBuffer;
using view::Face;
using view::kShades;
using view::palette;
using view::Triangle3;

constexpr double kWidth = 1000, kBorder = 20;  // sizes of the picture, pixels
/// Limits of the number of copies of the robots that are drawn between start and goal. The more
/// triangles a copy has, the fewer copies are drawn.
constexpr int kMostGhosts = 14, kFewestGhosts = 4;
/// Limits of the length of the SVG text, in bytes: of the bodies that stand still, of one copy of
/// the robots, and of all copies between start and goal.
constexpr std::size_t kWorldLimit = 220'000, kRobotLimit = 60'000, kGhostsLimit = 180'000;
/// A moving shape with more than `kFewTriangles` triangles is drawn coarser, on a grid of cells.
/// The cells are enlarged, up to `kLargestCell`, until one copy of all moving bodies has at most
/// `kMostTriangles` triangles. Edge lengths of cells are fractions of the scene's diagonal.
constexpr std::size_t kFewTriangles = 500, kMostTriangles = 5000;
constexpr double kCell = 1.0 / 250, kLargestCell = 1.0 / 60;

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

/// Returns an SVG polyline along the curve on which the origin of a frame moves.
std::string polyline(const Camera& camera, const Problem& problem, const Path& path,
                     std::size_t frame) {
  constexpr int parts = 12;
  std::string points;
  const auto add = [&](const Configuration& q) {
    const Vec3 p = camera.project(framePoses(problem.model.tree, q)[frame].t);
    char text[48];
    std::snprintf(text, sizeof text, "%.1f,%.1f ", p.x(), p.y());
    points += text;
  };
  add(path.front());
  for (std::size_t i = 1; i < path.size(); ++i)
    for (int k = 1; k <= parts; ++k)
      add(problem.model.space.interpolate(path[i - 1], path[i], double(k) / parts));
  return "<polyline points=\"" + points +
         "\" fill=\"none\" stroke=\"#fff\" stroke-width=\"5\" opacity=\".7\"/>\n" +
         "<polyline points=\"" + points +
         "\" fill=\"none\" stroke=\"#1f4e9e\" stroke-width=\"2\"/>\n";
}

/// Returns an SVG text that states the duration, in the lower left corner of the picture.
std::string caption(const Camera& camera, double seconds) {
  char text[160];
  std::snprintf(text, sizeof text,
                "<text x=\"%.0f\" y=\"%.0f\" font-family=\"sans-serif\" font-size=\"20\" "
                "fill=\"#1f2730\">duration %.4g s</text>\n",
                kBorder, camera.height() - kBorder, seconds);
  return text;
}

/// Returns whether the problem plans only for the pose of one planar body. Such a problem is drawn
/// as seen from above.
bool isSeenFromAbove(const Problem& problem) {
  return problem.model.space.groups().size() == 1 &&
         problem.model.space.groups()[0].kind == CoordinateGroup::Kind::planar;
}

}  // namespace

std::string svgPicture(const Problem& problem, const Path& path,
                       const std::optional<ViewDirection>& from,
                       const std::optional<double>& seconds) {
  constexpr double degree = std::numbers::pi / 180;
  const bool plan = !from && isSeenFromAbove(problem);
  const auto [azimuth, elevation] = from.value_or(plan ? ViewDirection{-90 * degree, 90 * degree}
                                                       : ViewDirection{-60 * degree, 38 * degree});
  Camera camera(azimuth, elevation);
  const double size = sceneSize(problem, path.front());
  const auto [world, worldBodies] = standingBodies(problem, size, path.front());
  const Moving robot = movingBodies(problem, size);
  // About half of a robot's triangles are visible, at about 28 bytes each: 14 bytes per triangle.
  const int ghostCount =
      static_cast<int>(std::clamp(kGhostsLimit / (14 * robot.triangles.size() + 1),
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
  for (const auto& triangle : world) points.insert(points.end(), triangle.begin(), triangle.end());
  camera.fit(points, kWidth, kBorder);

  DepthBuffer robots(camera.width(), camera.height(), 0.5);
  std::vector<std::vector<Face>> ghosts;
  for (const auto& copy : placed) {
    auto& faces = ghosts.emplace_back();
    const char palette = ghosts.size() == 1 ? 's' : ghosts.size() == placed.size() ? 'g' : 'r';
    for (const auto& triangle : copy) faces.push_back(makeFace(camera, triangle, palette));
    for (const Face& face : faces) robots.draw(face.corners, 0);
  }
  std::vector<Face> faces;
  // For each plane, the number of pixels of robots that it hides. All triangles of a wall are drawn
  // alike: transparent or solid.
  std::map<PlaneKey, int> hides;
  for (std::size_t i = 0; i < world.size(); ++i) {
    const Triangle3& triangle = world[i];
    faces.push_back(
        makeFace(camera, triangle, problem.model.bodies[worldBodies[i]].robot ? 'f' : 'w'));
    // Seen from above, the sides of walls are not visible, so walls look like the ground. Therefore
    // every triangle that reaches above the robot's lowest point is drawn dark.
    if (plan)
      faces.back().shade =
          std::max({triangle[0].z(), triangle[1].z(), triangle[2].z()}) > feet ? 1 : kShades - 1;
    int& count = hides[planeOf(worldBodies[i], triangle, camera.worldPixel())];
    robots.cover(faces.back().corners, [&](std::size_t pixel, double depth) {
      count += std::isfinite(robots.depth(pixel)) && depth > robots.depth(pixel) + 1;
    });
  }
  std::vector<Face> solid, glass;
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (hides[planeOf(worldBodies[i], world[i], camera.worldPixel())] > 3)
      glass.push_back(faces[i]);
    else
      cut(faces[i], solid);
  }

  char head[256];
  std::snprintf(head, sizeof head,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
                "stroke-width=\".8\" stroke-linejoin=\"round\">\n",
                camera.width(), camera.height());
  std::string svg =
      std::string(head) + "<style>\n" + palette('w', {112, 118, 130}, {233, 232, 226}) +
      palette('f', {74, 96, 132}, {186, 202, 226}) + palette('r', {150, 96, 20}, {255, 196, 84}) +
      palette('s', {22, 110, 50}, {92, 214, 128}) + palette('g', {150, 28, 28}, {246, 108, 92}) +
      "</style>\n<rect width=\"100%\" height=\"100%\" fill=\"#fbfaf7\"/>\n";
  svg += drawVisible(camera, solid, kWorldLimit);
  for (std::size_t i = 1; i + 1 < ghosts.size(); ++i)
    svg += "<g opacity=\".5\">\n" + drawVisible(camera, ghosts[i], kRobotLimit) + "</g>\n";
  if (ghosts.size() > 1) svg += drawVisible(camera, ghosts.back(), kRobotLimit);
  svg += drawVisible(camera, ghosts.front(), kRobotLimit);
  svg += "<g opacity=\".2\">\n" + drawVisible(camera, glass, kWorldLimit / 4) + "</g>\n";
  for (const std::size_t frame : view::tipFrames(problem.model))
    svg += polyline(camera, problem, path, frame);
  if (seconds) svg += caption(camera, *seconds);
  return svg + "</svg>\n";
}

}  // namespace corridor
