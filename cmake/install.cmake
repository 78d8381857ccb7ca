# `cmake --install`: the program, the library, its headers, and a package for find_package(exitance).

include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/exitance)

install(TARGETS exitance exitance-samples exitance-view-factors exitance-lab EXPORT exitanceTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY src/exitance DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
    FILES_MATCHING PATTERN "*.hpp" PATTERN cli EXCLUDE)
install(EXPORT exitanceTargets NAMESPACE exitance:: DESTINATION ${package_folder})
if(TARGET exitance-cli)
    install(TARGETS exitance-cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(cmake/exitanceConfig.cmake.in ${PROJECT_BINARY_DIR}/exitanceConfig.cmake
    INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/exitanceConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/exitanceConfig.cmake ${PROJECT_BINARY_DIR}/exitanceConfigVersion.cmake
    DESTINATION ${package_folder})

install(DIRECTORY ${PROJECT_BINARY_DIR}/viewer/ DESTINATION ${CMAKE_INSTALL_DATADIR}/exitance/viewer OPTIONAL)
