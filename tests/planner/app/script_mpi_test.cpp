// Tests of the script `./corridor` under `mpirun`: it neither installs nor builds, but reports what
// must be done first.
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/program_test.h"

namespace {

namespace fs = std::filesystem;

/// A clone that contains only the script `corridor`. Another script stands in for the program.
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
           "/corridor benchmark --help first, without mpirun\n";
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
              std::string("corridor: ") + command + " is not for mpirun; call it without mpirun\n");
  }

  for (const char* folder : {"build/release", "collision", "planner"})
    fs::create_directories(folder_ / folder);
  for (const char* source :
       {"CMakeLists.txt", "CMakePresets.json", "planner/a.cpp", "planner/README.md"})
    write(source, "");
  for (const char* program : {"build/release/corridor", "build/release/corridor_benchmark"}) {
    write(program, "#!/bin/sh\necho \"$@\"\n");
    fs::permissions(folder_ / program, fs::perms::owner_all);
  }
  const auto build = [&] {
    const std::string find =
        "{collision,planner,CMakeLists.txt,CMakePresets.json} -type f -not -name '*.md'";
    ASSERT_EQ(std::system(("bash -c \"find '" + folder_.string() + "'/" + find +
                           " | sort | cksum\" >'" + (folder_ / "built").string() + "'")
                              .c_str()),
              0);
    fs::rename(folder_ / "built", folder_ / "build/release/.built-corridor_benchmark");
  };
  build();
  const Result ready = script("benchmark x.yaml -o y");
  EXPECT_EQ(ready.status, 0) << ready.err;
  EXPECT_EQ(ready.out, "benchmark x.yaml -o y\n");
  const auto later = fs::file_time_type::clock::now() + std::chrono::hours(1);
  write("page", "");  // as git replaces a file
  fs::rename(folder_ / "page", folder_ / "planner/README.md");
  for (const char* each : {"planner/README.md", "planner"})
    fs::last_write_time(folder_ / each, later);
  EXPECT_EQ(script("benchmark x.yaml -o y").out, "benchmark x.yaml -o y\n");
  const auto expectOld = [&] {
    const Result old = script("benchmark x.yaml -o y");
    EXPECT_EQ(old.status, 2);
    EXPECT_EQ(old.err, "corridor: the program is older than its sources, and " + first());
    EXPECT_EQ(old.out, "");
  };
  fs::last_write_time(folder_ / "planner/a.cpp", later);
  expectOld();
  fs::remove(folder_ / "planner/a.cpp");
  expectOld();
  build();
  EXPECT_EQ(script("benchmark x.yaml -o y").status, 0);
  write("planner/b.cpp", "");
  expectOld();
  fs::remove_all(folder_ / "collision");
  expectOld();
}

}  // namespace
