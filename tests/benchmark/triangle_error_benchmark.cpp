// Measures run time against error of the test whether two triangles touch. The methods are a
// textbook test in float and in double, our test (double with a filter, and integers if the filter
// can't decide), our test in integers only, and a test in rationals. They run on the shared pairs
// (CORRIDOR_DATA), and on pairs made by the families and placings of the stress tests
// (tests/support/triangle_families.h).
//
//   triangle_error_benchmark [PAIRS_PER_FAMILY, default 2000]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "collision/predicates/triangle_contact.h"
#include "tests/support/rational_contact.h"
#include "tests/support/support.h"
#include "tests/support/triangle_families.h"
#include "tests/support/triangle_pairs.h"

namespace corridor {
namespace {

// ---- Möller, "A fast triangle-triangle intersection test", JGT 2(2), 1997, without its epsilon
// ----

template <class Scalar>
struct Textbook {
  using Point = std::array<Scalar, 3>;
  using Corners = std::array<Point, 3>;

  static Point minus(const Point& p, const Point& q) {
    return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
  }
  static Scalar dot(const Point& p, const Point& q) {
    return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
  }
  static Point cross(const Point& p, const Point& q) {
    return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
  }
  static int largest(const Point& p) {
    const Scalar x = std::abs(p[0]), y = std::abs(p[1]), z = std::abs(p[2]);
    return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
  }

  static Corners mapped(const Triangle& t, const Transform& X) {
    Corners c;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i)
        c[k][i] = static_cast<Scalar>(X.m(i, 0)) * static_cast<Scalar>(t[k][0]) +
                  static_cast<Scalar>(X.m(i, 1)) * static_cast<Scalar>(t[k][1]) +
                  static_cast<Scalar>(X.m(i, 2)) * static_cast<Scalar>(t[k][2]) +
                  static_cast<Scalar>(X.t[i]);
    return c;
  }

  /// Returns the signed distances of t's corners from the plane of p, times the length of its
  /// normal n.
  static Point heights(const Corners& t, const Corners& p, const Point& n) {
    const Scalar d = -dot(n, p[0]);
    return {dot(n, t[0]) + d, dot(n, t[1]) + d, dot(n, t[2]) + d};
  }
  static bool oneSide(const Point& h) { return h[0] * h[1] > 0 && h[0] * h[2] > 0; }

  /// Computes the interval, along one coordinate, in which a triangle meets the common line of both
  /// planes. Returns false if the triangle lies in the plane of the other triangle.
  static bool interval(const Corners& t, const Point& h, int axis, Scalar& low, Scalar& high) {
    int alone = 2;
    if (h[0] * h[1] > 0)
      alone = 2;
    else if (h[0] * h[2] > 0)
      alone = 1;
    else if (h[1] * h[2] > 0 || h[0] != 0)
      alone = 0;
    else if (h[1] != 0)
      alone = 1;
    else if (h[2] == 0)
      return false;
    const int i = (alone + 1) % 3, j = (alone + 2) % 3;
    const Scalar x = t[alone][axis], hx = h[alone];
    low = x + (t[i][axis] - x) * hx / (hx - h[i]);
    high = x + (t[j][axis] - x) * hx / (hx - h[j]);
    if (low > high) std::swap(low, high);
    return true;
  }

  static bool edgesCross(const Point& p, const Point& q, const Point& r, const Point& s, int i,
                         int j) {
    const Scalar ax = q[i] - p[i], ay = q[j] - p[j], bx = r[i] - s[i], by = r[j] - s[j],
                 cx = p[i] - r[i], cy = p[j] - r[j];
    const Scalar f = ay * bx - ax * by, d = by * cx - bx * cy;
    if (!((f > 0 && d >= 0 && d <= f) || (f < 0 && d <= 0 && d >= f))) return false;
    const Scalar e = ax * cy - ay * cx;
    return f > 0 ? e >= 0 && e <= f : e <= 0 && e >= f;
  }
  static bool inside(const Point& p, const Corners& t, int i, int j) {
    Scalar side[3];
    for (int k = 0; k < 3; ++k) {
      const Point &q = t[k], &r = t[(k + 1) % 3];
      side[k] = (r[j] - q[j]) * (p[i] - q[i]) - (r[i] - q[i]) * (p[j] - q[j]);
    }
    return side[0] * side[1] > 0 && side[0] * side[2] > 0;
  }
  static bool coplanar(const Point& n, const Corners& a, const Corners& b) {
    const int drop = largest(n), i = drop == 0 ? 1 : 0, j = drop == 2 ? 1 : 2;
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l)
        if (edgesCross(a[k], a[(k + 1) % 3], b[l], b[(l + 1) % 3], i, j)) return true;
    return inside(a[0], b, i, j) || inside(b[0], a, i, j);
  }

  static bool touch(const Triangle& ta, const Transform& X_WA, const Triangle& tb,
                    const Transform& X_WB) {
    const Corners a = mapped(ta, X_WA), b = mapped(tb, X_WB);
    const Point m = cross(minus(b[1], b[0]), minus(b[2], b[0])), ha = heights(a, b, m);
    if (oneSide(ha)) return false;
    const Point n = cross(minus(a[1], a[0]), minus(a[2], a[0])), hb = heights(b, a, n);
    if (oneSide(hb)) return false;
    const int axis = largest(cross(n, m));
    Scalar lowA, highA, lowB, highB;
    if (!interval(a, ha, axis, lowA, highA) || !interval(b, hb, axis, lowB, highB))
      return coplanar(n, a, b);
    return !(highA < lowB || highB < lowA);
  }
};

