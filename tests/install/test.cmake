# Tests `cmake --install` and find_package(corridor). Installs into a prefix with a space in its name. Configures,
# builds and runs three projects: the project in this folder, which uses collision/ alone, and those in ompl_program/
# and own_programs/, which use the planner. Tests that the guides show the files of these projects unchanged. Runs the
# installed program.
# Usage: cmake -D BUILD=… -D WORK=… -D CONFIG=… -D GENERATOR=… -D COMPILER=… -D FLAGS=… -P test.cmake
cmake_minimum_required(VERSION 3.25)
set(prefix "${WORK}/a prefix")
set(build "${WORK}/build")
file(REMOVE_RECURSE "${WORK}")

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}: ${status}\n${out}${err}")
  endif()
  set(out "${out}" PARENT_SCOPE)
  set(err "${err}" PARENT_SCOPE)
endfunction()

run(${CMAKE_COMMAND} --install "${BUILD}" --config "${CONFIG}" --prefix "${prefix}")

# Installed headers must include only installed headers.
file(GLOB_RECURSE headers "${prefix}/include/corridor/*.h")
list(LENGTH headers count)
if(count LESS 50)
  message(FATAL_ERROR "only ${count} headers were installed")
endif()
foreach(header ${headers})
  file(STRINGS "${header}" includes REGEX "^#include")
  foreach(include ${includes})
    if(include MATCHES "\"(.*)\"" AND NOT EXISTS "${prefix}/include/corridor/${CMAKE_MATCH_1}")
      message(FATAL_ERROR "${header} includes ${CMAKE_MATCH_1}, which is not installed")
    endif()
    if(include MATCHES "<(boost|assimp|hwy|yaml\\.h|nlohmann|CLI|tinyxml2|urdf|console_bridge)"
       OR (include MATCHES "<ompl" AND NOT header MATCHES "/planner/(checker|solve)/"))
      message(FATAL_ERROR "${header}: ${include}: an installed header must not include it, "
                          "since users of the library need not have it")
    endif()
  endforeach()
endforeach()

# Configures and builds a project that finds the installed package.
function(build_project source build)
  run(${CMAKE_COMMAND} -S "${source}" -B "${build}" -G "${GENERATOR}" "-DCMAKE_BUILD_TYPE=${CONFIG}"
      "-DCMAKE_PREFIX_PATH=${prefix}" "-DCMAKE_CXX_COMPILER=${COMPILER}" "-DCMAKE_CXX_FLAGS=${FLAGS}")
  run(${CMAKE_COMMAND} --build "${build}" --config "${CONFIG}")
endfunction()
build_project("${CMAKE_CURRENT_LIST_DIR}" "${build}")

# The headers must refuse compiler options under which the error bounds do not hold.
set(refused -ffast-math -ffinite-math-only)
if(NOT COMPILER MATCHES "clang")  # clang defines no macro for the other options
  list(APPEND refused -funsafe-math-optimizations -freciprocal-math)
endif()
foreach(option ${refused})
  execute_process(COMMAND ${COMPILER} -std=c++20 ${option} -fsyntax-only -Wfatal-errors -I "${prefix}/include/corridor"
    -I /usr/include/eigen3 "${CMAKE_CURRENT_LIST_DIR}/main.cpp" RESULT_VARIABLE status ERROR_VARIABLE err)
  if(status EQUAL 0 OR NOT err MATCHES "bounds do not hold under -ffast-math")
    message(FATAL_ERROR "main.cpp under ${option}: ${status}\n${err}")
  endif()
endforeach()

# Write a unit cube as OBJ, which Corridor itself reads, and as Collada, which assimp reads in a separate process.
set(corners "0 0 0" "1 0 0" "1 1 0" "0 1 0" "0 0 1" "1 0 1" "1 1 1" "0 1 1")
set(quads "0 3 2 1" "4 5 6 7" "0 1 5 4" "1 2 6 5" "2 3 7 6" "3 0 4 7")
set(obj "")
set(positions "")
set(indices "")
foreach(corner ${corners})
  string(APPEND obj "v ${corner}\n")
  string(APPEND positions "${corner} ")
endforeach()
foreach(quad ${quads})
  string(REPLACE " " ";" numbers "${quad}")
  string(APPEND obj "f")
  foreach(number ${numbers})
    math(EXPR number "${number} + 1")
    string(APPEND obj " ${number}")
  endforeach()
  string(APPEND obj "\n")
  string(APPEND indices "${quad} ")
