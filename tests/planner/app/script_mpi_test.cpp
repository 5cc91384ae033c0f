// Tests of the script `./corridor` under `mpirun`: it neither installs nor builds, but says what to
// do first.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/program_test.h"

namespace {

namespace fs = std::filesystem;

/// A clone of which only the script is there, and a build in which programs are made by `touch`.
class ScriptUnderMpi : public corridor::test::ProgramTest {
 protected:
  ScriptUnderMpi() {
    fs::copy_file(fs::path(CORRIDOR_SOURCE_DIR) / "corridor", folder_ / "corridor");
  }
  Result script(const std::string& arguments, const std::string& rank =
                                                  "OMPI_COMM_WORLD_SIZE=2 "
                                                  "OMPI_COMM_WORLD_RANK=0") {
    const std::string command = "cd '" + folder_.string() + "' && env -u PMIX_RANK " + rank +
                                " ./corridor " + arguments + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read("out.txt"), read("err.txt")};
  }
  std::string first() const {
    return "under mpirun nothing is installed or built: call " + folder_.string() +
           "/corridor --version first, without mpirun\n";
  }
};

TEST_F(ScriptUnderMpi, NeitherInstallsNorBuilds) {
  const Result absent = script("benchmark x.yaml");
  EXPECT_EQ(absent.status, 2);
  EXPECT_EQ(absent.err, "corridor: the program is not built, and " + first());
  EXPECT_FALSE(fs::exists(folder_ / "build"));
  EXPECT_EQ(script("benchmark x.yaml", "PMIX_RANK=0").err, absent.err);
  const Result other = script("benchmark x.yaml", "OMPI_COMM_WORLD_SIZE=2 OMPI_COMM_WORLD_RANK=1");
  EXPECT_EQ(other.status, 2);
  EXPECT_EQ(other.err, "");  // the first rank has reported it
  for (const char* command : {"test", "fuzz", "python"}) {
    const Result refused = script(command);
    EXPECT_EQ(refused.status, 2);
    EXPECT_EQ(refused.err,
              std::string("corridor: ") + command + " is not for mpirun; call it without\n");
  }

  if (std::system("command -v ninja >/dev/null 2>&1") != 0) GTEST_SKIP() << "ninja is needed";
  fs::create_directories(folder_ / "build/release");
  write("build/release/source", "1");
  write("build/release/build.ninja",
        "rule make\n  command = printf '#!/bin/sh\\necho \"$$@\"\\n' > $out; chmod +x $out\n"
        "  description = Building $out\nbuild corridor: make source\nbuild corridor_assimp: make "
        "source\n");
  ASSERT_EQ(
      std::system(("ninja -C '" + (folder_ / "build/release").string() + "' >/dev/null").c_str()),
      0);
  const Result ready = script("benchmark x.yaml -o y");
  EXPECT_EQ(ready.status, 0) << ready.err;
  EXPECT_EQ(ready.out, "benchmark x.yaml -o y\n");
  fs::last_write_time(folder_ / "build/release/source",
                      fs::file_time_type::clock::now() + std::chrono::hours(1));
  const Result old = script("benchmark x.yaml -o y");
  EXPECT_EQ(old.status, 2);
  EXPECT_EQ(old.err, "corridor: the program is older than its sources, and " + first());
  EXPECT_EQ(old.out, "");
}

}  // namespace
