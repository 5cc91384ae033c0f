#include "collision/core/whole_file.h"

#include <cerrno>
#include <csignal>
#include <ext/stdio_filebuf.h>
#include <fcntl.h>
#include <iostream>
#include <random>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/user_signals.h"

namespace corridor {
namespace {

/// While an object of this class exists, its thread blocks the signals by which users end programs.
class SignalBlocker {
 public:
  SignalBlocker() {
    sigset_t signals;
    sigemptyset(&signals);
    for (const int signal : kUserSignals) sigaddset(&signals, signal);
    sigaddset(&signals, SIGQUIT);
    ::pthread_sigmask(SIG_BLOCK, &signals, &before_);
  }
  SignalBlocker(const SignalBlocker&) = delete;
  SignalBlocker& operator=(const SignalBlocker&) = delete;
  ~SignalBlocker() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

 private:
  sigset_t before_{};
};

/// Opens a device or a pipe for writing. Opening a pipe waits for a reader. During this wait, the
/// signals by which users end programs have their default action, since nothing is written yet.
int openToWrite(const std::filesystem::path& file) {
  std::error_code none;
  if (!std::filesystem::is_fifo(file, none)) return ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  struct Handled {
    int signal;
    struct sigaction action;
  };
  std::vector<Handled> handled;
  for (const int signal : kUserSignals) {
    struct sigaction action {};
    if (::sigaction(signal, nullptr, &action) != 0 || action.sa_handler == SIG_IGN ||
        action.sa_handler == SIG_DFL)
      continue;
    handled.push_back({signal, action});
    ::signal(signal, SIG_DFL);
  }
  const int descriptor = ::open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const int failure = errno;
  for (const Handled& each : handled) ::sigaction(each.signal, &each.action, nullptr);
  errno = failure;
  return descriptor;
}

/// Writes to an open file, and closes it. @returns 0, or the system's error number (EIO if it gives
/// none).
int writeTo(int descriptor, const std::function<void(std::ostream&)>& write) {
  if (descriptor < 0) return errno;
  errno = 0;
  __gnu_cxx::stdio_filebuf<char> buffer(descriptor, std::ios::out | std::ios::binary);
  std::ostream out(&buffer);
  write(out);
  return out.flush() && buffer.close() ? 0 : errno != 0 ? errno : EIO;
}

/// A new file that is removed unless it is renamed. Its name can't be foreseen, and nothing that
/// has this name, such as a link, is opened. It is short, since the names of files have at most 255
/// bytes.
class Draft {
 public:
  explicit Draft(const std::filesystem::path& folder) {
    std::random_device random;
    for (int attempt = 0; descriptor_ < 0 && attempt < 100; ++attempt) {
      path_ = folder / (".corridor" + std::to_string(random()) + ".tmp");
      descriptor_ =
          ::open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
      if (descriptor_ < 0 && errno != EEXIST) break;
    }
    if (descriptor_ < 0) failure_ = errno, path_.clear();
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }

  /// Gives the file the mode of another one, if that exists, writes it, and gives it the other's
  /// name. @returns 0, or the system's error number.
  int replace(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
    if (failure_ != 0) return failure_;
    struct stat old {};
    if (::stat(file.c_str(), &old) == 0) ::fchmod(descriptor_, old.st_mode & 0777);
    if (const int failure = writeTo(descriptor_, write)) return failure;
    std::error_code failure;
    std::filesystem::rename(path_, file, failure);
    if (!failure) path_.clear();
    return failure.value();
  }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  int failure_ = 0;
};

/// Returns the file to which a symbolic link leads, which need not exist, or the file itself. For
/// links in a circle, returns one of them.
std::filesystem::path targetOf(std::filesystem::path file) {
  std::error_code failure;
  for (int links = 0; links < 40 && std::filesystem::is_symlink(file, failure); ++links) {
    const std::filesystem::path next = std::filesystem::read_symlink(file, failure);
    if (failure) break;
    file = file.parent_path() / next;
  }
  return file;
}

/// Returns the descriptor of the standard output or the errors if they go to this file, or else -1.
/// The file's name may be /dev/stdout, and other programs may write to it, too.
int standardStream(const std::filesystem::path& file) {
  struct stat named {
  }, stream{};
  if (::stat(file.c_str(), &named) == 0)
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO})
      if (::fstat(descriptor, &stream) == 0 && stream.st_dev == named.st_dev &&
          stream.st_ino == named.st_ino)
        return descriptor;
  return -1;
}

std::string helpFor(const std::error_code& failure) {
  switch (failure.value()) {
    case ENOSPC:
    case EDQUOT:
      return "; free some space, or name another file";
    case EFBIG:
      return "; raise the limit on the size of files (ulimit -f)";
    case EACCES:
    case EPERM:
    case EROFS:
      return "; name a file that you may write";
    default:
      return "";
  }
}

}  // namespace

std::error_code tryWriteWhole(const std::filesystem::path& file,
                              const std::function<void(std::ostream&)>& write) {
  std::error_code ignored;
  int failure = 0;
  // Renaming a file over a device or a pipe would replace it.
  const bool isDevice =
      std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored);
  if (const int stream = standardStream(file); stream >= 0) {
    std::cout.flush();  // what was printed before stays before
    failure = writeTo(::dup(stream), write);
  } else if (isDevice) {
    failure = writeTo(openToWrite(file), write);
  } else {
    const SignalBlocker wait;
    const std::filesystem::path target = targetOf(file);
    failure = std::filesystem::is_symlink(target, ignored)
                  ? ELOOP
                  : Draft(target.parent_path()).replace(target, write);
  }
  return {failure, std::generic_category()};
}

void writeWhole(const std::filesystem::path& file,
                const std::function<void(std::ostream&)>& write) {
  if (const std::error_code failure = tryWriteWhole(file, write))
    throw InputError(
        Fault{file.string(), 0, "can't be written: " + failure.message() + helpFor(failure)});
}

void writeWhole(const std::filesystem::path& file, const std::string& text) {
  writeWhole(file, [&](std::ostream& out) { out << text; });
}

}  // namespace corridor
