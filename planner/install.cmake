# `cmake --install` installs the program, and the libraries of planner/ for find_package(corridor COMPONENTS planner).
# That component has the targets corridor::planner, corridor::model and corridor::verify.
foreach(name verify model code planner)
  set_target_properties(corridor_${name} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(corridor_${name} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/corridor>)
endforeach()
install(TARGETS corridor_verify corridor_model corridor_code corridor_planner EXPORT corridor_planner
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT corridor_planner NAMESPACE corridor:: FILE corridorPlannerTargets.cmake DESTINATION ${package_dir})
install(FILES ${CMAKE_CURRENT_LIST_DIR}/find_ompl.cmake DESTINATION ${package_dir})

# The program finds corridor_assimp (collision/geometry/assimp_process.h) by its run path.
set_target_properties(corridor PROPERTIES INSTALL_RPATH
  "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}/corridor")
install(TARGETS corridor RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS corridor_benchmark corridor_query RUNTIME DESTINATION ${helper_dir})

# Not installed: headers that need libraries which users of corridor::planner need not have.
file(GLOB planner_headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}
     ${CMAKE_CURRENT_LIST_DIR}/robot/*.h ${CMAKE_CURRENT_LIST_DIR}/model/*.h ${CMAKE_CURRENT_LIST_DIR}/problem/*.h
     ${CMAKE_CURRENT_LIST_DIR}/import/*.h
     ${CMAKE_CURRENT_LIST_DIR}/checker/*.h ${CMAKE_CURRENT_LIST_DIR}/trajectory/*.h ${CMAKE_CURRENT_LIST_DIR}/solve/*.h
     ${CMAKE_CURRENT_LIST_DIR}/verify/verify_path.h ${CMAKE_CURRENT_LIST_DIR}/verify/polynomial_range.h
     ${CMAKE_CURRENT_LIST_DIR}/verify/bernstein.h ${CMAKE_CURRENT_LIST_DIR}/verify/triangle_gap.h)
list(FILTER planner_headers EXCLUDE REGEX "/(urdfdom|yaml_events|xml_file|urdf_outline|mesh_store|srdf_[a-z]+)\\.h$")
corridor_install_headers(${planner_headers})
