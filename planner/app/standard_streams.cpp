#include "planner/app/standard_streams.h"

#include <fcntl.h>
#include <iostream>
#include <unistd.h>

#include "collision/core/error.h"

namespace corridor::app {

void openStandardStreams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    if (::fcntl(stream, F_GETFD) >= 0) continue;
    // open() returns the lowest free descriptor, which is `stream`. The access mode is the opposite
    // of what the stream needs, so that using the stream fails.
    [[maybe_unused]] const int same =
        ::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  }
}

void requireResultsWritten() {
  if (!std::cout.flush())
    throw InputError(Fault{"standard output", 0, "can't be written, or not all of it"});
}

}  // namespace corridor::app
