// Tests of files that must be refused: files that are not ordinary files, and files that are too
// large. Refusing a file must neither wait nor fill memory.
#include "collision/core/read_file.h"

#include <fstream>
#include <functional>
#include <string>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <thread>
#include <unistd.h>

#include <gtest/gtest.h>

#include "collision/core/error.h"
#include "tests/support/support.h"

namespace corridor::test {
namespace {

class ReadFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  /// Creates a file of the given size that takes no space on the disk.
  std::filesystem::path sparse(const std::string& name, std::uint64_t size) const {
    const auto file = write(name, "x");
    std::filesystem::resize_file(file, size);
    return file;
  }

  /// Expects that all three ways of reading refuse the file with the same message.
  void expectRefused(const std::filesystem::path& file, const std::string& expectedLine) const {
    const std::string line = file.string() + ": " + expectedLine;
    EXPECT_EQ(complaintOf([&] { readFile(file, "a thing"); }), line);
    EXPECT_EQ(complaintOf([&] { readTextFile(file, "a thing"); }), line);
    EXPECT_EQ(complaintOf([&] { requireFile(file, "a thing"); }), line);
  }
  static std::string complaintOf(const std::function<void()>& reading) {
    try {
      reading();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no complaint";
  }

  std::filesystem::path folder_ = newFolder();
};

TEST_F(ReadFile, RefusesWhatIsNoOrdinaryFile) {
  expectRefused(folder_ / "missing", "no such file");
  expectRefused(folder_, "is a folder; a file is needed");
  for (const char* const device : {"/dev/zero", "/dev/null", "/dev/full"})
    expectRefused(device, "is a device; an ordinary file is needed");
  // The pipe has no writer, so opening the pipe would wait for a writer.
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  expectRefused(pipe, "is a pipe; an ordinary file is needed");
  std::filesystem::create_symlink(pipe, folder_ / "link");
  expectRefused(folder_ / "link", "is a pipe; an ordinary file is needed");
  const int socket = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string name = (folder_ / "socket").string();
  ASSERT_LT(name.size(), sizeof address.sun_path);
  name.copy(address.sun_path, name.size());
  ASSERT_EQ(::bind(socket, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  expectRefused(name, "is a socket; an ordinary file is needed");
  ::close(socket);
}

TEST_F(ReadFile, TheSizeIsTestedFirst) {
  expectRefused(write("empty", ""), "is empty; a thing is needed");
  const auto huge = sparse("huge", kMostFileBytes + 1);
  const std::string expectedLine = huge.string() + ": has 4294967297 bytes, more than ";
  EXPECT_EQ(complaintOf([&] { readFile(huge, "a thing"); }),
            expectedLine + "4294967296, the limit for a thing");
  EXPECT_EQ(complaintOf([&] { requireFile(huge, "a thing"); }),
            expectedLine + "4294967296, the limit for a thing");
  EXPECT_EQ(complaintOf([&] { readTextFile(huge, "a thing"); }),
            expectedLine + "268435456, the limit for a thing");
  EXPECT_EQ(complaintOf([&] { requireFile(sparse("most", kMostFileBytes), "a thing"); }),
            "no complaint");
  const auto large = sparse("large", kMostDocumentBytes + 1);
  EXPECT_EQ(complaintOf([&] { readTextFile(large, "a thing"); }),
            large.string() + ": has 268435457 bytes, more than 268435456, the limit for a thing");
}

TEST_F(ReadFile, APointerOfGitLfsIsNotTheFile) {
  expectRefused(write("pointer.stl",
                      "version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\n"
                      "size 12345\n"),
                "is a pointer of Git LFS, not the file itself; git lfs pull fetches the file");
  EXPECT_EQ(readFile(write("short", "version https://git-lfs"), "a thing"),
            "version https://git-lfs");
}

TEST_F(ReadFile, TextHasNoByte0) {
  const auto file = write("a", std::string("one\ntwo\n\0three\n", 15));
  EXPECT_EQ(readFile(file, "a thing").size(), 15u);
  for (const auto& reading : {readTextFile, readTextStream})
    EXPECT_EQ(complaintOf([&] { reading(file, "a thing"); }),
              file.string() + ":3: is not text: it has a byte 0; UTF-8 is needed");
  const auto blank = write("b", " \r\n\t\n");
  for (const auto& reading : {readTextFile, readTextStream})
    EXPECT_EQ(complaintOf([&] { reading(blank, "a thing"); }),
              blank.string() + ": is empty; a thing is needed");
}

/// Only `readTextStream` accepts a pipe. It must read to the end of the pipe, even if this needs
/// many short reads.
TEST_F(ReadFile, AStreamTakesAPipe) {
  const auto pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const std::string text(3'000'000, 'x');
  std::thread writer([&] { std::ofstream(pipe) << text; });
  EXPECT_TRUE(readTextStream(pipe, "a thing") == text);
  writer.join();
}

/// A stream that has a byte 0 is refused at once, since it may never end.
TEST_F(ReadFile, RefusesAStreamOfZerosAtOnce) {
  int pipe[2];
  ASSERT_EQ(::pipe(pipe), 0);
  const int before = ::dup(STDIN_FILENO);
  std::thread writer([&] {
    const std::string zeros(1000, '\0');
    for (const char* line = "first\n"; ::write(pipe[1], line, 6) != 6;) {
    }
    [[maybe_unused]] const auto written = ::write(pipe[1], zeros.data(), zeros.size());
  });
  ::dup2(pipe[0], STDIN_FILENO);
  EXPECT_EQ(complaintOf([] { readTextStream("-", "a thing"); }),
            "-:2: is not text: it has a byte 0; UTF-8 is needed");
  ::dup2(before, STDIN_FILENO);
  writer.join();  // returns although the pipe is still open for writing: the reader did not wait
                  // for the end
  for (const int end : {pipe[0], pipe[1], before}) ::close(end);
}

}  // namespace
}  // namespace corridor::test
