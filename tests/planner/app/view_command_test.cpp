// Tests of the program `corridor view`: a page or a picture, complete or absent, and one line per
// fault.
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/program_test.h"

namespace {

using testing::HasSubstr;
using testing::StartsWith;

const std::string kProblems = CORRIDOR_SOURCE_DIR "/problems/";

class ViewCommand : public corridor::test::ProgramTest {
 protected:
  ViewCommand() {
    write("path.yaml",
          "format: corridor-solution-1\nspace: SE3\npath:\n  - [-3, -2, 0, 0, 0, 0, 1]\n"
          "  - [3, -2, 0, 0, 0, 0, 1]\n");
    write("other.yaml", "format: corridor-solution-1\nspace: SE2\npath:\n  - [0, 0, 0]\n");
  }
  const std::string plate = kProblems + "thin_plate";
};

TEST_F(ViewCommand, WritesAPage) {
  const Result result = run("view " + plate + " path.yaml -o page.html");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_EQ(result.out, "problem: " + plate + "\nverdict: refuted\npage: page.html\n");
  const std::string page = read("page.html");
  EXPECT_THAT(page, StartsWith("<!DOCTYPE html>"));
  EXPECT_THAT(page, HasSubstr("\"verdict\":\"refuted\""));
  // The page holds the licence that three.js requires, and loads nothing.
  EXPECT_THAT(page, HasSubstr("Permission is hereby granted, free of charge"));
  for (const char* loads : {"<link", "src=\"", "@import", "url("})
    EXPECT_EQ(page.substr(0, page.find("id=\"data\"")).find(loads), std::string::npos) << loads;
}

TEST_F(ViewCommand, NamesThePageByTheProblem) {
  const Result result = run("view " + plate);
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("page: thin_plate.html\n"));
  EXPECT_THAT(read("thin_plate.html"), StartsWith("<!DOCTYPE html>"));
  const Result quiet = run("view " + plate + " -o quiet.html --quiet");
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_EQ(read("quiet.html"), read("thin_plate.html"));
}

TEST_F(ViewCommand, ReportsAPathOfChangedFilesOnThePage) {
  write("path.yaml", "format: corridor-solution-1\nspace: SE3\ndigest: " + std::string(64, 'a') +
                         "\npath:\n  - [-3, -2, 0, 0, 0, 0, 1]\n  - [3, -2, 0, 0, 0, 0, 1]\n");
  const Result result = run("view " + plate + " path.yaml -o page.html");
  EXPECT_EQ(result.status, 0);
  const std::string warning = "corridor: warning: path.yaml: made for other files than those of " +
                              plate + " (the digests differ)";
  EXPECT_EQ(result.err, warning + "; it is not verified: --ignore-digest verifies it anyway\n");
  EXPECT_THAT(result.out, HasSubstr("verdict: other problem\n"));
  EXPECT_THAT(read("page.html"), HasSubstr("\"other_files\":true"));
  EXPECT_THAT(read("page.html"), HasSubstr("\"verdict\":\"other problem\""));
  const Result ignored = run("view " + plate + " path.yaml -o page.html --ignore-digest");
  EXPECT_EQ(ignored.err, warning + "\n");
  EXPECT_THAT(ignored.out, HasSubstr("verdict: refuted\n"));
  EXPECT_THAT(read("page.html"), HasSubstr("\"other_files\":true"));
  EXPECT_THAT(read("page.html"), HasSubstr("\"verdict\":\"refuted\""));
}

