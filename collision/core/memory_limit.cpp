#include "collision/core/memory_limit.h"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <sys/resource.h>

namespace corridor {
namespace {

/// Returns the bytes that RLIMIT_DATA counts; 0 if they are unknown.
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

}  // namespace

void limitMemory(std::size_t bytes) {
  const std::size_t now = dataBytes();
  if (now == 0) return;
  rlimit limit{};
  getrlimit(RLIMIT_DATA, &limit);
  limit.rlim_cur = std::min<rlim_t>(now + bytes, limit.rlim_max);
  setrlimit(RLIMIT_DATA, &limit);
}

}  // namespace corridor
