// Tests of how the runs of a campaign are dealt out to shards: each run belongs to exactly one
// shard, and all shards have equal parts.
#include "planner/benchmark/campaign_shard.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

namespace corridor {
namespace {

TEST(CampaignShard, TextsReadBack) {
  for (const char* word : {"1/1", "2/3", "64/64", "1000000/1000000"}) {
    const auto shard = readShard(word);
    ASSERT_TRUE(shard) << word;
    EXPECT_EQ(text(*shard), word);
  }
  for (const char* word : {"", "1", "/", "1/", "/2", "0/2", "3/2", "1/0", "-1/2", "1/2/3", "1/2 ",
                           " 1/2", "a/b", "1.5/2", "1/1000001", "99999999999999999999/2"})
    EXPECT_FALSE(readShard(word)) << word;
}

TEST(CampaignShard, DealsEachRunOnceAndFairly) {
  for (std::size_t groups = 1; groups <= 24; ++groups)
    for (std::uint64_t count = 1; count <= 24; ++count) {
      SCOPED_TRACE(std::to_string(groups) + " groups, " + std::to_string(count) + " shards");
      const std::uint64_t seeds = 3 * count + 2;
      std::vector<std::uint64_t> runs(count, 0);
      std::vector<std::vector<std::uint64_t>> ofGroup(count, std::vector<std::uint64_t>(groups, 0));
      for (std::uint64_t seed = 0; seed < seeds; ++seed) {
        for (std::size_t group = 0; group < groups; ++group) {
          int owners = 0;
          for (std::uint64_t k = 1; k <= count; ++k) {
            if (!CampaignShard{k, count}.contains(group, groups, seed)) continue;
            ++owners, ++runs[k - 1], ++ofGroup[k - 1][group];
          }
          ASSERT_EQ(owners, 1);
        }
        const auto [least, most] = std::minmax_element(runs.begin(), runs.end());
        ASSERT_LE(*most - *least, 1u) << "after " << seed + 1 << " seeds";
        if ((seed + 1) % count != 0) continue;
        for (const auto& each : ofGroup)  // the same mix of problems and planners for all
          for (const std::uint64_t n : each) ASSERT_EQ(n, (seed + 1) / count);
      }
    }
}

}  // namespace
}  // namespace corridor
