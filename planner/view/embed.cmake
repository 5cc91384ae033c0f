# corridor_embed(TARGET FUNCTION FILE…): embeds files in a target, byte by byte. The caller declares FUNCTION, with its
# namespaces, in a header of its own as
#     std::string_view FUNCTION(std::string_view name);
# FUNCTION returns the text of the file whose name (the last part of its path) is `name`. The text is valid as long as
# the program runs. For other names it throws std::out_of_range. If a file changes, the next build embeds it again.
function(corridor_embed target function)
  string(REPLACE "::" ";" scopes ${function})
  list(POP_BACK scopes short)
  list(JOIN scopes "::" namespace)
  string(MAKE_C_IDENTIFIER "corridor_embedded_${function}" symbol)
  set(assembly "")
  set(declarations "")
  set(cases "")
  set(number 0)
  set(files "")
  foreach(file ${ARGN})
    get_filename_component(file ${file} ABSOLUTE)
    get_filename_component(name ${file} NAME)
    list(APPEND files ${file})
    set(first ${symbol}_${number})
    # The assembler includes the file. Unlike a string literal, this has no limit of length, and takes almost no time.
    string(APPEND assembly "    \"${first}: .incbin \\\"${file}\\\"\\n${first}_end: .byte 0\\n\"\n")
    string(APPEND declarations "extern const char ${first}[], ${first}_end[];\n")
    string(APPEND cases "  if (name == \"${name}\") return {${first}, static_cast<std::size_t>(${first}_end - ${first})};\n")
    math(EXPR number "${number} + 1")
  endforeach()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/embedded/${symbol}.cpp)
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT [[
// Made by corridor_embed (planner/view/embed.cmake).
#include <stdexcept>
#include <string>
#include <string_view>

asm(".pushsection .rodata, \"a\"\n"
@assembly@    ".popsection\n");

#pragma GCC visibility push(hidden)
extern "C" {
@declarations@}
#pragma GCC visibility pop

namespace @namespace@ {

std::string_view @short@(std::string_view name);

std::string_view @short@(std::string_view name) {
@cases@  throw std::out_of_range("no file " + std::string(name) + " is embedded");
}

}  // namespace @namespace@
]])
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}"
                              SKIP_UNITY_BUILD_INCLUSION ON)  # united, it would not depend on the files
  target_sources(${target} PRIVATE ${source})
endfunction()
