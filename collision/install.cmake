# `cmake --install` installs the library of collision/ for find_package(corridor): target corridor::collision.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/corridor)
set(helper_dir ${CMAKE_INSTALL_LIBDIR}/corridor)

set_target_properties(corridor_collision PROPERTIES EXPORT_NAME collision)
target_include_directories(corridor_collision INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/corridor>)
# A program that uses the library finds corridor_assimp (collision/geometry/assimp_process.h) by its run path.
target_link_options(corridor_collision INTERFACE
  $<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${helper_dir}>)

install(TARGETS corridor_collision EXPORT corridor ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(TARGETS corridor_assimp RUNTIME DESTINATION ${helper_dir})
install(EXPORT corridor NAMESPACE corridor:: FILE corridorTargets.cmake DESTINATION ${package_dir})
# Not installed: code that is compiled once per SIMD target (-inl.h), and rationals and wide integers (exact_*.h), which
# would make users need Boost.
install(DIRECTORY ${CMAKE_CURRENT_LIST_DIR}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/corridor/collision
        FILES_MATCHING PATTERN "*.h" PATTERN "*-inl.h" EXCLUDE PATTERN "exact_*.h" EXCLUDE)

write_basic_package_version_file(${PROJECT_BINARY_DIR}/corridorConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_LIST_DIR}/corridorConfig.cmake ${PROJECT_BINARY_DIR}/corridorConfigVersion.cmake
        DESTINATION ${package_dir})
