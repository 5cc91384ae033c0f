#include "planner/jobs/child_process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <fcntl.h>
#include <iostream>
#include <new>
#include <poll.h>
#include <sstream>
#include <stdexcept>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "collision/core/memory_limit.h"
#include "collision/core/user_signals.h"

namespace corridor {
namespace {

using Seconds = std::chrono::duration<double>;

/// Milliseconds between the parent's tests of `interrupted`.
constexpr int kSignalPollMs = 200;
// The first byte of each line that the child sends.
constexpr char kMessage = 'm', kFailure = 'f';

std::system_error systemError(const char* what) {
  return {errno, std::generic_category(), what};
}

void writeAll(int socket, const std::string& text) {
  for (std::size_t done = 0; done < text.size();) {
    const ssize_t n = ::send(socket, text.data() + done, text.size() - done, MSG_NOSIGNAL);
    if (n < 0 && errno != EINTR) ::_exit(1);  // the parent is gone
    if (n > 0) done += static_cast<std::size_t>(n);
  }
}

/// Waits in the child for a task of the parent. (If the parent ends, so does the child, by
/// `PR_SET_PDEATHSIG`: the socket stays open as long as children have copies of the parent's end.)
std::uint64_t nextTask(int socket) {
  std::uint64_t task = 0;
  ssize_t n = 0;
  do n = ::recv(socket, &task, sizeof task, MSG_WAITALL);
  while (n < 0 && errno == EINTR);
  if (n != sizeof task) ::_exit(1);
  return task;
}

[[noreturn]] void child(int socket, const std::function<void(int, const ChildProcess::Send&)>& run,
                        std::size_t bytes, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent ended before prctl took effect
  // A signal from the terminal reaches the whole process group. The child ignores it, so that the
  // parent alone decides what happens.
  for (const int signal : kUserSignals) ::signal(signal, SIG_IGN);
  if (bytes > 0) limitMemory(bytes);
  std::string failure;
  try {
    run(socket, [&](const std::string& text) { writeAll(socket, kMessage + text + '\n'); });
  } catch (const std::bad_alloc&) {
    failure = "out of memory";
  } catch (const std::exception& error) {
    failure = error.what();
    for (char& c : failure)
      if (c == '\n') c = ' ';
    if (failure.empty()) failure = "an exception without a text";
  }
  if (!failure.empty()) writeAll(socket, kFailure + failure + '\n');
  ::_exit(0);
}

std::string endOf(int status) {
  if (WIFSIGNALED(status))
    return "killed by signal " + std::to_string(WTERMSIG(status)) + " (" +
           ::strsignal(WTERMSIG(status)) + ")";
  return "ended early, with exit status " + std::to_string(WEXITSTATUS(status));
}

}  // namespace

void ChildProcess::start(const std::function<void(int, const Send&)>& run, std::size_t bytes) {
  int ends[2];
  // SOCK_CLOEXEC: programs that the child starts must not keep the socket open.
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
    throw systemError("socketpair");
  std::cout.flush();
  std::fflush(nullptr);  // otherwise the child would write buffered output a second time
  const pid_t parent = ::getpid();
  id_ = ::fork();
  if (id_ < 0) {
    const auto error = systemError("fork");
    ::close(ends[0]);
    ::close(ends[1]);
    throw error;
  }
  if (id_ == 0) {
    ::close(ends[0]);
    ::fcntl(ends[1], F_SETFL, 0);  // the child's end blocks
    child(ends[1], run, bytes, parent);
  }
  ::close(ends[1]);
  socket_ = ends[0];
}

ChildProcess::ChildProcess(const Work& work, const ChildLimits& limits)
    : patience_(limits.patience), since_(std::chrono::steady_clock::now()), isForTasks_(false) {
  start([&](int, const Send& send) { work(send); }, limits.bytes);
}

ChildProcess::ChildProcess(const TaskWork& work, std::uint64_t task, const ChildLimits& limits)
    : patience_(limits.patience), since_(std::chrono::steady_clock::now()), isForTasks_(true) {
  start(
      [&](int socket, const Send& send) {
        for (std::uint64_t now = task;; now = nextTask(socket)) {
          std::size_t sent = 0;
          work(now, [&](const std::string& text) {
            send(text);
            ++sent;
          });
          // Both sides would wait, or take the messages for those of the next task.
          if (sent != limits.patience.size())
            throw std::logic_error("a task sent " + std::to_string(sent) + " messages, not " +
                                   std::to_string(limits.patience.size()));
        }
      },
      limits.bytes);
}

ChildProcess::ChildProcess(ChildProcess&& other) noexcept
    : patience_(std::move(other.patience_)),
      since_(other.since_),
      isForTasks_(other.isForTasks_),
      socket_(std::exchange(other.socket_, -1)),
      id_(std::exchange(other.id_, -1)),
      text_(std::move(other.text_)),
      end_(std::move(other.end_)) {}

ChildProcess::~ChildProcess() {
  if (!over()) finish(true);
}

void ChildProcess::stop(const std::string& reason) {
  if (over()) return;
  end_.failure = reason;
  finish(true);
}

bool ChildProcess::begin(std::uint64_t task) {
  if (over()) return false;
  end_ = {};
  since_ = std::chrono::steady_clock::now();
  // The child has read all earlier tasks, so there is room for this one.
  if (::send(socket_, &task, sizeof task, MSG_NOSIGNAL) == sizeof task) return true;
  finish(true);
  return false;
}

/// Takes one line from the text that was read, and returns true; returns false if there is no
/// complete line. After the last message, a child that has no further task is killed. After a line
/// that reports a failure, this function waits for the end of the child.
bool ChildProcess::takeLine() {
  const auto at = text_.find('\n');
  if (at == std::string::npos) return false;
  const std::string line = text_.substr(1, at - 1);
  const bool failed = text_[0] == kFailure;
  text_.erase(0, at + 1);
  since_ = std::chrono::steady_clock::now();
  if (failed)
    end_.failure = line;
  else
    end_.messages.push_back(line);
  if (failed || (hasAll() && !isForTasks_)) finish(!failed);
  return true;
}

bool ChildProcess::poll() {
  while (!over() && !hasAll()) {
    if (takeLine()) continue;
    char part[65536];
    const ssize_t n = ::recv(socket_, part, sizeof part, 0);
    if (n > 0) {
      text_.append(part, static_cast<std::size_t>(n));
    } else if (n == 0 || errno == ECONNRESET) {  // the latter: the child left a task unread
      finish(false);
    } else if (errno != EINTR) {
      const double patience = patience_[end_.messages.size()];
      if (Seconds(std::chrono::steady_clock::now() - since_).count() <= patience) break;
      std::ostringstream text;
      text << "stopped after " << patience << " s";
      stop(text.str());
    }
  }
  return over() || hasAll();
}

void ChildProcess::finish(bool kill) {
  ::close(socket_);
  if (kill) ::kill(id_, SIGKILL);
  int status = 0;
  while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
  }
  socket_ = id_ = -1;
  if (end_.failure.empty() && !hasAll()) end_.failure = endOf(status);
}

void ChildProcess::waitForAny(const std::vector<ChildProcess*>& children, int milliseconds) {
  std::vector<pollfd> waiting;
  for (const ChildProcess* child : children) waiting.push_back({child->socket_, POLLIN, 0});
  ::poll(waiting.data(), waiting.size(), milliseconds);
}

ChildEnd inChild(const ChildProcess::Work& work, const ChildLimits& limits,
                 const std::atomic<bool>* interrupted) {
  ChildProcess child(work, limits);
  while (!child.poll()) {
    if (interrupted && interrupted->load())
      child.stop("interrupted");
    else
      ChildProcess::waitForAny({&child}, kSignalPollMs);
  }
  return child.end();
}

}  // namespace corridor
