# cmake --install: the program, the headers, one library per room, and what find_package(ajar) needs.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY AJAR_ROOMS)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/ajar)
install(TARGETS ${rooms} EXPORT ajar ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT ajar FILE ajarTargets.cmake NAMESPACE ajar:: DESTINATION ${package_folder})
install(DIRECTORY include/ajar DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})

file(WRITE ${PROJECT_BINARY_DIR}/ajarConfig.cmake [[
include(${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake)
if(DEFINED ajar_FOUND AND NOT ajar_FOUND)
  return()
endif()
include(${CMAKE_CURRENT_LIST_DIR}/ajarTargets.cmake)
]])
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ajarConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/dependencies.cmake ${PROJECT_BINARY_DIR}/ajarConfig.cmake ${PROJECT_BINARY_DIR}/ajarConfigVersion.cmake
        DESTINATION ${package_folder})
