# `cpack` (scripts/make_packages): a Debian package, and an archive that can be unpacked anywhere.

if(EXITANCE_SANITIZE OR EXITANCE_COVERAGE OR NOT TARGET exitance-cli)
    return()
endif()

# Files that Debian's policy asks for. The date is that of the release, so that packages are reproducible.
set(package_files ${PROJECT_BINARY_DIR}/package-files)
set(EXITANCE_RELEASE_DATE "Fri, 27 Nov 2026 00:00:00 +0000")
set(EXITANCE_MAINTAINER "exitance developers <exitance@users.noreply.github.com>")
configure_file(cmake/debian/changelog.in ${package_files}/changelog @ONLY)
add_custom_command(OUTPUT ${package_files}/changelog.gz
    COMMAND gzip -9nc ${package_files}/changelog > ${package_files}/changelog.gz
    DEPENDS ${package_files}/changelog VERBATIM)
add_custom_target(exitance-package-files ALL DEPENDS ${package_files}/changelog.gz)
install(FILES ${package_files}/changelog.gz cmake/debian/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(CPACK_PACKAGE_NAME exitance)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT ${EXITANCE_MAINTAINER})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "light in rooms of diffuse surfaces, with an estimate of its error")
set(CPACK_PACKAGE_DESCRIPTION
    "exitance computes the radiosity and irradiance of every surface of a scene of polygons
as a function that can be evaluated anywhere, by the radiosity method.
The package contains the program, the C++ library and the Python module.")
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_GENERATOR "DEB;TZST")
set(CPACK_STRIP_FILES ON)
set(CPACK_MONOLITHIC_INSTALL ON)
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_ARCHIVE_FILE_NAME exitance-${PROJECT_VERSION}-${CMAKE_SYSTEM_PROCESSOR})
set(CPACK_THREADS 0)

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_GENERATE_SHLIBS ON)
if(TARGET exitance-python)  # a module for one version of Python
    math(EXPR next_python "${Python_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${next_python})")
endif()
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, python3-scipy")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/triggers)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
include(CPack)
