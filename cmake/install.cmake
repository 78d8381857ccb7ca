# `cmake --install`: the program, the library with its headers, and a package for find_package(exitance).

include(CMakePackageConfigHelpers)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/exitance)

if(TARGET exitance-shared)
    install(TARGETS exitance-shared EXPORT exitanceTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library
            NAMELINK_COMPONENT development)
    install(TARGETS exitance-static exitance exitance-view-factors EXPORT exitanceStaticTargets
        ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)
    install(DIRECTORY include/exitance DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
    install(EXPORT exitanceTargets NAMESPACE exitance:: DESTINATION ${package_folder} COMPONENT development)
    install(EXPORT exitanceStaticTargets NAMESPACE exitance:: DESTINATION ${package_folder} COMPONENT development)
    configure_package_config_file(cmake/exitanceConfig.cmake.in ${PROJECT_BINARY_DIR}/exitanceConfig.cmake
        INSTALL_DESTINATION ${package_folder} PATH_VARS CMAKE_INSTALL_INCLUDEDIR)
    write_basic_package_version_file(${PROJECT_BINARY_DIR}/exitanceConfigVersion.cmake COMPATIBILITY SameMinorVersion)
    install(FILES ${PROJECT_BINARY_DIR}/exitanceConfig.cmake ${PROJECT_BINARY_DIR}/exitanceConfigVersion.cmake
        DESTINATION ${package_folder} COMPONENT development)
endif()
if(TARGET exitance-cli)
    install(TARGETS exitance-cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
endif()
if(TARGET exitance-python)
    install(DIRECTORY ${PROJECT_BINARY_DIR}/python/exitance DESTINATION lib/python3/dist-packages COMPONENT python
        PATTERN __pycache__ EXCLUDE)
endif()
install(DIRECTORY ${PROJECT_BINARY_DIR}/viewer/ DESTINATION ${CMAKE_INSTALL_DATADIR}/exitance/viewer OPTIONAL
    COMPONENT program)
