#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace corridor {

/// A shard: a part of a campaign's runs, for machines that exchange no messages. The runs of a
/// campaign are dealt out to `count` shards, numbered from 1. This object is the shard `index`.
///
/// The runs are dealt out in groups. A group has the runs of all variants for one problem, planner
/// and seed, so that the runs that are compared with each other are made on one machine. Groups are
/// dealt in turn, seed by seed. So the sizes of the shards differ by at most one group. Divide the
/// seeds, from the campaign's first seed on, into successive blocks of `count` seeds. From each
/// full block, each shard gets exactly one group of each problem and planner. If the campaign gets
/// more seeds later, the earlier groups stay in their shards.
struct CampaignShard {
  std::uint64_t index = 1, count = 1;

  /// Returns whether a group belongs to this shard.
  /// @param group the index, from 0, of the combination of problem and planner. @param groups the
  /// number of these combinations, above `group`.
  /// @param seed the index of the seed, from 0.
  bool contains(std::size_t group, std::size_t groups, std::uint64_t seed) const;
};

/// "2/3"
std::string text(const CampaignShard& shard);
/// Reads a shard K/N, such as "2/3". Returns nullopt for any other text: K and N must be whole
/// numbers, with 1 ≤ K ≤ N ≤ 1,000,000.
std::optional<CampaignShard> readShard(const std::string& text);

}  // namespace corridor
