#include "planner/view/volume_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "collision/convex/convex_polygon.h"
#include "collision/convex/quickhull.h"
#include "collision/hierarchy/obb4_tree.h"
#include "collision/hierarchy/with_trees.h"
#include "planner/view/raster.h"
#include "planner/view/tessellate.h"
#include "planner/view/volume_outline.h"

namespace corridor {
namespace {

using view::Camera;
using view::Surface;

constexpr double kPictureWidth = 640, kPictureBorder = 12;  // sizes of the picture, pixels
/// The limit of the length of the SVG text of all volumes together, bytes.
constexpr std::size_t kVolumesLimit = 40'000;
/// A line is drawn between two faces of a volume whose normals differ by more than this angle.
constexpr double kCrease = 12 * std::numbers::pi / 180;

/// The volumes of a level as convex parts, and the number of levels of the tree.
struct Level {
  std::vector<ConvexPart> volumes;
  std::size_t levels = 0;
};

/// Returns the volumes of a level, and of the leaves above it.
/// @param items a list with the root only. @param below returns the children of an item. @param
/// part returns the volume of an item.
template <class Item, class Below, class Part>
Level levelOf(std::vector<Item> items, std::size_t level, const Below& below, const Part& part) {
  std::vector<std::vector<Item>> all;
  std::vector<Item> leaves;
  while (!items.empty()) {
    std::vector<Item> next;
    for (const Item& item : items) {
      const std::vector<Item> children = below(item);
      next.insert(next.end(), children.begin(), children.end());
    }
    all.push_back(std::exchange(items, std::move(next)));
  }
  Level found{{}, all.size()};
  const std::size_t last = std::min(level, all.size() - 1);
  for (std::size_t i = 0; i <= last; ++i)
    for (const Item& item : all[i])
      if (i == last || below(item).empty()) found.volumes.push_back(part(item));
  return found;
}

template <class Volume>
Level levelOf(const VolumeTree<Volume>& tree, std::size_t level) {
  const auto below = [&](std::uint32_t i) {
    std::vector<std::uint32_t> children;
    if (!tree.node(i).isLeaf()) children = {i + 1, tree.node(i).right};
    return children;
  };
  return levelOf(std::vector<std::uint32_t>{0}, level, below,
                 [&](std::uint32_t i) { return view::outline(tree.node(i).box); });
}

Level levelOf(const Obb4Tree& tree, std::size_t level) {
  struct Item {
    Obb1 box;
    std::uint32_t child;
  };
  const auto below = [&](const Item& item) {
    std::vector<Item> children;
    if (Obb4Tree::isLeaf(item.child)) return children;
    const Obb4Tree::Node& node = tree.nodes()[item.child];
    for (std::uint32_t lane = 0; lane < Obb4Tree::kWidth; ++lane)
      if (node.child[lane] != Obb4Tree::kNone)
        children.push_back({boxOf(node, lane), node.child[lane]});
    return children;
  };
  const auto part = [&](const Item& item) {
    Obb box;
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) box.axes(k, j) = item.box.vectors[k][j];
      box.center[k] = item.box.vectors[k][Obb4::kCenter] * tree.length() + tree.origin()[k];
      box.half[k] = item.box.half[k] * tree.length();
    }
    return view::outline(box);
  };
  return levelOf(std::vector<Item>{{tree.root(), 0}}, level, below, part);
}

Level levelOf(const TriangleMesh& mesh, const TreeNames& words, std::size_t level) {
  const TreeChoice choice = treesNamed(words);
  if (choice.trees == TreeKind::obb4) return levelOf(Obb4Tree(mesh, choice.params.fit), level);
  return withVolume(choice.trees, [&]<class Volume, class Overlap>() {
    return levelOf(VolumeTree<Volume>(mesh, choice.params), level);
  });
}

/// Returns the corners of the convex hull of the projected points, in whole pixels. If the hull is
/// a line, returns its ends.
std::vector<Vec2> silhouette(const Camera& camera, const std::vector<Vec3>& points) {
  std::vector<Vec2> seen;
  for (const Vec3& x : points) seen.emplace_back(camera.project(x).head<2>().array().round());
  const auto isBefore = [](const Vec2& p, const Vec2& q) {
    return std::pair(p.x(), p.y()) < std::pair(q.x(), q.y());
  };
  const auto [first, last] = std::minmax_element(seen.begin(), seen.end(), isBefore);
  const bool isLine =
      std::all_of(seen.begin(), seen.end(),
                  [&, p = *first, q = *last](const Vec2& r) { return lineSide(p, q, r) == 0; });
  if (isLine) return {*first, *last};
  const ConvexPolygon hull(seen);
  return {hull.vertices().begin(), hull.vertices().end()};
}

