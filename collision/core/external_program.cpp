#include "collision/core/external_program.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <poll.h>
#include <sstream>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

namespace corridor {
namespace {

/// A file in memory for a program's output. Unlike a pipe, such a file is never full, so the two
/// outputs can be read one after the other when the program has ended.
class Output {
 public:
  Output() {
    const int file = ::memfd_create("output", MFD_CLOEXEC);
    if (file < 0) throw std::system_error(errno, std::generic_category());
    // If the caller's standard streams are closed, `file` may have the number of one of them. The
    // child needs these numbers.
    file_ = ::fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
    const int error = errno;
    ::close(file);
    if (file_ < 0) throw std::system_error(error, std::generic_category());
  }
  ~Output() { ::close(file_); }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  int file() const { return file_; }
  std::size_t size() const {
    struct stat now {};
    return ::fstat(file_, &now) == 0 ? static_cast<std::size_t>(now.st_size) : 0;
  }
  std::string text() const {
    std::string bytes(size(), '\0');
    std::size_t read = 0;
    while (read < bytes.size()) {
      const ssize_t n =
          ::pread(file_, bytes.data() + read, bytes.size() - read, static_cast<off_t>(read));
      if (n < 0 && errno == EINTR) continue;
      if (n <= 0) break;
      read += static_cast<std::size_t>(n);
    }
    bytes.resize(read);
    return bytes;
  }

 private:
  int file_ = -1;
};

/// Returns pointers to the words, and a null pointer at the end. The pointers are valid as long as
/// `words` exists.
std::vector<char*> pointersTo(const std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (const std::string& word : words) pointers.push_back(const_cast<char*>(word.c_str()));
  pointers.push_back(nullptr);
  return pointers;
}

/// Waits for the end of a process, up to 10 ms at a time. Without the kernel's help (before Linux
/// 5.3), each wait takes the 10 ms.
class EndOfProcess {
 public:
  explicit EndOfProcess(pid_t process)
      : file_(static_cast<int>(::syscall(SYS_pidfd_open, process, 0))) {}
  ~EndOfProcess() {
    if (file_ >= 0) ::close(file_);
  }
  EndOfProcess(const EndOfProcess&) = delete;
  EndOfProcess& operator=(const EndOfProcess&) = delete;
  void wait() const {
    pollfd end{file_, POLLIN, 0};  // poll ignores a negative file
    ::poll(&end, 1, 10);
  }

 private:
  int file_;
};

}  // namespace

ProgramEnd runProgram(const ProgramCall& call) {
  const Output out, err;
  const std::vector<char*> words = pointersTo(call.words), own = pointersTo(call.environment);
  char* const* const environment = call.environment.empty() ? environ : own.data();
  const char* const folder = call.folder.empty() ? "." : call.folder.c_str();
  const pid_t parent = ::getpid();
  const pid_t child = ::fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), call.words[0]);
  if (child == 0) {  // calls only functions that are safe after fork() in a process with threads
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    // Corridor ignores SIGXFSZ. A program that inherits this setting may hang at `ulimit -f`.
    ::signal(SIGXFSZ, SIG_DFL);
    const int nothing = ::open("/dev/null", O_RDONLY);
    if (nothing < 0 || ::dup2(nothing, STDIN_FILENO) < 0 || ::dup2(out.file(), STDOUT_FILENO) < 0 ||
        ::dup2(err.file(), STDERR_FILENO) < 0 || ::chdir(folder) != 0)
      ::_exit(127);
    ::execve(words[0], words.data(), environment);
    ::_exit(127);
  }
  ::setpgid(child, child);  // the child calls it, too, because either process may run first
  const auto latest =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(call.seconds);
  const EndOfProcess endOfChild(child);
  ProgramEnd end;
  int status = 0;
  bool ended = false;
  while (!ended && end.why == ProgramEnd::Why::exited) {
    // WNOWAIT: the child keeps its number until its group is killed. Another process could get it.
    siginfo_t found{};
    const int failed =
        ::waitid(P_PID, static_cast<id_t>(child), &found, WEXITED | WNOHANG | WNOWAIT);
    if (failed != 0 && errno == EINTR) continue;
    if (failed != 0) end.why = ProgramEnd::Why::statusLost;
    ended = failed != 0 || found.si_pid == child;
    if (ended) break;
    if (call.interrupted && *call.interrupted) end.why = ProgramEnd::Why::interrupted;
    if (std::chrono::steady_clock::now() > latest) end.why = ProgramEnd::Why::timedOut;
    if (out.size() > call.bytes || err.size() > call.bytes)
      end.why = ProgramEnd::Why::tooMuchOutput;
    endOfChild.wait();
  }
  ::kill(-child, SIGKILL);  // the whole group: the program, and children that it has left behind
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  const bool known = ended && end.why != ProgramEnd::Why::statusLost;
  if (known && WIFEXITED(status)) end.exitStatus = WEXITSTATUS(status);
  if (known && WIFSIGNALED(status)) end.signal = WTERMSIG(status);
  if (out.size() > call.bytes || err.size() > call.bytes) {
    end.why = ProgramEnd::Why::tooMuchOutput;
    return end;
  }
  end.out = out.text();
  end.err = err.text();
  return end;
}

std::filesystem::path findProgram(const std::string& name) {
  const char* const variable = std::getenv("PATH");
  std::istringstream folders(variable ? variable : "");
  std::error_code none;
  for (std::string folder; std::getline(folders, folder, ':');) {
    if (folder.empty()) continue;
    std::filesystem::path program = std::filesystem::absolute(folder, none) / name;
    if (std::filesystem::is_regular_file(program, none) && ::access(program.c_str(), X_OK) == 0)
      return program;
  }
  return {};
}

}  // namespace corridor
