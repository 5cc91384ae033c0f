#pragma once

#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "planner/robot/configuration_space.h"

namespace corridor {

/// Returns whether the edge between two configurations is free.
using EdgeTest = std::function<bool(const Configuration& from, const Configuration& to)>;

/// Remembers the answers of an edge test, so that no edge is tested twice. Two edges are the same
/// if both have the same first and the same last configuration, number for number.
class EdgeMemory {
 public:
  explicit EdgeMemory(EdgeTest isFree) : isFree_(std::move(isFree)) {}

  /// Returns whether an edge is free. Tests it if the answer is not known.
  bool isFree(const Configuration& from, const Configuration& to) {
    const auto [edge, isNew] = answers_.try_emplace(keyOf(from, to), false);
    if (isNew) edge->second = isFree_(from, to);
    return edge->second;
  }
  /// Remembers that an edge is free, because another test has proved it.
  void addFree(const Configuration& from, const Configuration& to) {
    answers_[keyOf(from, to)] = true;
  }
  /// Returns whether an edge is known to be free. Tests nothing.
  bool knowsFree(const Configuration& from, const Configuration& to) const {
    const auto edge = answers_.find(keyOf(from, to));
    return edge != answers_.end() && edge->second;
  }

 private:
  using Numbers = std::vector<double>;
  static std::pair<Numbers, Numbers> keyOf(const Configuration& from, const Configuration& to) {
    return {Numbers(from.data(), from.data() + from.size()),
            Numbers(to.data(), to.data() + to.size())};
  }

  EdgeTest isFree_;
  std::map<std::pair<Numbers, Numbers>, bool> answers_;
};

}  // namespace corridor
