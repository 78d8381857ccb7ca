# An overlay port of the working copy: vcpkg install exitance --overlay-ports=packaging/vcpkg. This port was not run.
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)

# The ports of tinygltf and cpp-httplib are headers only. The build searches for a library of each.
set(libraries "${CURRENT_BUILDTREES_DIR}/header_libraries")
file(MAKE_DIRECTORY "${libraries}")
file(WRITE "${libraries}/CMakeLists.txt" "cmake_minimum_required(VERSION 3.25)
project(header_libraries CXX)
file(WRITE \${PROJECT_BINARY_DIR}/tinygltf.cpp \"#define TINYGLTF_IMPLEMENTATION
#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <tiny_gltf.h>
\")
file(WRITE \${PROJECT_BINARY_DIR}/httplib.cpp \"#include <httplib.h>
\")
add_library(tinygltf STATIC \${PROJECT_BINARY_DIR}/tinygltf.cpp)
add_library(cpp-httplib STATIC \${PROJECT_BINARY_DIR}/httplib.cpp)
set_target_properties(tinygltf cpp-httplib PROPERTIES POSITION_INDEPENDENT_CODE ON CXX_STANDARD 20)
install(TARGETS tinygltf cpp-httplib ARCHIVE DESTINATION lib)
")
vcpkg_cmake_configure(SOURCE_PATH "${libraries}")
vcpkg_cmake_install()

find_file(font DejaVuSans.ttf PATHS /usr/share/fonts/truetype/dejavu /usr/share/fonts/dejavu /usr/share/fonts/TTF REQUIRED)
vcpkg_cmake_configure(SOURCE_PATH "${SOURCE_PATH}" OPTIONS -DEXITANCE_TESTS=OFF -DEXITANCE_VIEWER=OFF -DEXITANCE_PYTHON=OFF
    -DEXITANCE_DISTRIBUTED=OFF "-DEXITANCE_FONT=${font}")
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/exitance)
vcpkg_copy_tools(TOOL_NAMES exitance AUTO_CLEAN)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include" "${CURRENT_PACKAGES_DIR}/debug/share")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE")
