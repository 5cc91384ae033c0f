#include "planner/view/raster.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <zlib.h>

#include <Eigen/Geometry>

#include "planner/view/page_text.h"

namespace corridor::view {
namespace {

/// The image has kSamples times kSamples samples in each pixel.
constexpr int kSamples = 2;
/// The rows of samples that are drawn at a time, which limits the memory.
constexpr int kBand = 64;
/// Pixels of the image of an SVG along one pixel of the picture.
constexpr double kSvgDensity = 1.3;
const Vec3 kBackground(251, 250, 247);
constexpr double kFarthest = -std::numeric_limits<double>::infinity();

/// The nearest surface of one layer, for the samples of a band.
struct Layer {
  std::vector<double> depth;
  std::vector<const Surface*> nearest;
};

/// Returns the colour that a viewer sees at a sample: that of the nearest opaque surface, through
/// the surfaces of the other layers before it.
Vec3 colourAt(const std::vector<Layer>& layers, const std::vector<double>& opacities,
              std::size_t sample, std::vector<std::size_t>& before) {
  const Surface* const solid = layers[0].nearest[sample];
  Vec3 colour = solid ? solid->colour : kBackground;
  before.clear();
  for (std::size_t i = 1; i < layers.size(); ++i)
    if (layers[i].nearest[sample] && layers[i].depth[sample] > layers[0].depth[sample])
      before.push_back(i);
  std::sort(before.begin(), before.end(), [&](std::size_t a, std::size_t b) {
    return layers[a].depth[sample] < layers[b].depth[sample];
  });
  for (const std::size_t i : before)
    colour += opacities[i] * (layers[i].nearest[sample]->colour - colour);
  return colour;
}

void append(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 255);
}

void appendChunk(std::string& png, const std::string& name, const std::string& data) {
  append(png, static_cast<std::uint32_t>(data.size()));
  const std::string body = name + data;
  png += body;
  append(png, static_cast<std::uint32_t>(::crc32(0, reinterpret_cast<const Bytef*>(body.data()),
                                                 static_cast<uInt>(body.size()))));
}

}  // namespace

Surface makeSurface(const Camera& camera, const Triangle3& triangle, const Palette& palette,
                    std::size_t layer) {
  Vec3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]).stableNormalized();
  if (normal.dot(camera.towardsViewer()) < 0) normal = -normal;
  const double light = 0.15 + 0.85 * std::max(0.0, normal.dot(Vec3(0.35, -0.45, 0.82)));
  return {{camera.project(triangle[0]), camera.project(triangle[1]), camera.project(triangle[2])},
          palette.dark + light * (palette.light - palette.dark),
          layer};
}

void addLine(std::vector<Surface>& surfaces, std::span<const Vec3> points, double width,
             double depth, const Vec3& colour, std::size_t layer) {
  const auto add = [&](Vec3 a, Vec3 b, Vec3 c) {
    a.z() = b.z() = c.z() = depth;
    surfaces.push_back({{a, b, c}, colour, layer});
  };
  constexpr int kSides = 8;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3& p = points[i];
    const auto around = [&](int k) {
      const double angle = 2 * M_PI * k / kSides;
      return Vec3(p.x() + width / 2 * std::cos(angle), p.y() + width / 2 * std::sin(angle), 0);
    };
    for (int k = 1; k + 1 < kSides; ++k) add(around(0), around(k), around(k + 1));
    if (i == 0) continue;
    const Vec3& q = points[i - 1];
    const Eigen::Vector2d along = (p - q).head<2>();
    if (!(along.norm() > 0)) continue;
    const Vec3 side = width / 2 / along.norm() * Vec3(-along.y(), along.x(), 0);
    add(q + side, q - side, p + side);
    add(q - side, p - side, p + side);
  }
}

