#include <cstdio>
#include <memory>
#include <vector>

extern "C" {
#include <libqhull_r/libqhull_r.h>
}

#include "collision/volumes/moments.h"

namespace corridor {
namespace {

/// One run of Qhull. The destructor frees the memory of Qhull. Qhull writes its messages to a FILE.
/// The messages are discarded, because every failure has the same consequence: there is no hull,
/// and another fit is used.
class QhullRun {
 public:
  explicit QhullRun(std::vector<double>& xyz) : sink_(std::fopen("/dev/null", "w"), &std::fclose) {
    if (!sink_) return;
    qh_zero(&qh_, sink_.get());
    char command[] = "qhull Qt";  // triangulated facets
    ok_ = qh_new_qhull(&qh_, 3, static_cast<int>(xyz.size() / 3), xyz.data(), False, command,
                       sink_.get(), sink_.get()) == 0;
    started_ = true;
  }
  ~QhullRun() {
    if (!started_) return;
    qh_freeqhull(&qh_, !qh_ALL);
    int curlong, totlong;
    qh_memfreeshort(&qh_, &curlong, &totlong);
  }
  QhullRun(const QhullRun&) = delete;
  QhullRun& operator=(const QhullRun&) = delete;

  bool ok() const { return ok_; }
  std::vector<Triangle> facets() {
    std::vector<Triangle> all;
    for (facetT* f = qh_.facet_list; f && f->next; f = f->next) {
      Triangle t;
      int n = 0;
      for (void** v = &f->vertices->e[0].p; *v && n < 3; ++v, ++n)
        t[n] = Eigen::Map<const Vec3>(static_cast<vertexT*>(*v)->point);
      if (n == 3) all.push_back(t);
    }
    return all;
  }

 private:
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> sink_;
  qhT qh_{};
  bool ok_ = false, started_ = false;
};

}  // namespace

Moments hullMoments(std::span<const Triangle> triangles) {
  if (triangles.size() < 2) return {};
  std::vector<double> xyz;
  xyz.reserve(9 * triangles.size());
  for (const Triangle& t : triangles)
    for (const Vec3& p : t) xyz.insert(xyz.end(), {p[0], p[1], p[2]});
  QhullRun hull(xyz);
  if (!hull.ok()) return {};
  const std::vector<Triangle> facets = hull.facets();
  return facets.size() < 4 ? Moments{} : surfaceMoments(facets);
}

}  // namespace corridor
