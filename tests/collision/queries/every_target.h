#pragma once

#include <cstdint>
#include <hwy/highway.h>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace corridor::test {

/// Returns the SIMD targets (instruction sets) that this build contains and this machine supports.
inline std::vector<std::int64_t> simdTargets() {
  std::vector<std::int64_t> all;
  for (std::int64_t rest = hwy::SupportedTargets() & HWY_TARGETS & ~(HWY_SCALAR | HWY_EMU128); rest;
       rest &= rest - 1)
    all.push_back(rest & -rest);
  return all;
}

/// Runs each test once per SIMD target, and restores the best target afterwards.
class EveryTarget : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { hwy::SetSupportedTargetsForTest(GetParam()); }
  void TearDown() override { hwy::SetSupportedTargetsForTest(0); }
};

inline std::string targetName(const testing::TestParamInfo<std::int64_t>& target) {
  return hwy::TargetName(target.param);
}

}  // namespace corridor::test
