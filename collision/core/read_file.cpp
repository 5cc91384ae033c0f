#include "collision/core/read_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/text_encoding.h"

namespace corridor {
namespace {

[[noreturn]] void fail(const std::string& name, std::string text, int line = 0) {
  throw InputError(Fault{name, line, std::move(text)});
}

std::string whyNotOrdinary(std::filesystem::file_type type) {
  using Type = std::filesystem::file_type;
  switch (type) {
    case Type::regular:
      return "";
    case Type::not_found:
    case Type::none:
      return "no such file";
    case Type::directory:
      return "is a folder; a file is needed";
    case Type::fifo:
      return "is a pipe; an ordinary file is needed";
    case Type::character:
    case Type::block:
      return "is a device; an ordinary file is needed";
    case Type::socket:
      return "is a socket; an ordinary file is needed";
    default:
      return "is not an ordinary file; an ordinary file is needed";
  }
}

/// An open file descriptor, closed by the destructor.
class OpenFile {
 public:
  OpenFile(const std::filesystem::path& file, int flags)
      : descriptor_(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOCTTY | flags)) {
    if (descriptor_ < 0)
      fail(file.string(), std::string("cannot be read: ") + std::strerror(errno));
  }
  ~OpenFile() { ::close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Reads the bytes that are available, at most `size`. @returns the number of bytes read; 0 at the
/// end of the input.
std::size_t readSome(int descriptor, char* to, std::size_t size, const std::string& name) {
  constexpr std::size_t most = std::size_t{1} << 30;  // bytes per call; Linux's limit is 2 GiB
  while (true) {
    const ssize_t n = ::read(descriptor, to, std::min(size, most));
    if (n >= 0) return static_cast<std::size_t>(n);
    if (errno != EINTR) fail(name, std::string("cannot be read: ") + std::strerror(errno));
  }
}

/// An open ordinary file, and its size.
class OrdinaryFile : public OpenFile {
 public:
  // O_NONBLOCK: if a pipe replaces the file after `checkedPath`, opening does not wait for a
  // writer.
  OrdinaryFile(const std::filesystem::path& file, const std::string& what, std::uint64_t most)
      : OpenFile(checkedPath(file), O_NONBLOCK) {
    const std::string name = file.string();
    struct stat status {};
    if (::fstat(descriptor(), &status) != 0 || !S_ISREG(status.st_mode))
      fail(name, "is not an ordinary file; an ordinary file is needed");
    size_ = static_cast<std::uint64_t>(status.st_size);
    if (size_ == 0) fail(name, "is empty; " + what + " is needed");
    if (size_ > most)
      fail(name, "has " + std::to_string(size_) + " bytes, more than " + std::to_string(most) +
                     ", the limit for " + what);
    if (isLfsPointer())
      fail(name, "is a pointer of Git LFS, not the file itself; git lfs pull fetches the file");
  }
  std::uint64_t size() const { return size_; }

 private:
  static const std::filesystem::path& checkedPath(const std::filesystem::path& file) {
    if (const std::string why = whyNotOrdinaryFile(file); !why.empty()) fail(file.string(), why);
    return file;
  }

  /// Returns whether the file is a Git LFS pointer. Such pointers are common, because repositories
  /// are often cloned without their large files.
  bool isLfsPointer() const {
    constexpr std::string_view begin = "version https://git-lfs.github.com/spec/";
    std::array<char, begin.size()> bytes{};
    const ssize_t n = ::pread(descriptor(), bytes.data(), bytes.size(), 0);
    return n == static_cast<ssize_t>(bytes.size()) &&
           std::string_view(bytes.data(), bytes.size()) == begin;
  }

  std::uint64_t size_ = 0;
};

/// Throws if `text` has a byte 0 at `from` or later.
void requireText(const std::string& text, std::size_t from, const std::string& name) {
  const auto zero = text.find('\0', from);
  if (zero == text.npos) return;
  const auto lines =
      std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n');
  fail(name, "is not text: it has a byte 0; UTF-8 is needed", static_cast<int>(1 + lines));
}

/// Returns the text. Throws if the text consists of blanks only.
std::string notBlank(std::string text, const std::string& name, const std::string& what) {
  if (text.find_first_not_of(" \t\r\n") == text.npos)
    fail(name, "is empty; " + what + " is needed");
  return text;
}

/// Returns all bytes up to the end of the pipe. Throws if the text consists of blanks only, has
/// more than `kMostFileBytes` bytes, or contains a byte 0.
std::string readPipe(int descriptor, const std::string& name, const std::string& what) {
  std::vector<char> part(std::size_t{1} << 18);
  std::string text;
  while (true) {
    const std::size_t before = text.size();
    const std::size_t n = readSome(descriptor, part.data(), part.size(), name);
    text.append(part.data(), n);
    if (n == 0) return notBlank(std::move(text), name, what);
    if (text.size() > kMostFileBytes)
      fail(name,
           "has more than " + std::to_string(kMostFileBytes) + " bytes, the limit for " + what);
    requireText(text, before, name);
  }
}

}  // namespace

std::string whyNotOrdinaryFile(const std::filesystem::path& file) {
  std::error_code error;
  return whyNotOrdinary(std::filesystem::status(file, error).type());
}

void requireFile(const std::filesystem::path& file, const std::string& what, std::uint64_t most) {
  OrdinaryFile(file, what, most);
}

std::string readFile(const std::filesystem::path& file, const std::string& what,
                     std::uint64_t most) {
  const std::string name = file.string();
  const OrdinaryFile open(file, what, most);
  std::string bytes(static_cast<std::size_t>(open.size()), '\0');
  for (std::size_t done = 0; done < bytes.size();) {
    const std::size_t n =
        readSome(open.descriptor(), bytes.data() + done, bytes.size() - done, name);
    if (n == 0)
      fail(name, "cannot be read: it ended after " + std::to_string(done) + " of " +
                     std::to_string(bytes.size()) + " bytes");
    done += n;
  }
  return bytes;
}

void requireOwnFormat(std::string_view bytes, const std::filesystem::path& file,
                      const std::string& what) {
  const std::string other = foreignFormat(bytes.substr(0, 64));
  if (other.empty()) return;
  const bool isText = other.starts_with("text");
  fail(file.string(), "is " + other + "; " + (isText ? "save it in UTF-8" : what + " is needed"));
}

std::string withLineFeeds(std::string text) {
  for (std::size_t at = text.find('\r'); at != text.npos; at = text.find('\r', at + 1))
    if (at + 1 == text.size() || text[at + 1] != '\n') text[at] = '\n';
  return text;
}

std::string readTextFile(const std::filesystem::path& file, const std::string& what) {
  std::string text = readFile(file, what, kMostDocumentBytes);
  requireOwnFormat(text, file, what);
  requireText(text, 0, file.string());
  return withLineFeeds(notBlank(std::move(text), file.string(), what));
}

std::string readTextStream(const std::filesystem::path& file, const std::string& what) {
  const std::string name = file.string();
  if (file == "-" || file == "/dev/stdin") return withLineFeeds(readPipe(STDIN_FILENO, name, what));
  std::error_code none;
  if (std::filesystem::is_fifo(file, none))
    return withLineFeeds(readPipe(OpenFile(file, 0).descriptor(), name, what));
  std::string text = readFile(file, what);
  requireOwnFormat(text, file, what);
  requireText(text, 0, name);
  return withLineFeeds(notBlank(std::move(text), name, what));
}

}  // namespace corridor
