# `cmake --install` installs the library of collision/ for find_package(corridor): target corridor::collision.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/corridor)
set(helper_dir ${CMAKE_INSTALL_LIBDIR}/corridor)

set_target_properties(corridor_collision PROPERTIES EXPORT_NAME collision)
set_target_properties(corridor_course PROPERTIES EXPORT_NAME course)
target_include_directories(corridor_collision INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/corridor>)
# A program that uses the library finds corridor_assimp (collision/geometry/assimp_process.h) by its run path.
target_link_options(corridor_collision INTERFACE
  $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${helper_dir}>)

install(TARGETS corridor_collision corridor_course EXPORT corridor ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS corridor_assimp RUNTIME DESTINATION ${helper_dir})
install(EXPORT corridor NAMESPACE corridor:: FILE corridorTargets.cmake DESTINATION ${package_dir})

# corridor_install_headers(HEADER…) installs headers, and all headers of this project that they include. All other
# headers are implementation, and are not installed.
function(corridor_install_headers)
  set(open ${ARGN})
  set(installed)
  while(open)
    list(POP_FRONT open header)
    if(header IN_LIST installed OR NOT EXISTS ${PROJECT_SOURCE_DIR}/${header})
      continue()
    endif()
    list(APPEND installed ${header})
    cmake_path(GET header PARENT_PATH folder)
    install(FILES ${PROJECT_SOURCE_DIR}/${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/corridor/${folder})
    file(STRINGS ${PROJECT_SOURCE_DIR}/${header} lines REGEX "^#include \"")
    foreach(line ${lines})
      string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${line}")
      list(APPEND open ${included})
    endforeach()
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${header})
  endwhile()
endfunction()
file(GLOB course_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${CMAKE_CURRENT_LIST_DIR}/course/*.h)
list(FILTER course_headers EXCLUDE REGEX "-inl\\.h$")
corridor_install_headers(collision/collision.h ${course_headers}
  collision/convex/convex_contact.h collision/convex/convex_distance.h
  collision/core/parallel.h collision/core/simd_target.h
  collision/geometry/mesh_components.h collision/geometry/mesh_health.h
  collision/motion/check_certificate.h collision/motion/edge_method.h
  collision/queries/self_intersections.h)

write_basic_package_version_file(${PROJECT_BINARY_DIR}/corridorConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/corridorConfig.cmake ${PROJECT_BINARY_DIR}/corridorConfigVersion.cmake
        DESTINATION ${package_dir})
