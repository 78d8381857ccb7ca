#include "exitance/io/export/export.hpp"

#include "exitance/io/export/export_formats.hpp"
#include "exitance/io/solution/solution_groups.hpp"

namespace exitance {

Result<void> write_vtkhdf_file(const Solution& solution, const std::string& path) {
    Hdf5Writer file(path);
    if (solution.scene.is_photometric()) file.use_lumens();
    write_vtkhdf(file, solution);
    return file.commit();
}

Result<void> export_solution(const Solution& solution, const std::string& path) {
    const struct {
        const char* ending;
        Result<void> (*write)(const Solution&, const std::string&);
    } formats[] = {{".vtkhdf", write_vtkhdf_file},
                   {".hdf", write_vtkhdf_file},
                   {".vtu", write_vtu},
                   {".glb", write_glb},
                   {".obj", write_obj},
                   {".csv", write_surface_table}};
    if (path.ends_with(".curves.csv")) return write_curves(solution, path);
    std::string known;
    for (const auto& format : formats) {
        if (path.ends_with(format.ending)) return format.write(solution, path);
        known += std::string(known.empty() ? "" : ", ") + format.ending;
    }
    return Error{ErrorCode::usage, "the ending of " + path + " is not that of a known format", path,
                 "known endings: " + known + ", .curves.csv"};
}

}  // namespace exitance