endforeach()
file(WRITE "${WORK}/cube.obj" "${obj}")
file(WRITE "${WORK}/cube.dae" "<?xml version=\"1.0\"?>
<COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset/>
<library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"24\">${positions}</float_array>
<technique_common><accessor source=\"#a\" count=\"8\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/>
<param name=\"Z\" type=\"float\"/></accessor></technique_common></source>
<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>
<polylist count=\"6\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><vcount>4 4 4 4 4 4</vcount><p>${indices}</p></polylist>
</mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>
")

# Build and run an OMPL program with Corridor's checkers. Then let the installed program inspect the Collada file.
set(source "${CMAKE_CURRENT_LIST_DIR}/../..")
build_project("${CMAKE_CURRENT_LIST_DIR}/ompl_program" "${WORK}/ompl")
run("${WORK}/ompl/plan" "${source}/robots/arm6/arm6.urdf")
if(NOT out MATCHES "(^|\n)certified\n$")
  message(FATAL_ERROR "the OMPL program says:\n${out}${err}")
endif()
execute_process(COMMAND "${WORK}/ompl/plan" none.urdf RESULT_VARIABLE status ERROR_VARIABLE err)
if(NOT status EQUAL 2 OR NOT err MATCHES "none.urdf")
  message(FATAL_ERROR "the OMPL program without a URDF: ${status}\n${err}")
endif()
run("${prefix}/bin/corridor" inspect "${WORK}/cube.dae")
# Two commands are programs of their own.
file(WRITE "${WORK}/pose.txt" "1 0 0 0 1 0 0 0 1 0 0 0\n")
run("${prefix}/bin/corridor" query "${WORK}/cube.obj" "${WORK}/cube.obj" --poses "${WORK}/pose.txt")
run("${prefix}/bin/corridor" benchmark --help)

# Build and run own_programs/: a rigid body in an OMPL program, and a program that checks trajectories made elsewhere.
# One trajectory stays beside the post, another goes through the post.
build_project("${CMAKE_CURRENT_LIST_DIR}/own_programs" "${WORK}/own")
run("${WORK}/own/rigid" "${WORK}/cube.obj")
if(NOT out MATCHES "(^|\n)certified\n$")
  message(FATAL_ERROR "the program with a rigid body says:\n${out}${err}")
endif()
set(names "time,pan,lift,elbow,wrist1,wrist2,wrist3")
file(WRITE "${WORK}/still.csv" "${names}\n0,-1,1,1,0,0,0\n1,-0.9,1,1,0,0,0\n")
file(WRITE "${WORK}/through.csv" "${names}\n0,-1,1,1,0,0,0\n2,1,1,1,0,0,0\n")
run("${WORK}/own/trajectory" "${source}/robots/arm6/arm6.urdf" "${WORK}/still.csv")
if(NOT out STREQUAL "free\n")
  message(FATAL_ERROR "the program with a trajectory says:\n${out}${err}")
endif()
execute_process(COMMAND "${WORK}/own/trajectory" "${source}/robots/arm6/arm6.urdf" "${WORK}/through.csv"
                RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT status EQUAL 1 OR NOT out MATCHES "^contact at [01]\\.[0-9]+\n$")
  message(FATAL_ERROR "the program with a trajectory through the post: ${status}\n${out}${err}")
endif()

# If the Python package was built, it must find the installed helper program, too.
file(GLOB package "${prefix}/lib/python3*/dist-packages")
if(package AND NOT FLAGS MATCHES "sanitize")
  file(WRITE "${WORK}/use.py" "import corridor
print(corridor.touch(corridor.Body(corridor.shapes.mesh_file('${WORK}/cube.dae')), corridor.Body(corridor.shapes.sphere(1)))[0])
")
  run(${CMAKE_COMMAND} -E env "PYTHONPATH=${package}" /usr/bin/python3 "${WORK}/use.py")
  if(NOT out STREQUAL "True\n")
    message(FATAL_ERROR "the installed Python package says:\n${out}${err}")
  endif()
endif()

run("${build}/two_meshes" "${WORK}/cube.obj" "${WORK}/cube.dae")
set(number " *[-0-9.e]+")  # Eigen aligns numbers with blanks
if(NOT out MATCHES "^triangles [0-9]+ and [0-9]+ touch
[1-9][0-9]* pairs of triangles touch
distance 0 from${number}${number}${number} to${number}${number}${number}
closer than 0.75
0 pairs of triangles touch
distance 1 from *1${number}${number} to *2${number}${number}
farther than 0.75
$")
  message(FATAL_ERROR "two_meshes printed:\n${out}")
endif()

# The helper program for OMPL.app's meshes is installed where programs search for it.
if(NOT EXISTS "${prefix}/lib/corridor/corridor_assimp")
  message(FATAL_ERROR "the helper program is not installed")
endif()

# Tests that the guides show the files of the three projects exactly.
function(expect_shown guide folder)
  file(READ "${source}/${guide}" text)
  foreach(file main.cpp CMakeLists.txt)
    file(READ "${CMAKE_CURRENT_LIST_DIR}/${folder}${file}" shown)
    string(FIND "${text}" "\n${shown}```\n" at)
    if(at EQUAL -1)
      message(FATAL_ERROR "${guide} does not show tests/install/${folder}${file} as it is")
    endif()
  endforeach()
endfunction()
expect_shown(collision/README.md "")
expect_shown(planner/README.md ompl_program/)
