// Tests queries on trees of OBBs with every overlap test. Verdicts are decided exactly, by
// triangles, so all overlap tests must give the same verdicts.
#include <gtest/gtest.h>

#include "collision/queries/contacts.h"
#include "collision/queries/interference.h"
#include "collision/volumes/overlap_obb_obb_variants.h"
#include "tests/collision/hierarchy/volumes.h"
#include "tests/support/support.h"
#include "tests/support/workload.h"

namespace corridor {
namespace {

using test::kParams;

template <class Overlap>
class OverlapInterference : public testing::Test {};
using Overlaps = testing::Types<Gjk, LinearProgram, EdgeFace>;
struct OverlapNames {
  template <class Overlap>
  static std::string GetName(int) {
    return std::is_same_v<Overlap, Gjk>             ? "Gjk"
           : std::is_same_v<Overlap, LinearProgram> ? "LinearProgram"
                                                    : "EdgeFace";
  }
};
TYPED_TEST_SUITE(OverlapInterference, Overlaps, OverlapNames);

/// The counters must show that every overlap test prunes as well as the separating-axis test,
/// except for boxes that are apart by some 10^-15, as in e_touching_boxes.
TYPED_TEST(OverlapInterference, SharedWorkloads) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  std::size_t turn = 0;
  for (const std::string& name : test::workloadNames(*data / "collision")) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    QueryContext context, standard;
    ++turn;
    for (std::size_t v = 0; v < std::size(kParams); ++v) {
      const auto poses = test::posesInTurn(w, 3, v + turn, std::size(kParams));
      if (poses.empty()) continue;
      const ObbTree a(w.a, kParams[v]), b(w.b, kParams[v]);
      int wrong = 0;
      for (const std::size_t i : poses) {
        const bool hit = w.hit[i] == 1;
        wrong +=
            interference<TypeParam>(Posed(a), Posed(b, w.poses[i]), context).has_value() != hit;
        wrong += interference(Posed(a), Posed(b, w.poses[i]), standard).has_value() != hit;
      }
      EXPECT_EQ(wrong, 0) << name << ", " << test::str(kParams[v]);
    }
    const auto tests = static_cast<double>(context.counters.boxTests),
               expected = static_cast<double>(standard.counters.boxTests);
    EXPECT_NEAR(tests, expected, 0.05 * expected) << name;
  }
}

TYPED_TEST(OverlapInterference, ContactsAreTheSame) {
  const auto data = test::dataFolder();
  if (!data) GTEST_SKIP() << "set CORRIDOR_DATA to the folder of shared test data";
  for (const char* name : {"e_touching_boxes", "e_slivers"}) {
    const test::Workload w = test::loadWorkload(*data / "collision", name);
    const ObbTree a(w.a), b(w.b);
    QueryContext context;
    const auto pairs = [](const std::vector<TriangleContact>& all) {
      std::vector<std::pair<std::uint32_t, std::uint32_t>> numbers;
      for (const TriangleContact& c : all) numbers.emplace_back(c.a, c.b);
      return numbers;
    };
    for (std::size_t i = 0; i < w.poses.size(); i += 7)
      EXPECT_EQ(pairs(contacts<TypeParam>(Posed(a), Posed(b, w.poses[i]), context)),
                pairs(contacts(Posed(a), Posed(b, w.poses[i]), context)))
          << name << ", pose " << i;
  }
}

}  // namespace
}  // namespace corridor
