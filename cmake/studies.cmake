# The studies in experiments/*.toml become a part of the program.

file(GLOB study_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/experiments/*.toml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${study_files})
set(studies "")
foreach(path IN LISTS study_files)
    get_filename_component(name ${path} NAME_WE)
    file(READ ${path} text)
    string(APPEND studies "    {\"${name}\", R\"toml(${text})toml\"},\n")
endforeach()
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/built_in_studies.cpp @ONLY CONTENT [[
// Made by cmake/studies.cmake.
#include "exitance/lab/study/study.hpp"

namespace exitance {

std::span<const BuiltInStudy> built_in_studies() {
    static constexpr BuiltInStudy studies[] = {
@studies@    };
    return studies;
}

}  // namespace exitance
]])
target_sources(exitance-lab PRIVATE ${PROJECT_BINARY_DIR}/built_in_studies.cpp)

# The scripts in experiments/peers, likewise.
set(script_file ${PROJECT_SOURCE_DIR}/experiments/peers/blender.py)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${script_file})
file(READ ${script_file} script)
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/peer_scripts.cpp @ONLY CONTENT [[
// Made by cmake/studies.cmake.
#include "exitance/lab/peers/peer_scripts.hpp"

namespace exitance {

const std::string_view blender_script = R"script(@script@)script";

}  // namespace exitance
]])
target_sources(exitance-lab PRIVATE ${PROJECT_BINARY_DIR}/peer_scripts.cpp)
