// Fuzz target: solution files (YAML and .path) of problems in SE(2), of problems in SE(3), and of
// problems of a robot with two joints. The first line of an input is the file's extension.
#include "planner/solve/solution.h"
#include "tests/stress/fuzz/fuzz.h"

namespace {

using corridor::Coordinate, corridor::CoordinateGroup, corridor::ConfigurationSpace;

ConfigurationSpace space(CoordinateGroup::Kind kind, const std::vector<Coordinate>& coordinates) {
  ConfigurationSpace space;
  CoordinateGroup group;
  group.kind = kind;
  for (const Coordinate& c : coordinates) group.coordinates.push_back(space.add(c));
  space.addGroup(group);
  return space;
}

std::vector<ConfigurationSpace> spaces() {
  using Kind = Coordinate::Kind;
  const Coordinate x{Kind::line, "x", 0, -9, 9}, y{Kind::line, "y", 0, -9, 9},
      z{Kind::line, "z", 0, -9, 9}, yaw{Kind::circle, "yaw"}, rotation{Kind::rotation, "rotation"},
      pan{Kind::circle, "pan"}, lift{Kind::line, "lift", 0, -2, 2, true};
  return {space(CoordinateGroup::Kind::planar, {x, y, yaw}),
          space(CoordinateGroup::Kind::floating, {x, y, z, rotation}),
          space(CoordinateGroup::Kind::joints, {pan, lift})};
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  static const fuzz::Folder folder;
  static const std::vector<ConfigurationSpace> all = spaces();
  const auto input = fuzz::namedInput(data, size);
  if (!input || (input->ending != "yaml" && input->ending != "path")) return 0;
  const auto file = folder.write("a." + input->ending, input->bytes);
  for (const ConfigurationSpace& space : all)
    fuzz::readsOrRefuses([&] {
      const Solution solution = readSolution(file, space);
      if (solution.path.empty()) fuzz::fail("a solution without a state");
      for (const Configuration& q : solution.path)
        if (std::size_t(q.size()) != space.size() || !space.isFinite(q))
          fuzz::fail("a state that is not one of the space");
    });
  return 0;
}
