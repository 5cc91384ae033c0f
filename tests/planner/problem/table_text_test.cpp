// Tests of what could be misread in tables of numbers.
#include "planner/problem/table_text.h"

#include <gmock/gmock.h>

namespace corridor {
namespace {

using Names = std::vector<std::string>;

TEST(TableText, CommentsThatResembleAHeader) {
  const Names names{"turn", "slide"};
  for (const char* const comment :
       {" turn [rad], slide [m]", "turn_deg, slide", "Turn, Slide", "turn;slide", "# turn, slide",
        "turn, slide (rad, m)", "order: turn slide", " slide turn", "turn: slide:", "turn\tsldie",
        "[slide|turn]", "pos_turn,pos_slide", "joints=turn/slide"})
    EXPECT_TRUE(resemblesHeader(comment, names)) << comment;
  for (const char* const comment :
       {"", "0 1 2", " turn, slide", " a path on which we turn and slide in the hall", "return",
        "turning, sliding, done", "the arm, in rad and m", " ----"})
    EXPECT_FALSE(resemblesHeader(comment, names)) << comment;
  const Names many{"j1", "j2", "j3", "j10"};
  EXPECT_TRUE(resemblesHeader("the columns are those of j10 and of j3, j2 and finally j1", many));
  EXPECT_TRUE(resemblesHeader("J10 J3", many));
  EXPECT_TRUE(resemblesHeader("j_2 [rad], j[1]", {"j1", "j2"}));
  EXPECT_TRUE(resemblesHeader("J2 j1", {"j_1", "j_2"}));
  const Names pose{"drive/x", "drive/y", "drive/yaw"};
  EXPECT_TRUE(resemblesHeader("y x yaw", pose));
  EXPECT_TRUE(resemblesHeader("drive.y [m] drive.x [m] drive.yaw", pose));
  EXPECT_TRUE(resemblesHeader("b_slide, a_slide", {"a/slide", "b/slide"}));
  EXPECT_FALSE(resemblesHeader("j1 only", many));
  EXPECT_FALSE(resemblesHeader("a test of j1, j2 and j3 in the hall", many));
}

TEST(TableText, EmptyFieldsAndHeadersOfNumbers) {
  const Names names{"2", "1"};
  EXPECT_EQ(wrongFields("1, 2,", false, names), "");
  EXPECT_EQ(wrongFields("1  2 # a,, b", true, {"a", "b"}), "");
  EXPECT_EQ(wrongFields(",1,2", false, names), "the field before comma 1 is empty");
  EXPECT_EQ(wrongFields(",a,b", true, {"a", "b"}),
            "the field before comma 1 is empty (pandas writes its index so; use index=False)");
  EXPECT_EQ(wrongFields("1,2, \t,3", false, names), "the field before comma 3 is empty");
  EXPECT_EQ(wrongFields("1,2", false, names), "");
  EXPECT_EQ(wrongFields("1,2", true, names),
            "the names of all columns are numbers, so this may be a header or a row; for a row, "
            "write decimal points: 1.0");
  EXPECT_EQ(wrongFields("1,2.0", true, names), "");
  EXPECT_EQ(wrongFields("turn,slide", true, {"turn", "slide"}), "");
}

}  // namespace
}  // namespace corridor
