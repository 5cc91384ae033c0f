// Tests of the tips of robots, and of the SVG's colours and directions of view.
#include "planner/view/path_picture.h"

#include <cstdint>
#include <numbers>
#include <zlib.h>

#include "planner/view/tip_frames.h"
#include "tests/planner/problem/arm_fixture.h"

namespace corridor {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

class SvgPicture : public test::ArmTest {
 protected:
  static std::string nameOf(const Model& model, std::size_t frame) {
    return model.tree.frames[frame].name;
  }
  /// Returns the picture of a straight path from start to goal.
  static std::string picture(const Problem& problem,
                             const std::optional<ViewDirection>& from = {}) {
    return svgPicture(problem, {problem.task.start, problem.task.goals.at(0)}, from);
  }
};

/// The arm's last frame is `thumb`. The joint of `thumb` stands still, because it mimics a held
/// joint, but `thumb` moves with the joints before it. So `thumb` is the tip. If the last frame of
/// the file is a camera on the base, `thumb` is still the tip.
TEST_F(SvgPicture, TheTipIsTheFrameWithMostMovingJointsBefore) {
  const Problem held = read(armHead + armStates);
  ASSERT_THAT(view::tipFrames(held.model), testing::SizeIs(1));
  EXPECT_EQ(nameOf(held.model, view::tipFrames(held.model)[0]), "thumb");

  std::string more = urdf;  // a camera on the base, on a joint that is held
  const std::string end = "</robot>\n";
  more.replace(more.find(end), end.size(),
               link("camera", "<sphere radius='0.02'/>", 0) +
                   joint("tilt", "revolute", "base", "camera",
                         "<axis xyz='0 1 0'/><limit lower='-1' upper='1' effort='1' "
                         "velocity='1'/>") +
                   end);
  write("arm.urdf", more);
  const Problem camera = read(armHead + armStates);
  EXPECT_EQ(camera.model.tree.frames.back().name, "camera");
  EXPECT_EQ(nameOf(camera.model, view::tipFrames(camera.model).at(0)), "thumb");

  const Problem two = read(
      "format: corridor-problem-1\nrobots:\n  left: {file: arm.yaml}\n  right: {file: arm.yaml, "
      "base: {at: [2, 0, 0]}}\nstart: {left: ready, right: ready}\ngoal: {left: {pan: 1, lift: "
      "0.3}, right: ready}\n");
  const auto tips = view::tipFrames(two.model);
  ASSERT_EQ(tips.size(), 2u);
  EXPECT_EQ(nameOf(two.model, tips[0]), "left/thumb");
  EXPECT_EQ(nameOf(two.model, tips[1]), "right/thumb");
}

/// Returns the numbers of pixels of a PNG that are mostly blue (links that stand still), green
/// (start), red (goal) and orange (between).
struct Pixels {
  int blue = 0, green = 0, red = 0, orange = 0;
};
Pixels pixelsOf(const std::string& png) {
  const auto number = [&](std::size_t at) {
    std::uint32_t n = 0;
    for (std::size_t i = 0; i < 4; ++i) n = n << 8 | static_cast<unsigned char>(png.at(at + i));
    return n;
  };
  const std::size_t width = number(16), height = number(20), begin = png.find("IDAT");
  std::string rows((3 * width + 1) * height, '\0');
  uLongf size = rows.size();
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(rows.data()), &size,
                         reinterpret_cast<const Bytef*>(png.data() + begin + 4), number(begin - 4)),
            Z_OK);
  EXPECT_EQ(size, rows.size());
  Pixels count;
  std::vector<unsigned char> above(3 * width, 0);
  for (std::size_t y = 0; y < height; ++y) {
    EXPECT_EQ(rows[y * (3 * width + 1)], 2);  // the filter: differences from the row above
    for (std::size_t i = 0; i < 3 * width; ++i)
      above[i] = static_cast<unsigned char>(
          above[i] + static_cast<unsigned char>(rows[y * (3 * width + 1) + 1 + i]));
    for (std::size_t x = 0; x < width; ++x) {
      const int r = above[3 * x], g = above[3 * x + 1], b = above[3 * x + 2];
      count.blue += b > r + 30 && b > g + 10;
      count.green += g > r + 50 && g > b + 30;
      count.red += r > g + 70 && std::abs(g - b) < 40;
      count.orange += r > b + 60 && g > b + 40;
    }
  }
  return count;
}

/// The trace of the tip is blue, too, so only the picture without moving links has a known number
/// of blue pixels: those of the base, which is drawn once.
TEST_F(SvgPicture, LinksThatStandStillAreDrawnOnce) {
  const auto pixels = [](const Problem& problem) {
    return pixelsOf(pngPicture(problem, {problem.task.start, problem.task.goals.at(0)}, {}, 300));
  };
  const Pixels whole = pixels(read(armHead + armStates));
  EXPECT_GT(whole.blue, 20);
  EXPECT_GT(whole.green, 20);
  EXPECT_GT(whole.red, 20);
  EXPECT_GT(whole.orange, 20);
  // Now only the base has a shape. It is drawn once, and the moving links have nothing to draw.
  std::string bare = urdf;
  for (const std::string name : {"upper", "lower", "finger", "thumb"}) {
    const auto at = bare.find("<collision>", bare.find("<link name='" + name));
    bare.erase(at, bare.find("</link>", at) - at);
  }
  write("arm.urdf", bare);
  const Pixels base = pixels(read(armHead + armStates));
  EXPECT_GT(base.blue, 20);
  EXPECT_EQ(base.green + base.red + base.orange, 0);
}

TEST_F(SvgPicture, DirectionOfView) {
  const auto degrees = [](const std::string& text) {
    const auto [azimuth, elevation] = viewDirection(text, "--from");
    const auto rounded = [](double radians) {
      return std::round(radians * 180 / std::numbers::pi * 1e6) / 1e6;
    };
    return std::vector<double>{rounded(azimuth), rounded(elevation)};
  };
  EXPECT_THAT(degrees("front"), ElementsAre(0, 0));
  EXPECT_THAT(degrees("back"), ElementsAre(180, 0));
  EXPECT_THAT(degrees("left"), ElementsAre(90, 0));
  EXPECT_THAT(degrees("right"), ElementsAre(-90, 0));
  EXPECT_THAT(degrees("top"), ElementsAre(-90, 90));
  EXPECT_THAT(degrees("bottom"), ElementsAre(-90, -90));
  EXPECT_THAT(degrees("-60,38.5"), ElementsAre(-60, 38.5));
  const Problem problem = read(armHead + armStates);
  EXPECT_EQ(picture(problem), picture(problem, viewDirection("-60,38", "--from")));
  EXPECT_NE(picture(problem), picture(problem, viewDirection("front", "--from")));
}

TEST_F(SvgPicture, TheCaptionStatesTheDuration) {
  const Problem problem = read(armHead + armStates);
  const Path path{problem.task.start, problem.task.goals.at(0)};
  EXPECT_THAT(svgPicture(problem, path, {}, 2.5), HasSubstr(">duration 2.5 s</text>"));
  EXPECT_THAT(svgPicture(problem, path), Not(HasSubstr("<text")));
}

}  // namespace
}  // namespace corridor
