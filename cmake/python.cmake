# The Python module: build/python/exitance, importable with PYTHONPATH=build/python. It needs pybind11-dev, python3-dev and
# python3-numpy. EXITANCE_PYTHON=AUTO builds it if they are there, ON requires them.

set(EXITANCE_PYTHON AUTO CACHE STRING "Build the Python module: ON, OFF, or AUTO if its packages are there")
if(NOT EXITANCE_PYTHON OR EXITANCE_SANITIZE OR EXITANCE_COVERAGE OR CMAKE_CROSSCOMPILING)
    return()
endif()

# The system's Python comes first: others on the path often lack NumPy and the packages of the tests.
if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
    set(Python_EXECUTABLE /usr/bin/python3)
endif()
set(PYBIND11_FINDPYTHON ON)
find_package(Python COMPONENTS Interpreter Development.Module NumPy QUIET)
find_package(pybind11 2.10 CONFIG QUIET)
if(NOT Python_NumPy_FOUND OR NOT Python_Development.Module_FOUND OR NOT pybind11_FOUND)
    set(lacking "The Python module needs pybind11-dev, python3-dev and python3-numpy (for ${Python_EXECUTABLE})")
    if(EXITANCE_PYTHON STREQUAL AUTO)
        message(STATUS "${lacking}: it is not built")
        return()
    endif()
    message(FATAL_ERROR "${lacking}")
endif()

set(python_source ${PROJECT_SOURCE_DIR}/bindings/python)
set(python_build ${PROJECT_BINARY_DIR}/python)
file(GLOB public_headers CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/include/exitance/*.hpp)
set(python_docs ${PROJECT_BINARY_DIR}/python-generated/docs.hpp)
add_custom_command(OUTPUT ${python_docs}
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/python-generated
    COMMAND Python::Interpreter ${python_source}/docstrings.py ${python_docs} ${public_headers}
    DEPENDS ${python_source}/docstrings.py ${public_headers} VERBATIM)

file(GLOB python_sources CONFIGURE_DEPENDS ${python_source}/*.cpp)
pybind11_add_module(exitance-python MODULE NO_EXTRAS ${python_sources} ${python_docs})
target_include_directories(exitance-python PRIVATE ${PROJECT_BINARY_DIR}/python-generated)
target_compile_options(exitance-python PRIVATE -Wall -Wextra -Werror -O1)  # the library does the work
target_compile_definitions(exitance-python PRIVATE "EXITANCE_VERSION=\"${PROJECT_VERSION}\"")
target_link_libraries(exitance-python PRIVATE exitance-static fmt::fmt)
# Only the module's entry is visible, so that other modules may contain other versions of the same libraries.
target_link_options(exitance-python PRIVATE -Wl,--exclude-libs,ALL)
set_target_properties(exitance-python PROPERTIES OUTPUT_NAME _exitance LIBRARY_OUTPUT_DIRECTORY ${python_build}/exitance)

# The files in Python, beside the module.
file(GLOB python_files CONFIGURE_DEPENDS RELATIVE ${python_source} ${python_source}/exitance/*.py
    ${python_source}/exitance/*.pyi ${python_source}/exitance/py.typed)
set(python_copies "")
foreach(name IN LISTS python_files)
    add_custom_command(OUTPUT ${python_build}/${name}
        COMMAND ${CMAKE_COMMAND} -E copy ${python_source}/${name} ${python_build}/${name}
        DEPENDS ${python_source}/${name} VERBATIM)
    list(APPEND python_copies ${python_build}/${name})
endforeach()
add_custom_target(exitance-python-files ALL DEPENDS ${python_copies})
add_dependencies(exitance-python exitance-python-files)
