/// Measures how thick a bounding volume is around a patch of a curved surface, as the patch gets
/// smaller: `thickness_benchmark [--orientations N]`.
///
/// The slides on OBBTrees explain parallel close proximity by this thickness: it is quadratic in
/// the patch's size for OBBs, and linear for AABBs and spheres. The patch is a piece of the unit
/// sphere, s × s radians, of 2·24² triangles, in N random orientations (default 201). The volumes
/// are fitted as a tree fits those of its nodes.
///
/// The thickness is the least extent of the volume: of a box the shortest edge, of a sphere the
/// diameter, of an RSS the least of its extents along its three axes, and of a k-DOP the distance
/// between the planes of its thinnest slab.
///
/// Prints CSV on stdout: for each volume the median thickness for each s, and the slope of log
/// thickness over log s.
#include <algorithm>
#include <iostream>
#include <random>
#include <string>
#include <vector>

#include "collision/core/quantiles.h"
#include "collision/volumes/aabb.h"
#include "collision/volumes/bounding_sphere.h"
#include "collision/volumes/kdop.h"
#include "collision/volumes/obb.h"
#include "collision/volumes/rss.h"
#include "tests/benchmark/arguments.h"
#include "tests/benchmark/plot.h"
#include "tests/benchmark/shapes.h"

namespace corridor {
namespace {

using namespace bench;

const std::vector<double> kSizes = {0.4, 0.2, 0.1, 0.05, 0.02, 0.01};

/// Returns the patch of s × s radians around the point R·(0, 0, 1) of the unit sphere.
std::vector<Triangle> patch(double s, const Mat3& R) {
  constexpr int cells = 24;
  const auto at = [&](int i, int k) -> Vec3 {
    const double u = s * (i / double{cells} - 0.5), v = s * (k / double{cells} - 0.5);
    return R * Vec3(std::sin(u), std::cos(u) * std::sin(v), std::cos(u) * std::cos(v));
  };
  std::vector<Triangle> triangles;
  for (int i = 0; i < cells; ++i)
    for (int k = 0; k < cells; ++k) {
      triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  return triangles;
}

double thickness(const Obb& box) {
  return 2 * box.half.minCoeff();
}
double thickness(const Aabb& box) {
  return 2 * box.half.minCoeff();
}
double thickness(const BoundingSphere& sphere) {
  return 2 * sphere.size;
}
double thickness(const Rss& rss) {
  return 2 * (rss.core.half.minCoeff() + rss.size);
}
template <int K>
double thickness(const Kdop<K>& kdop) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < K / 2; ++i)
    least = std::min(least, (kdop.high[i] - kdop.low[i]) / slabDirections<K>()[i].norm());
  return least;
}

template <class Volume>
void measure(const std::string& name, const std::vector<Mat3>& orientations) {
  std::vector<PlotPoint> medians;
  std::cout << name;
  for (const double s : kSizes) {
    std::vector<double> all;
    for (const Mat3& R : orientations) {
      const std::vector<Triangle> triangles = patch(s, R);
      const Content content(triangles);
      const Mat3 axes =
          Volume::kOriented ? fitFrame(content, ObbFit::triangles).axes : Mat3::Identity();
      all.push_back(thickness(Volume::around(enclosingObb(content, axes), content)));
    }
    medians.push_back({s, medianOf(all)});
    std::cout << ',' << text(medians.back().y);
  }
  std::cout << ',' << text(logSlope(medians)) << std::endl;
}

void run(const Arguments& arguments) {
  std::mt19937_64 random(1996);
  std::vector<Mat3> orientations(static_cast<std::size_t>(arguments.number("--orientations", 201)));
  for (Mat3& R : orientations) R = randomRotation(random);
  std::cout << "volume";
  for (const double s : kSizes) std::cout << ',' << s;
  std::cout << ",slope\n";
  measure<Obb>("obb", orientations);
  measure<Rss>("rss", orientations);
  measure<Kdop<26>>("kdop26", orientations);
  measure<Kdop<18>>("kdop18", orientations);
  measure<Kdop<14>>("kdop14", orientations);
  measure<Aabb>("aabb", orientations);
  measure<BoundingSphere>("sphere", orientations);
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  return corridor::bench::runWith(argc, argv, {"--orientations"}, corridor::run);
}
