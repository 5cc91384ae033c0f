// The program corridor_assimp: reads one file by assimp and writes the import to its standard
// output, for assimp_process.cpp. It is a process of its own, so that a damaged file can crash
// nothing else.
#include <cstdlib>
#include <new>
#include <string>
#include <sys/resource.h>
#include <unistd.h>

#include "collision/core/memory_limit.h"
#include "collision/geometry/assimp_import.h"

int main(int count, char** words) {
  // The arguments are FILE SECONDS BYTES.
  if (count != 4) return 2;
  const std::string file = words[1];
  const auto seconds = static_cast<rlim_t>(std::atof(words[2])) + 1;
  const rlimit time{seconds, seconds}, none{0, 0};
  ::setrlimit(RLIMIT_CPU, &time);
  ::setrlimit(RLIMIT_CORE, &none);
  corridor::limitMemory(std::strtoull(words[3], nullptr, 10));

  std::set_new_handler([] { ::_exit(corridor::kOutOfMemoryStatus); });
  const std::string bytes = corridor::packed(corridor::importByAssimp(file));
  for (std::size_t done = 0; done < bytes.size();) {
    const ssize_t n = ::write(STDOUT_FILENO, bytes.data() + done, bytes.size() - done);
    if (n < 0) ::_exit(1);
    done += static_cast<std::size_t>(n);
  }
  ::_exit(0);  // skips assimp's clean-up, which is needless because the process ends
}
