# Called by viewer.cmake: the page of SOURCE, built in BUILD, appears in PAGE. A registry that cannot be reached is no
# reason to stop: the page is left out, and that is said.

file(MAKE_DIRECTORY ${BUILD})
foreach(name src index.html package.json package-lock.json tsconfig.json vite.config.ts)
    file(COPY ${SOURCE}/${name} DESTINATION ${BUILD})
endforeach()
file(SHA256 ${BUILD}/package-lock.json wanted)
set(installed "")
if(EXISTS ${BUILD}/installed)
    file(READ ${BUILD}/installed installed)
endif()
if(NOT installed STREQUAL wanted)
    execute_process(COMMAND ${NPM} install --no-save --no-audit --no-fund --ignore-scripts --fetch-retries=1 --loglevel=error
        WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE failed OUTPUT_QUIET TIMEOUT 300)
    if(failed)
        message("No viewer: npm cannot install what its page is made of (see above)")
        return()
    endif()
    file(WRITE ${BUILD}/installed ${wanted})
endif()
execute_process(COMMAND ${BUILD}/node_modules/.bin/vite build --logLevel warn
    WORKING_DIRECTORY ${BUILD} RESULT_VARIABLE failed TIMEOUT 300)
if(failed)
    message(FATAL_ERROR "the viewer's page does not build")
endif()
file(REMOVE_RECURSE ${PAGE})
file(RENAME ${BUILD}/dist ${PAGE})
file(TOUCH ${PAGE}.stamp)
