#include "planner/benchmark/campaign_shard.h"

#include <cassert>
#include <charconv>
#include <numeric>

namespace corridor {

bool CampaignShard::contains(std::size_t group, std::size_t groups, std::uint64_t seed) const {
  assert(count >= 1 && group < groups);
  // The basic rule: group g of seed i goes to the shard with the index (i·groups + g) mod count,
  // from 0. By this rule alone, group g would go only to shards s with s ≡ g (mod gcd(groups,
  // count)), and to each of them once in `period` seeds. So the order of the groups is rotated by
  // one after every period.
  const std::uint64_t period = count / std::gcd<std::uint64_t>(groups, count);
  const std::uint64_t turned = (group + seed / period) % groups;
  return (seed * groups + turned) % count == index - 1;
}

std::string text(const CampaignShard& shard) {
  return std::to_string(shard.index) + "/" + std::to_string(shard.count);
}

std::optional<CampaignShard> readShard(const std::string& text) {
  constexpr std::uint64_t kMost = 1'000'000;
  CampaignShard shard;
  const char* const end = text.data() + text.size();
  const auto slash = std::from_chars(text.data(), end, shard.index);
  if (slash.ec != std::errc{} || slash.ptr == end || *slash.ptr != '/') return std::nullopt;
  const auto last = std::from_chars(slash.ptr + 1, end, shard.count);
  if (last.ec != std::errc{} || last.ptr != end) return std::nullopt;
  if (shard.index < 1 || shard.index > shard.count || shard.count > kMost) return std::nullopt;
  return shard;
}

}  // namespace corridor
