#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace corridor::test {

/// Returns the folder of shared test data: the environment variable CORRIDOR_DATA, or `shared/data`
/// beside the project; nullopt if it is absent. Tests that need it skip themselves, visibly.
std::optional<std::filesystem::path> dataFolder();

/// Returns OMPL.app's `resources` folder: the environment variable CORRIDOR_OMPLAPP.
std::optional<std::filesystem::path> omplAppFolder();

/// Returns whether the long versions of stress tests are requested (`./corridor test --all` sets
/// CORRIDOR_STRESS).
bool stressAsked();

/// About how much slower this build is than a release. Time limits are multiplied by it, and long
/// counts divided by it.
#ifdef __SANITIZE_ADDRESS__
constexpr int kSlowdown = 20;
#else
constexpr int kSlowdown = 1;
#endif

/// Creates an empty folder for the files of one test. The test removes it at its end.
std::filesystem::path newFolder();

/// Returns a file's bytes; "" if it can't be read.
std::string contents(const std::filesystem::path& file);

/// Returns and prints the seed of a random test: CORRIDOR_SEED if set, else `fallback`.
std::uint64_t testSeed(std::uint64_t fallback);

}  // namespace corridor::test
