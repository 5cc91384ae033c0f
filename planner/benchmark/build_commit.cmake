# Writes TARGET, a source file that knows the commit of SOURCE; leaves it alone where that is the same.
# SOURCE is to be a clone's own top: of a release that was unpacked in a clone of something else that one's commit says nothing.
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
