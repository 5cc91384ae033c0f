#include "planner/benchmark/child_process.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <fstream>
#include <iostream>
#include <new>
#include <poll.h>
#include <sstream>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace corridor {
namespace {

using Seconds = std::chrono::duration<double>;

/// How often the parent looks whether it was interrupted.
constexpr int kLookMs = 200;
// What a line of the child's is.
constexpr char kMessage = 'm', kFailure = 'f';

std::system_error systemError(const char* what) {
  return {errno, std::generic_category(), what};
}

void writeAll(int pipe, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::write(pipe, text.data() + done, text.size() - done);
    if (n < 0 && errno != EINTR) ::_exit(1);  // the parent is gone
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

/// What a process has of data, stack and heap: what RLIMIT_DATA limits.
std::size_t dataBytes() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmData:", 0) == 0) {
      std::size_t kilobytes = 0;
      std::istringstream(line.substr(7)) >> kilobytes;
      return kilobytes * 1024;
    }
  return 0;
}

void limitMemory(std::size_t bytes) {
  const std::size_t now = dataBytes();
  if (bytes == 0 || now == 0) return;
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min<rlim_t>(now + bytes, limit.rlim_max);
  setrlimit(RLIMIT_DATA, &limit);
}

[[noreturn]] void child(
    int pipe, const std::function<void(const std::function<void(const std::string&)>&)>& work,
    std::size_t bytes) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent decides what an interrupt from the terminal means.
  ::signal(SIGINT, SIG_IGN);
  limitMemory(bytes);
  std::string failure;
  try {
    work([&](const std::string& text) { writeAll(pipe, kMessage + text + '\n'); });
  } catch (const std::bad_alloc&) {
    failure = "out of memory";
  } catch (const std::exception& error) {
    failure = error.what();
    for (char& c : failure)
      if (c == '\n') c = ' ';
    if (failure.empty()) failure = "an exception without a text";
  }
  if (!failure.empty()) writeAll(pipe, kFailure + failure + '\n');
  ::_exit(0);
}

std::string endOf(int status) {
  if (WIFSIGNALED(status))
    return "killed by signal " + std::to_string(WTERMSIG(status)) + " (" +
           ::strsignal(WTERMSIG(status)) + ")";
  return "ended early, with exit status " + std::to_string(WEXITSTATUS(status));
}

/// The child's lines, as they come.
class Lines {
 public:
  Lines(int pipe, ChildEnd& end) : pipe_(pipe), end_(end) {}

  enum class Got { nothing, message, failure, theEnd };
  /// Waits for kLookMs at most.
  Got next() {
    for (;;) {
      if (const auto at = text_.find('\n'); at != std::string::npos) {
        const char kind = text_[0];
        const std::string line = text_.substr(1, at - 1);
        text_.erase(0, at + 1);
        if (kind == kFailure) {
          end_.failure = line;
          return Got::failure;
        }
        end_.messages.push_back(line);
        return Got::message;
      }
      pollfd waiting{pipe_, POLLIN, 0};
      if (::poll(&waiting, 1, kLookMs) <= 0) return Got::nothing;
      char part[65536];
      const ssize_t n = ::read(pipe_, part, sizeof part);
      if (n == 0) return Got::theEnd;
      if (n > 0) text_.append(part, static_cast<std::size_t>(n));
    }
  }

 private:
  int pipe_;
  ChildEnd& end_;
  std::string text_;
};

}  // namespace

ChildEnd inChild(const std::function<void(const std::function<void(const std::string&)>&)>& work,
                 const ChildLimits& limits, const std::atomic<bool>* interrupted) {
  int pipe[2];
  // Programs that the child starts shall not keep it open.
  if (::pipe2(pipe, O_CLOEXEC) != 0) throw systemError("pipe");
  std::cout.flush();
  std::fflush(nullptr);  // what is buffered would be written twice
  const pid_t id = ::fork();
  if (id < 0) {
    const auto error = systemError("fork");
    ::close(pipe[0]);
    ::close(pipe[1]);
    throw error;
  }
  if (id == 0) {
    ::close(pipe[0]);
    child(pipe[1], work, limits.bytes);
  }
  ::close(pipe[1]);

  ChildEnd end;
  Lines lines(pipe[0], end);
  bool over = false;  // it said why, or nothing more
  auto since = std::chrono::steady_clock::now();
  while (!over && end.messages.size() < limits.patience.size()) {
    const double patience = limits.patience[end.messages.size()];
    const Lines::Got got = lines.next();
    if (got == Lines::Got::message) {
      since = std::chrono::steady_clock::now();
    } else if (got != Lines::Got::nothing) {
      over = true;
    } else if (interrupted && interrupted->load()) {
      end.failure = "interrupted";
    } else if (Seconds(std::chrono::steady_clock::now() - since).count() > patience) {
      std::ostringstream text;
      text << "stopped after " << patience << " s";
      end.failure = text.str();
    }
    if (!end.failure.empty()) break;
  }
  ::close(pipe[0]);
  if (!over) ::kill(id, SIGKILL);  // all was said, or the patience is at its end
  int status = 0;
  while (::waitpid(id, &status, 0) < 0 && errno == EINTR) {
  }
  if (end.failure.empty() && end.messages.size() < limits.patience.size())
    end.failure = endOf(status);
  return end;
}

}  // namespace corridor
