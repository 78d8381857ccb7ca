# Compiles several source files of one folder as one unit. Reading headers is most of the time of compiling a file, so that a
# fresh build takes about half as long. Unnamed namespaces of the files of one unit are one: two files of a folder may not
# give the same name to different things.

option(EXITANCE_LARGE_UNITS "Compile several files of a folder at once: fast for a fresh build, slower for one file" ON)

# Files of a unit at most. Larger units spare little more, and one changed file compiles all files of its unit.
set(most_files_of_unit 8)

# Deals the sources of a target into units. Files with options of their own stay alone.
function(group_units target)
    if(NOT EXITANCE_LARGE_UNITS)
        return()
    endif()
    get_target_property(sources ${target} SOURCES)
    list(FILTER sources INCLUDE REGEX "\\.cpp$")
    list(SORT sources)
    set(folders "")
    foreach(source IN LISTS sources)
        # Names without the path of the repository are equal in every copy of it.
        get_filename_component(folder ${source} ABSOLUTE)
        file(RELATIVE_PATH folder ${PROJECT_SOURCE_DIR} ${folder})
        get_filename_component(folder ${folder} DIRECTORY)
        string(MAKE_C_IDENTIFIER "${folder}" folder)
        list(APPEND folders ${folder})
        list(APPEND files_${folder} ${source})
    endforeach()
    list(REMOVE_DUPLICATES folders)
    foreach(folder IN LISTS folders)
        list(LENGTH files_${folder} count)
        math(EXPR units "(${count} + ${most_files_of_unit} - 1) / ${most_files_of_unit}")
        set(k 0)
        foreach(source IN LISTS files_${folder})
            math(EXPR unit "${k} * ${units} / ${count}")  # equal parts
            set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${folder}_${unit})
            math(EXPR k "${k} + 1")
        endforeach()
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
endfunction()
