# Tests for the thread sanitizer: those that run on several threads. These are the tests for equal results on any number
# of threads (every parallel loop of the library has one; their names end in "Threads") and those of the task queues.
# Tests are selected by these names.

set(thread_tests "")
# Folders that the libraries are built without.
list(FILTER unit_tests EXCLUDE REGEX "/exitance/(io|lab/(study|studies|thesis|peers|cie171|flatland))/")
foreach(path IN LISTS unit_tests)
    file(STRINGS ${path} found REGEX "^TEST(_P)?\\(.*(Threads\\)|TaskQueues,)")
    if(found)
        list(APPEND thread_tests ${path})
    endif()
endforeach()
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${thread_tests})
add_executable(exitance-thread-tests ${thread_tests} planted_race.cpp support/lab_methods.cpp ${places})
target_include_directories(exitance-thread-tests PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
target_compile_options(exitance-thread-tests PRIVATE -Wall -Wextra -Werror)
target_link_libraries(exitance-thread-tests PRIVATE exitance-lab GTest::gtest_main rapidcheck fmt::fmt)
target_precompile_headers(exitance-thread-tests PRIVATE <gtest/gtest.h>
    ${PROJECT_SOURCE_DIR}/src/exitance/transport/stage.hpp ${PROJECT_SOURCE_DIR}/src/exitance/solution/solution.hpp)
set(sanitizer_options "suppressions=${CMAKE_CURRENT_SOURCE_DIR}/thread_sanitizer.supp:halt_on_error=1:second_deadlock_stack=1")
gtest_discover_tests(exitance-thread-tests TEST_FILTER "*Threads:*Threads/*:TaskQueues.*" DISCOVERY_TIMEOUT 60
    PROPERTIES TIMEOUT 600 ENVIRONMENT "TSAN_OPTIONS=${sanitizer_options}")
