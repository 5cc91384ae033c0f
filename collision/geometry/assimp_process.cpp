#include "collision/geometry/assimp_process.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstring>
#include <dlfcn.h>
#include <fcntl.h>
#include <link.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "collision/core/error.h"

namespace corridor {
namespace {

using Clock = std::chrono::steady_clock;

/// Returns the folders where the program or shared library that contains this code searches for
/// libraries.
std::vector<std::filesystem::path> runPath() {
  std::vector<std::filesystem::path> folders;
  Dl_info info{};
  void* self = nullptr;  // glibc's link map, which is also the handle that dlopen returns
  if (!dladdr1(reinterpret_cast<void*>(&runPath), &info, &self, RTLD_DL_LINKMAP) || !self)
    return folders;
  Dl_serinfo size{};
  if (dlinfo(self, RTLD_DI_SERINFOSIZE, &size) != 0) return folders;
  std::vector<std::max_align_t> memory(size.dls_size / sizeof(std::max_align_t) + 1);
  auto* const all = reinterpret_cast<Dl_serinfo*>(memory.data());
  all->dls_size = size.dls_size;
  all->dls_cnt = size.dls_cnt;
  if (dlinfo(self, RTLD_DI_SERINFO, all) != 0) return folders;
  for (unsigned i = 0; i < all->dls_cnt; ++i) folders.emplace_back(all->dls_serpath[i].dls_name);
  return folders;
}

/// A child process that writes to a pipe. The destructor kills it and waits for it.
class Helper {
 public:
  /// @throws std::system_error
  explicit Helper(const std::vector<std::string>& words) {
    int pipe[2];
    if (::pipe2(pipe, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category());
    pipe_ = pipe[0];
    // A larger pipe saves process switches. If the call fails, the pipe keeps the usual 64 KiB.
    ::fcntl(pipe_, F_SETPIPE_SZ, 1 << 20);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, pipe[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    const int error = posix_spawn(&id_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    ::close(pipe[1]);
    if (error == 0) return;
    ::close(pipe_);
    throw std::system_error(error, std::generic_category());
  }
  ~Helper() {
    ::close(pipe_);
    if (id_ < 0) return;
    ::kill(id_, SIGKILL);
    wait();
  }
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  /// Appends to `bytes` all that the process writes until it closes its output, which it does at
  /// the latest when it ends. @returns false if this takes longer than `seconds`.
  bool readAll(double seconds, std::string& bytes) {
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    std::vector<char> part(std::size_t{1} << 18);
    while (true) {
      const double left = std::chrono::duration<double, std::milli>(end - Clock::now()).count();
      pollfd waiting{pipe_, POLLIN, 0};
      if (left <= 0) return false;
      if (::poll(&waiting, 1, static_cast<int>(std::min(std::ceil(left), 1e6))) <= 0) continue;
      const ssize_t n = ::read(pipe_, part.data(), part.size());
      if (n == 0) return true;
      if (n > 0) bytes.append(part.data(), static_cast<std::size_t>(n));
    }
  }

  /// Waits until the process ends. Returns its status, as waitpid(2) reports it. @pre `readAll` has
  /// returned true.
  int end() { return wait(); }

 private:
  int wait() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    id_ = -1;
    return status;
  }

  int pipe_ = -1;
  pid_t id_ = -1;
};

std::string textOf(int status) {
  if (WIFSIGNALED(status))
    return "killed by signal " + std::to_string(WTERMSIG(status)) + ", " +
           ::strsignal(WTERMSIG(status));
  return "exit status " + std::to_string(WEXITSTATUS(status));
}

std::string text(double seconds) {
  char digits[32];
  return {digits, std::to_chars(digits, digits + sizeof digits, seconds).ptr};
}

}  // namespace

std::filesystem::path AssimpLimits::assimpProgram() {
  std::error_code error;
  std::vector<std::filesystem::path> folders{
      std::filesystem::read_symlink("/proc/self/exe", error).parent_path()};
  for (auto& folder : runPath()) folders.push_back(std::move(folder));
  folders.emplace_back(CORRIDOR_ASSIMP_DIR);
  for (auto& folder : folders)
    if (auto file = folder / CORRIDOR_ASSIMP_PROGRAM;
        std::filesystem::is_regular_file(file, error) && ::access(file.c_str(), X_OK) == 0)
      return file;
  return {};
}

AssimpImport readWithAssimp(const std::string& file, AssimpRules rules,
                            const AssimpLimits& limits) {
  const auto fail = [&](const std::string& what) { throw InputError(Fault{file, 0, what}); };
  const std::string instead = "; save the mesh as OBJ, STL, PLY or OFF";
  if (limits.program.empty())
    fail("assimp is needed for this format, and its program " CORRIDOR_ASSIMP_PROGRAM
         " is not found; install it with the library, or save the mesh as OBJ, STL, PLY or OFF");
  AssimpImport result;
  try {
    Helper helper({limits.program.string(), file, std::to_string(static_cast<int>(rules)),
                   text(limits.seconds), std::to_string(limits.bytes), std::to_string(::getpid())});
    std::string bytes;
    if (!helper.readAll(limits.seconds, bytes))
      fail("assimp, which reads this format, took more than " + text(limits.seconds) +
           " s and was stopped" + instead);
    if (!unpack(bytes, result)) {
      const int status = helper.end();
      if (WIFEXITED(status) && WEXITSTATUS(status) == kOutOfMemoryStatus)
        fail("assimp, which reads this format, needs more than " +
             std::to_string(limits.bytes >> 20) + " MiB of memory for this file" + instead);
      fail("assimp, which reads this format, ended without an answer (" + textOf(status) + ")" +
           instead);
    }
  } catch (const std::system_error& error) {
    fail("assimp is needed for this format, and its program " + limits.program.string() +
         " cannot be started: " + error.code().message());
  }
  if (!result.faults.empty()) throw InputError(std::move(result.faults));
  if (!result.error.empty()) fail("cannot be read by assimp: " + result.error);
  return result;
}

}  // namespace corridor
