#include "tests/support/workload.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/support.h"

namespace corridor::test {
namespace {

std::ifstream opened(const std::filesystem::path& file) {
  std::ifstream in(file);
  if (!in) throw std::runtime_error("cannot read " + file.string());
  return in;
}

}  // namespace

TriangleMesh plainObj(const std::filesystem::path& file) {
  std::ifstream in = opened(file);
  TriangleMesh mesh;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::string key, x, y, z;
    words >> key >> x >> y >> z;
    if (key == "v") mesh.vertices.emplace_back(std::stod(x), std::stod(y), std::stod(z));
    if (key == "f")
      mesh.triangles.push_back({static_cast<std::uint32_t>(std::stoul(x) - 1),
                                static_cast<std::uint32_t>(std::stoul(y) - 1),
                                static_cast<std::uint32_t>(std::stoul(z) - 1)});
  }
  return mesh;
}

std::vector<std::string> workloadNames(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    if (std::filesystem::exists(entry.path() / "poses.txt"))
      names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

Workload loadWorkload(const std::filesystem::path& folder, const std::string& name) {
  Workload w;
  w.name = name;
  std::ifstream pair = opened(folder / name / "pair.txt");
  for (std::string which, file; pair >> which >> file;)
    (which == "A" ? w.a : w.b) = plainObj(folder / file);
  const auto lines = [&](const char* file, auto take) {
    std::ifstream in = opened(folder / name / file);
    for (std::string line; std::getline(in, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      take(words);
    }
  };
  lines("poses.txt", [&](std::istream& in) {
    Transform X;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) in >> X.m(i, k);
    for (int i = 0; i < 3; ++i) in >> X.t[i];
    if (!in) throw std::runtime_error(name + ": bad pose");
    w.poses.push_back(X);
  });
  lines("truth.txt", [&](std::istream& in) {
    int hit;
    std::string distance;  // a stream doesn't read nan
    in >> hit >> distance;
    w.hit.push_back(hit);
    w.distance.push_back(std::stod(distance));
  });
  if (w.poses.size() != w.hit.size())
    throw std::runtime_error(name + ": the numbers of poses and of truths differ");
  return w;
}

bool Workload::hasDistances() const {
  return !std::all_of(distance.begin(), distance.end(), [](double d) { return std::isnan(d); });
}

std::vector<std::size_t> posesInTurn(const Workload& w, std::size_t step, std::size_t way,
                                     std::size_t ways) {
  if (isStressRun()) step = ways = 1;
  way %= ways;
  if (w.poses.size() < 100) {
    if (way > 0) return {};
    ways = 1;
  }
  step *= kSlowdown;
  std::vector<std::size_t> poses;
  for (std::size_t i = way * step; i < w.poses.size(); i += ways * step) poses.push_back(i);
  return poses;
}

}  // namespace corridor::test
