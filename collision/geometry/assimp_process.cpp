#include "collision/geometry/assimp_process.h"

#include <charconv>
#include <cstring>
#include <dlfcn.h>
#include <link.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "collision/core/error.h"
#include "collision/core/external_program.h"

namespace corridor {
namespace {

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

std::string textOf(const ProgramEnd& end) {
  if (end.signal != 0)
    return "killed by signal " + std::to_string(end.signal) + ", " + ::strsignal(end.signal);
  return "exit status " + std::to_string(end.exitStatus);
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

AssimpImport readWithAssimp(const std::string& file, const AssimpLimits& limits) {
  const auto fail = [&](const std::string& what) { throw InputError(Fault{file, 0, what}); };
  const std::string instead = "; save the mesh as OBJ, STL, PLY or OFF";
  if (limits.program.empty())
    fail("assimp is needed for OMPL.app's files, and its program " CORRIDOR_ASSIMP_PROGRAM
         " is not found; install it with the library, or save the mesh as OBJ, STL, PLY or OFF");
  const std::string needed =
      "assimp is needed for OMPL.app's files, and its program " + limits.program.string() + ' ';
  AssimpImport result;
  try {
    ProgramCall call{
        {limits.program.string(), file, text(limits.seconds), std::to_string(limits.bytes)}};
    call.seconds = limits.seconds;
    call.bytes = limits.bytes;
    const ProgramEnd end = runProgram(call);
    if (end.why == ProgramEnd::Why::timedOut)
      fail("assimp, which OMPL.app uses, took more than " + text(limits.seconds) +
           " s and was stopped" + instead);
    if (end.why == ProgramEnd::Why::tooMuchOutput)
      fail("assimp, which OMPL.app uses, returns more than " + std::to_string(limits.bytes >> 20) +
           " MiB for this file" + instead);
    if (end.exitStatus == kOutOfMemoryStatus)
      fail("assimp, which OMPL.app uses, needs more than " + std::to_string(limits.bytes >> 20) +
           " MiB of memory for this file" + instead);
    // If the status is lost, a complete answer shows that the program succeeded.
    if (end.exitStatus == 127) fail(needed + "cannot be run");
    if (!unpack(end.out, result))
      fail("assimp, which OMPL.app uses, ended without an answer (" + textOf(end) + ")" + instead);
  } catch (const std::system_error& error) {
    fail(needed + "cannot be started: " + error.code().message());
  }
  if (!result.error.empty()) fail("cannot be read by assimp: " + result.error);
  return result;
}

}  // namespace corridor
