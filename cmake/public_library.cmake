# The library that other programs use: the functions of the headers in include/exitance, over the engine and the view factors.
#
#   exitance-static  static; whoever links it also links the engine and its dependencies
#   exitance-shared  libexitance.so, which contains the engine and exports the functions of the headers only

if(EXITANCE_SANITIZE MATCHES thread)
    return()  # that build has no file formats
endif()

add_exitance_library(exitance-static ${api_sources})
target_include_directories(exitance-static PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_link_libraries(exitance-static PRIVATE exitance exitance-view-factors)
set_target_properties(exitance-static PROPERTIES OUTPUT_NAME exitance EXPORT_NAME static)

if(EXITANCE_SANITIZE OR EXITANCE_COVERAGE)
    return()  # a shared object with undefined symbols of the sanitizers
endif()

set(exports ${PROJECT_SOURCE_DIR}/cmake/exported_symbols.map)
add_library(exitance-shared SHARED $<TARGET_OBJECTS:exitance-static>)
target_include_directories(exitance-shared INTERFACE $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(exitance-shared INTERFACE cxx_std_20)
target_compile_definitions(exitance-shared INTERFACE EXITANCE_BANDS=${EXITANCE_BANDS})
target_link_libraries(exitance-shared PRIVATE exitance exitance-view-factors fmt::fmt)
target_link_options(exitance-shared PRIVATE -Wl,--version-script=${exports} -Wl,-z,defs)
set_target_properties(exitance-shared PROPERTIES EXPORT_NAME exitance OUTPUT_NAME exitance
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib LINK_DEPENDS ${exports}
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
