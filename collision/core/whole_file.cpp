#include "collision/core/whole_file.h"

#include <cerrno>
#include <csignal>
#include <fstream>
#include <system_error>
#include <unistd.h>

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

/// A file that is removed unless it is renamed.
class Draft {
 public:
  explicit Draft(std::filesystem::path path) : path_(std::move(path)) {}
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;
  ~Draft() {
    std::error_code ignored;
    if (!path_.empty()) std::filesystem::remove(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  /// @returns 0, or the system's error number.
  int rename(const std::filesystem::path& file) {
    std::error_code failure;
    std::filesystem::rename(path_, file, failure);
    if (!failure) path_.clear();
    return failure.value();
  }

 private:
  std::filesystem::path path_;
};

/// Writes the file. @returns 0, or the system's error number (-1 if it gives none).
int writeFile(const std::filesystem::path& file, const std::function<void(std::ostream&)>& write) {
  errno = 0;
  std::ofstream out(file, std::ios::binary);
  if (out) write(out);
  if (out) out.close();
  return out ? 0 : errno != 0 ? errno : -1;
}

std::string helpFor(int failure) {
  switch (failure) {
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

void writeWhole(const std::filesystem::path& file,
                const std::function<void(std::ostream&)>& write) {
  std::error_code ignored;
  int failure = 0;
  // Renaming a file over a device or a pipe would replace it.
  if (std::filesystem::exists(file, ignored) && !std::filesystem::is_regular_file(file, ignored)) {
    failure = writeFile(file, write);
  } else {
    const SignalBlocker wait;
    Draft draft(file.string() + ".tmp" + std::to_string(::getpid()));
    failure = writeFile(draft.path(), write);
    if (failure == 0) failure = draft.rename(file);
  }
  if (failure != 0)
    throw InputError(
        Fault{file.string(), 0,
              "can't be written" +
                  (failure > 0 ? ": " + std::generic_category().message(failure) + helpFor(failure)
                               : std::string())});
}

void writeWhole(const std::filesystem::path& file, const std::string& text) {
  writeWhole(file, [&](std::ostream& out) { out << text; });
}

}  // namespace corridor
