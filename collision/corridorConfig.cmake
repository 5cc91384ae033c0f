# For find_package(corridor): the target corridor::collision, and the libraries that it links.
include(CMakeFindDependencyMacro)
find_dependency(Eigen3)
find_dependency(HWY)
find_dependency(Qhull)
find_dependency(Threads)
include("${CMAKE_CURRENT_LIST_DIR}/corridorTargets.cmake")
