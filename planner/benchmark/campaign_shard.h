#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace corridor {

/// A shard: a part of a campaign's runs, for machines that exchange no messages. It is number
/// `index`, from 1, of `count` shards.
///
/// The runs are dealt out in groups. A group has the runs of all variants for one problem, planner
/// and seed, so that one machine measures all that is compared. Groups are dealt in turn, seed by
/// seed. So the sizes of the shards differ by at most one group. Take any `count` successive seeds
/// of which the first is the campaign's first seed plus a multiple of `count`: from these, each
/// shard gets exactly one group of each problem and planner. If the campaign gets more seeds later,
/// the earlier groups stay in their shards.
struct CampaignShard {
  std::uint64_t index = 1, count = 1;

  /// Returns whether a group belongs to this shard.
  /// @param group the index, from 0, of the combination of problem and planner. @param groups the
  /// number of these combinations.
  /// @param seed the index of the seed, from 0.
  bool contains(std::size_t group, std::size_t groups, std::uint64_t seed) const;
};

/// "2/3"
std::string text(const CampaignShard& shard);
/// Reads "2/3"; nullopt if the text is no shard: K and N are whole numbers, 1 ≤ K ≤ N ≤ 1,000,000.
std::optional<CampaignShard> readShard(const std::string& text);

}  // namespace corridor
