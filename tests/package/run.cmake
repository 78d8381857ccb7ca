# Installs BUILD into an empty prefix, then configures, builds and runs a project that only uses that prefix: a program that
# links the static library, and one that links a shared object made from it.

set(prefix ${BUILD}/tests/package/prefix)
set(user_build ${BUILD}/tests/package/build)
file(REMOVE_RECURSE ${prefix} ${user_build})

function(run)
    execute_process(COMMAND ${ARGN} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR} -B ${user_build} -G ${GENERATOR} -D CMAKE_PREFIX_PATH=${prefix}
    -D CMAKE_CXX_COMPILER=${COMPILER})
run(${CMAKE_COMMAND} --build ${user_build})
run(${user_build}/user)
run(${user_build}/host)