/// If `corridor verify` reads a file as a trajectory, the page plays this trajectory at its true
/// speed.
TEST_F(ViewCommand, PlaysATrajectory) {
  const std::string header = "time,x,y,z,qx,qy,qz,qw\n";
  write("through.csv", header + "0.5,-2.5,-2,0,0,0,0,1\n3,3,-2,0,0,0,0,1\n");
  const Result result = run("view " + plate + " through.csv -o page.html");
  EXPECT_EQ(result.status, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("verdict: refuted\n"));
  const std::string page = read("page.html");
  EXPECT_THAT(page, HasSubstr("\"times\":[0.5,3.0]"));
  EXPECT_THAT(page, HasSubstr("\"time_s\":"));
  EXPECT_THAT(page, HasSubstr("\"between\":\"linear\""));
  EXPECT_THAT(page, HasSubstr("the trajectory does not begin at the problem's start"));
  write("states.csv", "x,y,z,qx,qy,qz,qw\n-3,-2,0,0,0,0,1\n3,-2,0,0,0,0,1\n");
  EXPECT_EQ(run("view " + plate + " states.csv -o page.html").status, 0);
  EXPECT_THAT(read("page.html"), testing::Not(HasSubstr("\"times\":")));
  expectFault("view " + plate + " path.yaml --between linear",
              "--between: path.yaml is a solution, whose edges are linear; --between is for "
              "trajectories");
  expectFault("view " + plate + " through.csv --between cubic",
              "through.csv: --between cubic needs times and velocities, which the file does not "
              "have; by default, linear is used");
  expectFault("view robots/none.obj --volume aabb --between linear",
              "--between: can't be used with --volume, which draws a mesh");
}

TEST_F(ViewCommand, Faults) {
  expectFault("view none.yaml", "none.yaml: no such file");
  const Result missing = run("view " + plate + " none.yaml -o page.html");
  EXPECT_EQ(missing.status, 2);
  EXPECT_THAT(missing.err, StartsWith("none.yaml"));
  const Result other = run("view " + plate + " other.yaml -o page.html");
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, StartsWith("other.yaml"));
  expectFault("view " + plate + " -o none/page.html", "--output: there is no folder none");
  expectFault("view " + plate + " --image none/a.png", "--image: there is no folder none");
  for (const char* name : {"a.jpg", "a.svg", "a.png.html"})
    expectFault("view none.yaml --image " + std::string(name),
                "--image: pictures are PNG: a name that ends in .png is needed, not \"" +
                    std::string(name) + "\"");
  for (const char* name : {"a.PNG", "a"})
    expectFault("view none.yaml --image " + std::string(name), "none.yaml: no such file");
  expectFault("view none.yaml -o a.png",
              "--output: pages are HTML: a name that ends in .html is needed, not \"a.png\"");
  for (const char* option : {"--output", "--image"})
    expectFault(std::string("view none.yaml ") + option + " -",
                std::string(option) + ": is not written to the standard output; name a file");
  // Input files are not overwritten.
  std::filesystem::copy_file(folder_ / "path.yaml", folder_ / "path");
  std::filesystem::create_symlink(plate + "/problem.yaml", folder_ / "problem.png");
  expectFault("view " + plate + " path -o path",
              "--output: path belongs to the path and would be overwritten; name another file");
  expectFault(
      "view " + plate + " path --image problem.png",
      "--image: problem.png belongs to the problem and would be overwritten; name another file");
  EXPECT_EQ(read("path"), read("path.yaml"));
  expectFault("view " + plate + " -o .", "--output: . is a folder; a file's name is needed");
  expectFault("view " + plate + " --size 100x100", "--size: needs --image, which is not given");
  for (const char* size :
       {"100", "100x", "x100", "99x100", "100x8001", "100x100x", "1e3x100", "-100x100"})
    expectFault(
        "view " + plate + " --image a.png --size=" + size,
        std::string("--size: WIDTHxHEIGHT is needed, 100 to 8000 pixels each, such as 1366x768, "
                    "not \"") +
            size + "\"");
  for (const std::string from : {"frnt", "1", "0,91", "361,0", "1,2,3", "nan,0"})
    expectFault("view " + plate + " --from=" + from,
                "--from: one of front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in "
                "degrees (-360 to 360, -90 to 90; such as -60,38) is needed, not \"" +
                    from + "\"" + (from == "frnt" ? " (did you mean \"front\"?)" : ""));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "page.html"));
}

