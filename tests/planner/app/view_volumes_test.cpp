// Tests of `corridor view MESH --volume`: pictures of the volumes of a tree.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/program_test.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

class ViewVolumes : public corridor::test::ProgramTest {
 protected:
  const std::string piano = CORRIDOR_SOURCE_DIR "/robots/piano/piano.obj";
};

TEST_F(ViewVolumes, WritesAPicture) {
  const Result result = run("view " + piano + " --volume rss --level 2 -o picture.svg");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, StartsWith("mesh: " + piano + "\nvolumes: 4, on level 2 of "));
  EXPECT_THAT(result.out, HasSubstr("\npicture: picture.svg\n"));
  EXPECT_THAT(read("picture.svg"), StartsWith("<svg "));
  const Result usual = run("view " + piano + " --volume obb --from top");
  EXPECT_EQ(usual.status, 0) << usual.err;
  EXPECT_THAT(usual.out, HasSubstr("picture: piano_obb_3.svg\n"));
  EXPECT_THAT(read("piano_obb_3.svg"), StartsWith("<svg "));
}

TEST_F(ViewVolumes, BadInputIsOneLineAndExit2) {
  expectFaultThatBegins("view " + piano + " --volume spher",
                        "--volume: unknown volume \"spher\" (did you mean \"sphere\"?); "
                        "there are: obb, obb-binary, aabb, sphere, rss, kdop14, kdop18, kdop26");
  expectFaultThatBegins("view " + piano + " --volume aabb --level 999",
                        "--level: the tree has the levels 0 to ");
  expectFault("view " + piano + " --level 1", "--level: needs --volume, which is not given");
  expectFault("view " + piano, piano +
                                   ": is a mesh, and view draws a problem; add --volume NAME "
                                   "to draw the bounding volumes of a mesh");
  expectFault("view " + piano + " --volume aabb --size 9x9",
              "--size: can't be used with --volume, which draws a mesh");
  expectFault("view " + piano + " --volume aabb -o a.html",
              "--output: pictures of volumes are SVG: a name that ends in .svg is needed, not "
              "\"a.html\"");
  expectFault("view none.obj --volume aabb", "none.obj: no such file");
}

}  // namespace
