# Writes TARGET, a source file that knows the commit of SOURCE; leaves it alone where that is the same.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${TARGET} @ONLY CONTENT [[#include "planner/benchmark/build_commit.h"

const char* corridor::buildCommit() {
  return "@commit@";
}
]])