// ---- measuring ----

struct Judged {
  test::PlacedPair pair;
  bool touch;
};
using Method = bool (*)(const test::PlacedPair&);

struct Named {
  const char* name;
  Method method;
  bool slow;
};
constexpr Named kMethods[] = {
    {"float",
     [](const test::PlacedPair& p) { return Textbook<float>::touch(p.a, p.X_WA, p.b, p.X_WB); },
     false},
    {"double",
     [](const test::PlacedPair& p) { return Textbook<double>::touch(p.a, p.X_WA, p.b, p.X_WB); },
     false},
    {"ours",
     [](const test::PlacedPair& p) { return trianglesTouch(p.a, p.X_WA, p.b, p.X_WB).holds; },
     false},
    {"integers",
     [](const test::PlacedPair& p) { return trianglesTouchExact(p.a, p.X_WA, p.b, p.X_WB); },
     false},
    {"rationals",
     [](const test::PlacedPair& p) { return test::rationalContact(p.a, p.X_WA, p.b, p.X_WB); },
     true}};

/// Returns the nanoseconds of processor time per pair, from one pass over all pairs, or over some
/// of them if the method is slow.
double nanoseconds(const Named& named, const std::vector<Judged>& pairs) {
  const std::size_t count = named.slow ? std::min<std::size_t>(200, pairs.size()) : pairs.size();
  int hits = 0;
  const std::clock_t start = std::clock();
  for (std::size_t i = 0; i < count; ++i) hits += named.method(pairs[i].pair);
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  volatile int sink = hits;
  (void)sink;
  return 1e9 * seconds / static_cast<double>(count);
}

/// Prints a line of the table: for each method the contacts missed, the false contacts, and the
/// median time of nine passes, in which the methods take turns.
void report(const std::string& name, const std::vector<Judged>& pairs) {
  std::array<std::array<double, 9>, std::size(kMethods)> times{};
  for (std::size_t pass = 0; pass < 9; ++pass)
    for (std::size_t m = 0; m < times.size(); ++m)
      if (pass == 0 || !kMethods[m].slow)
        times[m][pass] = nanoseconds(kMethods[m], pairs);
      else
        times[m][pass] = times[m][0];
  const auto touching =
      std::count_if(pairs.begin(), pairs.end(), [](const Judged& j) { return j.touch; });
  std::printf("| %s | %zu | %td |", name.c_str(), pairs.size(), touching);
  for (std::size_t m = 0; m < times.size(); ++m) {
    int missed = 0, wrong = 0;
    for (const Judged& judged : pairs) {
      const bool answer = kMethods[m].method(judged.pair);
      missed += judged.touch && !answer;
      wrong += answer && !judged.touch;
    }
    std::sort(times[m].begin(), times[m].end());
    std::printf(" %d, %d, %.0f |", missed, wrong, times[m][4]);
  }
  std::printf("\n");
  std::fflush(stdout);
}

int run(int count) {
  std::printf("| pairs | number | touching |");
  for (const Named& named : kMethods) std::printf(" %s |", named.name);
  std::printf("\n|---|---|---|---|---|---|---|---|\n");
  if (const auto data = test::dataFolder()) {
    for (const auto& [name, known] : test::sharedPairs(*data / "collision")) {
      std::vector<Judged> pairs;
      for (const auto& [a, b, touch] : known) pairs.push_back({{a, b, {}, {}}, touch});
      report(name, pairs);
    }
  } else {
    std::fprintf(stderr, "skipped: the shared pairs (set CORRIDOR_DATA)\n");
  }
  std::mt19937_64 random(20261121);
  const auto add = [&](std::vector<Judged>& pairs, const test::PairFamily& family,
                       const test::PairPlacing& placing) {
    Triangle a, b;
    family.make(random, a, b);
    const test::PlacedPair p = placing.place(random, a, b);
    pairs.push_back({p, test::rationalContact(p.a, p.X_WA, p.b, p.X_WB)});
  };
  const auto families = test::pairFamilies();
  const auto placings = test::pairPlacings();
  for (const test::PairFamily& family : families) {
    std::vector<Judged> pairs;
    for (int n = 0; n < count; ++n) add(pairs, family, placings[0]);
    report(family.name, pairs);
  }
  for (const test::PairPlacing& placing : placings.subspan(1)) {
    std::vector<Judged> pairs;
    for (int n = 0; n < count; ++n) add(pairs, families[random() % families.size()], placing);
    report(std::string("all of these, ") + placing.name, pairs);
  }
  return 0;
}

}  // namespace
}  // namespace corridor

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 2000;
  if (count < 1) {
    std::fprintf(stderr, "usage: triangle_error_benchmark [PAIRS_PER_FAMILY]\n");
    return 2;
  }
  std::printf("For each method: contacts missed, false contacts, ns per pair.\n\n");
  return corridor::run(count);
}
