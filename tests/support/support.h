#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace corridor::test {

/// Returns the folder of shared test data: the environment variable CORRIDOR_DATA, or `shared/data`
/// beside the project; nullopt if there is no such folder. Without it, tests that need the data are
/// reported as skipped.
std::optional<std::filesystem::path> dataFolder();

/// Returns OMPL.app's `resources` folder: the environment variable CORRIDOR_OMPLAPP; nullopt if it
/// is not set, or is no folder.
std::optional<std::filesystem::path> omplAppFolder();

/// Returns whether the long versions of stress tests are requested (`./corridor test --all` sets
/// CORRIDOR_STRESS).
bool isStressRun();

/// Returns the number of cases of a random test: `stress` in a stress run, else `normally`, which
/// should take at most half a second in a release build.
int casesOf(int normally, int stress);

/// The factor by which this build is slower than a release build, roughly. Tests multiply time
/// limits by it, and divide large numbers of cases by it.
#ifndef __has_feature  // clang has it; g++ 12 defines __SANITIZE_ADDRESS__ instead
#define __has_feature(name) 0
#endif
#if defined(__SANITIZE_ADDRESS__) || __has_feature(address_sanitizer)
constexpr int kSlowdown = 20;
#else
constexpr int kSlowdown = 1;
#endif

/// Creates an empty folder for the files of one test. The test must remove the folder at its end.
std::filesystem::path newFolder();

/// Returns a file's bytes; "" if it can't be read.
std::string contents(const std::filesystem::path& file);

/// Returns and prints the seed of a random test: CORRIDOR_SEED if set, else `fallback`.
std::uint64_t testSeed(std::uint64_t fallback);

}  // namespace corridor::test
