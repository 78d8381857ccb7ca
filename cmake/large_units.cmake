# Compiles several source files as one unit. Reading headers is most of the time of compiling a file, so that a fresh build
# takes about half as long. Unnamed namespaces of the files of one unit are one: two files of a unit may not give the same
# name to different things.

option(EXITANCE_LARGE_UNITS "Compile several files at once: fast for a fresh build, slower for one file" ON)

# Files of one folder that form a unit while developers work: a changed file compiles all files of its unit.
set(files_of_small_unit 8)
# First builds take units of 24 files: scripts/build_settings sets this where no build folder exists. Above 8 files, a folder
# that fits into the unit of the folder before it joins that unit.
set(EXITANCE_UNIT_FILES ${files_of_small_unit} CACHE STRING "Files that are compiled as one unit, at most")

# Folders of src/exitance whose code runs briefly or waits for files. Optimising it less saves a third of its compile time.
# Results have the same bits: no level of optimisation changes the order of floating-point operations. The sanitizers see
# more of code that is not optimised at all, which Clang compiles in less than half of the time.
set(briefly_optimised "^src/exitance/(cli|io|sweep|samples|api|methods/(options|plan)|lab/(study|studies|thesis|peers|cie171|flatland))(/|$)")
set(brief_optimisation "$<$<AND:$<CONFIG:Release,RelWithDebInfo>,$<CXX_COMPILER_ID:GNU,Clang>>:-O1>")
if(EXITANCE_SANITIZE)
    set(brief_optimisation -O0)
endif()

# Sets `result` to the folder of a source, relative to the repository, so that names are equal in every copy of it.
function(find_folder source result)
    get_filename_component(folder ${source} ABSOLUTE)
    file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
    get_filename_component(folder "${folder}" DIRECTORY)
    set(${result} "${folder}" PARENT_SCOPE)
endfunction()

# Headers that are precompiled at one level of optimisation cannot be read at -O0.
function(optimise_briefly source)
    set_source_files_properties(${source} PROPERTIES COMPILE_OPTIONS "${brief_optimisation}")
    if(EXITANCE_SANITIZE)
        set_source_files_properties(${source} PROPERTIES SKIP_PRECOMPILE_HEADERS ON)
    endif()
endfunction()

# Assigns the sources of a target to units of at most `most_files` files. Files with options of their own remain separate.
function(group_units target most_files)
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    list(SORT sources)
    set(folders "")
    set(brief_folders "")
    foreach(source IN LISTS sources)
        cmake_path(IS_PREFIX PROJECT_BINARY_DIR "${source}" NORMALIZE is_generated)
        if(is_generated)  # small, and its path differs between copies of the repository
            continue()
        endif()
        find_folder(${source} folder)
        list(APPEND "files_${folder}" ${source})
        if(NOT folder MATCHES ${briefly_optimised})
            list(APPEND folders "${folder}")
            continue()
        endif()
        list(APPEND brief_folders "${folder}")
        if(NOT EXITANCE_LARGE_UNITS)
            optimise_briefly(${source})
        endif()
    endforeach()
    list(APPEND folders ${brief_folders})
    if(NOT EXITANCE_LARGE_UNITS)
        return()
    endif()
    list(REMOVE_DUPLICATES folders)
    set(room 0)  # files that the last unit can still take
    set(last_is_brief FALSE)
    foreach(folder IN LISTS folders)
        set(files ${files_${folder}})
        string(MAKE_C_IDENTIFIER "${folder}" name)
        list(LENGTH files count)
        math(EXPR units "(${count} + ${most_files} - 1) / ${most_files}")
        set(is_brief FALSE)
        if(folder MATCHES ${briefly_optimised})
            set(is_brief TRUE)
        endif()
        if(most_files GREATER files_of_small_unit AND NOT count GREATER room AND is_brief STREQUAL last_is_brief)
            set_source_files_properties(${files} PROPERTIES UNITY_GROUP ${last_unit})
            math(EXPR room "${room} - ${count}")
            continue()
        endif()
        set(k 0)
        foreach(source IN LISTS files)
            math(EXPR unit "${k} * ${units} / ${count}")  # equal parts
            set(last_unit ${name}_${unit})
            set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${last_unit})
            if(is_brief)  # the file that CMake writes for the unit
                optimise_briefly(${CMAKE_CURRENT_BINARY_DIR}/CMakeFiles/${target}.dir/Unity/unity_${last_unit}_cxx.cxx)
            endif()
            math(EXPR k "${k} + 1")
        endforeach()
        math(EXPR room "${most_files} - (${count} + ${units} - 1) / ${units}")
        set(last_is_brief ${is_brief})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
