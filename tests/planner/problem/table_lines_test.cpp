// Tests of what could be misread in tables of numbers.
#include "planner/problem/table_lines.h"

#include <algorithm>

#include <gmock/gmock.h>

#include "collision/core/error.h"

namespace corridor {
namespace {

using Names = std::vector<std::string>;

/// Returns what is read of a table: "header line 1: b a; line 2: 1 2", then the note; or the fault.
std::string read(const std::string& text, const Names& columns = {"pan", "lift"},
                 bool hasHeader = true) {
  const auto isName = [&](const std::string& word) {
    return std::find(columns.begin(), columns.end(), word) != columns.end();
  };
  try {
    std::string all;
    TableLines lines("t", text, columns,
                     hasHeader ? isName : std::function<bool(const std::string&)>());
    while (lines.next()) {
      all += (all.empty() ? "" : "; ") + std::string(lines.isHeader() ? "header " : "") + "line " +
             std::to_string(lines.number()) + ":";
      for (const std::string& word : lines.words()) all += " " + word;
    }
    if (const auto note = lines.note()) all += "; " + note->text;
    return all;
  } catch (const InputError& error) {
    return error.what();
  }
}

std::string notRead(int line, const std::string& comment, const std::string& columns) {
  return "; t: comments are not read: \"" + comment + "\" (line " + std::to_string(line) +
         "); the columns are " + columns + ", in this order, in m and rad";
}

TEST(TableLines, CommentsThatResembleAHeader) {
  const Names names{"turn", "slide"};
  for (const char* const comment :
       {" turn [rad], slide [m]", "turn_deg, slide", "Turn, Slide", "turn;slide", "# turn, slide",
        "turn, slide (rad, m)", "order: turn slide", " slide turn", "turn: slide:", "turn\tsldie",
        "[slide|turn]", " turn, slide", "pos_turn,pos_slide", "joints=turn/slide"})
    EXPECT_TRUE(resemblesHeader(comment, names)) << comment;
  for (const char* const comment :
       {"", "0 1 2", " a path on which we turn and slide in the hall", "return",
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

TEST(TableLines, EmptyFieldsAndSemicolons) {
  EXPECT_EQ(read("1, 2,\n3\t4 # a,, b\n"), "line 1: 1 2; line 2: 3 4");
  EXPECT_EQ(read("1,2\n,1,2\n"), "t:2: the field before comma 1 is empty");
  EXPECT_EQ(read(",pan,lift\n0,1,2\n"),
            "t:1: the field before comma 1 is empty (pandas writes its index so; use index=False)");
  EXPECT_EQ(read("1,2\n,,\n"), "t:2: the field before comma 1 is empty");
  EXPECT_EQ(read("1,2, \t,3\n"), "t:1: the field before comma 3 is empty");
  EXPECT_EQ(
      read("1;2\n"),
      "t:1: \";\" separates the numbers; separate them by commas or blanks, and write decimal "
      "points, not commas");
}

TEST(TableLines, HeadersOfNumbers) {
  const Names names{"2", "1"};
  EXPECT_EQ(read("1,2\n3,4\n", names),
            "t:1: the names of all columns are numbers, so this may be a header or a row; for a "
            "row, write decimal points: 1.0, and for a header, quotes: \"1\"");
  EXPECT_EQ(read("\"1\",2\n3,4\n", names), "header line 1: 1 2; line 2: 3 4");
  EXPECT_EQ(read("1,2.0\n1,2\n", names), "line 1: 1 2.0; line 2: 1 2");
  EXPECT_EQ(read("1,2\n", names, false), "line 1: 1 2");
}

TEST(TableLines, NamesInQuotes) {
  const Names names{"Joint 1", "a,b", "c # d"};
  EXPECT_EQ(read("\"a,b\",\"Joint 1\",\"c # d\"\n1,2,3\n", names),
            "header line 1: a,b Joint 1 c # d; line 2: 1 2 3");
  EXPECT_EQ(read("# \"a,b\" \"Joint 1\" \"c # d\"\n1 2 3\n", names),
            "header line 1: a,b Joint 1 c # d; line 2: 1 2 3");
}

TEST(TableLines, Headers) {
  EXPECT_EQ(read("\xEF\xBB\xBFlift,pan\n1,2\n"), "header line 1: lift pan; line 2: 1 2");
  EXPECT_EQ(read("# lift pan time\n1 2\n", {"pan", "lift", "time"}),
            "header line 1: lift pan time; line 2: 1 2");
  EXPECT_EQ(read("lift,1\n1,2\n"), "header line 1: lift 1; line 2: 1 2");
  EXPECT_EQ(read("Pan,Lift\n1,2\n"), "header line 1: Pan Lift; line 2: 1 2");
  EXPECT_EQ(read("l,1\n"), "line 1: l 1");  // a wrong number
  EXPECT_EQ(read("pan lift\n1 2\n", {"pan", "lift"}, false), "line 1: pan lift; line 2: 1 2");
  // The same header again.
  EXPECT_EQ(read("# lift pan\nlift pan\n1 2\n"), "header line 1: lift pan; line 3: 1 2");
  EXPECT_EQ(read("lift pan\n# lift pan\n1 2\n"), "header line 1: lift pan; line 3: 1 2");
  EXPECT_EQ(read("lift pan\n1 2\n# lift pan\n3 4\n"),
            "header line 1: lift pan; line 2: 1 2; line 4: 3 4");
  EXPECT_EQ(read("1 2\n# pan lift\n3 4\n"), "line 1: 1 2; line 3: 3 4");
  // Lines may end with CR alone.
  EXPECT_EQ(read("lift pan\r1 2\r\n3 4 # low\r5 6"),
            "header line 1: lift pan; line 2: 1 2; line 3: 3 4; line 4: 5 6");
  // Another one.
  const std::string other =
      ": names other columns than line 1, or in another order; delete one of the two lines";
  EXPECT_EQ(read("# lift pan\n# pan lift\n1 2\n"), "t:2" + other);
  EXPECT_EQ(read("# lift pan\npan lift\n1 2\n"), "t:2" + other);
  EXPECT_EQ(read("lift pan\n# pan lift\n1 2\n"), "t:2" + other);
  for (const char* const first : {"", "lift pan\n"})
    EXPECT_THAT(
        read(first + std::string("1 2\n# pan lift pan\n3 4\n")),
        testing::EndsWith(": names other columns than the rows above it have, or in another "
                          "order; delete the line, or make two files"));
}

TEST(TableLines, CommentsThatSeemToBeHeaders) {
  const std::string wrong =
      ": the comment seems to be a header, but is not one; write the names only, as in "
      "\"pan,lift\" (rad, m), or delete the comment";
  EXPECT_EQ(read("# a title\n# Pan, Lift\n1 2\n"), "t:2" + wrong);
  EXPECT_EQ(read("1 2 # lift, pan!\n"), "t:1" + wrong);
  EXPECT_EQ(read("## lift pan\n1 2\n", {"pan", "lift"}, false), "t:1" + wrong);
  EXPECT_EQ(
      read("# pan [rad], lift [m]\nlift pan\n1 2\n"),
      "header line 2: lift pan; line 3: 1 2" + notRead(1, " pan [rad], lift [m]", "lift, pan"));
  EXPECT_EQ(read("1 2\n# lift, pan!\n"),
            "t:2: the comment seems to be a header, but the rows above it have the columns pan, "
            "lift; delete the comment, or make two files");
  EXPECT_THAT(read("1 2\n\t # lift, pan!\n"), testing::StartsWith("t:2: the comment seems"));
  EXPECT_EQ(read("1 2\n3 4 # lift, pan!\n"), "line 1: 1 2; line 2: 3 4");
  EXPECT_EQ(read("pan lift\n1 2\n# Pan lift\n"),
            "t:3: the comment seems to be a header, but the rows above it have the columns pan, "
            "lift; delete the comment, or make two files");
  // The names of one state, above a file of edges.
  EXPECT_EQ(read("# a b\n1 2 3 4\n", {"a", "b", "a", "b"}, false), "line 2: 1 2 3 4");
  EXPECT_THAT(read("# b a\n1 2 3 4\n", {"a", "b", "a", "b"}, false), testing::HasSubstr("seems"));
}

TEST(TableLines, CommentsOnUnits) {
  const auto fault = [](const std::string& word) {
    return "t:1: the comment says \"" + word +
           "\", but the numbers are read in rad, m and s; convert them, or delete the comment if "
           "it is wrong";
  };
  EXPECT_EQ(read("# in degrees\n1 2\n"), fault("degrees"));
  EXPECT_EQ(read("# Units: rad, MM\n1 2\n"), fault("mm"));
  EXPECT_EQ(read("lift pan # [deg]\n1 2\n"), fault("deg"));
  EXPECT_EQ(read("# (cm)\n1 2\n", {"pan", "lift"}, false), fault("cm"));
  EXPECT_THAT(read("1 2\n# in degrees\n3 4\n"), testing::StartsWith("t:2: the comment says"));
  for (const char* const comment :
       {"angles: deg", "angles = deg", "deg, m", "in rad and mm", "in rad, mm", "unit: inch",
        "time in ms", "angles in mrad", "units are radians and millimeters", "pan [rad] lift (cm)",
        "\u00b0"})
    EXPECT_THAT(read("# " + std::string(comment) + "\n1 2\n"), testing::HasSubstr("comment says"))
        << comment;
  for (const char* const comment :
       {"radians (not in degrees)", "turns by 90 deg", "speed: 90 deg", "in m and rad", "rad, m",
        "a mm of play", "in turn", "exported from Unity every 20 ms", "units: rad, period 10 ms",
        "units: rad; mm of error"})
    EXPECT_THAT(read("# " + std::string(comment) + "\n1 2\n"), testing::StartsWith("line 2: 1 2;"))
        << comment;
  EXPECT_EQ(read("1 2\n3 4 # in degrees: 5 6\n"), "line 1: 1 2; line 2: 3 4");
}

TEST(TableLines, OtherCommentsAreNoted) {
  EXPECT_EQ(read("# 12.5\n# turns by 90 degrees\n# by foo\n1 2\n"),
            "line 4: 1 2; t: comments are not read: \" turns by 90 degrees\" (line 2), \" by "
            "foo\" (line 3); the columns are pan, lift, in this order, in m and rad");
  EXPECT_EQ(read("lift pan # a title\n1 2\n"),
            "header line 1: lift pan; line 2: 1 2" + notRead(1, " a title", "lift, pan"));
  EXPECT_EQ(read("1 2 # low\n"), "line 1: 1 2" + notRead(1, " low", "pan, lift"));
  EXPECT_EQ(read("1 2\n# by foo\n"), "line 1: 1 2");
}

}  // namespace
}  // namespace corridor
