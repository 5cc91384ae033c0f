#include "planner/view/svg_faces.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

namespace corridor::view {
namespace {

/// The longest edge of a piece, pixels. Triangles with longer edges are cut into pieces, so that
/// the pieces can be sorted by depth.
constexpr double kPiece = 70;

/// Returns the faces with more than `least` visible pixels, farthest first.
std::vector<Face> visible(const Camera& camera, const std::vector<Face>& faces, int least) {
  DepthBuffer buffer(camera.width(), camera.height(), 1);
  for (std::size_t i = 0; i < faces.size(); ++i) buffer.draw(faces[i].corners, static_cast<int>(i));
  const std::vector<int> pixels = buffer.pixelsOf(static_cast<int>(faces.size()));
  std::vector<Face> kept;
  for (std::size_t i = 0; i < faces.size(); ++i)
    if (pixels[i] > least) kept.push_back(faces[i]);
  std::sort(kept.begin(), kept.end(),
            [](const Face& a, const Face& b) { return a.depth() < b.depth(); });
  return kept;
}

/// Returns SVG paths of faces, with coordinates in whole pixels. Consecutive faces of the same
/// palette and shade are in one path.
std::string draw(const std::vector<Face>& faces) {
  std::string svg;
  const Face* last = nullptr;
  for (const Face& face : faces) {
    if (!last || face.shade != last->shade || face.palette != last->palette) {
      if (last) svg += "\"/>\n";
      svg += std::string("<path class=\"") + face.palette + std::to_string(face.shade) + "\" d=\"";
    }
    last = &face;
    long x[3], y[3];
    for (int i = 0; i < 3; ++i) {
      x[i] = std::lround(face.corners[i].x());
      y[i] = std::lround(face.corners[i].y());
    }
    char text[96];
    std::snprintf(text, sizeof text, "M%ld %ldl%ld %ld %ld %ldz", x[0], y[0], x[1] - x[0],
                  y[1] - y[0], x[2] - x[1], y[2] - y[1]);
    svg += text;
  }
  return last ? svg + "\"/>\n" : svg;
}

}  // namespace

Face makeFace(const Camera& camera, const Triangle3& triangle, char palette) {
  Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).stableNormalized();
  if (normal.dot(camera.towardsViewer()) < 0) normal = -normal;
  const double light = std::max(0.0, normal.dot(Vec3(0.35, -0.45, 0.82)));
  Face face{{camera.project(triangle[0]), camera.project(triangle[1]), camera.project(triangle[2])},
            palette,
            0};
  face.shade = std::clamp(static_cast<int>((0.15 + 0.85 * light) * kShades), 0, kShades - 1);
  return face;
}

void cut(const Face& face, std::vector<Face>& pieces) {
  int longest = 0;
  double length = 0;
  for (int i = 0; i < 3; ++i) {
    const double l = (face.corners[(i + 1) % 3] - face.corners[i]).head<2>().norm();
    if (l > length) length = l, longest = i;
  }
  if (!(length > kPiece)) {
    pieces.push_back(face);
    return;
  }
  const int next = (longest + 1) % 3;
  const Vec3 middle = (face.corners[longest] + face.corners[next]) / 2;
  Face first = face, second = face;
  first.corners[next] = middle;
  second.corners[longest] = middle;
  cut(first, pieces);
  cut(second, pieces);
}

std::string drawVisible(const Camera& camera, const std::vector<Face>& faces, std::size_t limit) {
  for (int least = 0;; least = 2 * least + 1) {
    std::string svg = draw(visible(camera, faces, least));
    if (svg.size() <= limit || least > 2000) return svg;
  }
}

std::string palette(char name, const Vec3& dark, const Vec3& light) {
  std::string css;
  for (int i = 0; i < kShades; ++i) {
    const Vec3 c = dark + (light - dark) * i / (kShades - 1);
    char text[96];
    std::snprintf(text, sizeof text, ".%c%d{fill:#%02x%02x%02x;stroke:#%02x%02x%02x}\n", name, i,
                  int(c.x()), int(c.y()), int(c.z()), int(c.x()), int(c.y()), int(c.z()));
    css += text;
  }
  return css;
}

}  // namespace corridor::view
