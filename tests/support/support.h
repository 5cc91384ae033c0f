#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace corridor::test {

/// The folder of shared test data, from the environment variable CORRIDOR_DATA, or `shared/data`
/// beside the project. nullopt where it is absent: tests that need it skip themselves, visibly.
std::optional<std::filesystem::path> dataFolder();

/// OMPL.app's `resources` folder, from the environment variable CORRIDOR_OMPLAPP.
std::optional<std::filesystem::path> omplAppFolder();

/// True when the long versions of stress tests are asked for (`./corridor test --all` sets
/// CORRIDOR_STRESS).
bool stressAsked();

/// About how much slower this build is than a release: limits of time are multiplied, and long
/// counts divided by it.
#ifdef __SANITIZE_ADDRESS__
constexpr int kSlowdown = 20;
#else
constexpr int kSlowdown = 1;
#endif

/// A new, empty folder for files of one test, which removes it at its end.
std::filesystem::path newFolder();

/// The seed of a random test: CORRIDOR_SEED where set, else `fallback`. Prints it.
std::uint64_t testSeed(std::uint64_t fallback);

}  // namespace corridor::test