/// Returns an SVG path of the visible edges of the points' convex hull. It has the edges between
/// two faces whose normals differ by more than `kCrease`.
std::string creases(const Camera& camera, const std::vector<Vec3>& points) {
  std::map<std::array<std::uint32_t, 2>, Vec3> normals;
  std::string path;
  for (const auto& face : quickhull(points)) {
    const Vec3 n = (points[face[1]] - points[face[0]])
                       .cross(points[face[2]] - points[face[0]])
                       .stableNormalized();
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = face[i], b = face[(i + 1) % 3];
      const auto other = normals.find({b, a});
      if (other == normals.end()) {
        normals[{a, b}] = n;
        continue;
      }
      const double front =
          std::max(n.dot(camera.towardsViewer()), other->second.dot(camera.towardsViewer()));
      if (front <= 0 || n.dot(other->second) > std::cos(kCrease)) continue;
      const Vec3 from = camera.project(points[a]), to = camera.project(points[b]);
      char text[96];
      std::snprintf(text, sizeof text, "M%ld %ldL%ld %ld", std::lround(from.x()),
                    std::lround(from.y()), std::lround(to.x()), std::lround(to.y()));
      path += text;
    }
  }
  return path;
}

/// Returns the SVG elements of one volume: its silhouette, filled like glass, and its visible
/// edges.
std::string draw(const Camera& camera, const ConvexPart& volume, std::size_t number) {
  const bool round = volume.radius > 0;
  const std::vector<Vec3> points = round ? view::tessellated(volume).vertices : volume.points;
  static const std::array<const char*, 6> colours = {"#2f6fbf", "#c2552d", "#3d8f4e",
                                                     "#8a4fae", "#b8860b", "#20868c"};
  std::string path;
  for (const Vec2& p : silhouette(camera, points))
    path += (path.empty() ? "M" : "L") + std::to_string(std::lround(p.x())) + " " +
            std::to_string(std::lround(p.y()));
  const char* colour = colours[number % colours.size()];
  std::string svg = std::string("<path fill=\"") + colour + "\" stroke=\"" + colour + "\" d=\"" +
                    path + "z\"/>\n";
  if (const std::string lines = round ? "" : creases(camera, points); !lines.empty())
    svg += std::string("<path fill=\"none\" stroke=\"") + colour + "\" d=\"" + lines + "\"/>\n";
  return svg;
}

}  // namespace

VolumePicture volumePicture(const TriangleMesh& mesh, const TreeNames& trees, std::size_t level,
                            const std::optional<ViewDirection>& from) {
  constexpr double degree = std::numbers::pi / 180;
  const auto [azimuth, elevation] = from.value_or(ViewDirection{-60 * degree, 38 * degree});
  Camera camera(azimuth, elevation);
  const Level found = levelOf(mesh, trees, level);
  std::vector<Vec3> points = mesh.vertices;
  for (const ConvexPart& volume : found.volumes) {
    const std::vector<Vec3> own =
        volume.radius > 0 ? view::tessellated(volume).vertices : volume.points;
    points.insert(points.end(), own.begin(), own.end());
  }
  camera.fit(points, kPictureWidth, kPictureBorder);
  std::vector<Surface> surfaces;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    surfaces.push_back(makeSurface(camera,
                                   {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)},
                                   {{112, 118, 130}, {233, 232, 226}}));
  const std::string svg =
      svgHead(camera, surfaces, {}) + "<g fill-opacity=\".13\" stroke-width=\"1\">\n";
  // The farthest volumes are drawn first. The index of a volume on the level determines its colour,
  // so that neighbours differ.
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < found.volumes.size(); ++i) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : found.volumes[i].points) sum += p;
    sum /= static_cast<double>(found.volumes[i].points.size());
    order.emplace_back(sum.dot(camera.towardsViewer()), i);
  }
  std::sort(order.begin(), order.end());
  VolumePicture picture{"", 0, found.volumes.size(), found.levels};
  std::string volumes;
  for (auto at = order.rbegin(); at != order.rend() && volumes.size() < kVolumesLimit; ++at) {
    // The loop goes from near to far. Each volume is inserted before those that are nearer.
    volumes.insert(0, draw(camera, found.volumes[at->second], at->second));
    ++picture.drawn;
  }
  picture.svg = svg + volumes + "</g>\n</svg>\n";
  return picture;
}

}  // namespace corridor
