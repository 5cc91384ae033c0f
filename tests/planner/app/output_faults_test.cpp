// Tests of outputs that can't be written, in every use of every command: on a full disk, in a
// read-only folder, to a closed pipe, to a closed stdout. Each file is complete or absent, and the
// exit status reports the fault.
#include <algorithm>
#include <csignal>
#include <fcntl.h>
#include <set>
#include <sys/resource.h>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/planner/app/uses.h"

namespace corridor::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr const char* kStdoutFault = "standard output: can't be written, or not all of it\n";

class OutputFaults : public UseTest {
 protected:
  OutputFaults() { learnWhole(GetParam()); }
  void expectAll() const {
    expectWholeOrNothing(GetParam());
    for (const std::string& file : GetParam().files)
      EXPECT_TRUE(std::filesystem::exists(folder_ / "out" / file)) << file;
  }
};

TEST_P(OutputFaults, AFullDiskBehindStdout) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const End end =
      this->end(GetParam().arguments, [] { ::dup2(::open("/dev/full", O_WRONLY), STDOUT_FILENO); });
  EXPECT_EQ(end.status, 2);
  EXPECT_THAT(end.err, EndsWith(kStdoutFault));
  EXPECT_TRUE(end.noChildLeft);
  expectAll();
}

/// If stdout is closed, the next file that the program opens would get the file descriptor of
/// stdout, and the results would be written into this file. openStandardStreams prevents this.
TEST_P(OutputFaults, AClosedStdout) {
  const End end = this->end(GetParam().arguments, [] { ::close(STDOUT_FILENO); });
  EXPECT_EQ(end.status, 2);
  EXPECT_THAT(end.err, EndsWith(kStdoutFault));
  EXPECT_TRUE(end.noChildLeft);
  expectAll();
}

TEST_P(OutputFaults, APipeThatNobodyReads) {
  for (const bool ignored : {false, true}) {
    const End end = this->end(GetParam().arguments, [ignored] {
      int pipe[2];
      if (::pipe(pipe) != 0) ::_exit(99);
      ::close(pipe[0]);
      ::dup2(pipe[1], STDOUT_FILENO);
      if (ignored) ::signal(SIGPIPE, SIG_IGN);
    });
    EXPECT_EQ(end.status, ignored ? 2 : 128 + SIGPIPE);
    EXPECT_THAT(end.err, EndsWith(ignored ? kStdoutFault : ""));
    EXPECT_TRUE(end.noChildLeft);
    expectAll();
    // Empties `out` for the second run: `benchmark` does not overwrite a campaign.
    std::filesystem::remove_all(folder_ / "out");
    std::filesystem::create_directory(folder_ / "out");
  }
}

/// `query` prints results on stderr, too; all other commands ignore a full stderr.
TEST_P(OutputFaults, AFullDiskBehindStderr) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  const End end =
      this->end(GetParam().arguments, [] { ::dup2(::open("/dev/full", O_WRONLY), STDERR_FILENO); });
  EXPECT_EQ(end.status, GetParam().arguments.starts_with("query") ? 2 : 0);
  EXPECT_TRUE(end.noChildLeft);
  expectAll();
}

INSTANTIATE_TEST_SUITE_P(Uses, OutputFaults, testing::ValuesIn(uses()),
                         [](const auto& use) { return use.param.name; });

/// Runs the uses that write files.
class FileFaults : public OutputFaults {
 protected:
  bool isFolder() const { return GetParam().arguments.starts_with("benchmark"); }
  /// Expects exit status 2 and one line on stderr that contains `why`.
  static void expectSaid(const End& end, const std::string& why) {
    EXPECT_EQ(end.status, 2);
    EXPECT_THAT(end.err, HasSubstr(why));
    EXPECT_EQ(std::count(end.err.begin(), end.err.end(), '\n'), 1) << end.err;
    EXPECT_TRUE(end.noChildLeft);
  }
};