Image render(const Camera& camera, std::span<const Surface> surfaces,
             const std::vector<double>& opacities, int longest) {
  const double scale = longest / std::max(camera.width(), camera.height());
  const auto pixels = [&](double side) {
    return std::max(1, static_cast<int>(std::lround(scale * side)));
  };
  Image image{pixels(camera.width()), pixels(camera.height()), {}};
  image.rgb.reserve(std::size_t{3} * image.width * image.height);
  const int columns = kSamples * image.width, rows = kSamples * image.height;
  std::vector<Surface> scaled(surfaces.begin(), surfaces.end());
  for (Surface& surface : scaled)
    for (Vec3& corner : surface.corners) corner *= kSamples * scale;
  std::vector<Layer> layers(std::max<std::size_t>(1, opacities.size()));
  std::vector<std::size_t> before;
  for (int first = 0; first < rows; first += kBand) {
    const PixelGrid grid{columns, first, std::min(first + kBand, rows)};
    for (Layer& layer : layers) {
      layer.depth.assign(grid.size(), kFarthest);
      layer.nearest.assign(grid.size(), nullptr);
    }
    for (const Surface& surface : scaled) {
      Layer& layer = layers[surface.layer];
      grid.cover(surface.corners, [&](std::size_t sample, double depth) {
        if (depth <= layer.depth[sample]) return;
        layer.depth[sample] = depth;
        layer.nearest[sample] = &surface;
      });
    }
    for (int y = 0; y < grid.end - grid.begin; y += kSamples)
      for (int x = 0; x < columns; x += kSamples) {
        Vec3 sum = Vec3::Zero();
        for (int j = 0; j < kSamples; ++j)
          for (int i = 0; i < kSamples; ++i)
            sum += colourAt(layers, opacities, std::size_t(y + j) * columns + x + i, before);
        for (const double c : sum / (kSamples * kSamples))
          image.rgb += static_cast<char>(std::lround(std::clamp(c, 0.0, 255.0)));
      }
  }
  return image;
}

std::string pngOf(const Image& image) {
  // Each row begins with its filter, 2: a byte is the difference from that of the row above.
  const std::size_t row = std::size_t{3} * image.width;
  std::string filtered;
  filtered.reserve((row + 1) * image.height);
  for (std::size_t y = 0; y < std::size_t(image.height); ++y) {
    filtered += '\2';
    for (std::size_t i = y * row; i < (y + 1) * row; ++i)
      filtered += static_cast<char>(image.rgb[i] - (y > 0 ? image.rgb[i - row] : 0));
  }
  uLongf size = ::compressBound(static_cast<uLong>(filtered.size()));
  std::string packed(size, '\0');
  if (::compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
                  reinterpret_cast<const Bytef*>(filtered.data()),
                  static_cast<uLong>(filtered.size()), Z_BEST_COMPRESSION) != Z_OK)
    throw std::runtime_error("zlib can't compress a picture");
  packed.resize(size);
  std::string header;
  append(header, static_cast<std::uint32_t>(image.width));
  append(header, static_cast<std::uint32_t>(image.height));
  header.append({8, 2, 0, 0, 0});  // bits of a colour, RGB, and the only methods that there are
  std::string png = "\x89PNG\r\n\x1a\n";
  appendChunk(png, "IHDR", header);
  appendChunk(png, "IDAT", packed);
  appendChunk(png, "IEND", "");
  return png;
}

std::string svgHead(const Camera& camera, std::span<const Surface> surfaces,
                    const std::vector<double>& opacities) {
  const Image image =
      render(camera, surfaces, opacities,
             static_cast<int>(kSvgDensity * std::max(camera.width(), camera.height())));
  char head[320];
  std::snprintf(head, sizeof head,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" "
                "stroke-width=\".8\" stroke-linejoin=\"round\">\n"
                "<image width=\"%.0f\" height=\"%.0f\" preserveAspectRatio=\"none\" "
                "href=\"data:image/png;base64,",
                camera.width(), camera.height(), camera.width(), camera.height());
  return head + base64(pngOf(image)) + "\"/>\n";
}

}  // namespace corridor::view
