# corridor_embed(TARGET FUNCTION FILE…): puts files into a target, each as it is. FUNCTION, with its namespaces, is declared by
# a header of the caller's own as
#     std::string_view FUNCTION(std::string_view name);
# and gives the text of the file of that name (the last part of its path; std::out_of_range where there is none), for as
# long as the program runs. A file that changes is embedded anew by the next build.
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
    # By the assembler: no limit of a string literal, and no time, however long the file.
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
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}")
  target_sources(${target} PRIVATE ${source})
endfunction()
