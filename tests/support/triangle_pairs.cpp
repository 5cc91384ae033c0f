#include "tests/support/triangle_pairs.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace corridor::test {

std::vector<KnownPairs> sharedPairs(const std::filesystem::path& collisionFolder) {
  std::vector<KnownPairs> all;
  for (const auto& file : std::filesystem::directory_iterator(collisionFolder / "tripairs")) {
    KnownPairs& known = all.emplace_back();
    known.name = file.path().stem();
    std::ifstream in(file.path());
    for (std::string line; std::getline(in, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      std::vector<double> numbers;
      for (std::string word; words >> word;)  // iostreams refuse denormals
        numbers.push_back(std::strtod(word.c_str(), nullptr));
      if (numbers.size() != 19) throw std::runtime_error(file.path().string() + ": " + line);
      KnownPair& pair = known.pairs.emplace_back();
      pair.touch = numbers[0] == 1;
      for (std::size_t i = 0; i < 9; ++i) {
        pair.a[i / 3][static_cast<Eigen::Index>(i % 3)] = numbers[1 + i];
        pair.b[i / 3][static_cast<Eigen::Index>(i % 3)] = numbers[10 + i];
      }
    }
  }
  std::sort(all.begin(), all.end(),
            [](const KnownPairs& x, const KnownPairs& y) { return x.name < y.name; });
  return all;
}

}  // namespace corridor::test
