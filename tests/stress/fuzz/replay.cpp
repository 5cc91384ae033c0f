// The main program of the fuzz targets without libFuzzer. Runs a target on the given files, on all
// files in the given folders, and then on N mutations of these files. Usage:
// `fuzz_replay TARGET [--mutations N] [--longest SECONDS] FILE|FOLDER…`. An input that takes longer
// than SECONDS (default 10) is a finding. The same seed (CORRIDOR_SEED) makes the same mutations.
// Each input is written to TMPDIR/input before it runs: if the program crashes, that file is the
// reproducer.
#include <algorithm>
#include <chrono>
#include <iostream>
#include <iterator>
#include <random>
#include <vector>

#include "tests/stress/fuzz/fuzz.h"
#include "tests/support/support.h"

#define CORRIDOR_TARGET(name) extern "C" int fuzz_##name(const std::uint8_t*, std::size_t);
#include "fuzz_targets.inc"  // CORRIDOR_TARGET(read_mesh) …, one for each target
#undef CORRIDOR_TARGET

namespace {

using Target = int (*)(const std::uint8_t*, std::size_t);
/// Returns a target by its name; null if there is none.
Target targetNamed(std::string_view wanted) {
#define CORRIDOR_TARGET(name) \
  if (wanted == #name) return fuzz_##name;
#include "fuzz_targets.inc"
#undef CORRIDOR_TARGET
  return nullptr;
}

using Random = std::mt19937_64;
using Clock = std::chrono::steady_clock;

std::size_t below(Random& random, std::size_t n) {
  return n == 0 ? 0 : random() % n;
}

std::string bytesOf(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    std::cerr << file.string() << ": can't be read\n";
    std::exit(2);
  }
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Returns an input with a few bytes changed, removed, repeated, or taken from another input.
std::string mutated(std::string bytes, const std::vector<std::string>& inputs, Random& random) {
  for (std::size_t times = 1 + below(random, 4); times > 0; --times) {
    const std::size_t at = below(random, bytes.size());
    switch (below(random, 8)) {
      case 0:
        bytes.resize(at);
        break;
      case 1:
        bytes.erase(at, 1 + below(random, 8));
        break;
      case 2:
        bytes.insert(at, bytes.substr(below(random, bytes.size()), below(random, 64)));
        break;
      case 3: {
        const std::string& other = inputs[below(random, inputs.size())];
        bytes.insert(at, other.substr(below(random, other.size()), below(random, 64)));
        break;
      }
      case 4: {  // a digit is replaced by another number
        const std::size_t digit = bytes.find_first_of("0123456789", at);
        static const char* const numbers[] = {"0", "-1", "1e999", "nan", "4294967296", "1e-320"};
        if (digit != bytes.npos) bytes.replace(digit, 1, numbers[below(random, 6)]);
        break;
      }
      default:
        if (!bytes.empty()) bytes[at] = static_cast<char>(random());
    }
  }
  return bytes;
}

void run(Target target, const std::string& input, std::chrono::seconds longest,
         const std::filesystem::path& kept) {
  std::ofstream(kept, std::ios::binary | std::ios::trunc) << input;
  const auto start = Clock::now();
  target(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  if (Clock::now() - start > longest)
    corridor::fuzz::fail("more than " + std::to_string(longest.count()) + " s for one input");
}

}  // namespace

int main(int count, char** arguments) {
  std::size_t mutations = 0;
  std::chrono::seconds longest{10 * corridor::test::kSlowdown};
  std::vector<std::string> inputs;
  const Target target = count > 1 ? targetNamed(arguments[1]) : nullptr;
  for (int i = 2; i < count; ++i) {
    const std::filesystem::path path = arguments[i];
    if (path == "--mutations" && i + 1 < count) {
      mutations = std::stoul(arguments[++i]);
    } else if (path == "--longest" && i + 1 < count) {
      longest = std::chrono::seconds(std::stoul(arguments[++i]));
    } else if (std::filesystem::is_directory(path)) {
      std::vector<std::filesystem::path> files{std::filesystem::directory_iterator(path), {}};
      std::sort(files.begin(), files.end());
      for (const auto& file : files) inputs.push_back(bytesOf(file));
    } else {
      inputs.push_back(bytesOf(path));
    }
  }
  if (!target || inputs.empty()) {
    std::cerr << "usage: fuzz_replay TARGET [--mutations N] [--longest SECONDS] FILE|FOLDER…: a "
                 "target (read_*.cpp, compare_*.cpp) and at least one input file are needed\n";
    return 2;
  }
  const auto kept = std::filesystem::temp_directory_path() / "input";
  const char* const asked = std::getenv("CORRIDOR_SEED");
  const unsigned long seed = asked ? std::stoul(asked) : 7;
  std::cout << inputs.size() << " inputs, then " << mutations
            << " mutations, CORRIDOR_SEED=" << seed << "; the input that runs is in "
            << kept.string() << std::endl;
  for (const std::string& input : inputs) run(target, input, longest, kept);
  Random random(seed);
  for (std::size_t i = 0; i < mutations; ++i)
    run(target, mutated(inputs[below(random, inputs.size())], inputs, random), longest, kept);
  std::error_code ignored;
  std::filesystem::remove(kept, ignored);
}
