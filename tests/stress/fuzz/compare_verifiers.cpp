// Fuzz target: an edge of a small robot among small bodies. The checker and the verifier, which
// share no code, must not contradict each other. `undecided` contradicts nothing.
#include "tests/stress/fuzz/small_robot.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace corridor;
  fuzz::Decoder in(data, size);
  static constexpr double limits[] = {10, 100, 1e3, 1e6};
  in.limit(limits[in.below(4)]);
  if (const auto robot = fuzz::decodeRobot(in)) fuzz::compareEdge(*robot, in);
  return 0;
}
