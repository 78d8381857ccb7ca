#include <fmt/format.h>

#include <iterator>

#include "exitance/evaluate/surface_light.hpp"
#include "exitance/io/export/export_formats.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/probe_file.hpp"

namespace exitance {
namespace {

/// Formats a text as a field of CSV, quoted if necessary.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
    std::string out = "\"";
    for (char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
    return out + "\"";
}

}  // namespace

Result<void> write_surface_table(const Solution& solution, const std::string& path) {
    const Scene& scene = solution.scene;
    const Field<SurfaceId, SurfaceLight> light = mean_light(solution);
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    std::string row = "surface,line,group,material,area [m^2]";
    for (const char* prefix : {",E_", ",B_"})
        for (std::size_t b = 0; b < bands; ++b)
            row += prefix + band_name(b) +
                   (!scene.is_photometric() ? " [W/m^2]"
                    : prefix[1] == 'E'      ? " [lx]"
                                            : " [lm/m^2]");
    row += ",relative_error,error_points";
    const std::vector<FaceError>& errors = solution.statistics.surface_errors;
    const bool has_errors = errors.size() == scene.surfaces().size();
    file->write(row + "\n");
    for (SurfaceId s : scene.surfaces().ids()) {
        const Surface& face = scene.surfaces()[s];
        row = fmt::format("{},{},{},{},{:.10g}", s.value, face.line, field(scene.groups()[face.group]),
                          field(scene.material(s).name), face.area);
        for (const Spectrum& mean : {light[s].irradiance, light[s].radiosity})
            for (double value : mean.value) fmt::format_to(std::back_inserter(row), ",{:.10g}", value);
        if (has_errors)
            fmt::format_to(std::back_inserter(row), ",{:.4g},{}", errors[s.value].error, errors[s.value].points);
        else
            row += ",,";
        file->write(row + "\n");
    }
    return file->commit();
}

}  // namespace exitance
