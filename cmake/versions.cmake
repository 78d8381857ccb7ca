# EXITANCE_LIBRARIES: what `exitance --version` says about the libraries built in.

function(read_version result header_name pattern)
    unset(header)
    find_file(header ${header_name} NO_CACHE)
    file(STRINGS ${header} line REGEX "${pattern}" LIMIT_COUNT 1)
    string(REGEX REPLACE ".*${pattern}.*" "\\1" version "${line}")
    set(${result} ${version} PARENT_SCOPE)
endfunction()

read_version(cgal_version CGAL/version.h "#define CGAL_VERSION ([0-9.]+)")
read_version(httplib_version httplib.h "#define CPPHTTPLIB_VERSION \"([0-9.]+)\"")

set(EXITANCE_LIBRARIES "Embree ${embree_VERSION}, oneTBB ${TBB_VERSION}, CGAL ${cgal_version}, Eigen ${Eigen3_VERSION}")
string(APPEND EXITANCE_LIBRARIES ", HDF5 ${HDF5_VERSION}, libpng ${PNG_VERSION_STRING}, OpenEXR ${OpenEXR_VERSION}, fmt ${fmt_VERSION}")
string(APPEND EXITANCE_LIBRARIES ", CLI11 ${CLI11_VERSION}, nlohmann-json ${nlohmann_json_VERSION}, cpp-httplib ${httplib_version}")
if(MPI_C_FOUND)
    string(APPEND EXITANCE_LIBRARIES ", MPI ${MPI_C_VERSION}")
endif()
