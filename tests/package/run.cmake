# Installs BUILD into an empty prefix, then configures, builds and runs a project that only uses that prefix: programs that
# link the shared and the static library, one that links a shared object made from the latter, and the example of the README.

set(prefix ${BUILD}/tests/package/prefix)
set(user_build ${BUILD}/tests/package/build)
file(REMOVE_RECURSE ${prefix} ${user_build})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The first C++ block of the README.
file(READ ${CMAKE_CURRENT_LIST_DIR}/../../README.md readme)
string(REGEX MATCH "```cpp\n([^`]*)```" found "${readme}")
if(NOT found)
    message(FATAL_ERROR "README.md has no C++ block")
endif()
file(WRITE ${user_build}/readme.cpp "${CMAKE_MATCH_1}")

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${user_build} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${user_build})
foreach(program user static_user)
    file(MAKE_DIRECTORY ${user_build}/${program}.files)
    run(${user_build}/${program} ${user_build}/${program}.files)
endforeach()
run(${user_build}/host)
run(${prefix}/bin/exitance generate cornell -o ${user_build}/room.obj)
execute_process(COMMAND ${user_build}/readme WORKING_DIRECTORY ${user_build} COMMAND_ERROR_IS_FATAL ANY)

# Only the public headers are installed.
file(GLOB_RECURSE installed RELATIVE ${prefix}/include ${prefix}/include/*)
file(GLOB expected RELATIVE ${CMAKE_CURRENT_LIST_DIR}/../../include ${CMAKE_CURRENT_LIST_DIR}/../../include/exitance/*.hpp)
list(SORT installed)
list(SORT expected)
if(NOT installed STREQUAL expected)
    message(FATAL_ERROR "installed headers: ${installed}")
endif()
