# The viewer's page (viewer/), made by node and npm where they are there; without them everything else is built, and
# `exitance view` says what to install. A page that is made once is made again only when its sources change.

option(EXITANCE_VIEWER "Build the viewer's page" ON)
find_program(EXITANCE_NPM npm)
find_program(EXITANCE_NODE node)

if(NOT EXITANCE_VIEWER OR EXITANCE_SANITIZE OR EXITANCE_COVERAGE)
    return()
endif()
if(NOT EXITANCE_NPM OR NOT EXITANCE_NODE)
    message(STATUS "No viewer: its page needs nodejs (18 or later) and npm")
    return()
endif()

file(GLOB viewer_sources CONFIGURE_DEPENDS viewer/src/* viewer/*.html viewer/*.json viewer/*.ts)
add_custom_command(OUTPUT ${PROJECT_BINARY_DIR}/viewer.stamp
    COMMAND ${CMAKE_COMMAND} -D NPM=${EXITANCE_NPM} -D SOURCE=${PROJECT_SOURCE_DIR}/viewer
        -D BUILD=${PROJECT_BINARY_DIR}/viewer-build -D PAGE=${PROJECT_BINARY_DIR}/viewer
        -P ${PROJECT_SOURCE_DIR}/cmake/build_viewer.cmake
    DEPENDS ${viewer_sources} ${PROJECT_SOURCE_DIR}/cmake/build_viewer.cmake
    COMMENT "Building the viewer's page" VERBATIM)
add_custom_target(viewer-page ALL DEPENDS ${PROJECT_BINARY_DIR}/viewer.stamp)