/// If no file may be larger than half of the new file (`ulimit -f`), the file that existed before
/// must stay unchanged.
TEST_P(FileFaults, FilesThatMayNotGrow) {
  for (const std::string& file : GetParam().files) {
    if (isFolder() && file != GetParam().files[0]) break;  // the runs fail first
    if (!isFolder()) write("out/" + file, "before");
    const std::size_t half = whole_.at(file).size() / 2;
    const End end = this->end(GetParam().arguments, [half] {
      const rlimit limit{half, half};
      if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ::_exit(99);
      ::dup2(::open("/dev/null", O_WRONLY), STDOUT_FILENO);
    });
    EXPECT_EQ(end.status, 2) << end.err;
    EXPECT_THAT(end.err, HasSubstr("can't be written: File too large"));
    EXPECT_THAT(end.err, HasSubstr("ulimit -f"));
    EXPECT_TRUE(end.noChildLeft);
    if (isFolder()) continue;
    EXPECT_EQ(read("out/" + file), "before");
    std::filesystem::remove(folder_ / "out" / file);
    expectWholeOrNothing(GetParam());
  }
}

constexpr const char* kLookAndGo =
    "\"$0\" \"$@\"; status=$?; find out -type f ! -name fill >left.txt; umount out; exit $status";

TEST_P(FileFaults, AFullDisk) {
  const auto wrapper = mounting(
      std::string("mount -t tmpfs -o size=64k none out && { head -c 1m /dev/zero >out/fill "
                  "2>/dev/null; true; } && ") +
      kLookAndGo);
  if (wrapper.empty()) GTEST_SKIP() << "a small file system may not be mounted here (unshare -m)";
  const End end = wait(startBy(wrapper, GetParam().arguments));
  expectSaid(end, "No space left on device");
  EXPECT_EQ(read("left.txt"), "");
  expectWholeOrNothing(GetParam());
}

TEST_P(FileFaults, AReadOnlyFolder) {
  const auto wrapper = mounting(
      std::string("mount --bind out out && mount -o remount,bind,ro out && ") + kLookAndGo);
  if (wrapper.empty()) GTEST_SKIP() << "a folder may not be mounted read-only here (unshare -m)";
  const End end = wait(startBy(wrapper, GetParam().arguments));
  expectSaid(end, "Read-only file system");
  EXPECT_EQ(read("left.txt"), "");
  expectWholeOrNothing(GetParam());
}

std::vector<Use> usesWithFiles() {
  std::vector<Use> all;
  for (const Use& use : uses())
    if (!use.files.empty()) all.push_back(use);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Uses, FileFaults, testing::ValuesIn(usesWithFiles()),
                         [](const auto& use) { return use.param.name; });

class Uses : public ProgramTest {};

/// Fails if a command, an output option or a query has no entry in `uses()`.
TEST_F(Uses, HaveEveryCommandAndOutput) {
  std::set<std::string> used;
  for (const Use& use : uses()) used.insert(use.arguments.substr(0, use.arguments.find(' ')));
  const std::vector<std::string> all = commands();
  EXPECT_EQ(used, std::set<std::string>(all.begin(), all.end()));
  const auto hasUse = [](const std::string& command, const std::string& words) {
    return std::any_of(uses().begin(), uses().end(), [&](const Use& use) {
      return use.arguments.starts_with(command + " ") &&
             (use.arguments + " ").find(" " + words + " ") != std::string::npos;
    });
  };
  const std::map<std::string, std::string> shortNames{{"solve --output", "-o"}};
  for (const std::string& command : all) {
    const std::string help = run(command + " --help").out;
    for (const std::string option : {"--output", "--picture", "--image", "--save-poses", "--json",
                                     "--states", "--against", "--motions"}) {
      if (help.find(option) == std::string::npos) continue;
      const auto brief = shortNames.find(command + " " + option);
      EXPECT_TRUE(hasUse(command, brief == shortNames.end() ? option : brief->second))
          << command << " " << option;
    }
  }
  for (const std::string query : {"contacts", "distance", "tolerance"})
    EXPECT_TRUE(hasUse("query", "--query " + query)) << query;
}

/// --help and --version print results, so losing them must give exit status 2.
TEST_F(Uses, HelpThatCannotBeWrittenIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "there is no /dev/full";
  for (const char* words : {"--help", "solve --help", "--version"})
    EXPECT_EQ(run(words + std::string(" >/dev/full 2>stderr.txt; exit $?;")).status, 2) << words;
  EXPECT_EQ(read("stderr.txt"), kStdoutFault);
}

}  // namespace
}  // namespace corridor::test
