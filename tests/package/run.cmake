# Installs BUILD into an empty prefix, then configures, builds and runs a project that only uses that prefix: a program that
# links the static library, one that links a shared object made from it, one that uses the laboratory, and the example of the
# README, which solves a room.

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
run(${user_build}/user)
run(${user_build}/host)
run(${user_build}/laboratory)
run(${prefix}/bin/exitance generate cornell -o ${user_build}/room.obj)
execute_process(COMMAND ${user_build}/readme WORKING_DIRECTORY ${user_build} COMMAND_ERROR_IS_FATAL ANY)
