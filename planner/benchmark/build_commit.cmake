# Writes TARGET, a C++ source that returns the commit of SOURCE. TARGET is not written again if its content would stay
# the same. If SOURCE is not the top folder of a clone, the commit is "unknown". For example, a release may be unpacked
# inside the clone of another project, whose commit says nothing about the release.
set(git ${CMAKE_COMMAND} -E env --unset=GIT_DIR --unset=GIT_WORK_TREE --unset=GIT_INDEX_FILE git -C ${SOURCE})
execute_process(COMMAND ${git} rev-parse --show-prefix
                OUTPUT_VARIABLE below OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE none)
execute_process(COMMAND ${git} describe --always --dirty --abbrev=12 --exclude=*
                OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(none OR NOT below STREQUAL "" OR failed OR NOT commit MATCHES "^[0-9a-f]+(-dirty)?$")
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${TARGET} @ONLY CONTENT [[#include "planner/benchmark/build_commit.h"

const char* corridor::buildCommit() {
  return "@commit@";
}
]])
