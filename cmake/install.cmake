# cmake --install: the program, the headers, one library per room, what find_package(ajar) needs, and documents.
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY AJAR_ROOMS)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/ajar)
install(TARGETS ${rooms} EXPORT ajar ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT ajar FILE ajarTargets.cmake NAMESPACE ajar:: DESTINATION ${package_folder})
install(DIRECTORY include/ajar ${PROJECT_BINARY_DIR}/include/ajar DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(document_folder ${CMAKE_INSTALL_DATAROOTDIR}/doc/ajar)  # CMAKE_INSTALL_DOCDIR may be a parent project's
install(FILES LICENSE README.md DESTINATION ${document_folder})
install(DIRECTORY docs DESTINATION ${document_folder})

configure_package_config_file(cmake/ajarConfig.cmake.in ${PROJECT_BINARY_DIR}/ajarConfig.cmake
                              INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/ajarConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES cmake/dependencies.cmake ${PROJECT_BINARY_DIR}/ajarConfig.cmake ${PROJECT_BINARY_DIR}/ajarConfigVersion.cmake
        DESTINATION ${package_folder})