TEST_F(ViewCommand, FromChoosesTheFirstView) {
  EXPECT_EQ(run("view " + plate + " -o page.html --from left").status, 0);
  EXPECT_THAT(read("page.html"), HasSubstr("\"from\":[1.57079632679"));
  for (const char* from : {" --from=-60,38", " --from -60,38"})
    EXPECT_EQ(run("view " + plate + " -o page.html" + from).status, 0) << from;
  EXPECT_THAT(read("page.html"), HasSubstr("\"from\":[-1.0471975511"));
  EXPECT_EQ(run("view " + plate + " -o page.html").status, 0);
  EXPECT_THAT(read("page.html"), testing::Not(HasSubstr("\"from\":[")));
}

TEST_F(ViewCommand, WithoutChromiumThereIsNoPicture) {
  const std::string command = "cd '" + folder_.string() +
                              "' && PATH=/nowhere '" CORRIDOR_PROGRAM "' view " + plate +
                              " -o page.html --image a.png >out.txt 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
  EXPECT_EQ(read("err.txt"),
            "--image: needs Chromium, and there is no chromium in PATH (Debian: apt-get install "
            "chromium); -o writes the page without it\n");
  EXPECT_FALSE(std::filesystem::exists(folder_ / "page.html"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
}

/// If the browser draws nothing, the file that existed before must stay.
TEST_F(ViewCommand, ABrowserThatFailsIsReported) {
  write("chromium", "#!/bin/sh\nexit 1\n");
  std::filesystem::permissions(folder_ / "chromium", std::filesystem::perms::owner_all);
  write("a.png", "before");
  const std::string command = "cd '" + folder_.string() + "' && PATH='" + folder_.string() +
                              "' '" CORRIDOR_PROGRAM "' view " + plate +
                              " --image a.png >out.txt 2>err.txt";
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 2);
  EXPECT_EQ(read("err.txt"), (folder_ / "chromium").string() + ": has not drawn the picture\n");
  EXPECT_EQ(read("a.png"), "before");
}

/// An interrupt ends the browser and removes its folder, even if a second interrupt comes during
/// the removal.
TEST_F(ViewCommand, TwoInterruptsLeaveNoFilesOrProcesses) {
  // A script that stands in for Chromium: it writes a file that it does not remove, writes its
  // process id, and then waits. (interrupt_test tests that the second interrupt is ignored.)
  write("chromium",
        "#!/bin/sh\nfor word in \"$@\"; do case \"$word\" in --user-data-dir=*) "
        "folder=\"${word#*=}\";; esac; done\nmkdir -p \"$folder\" && cd \"$folder\"\n"
        "touch left\necho $$ >\"" +
            (folder_ / "browser.txt").string() + "\"\nexec sleep 600\n");
  std::filesystem::permissions(folder_ / "chromium", std::filesystem::perms::owner_all);
  std::filesystem::create_directory(folder_ / "temporary");
  const pid_t id = ::fork();
  if (id == 0) {
    if (::chdir(folder_.c_str()) != 0 || !std::freopen("out.txt", "w", stdout) ||
        !std::freopen("err.txt", "w", stderr))
      ::_exit(1);
    ::setenv("TMPDIR", "temporary", 1);
    ::setenv("PATH", (folder_.string() + ":/usr/bin:/bin").c_str(), 1);
    ::execl(CORRIDOR_PROGRAM, CORRIDOR_PROGRAM, "view", plate.c_str(), "--image", "a.png",
            static_cast<char*>(nullptr));
    ::_exit(1);
  }
  const auto wait = [](int milliseconds) {
    std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
  };
  for (int i = 0; i < 6000 && lines(read("browser.txt")).empty(); ++i) wait(10);
  const pid_t browser = std::atoi(read("browser.txt").c_str());
  ASSERT_GT(browser, 0) << read("err.txt");
  ::kill(id, SIGINT);
  wait(550);  // long enough to count as a second interrupt
  ::kill(id, SIGINT);
  int status = 0;
  ASSERT_EQ(::waitpid(id, &status, 0), id);
  EXPECT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 130);
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "temporary"));
  EXPECT_NE(::kill(browser, 0), 0);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
}

}  // namespace
