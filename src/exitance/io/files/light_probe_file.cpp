#include "exitance/io/files/light_probe_file.hpp"

#include <fmt/format.h>

#include "exitance/base/version.hpp"
#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/text_table.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"
#include "exitance/scene/photometric_units.hpp"

namespace exitance {
namespace {

constexpr const char* order = "(0,0) (1,-1) (1,0) (1,1) (2,-2) (2,-1) (2,0) (2,1) (2,2)";

std::string numbers(const Spectrum& value) {
    std::string out;
    for (std::size_t b = 0; b < bands; ++b) out += fmt::format("{}{:.7g}", b > 0 ? "," : "", value[b]);
    return fmt::format("[{}]", out);
}

std::string coefficients(const Harmonics<Spectrum>& values) {
    std::string out;
    for (const Spectrum& value : values) out += fmt::format("{}{}", out.empty() ? "" : ",", numbers(value));
    return fmt::format("[{}]", out);
}

Result<void> write_json(const std::string& path, const LightProbeTable& table) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    const LightUnit unit(UnitChoice::scene, table.is_photometric);
    file->write(
        fmt::format("{{\n  \"version\": 1,\n  \"generator\": \"exitance {}\",\n  \"unit\": \"{}\",\n"
                    "  \"order\": \"{}\",\n  \"irradiance_factors\": [{}, {}, {}],\n  \"rays\": {},\n",
                    program_version, unit.radiance(), order, irradiance_factors[0], irradiance_factors[1],
                    irradiance_factors[2], table.rays));
    if (table.grid)
        file->write(fmt::format(
            "  \"grid\": {{\"origin\": [{}, {}, {}], \"step\": [{}, {}, {}], \"count\": [{}, {}, "
            "{}]}},\n",
            table.grid->origin.x, table.grid->origin.y, table.grid->origin.z, table.grid->step.x, table.grid->step.y,
            table.grid->step.z, table.grid->count[0], table.grid->count[1], table.grid->count[2]));
    file->write("  \"probes\": [");
    for (std::size_t i = 0; i < table.probes.size(); ++i) {
        const Point& x = table.points[i];
        const LightProbe& probe = table.probes[i];
        file->write(
            fmt::format("{}\n    {{\"position\": [{}, {}, {}], \"back_share\": {}, \"radiance\": {}, "
                        "\"standard_error\": {}}}",
                        i > 0 ? "," : "", x.x, x.y, x.z, probe.back_share, coefficients(probe.radiance),
                        coefficients(probe.standard_error)));
    }
    file->write("\n  ]\n}\n");
    return file->commit();
}

Result<void> write_hdf5(const std::string& path, const LightProbeTable& table) {
    const std::string group = "light_probes";
    Hdf5Writer file(path);
    if (table.is_photometric) file.use_lumens();
    file.make_group(group);
    file.set_attribute(group, "version", std::int32_t(1));
    file.set_attribute(group, "order", std::string_view(order));
    file.set_attribute(group, "rays", static_cast<std::int64_t>(table.rays));
    file.set_attribute(group, "irradiance_factors", std::span<const double>(irradiance_factors));
    if (table.grid) {
        const Point& o = table.grid->origin;
        const Vec3& d = table.grid->step;
        const std::array<double, 3> origin{o.x, o.y, o.z}, step{d.x, d.y, d.z};
        const std::array<std::int32_t, 3> count{table.grid->count[0], table.grid->count[1], table.grid->count[2]};
        file.set_attribute(group, "grid_origin", std::span<const double>(origin));
        file.set_attribute(group, "grid_step", std::span<const double>(step));
        file.set_attribute(group, "grid_count", std::span<const std::int32_t>(count));
    }
    const std::size_t n = table.probes.size();
    file.write_rows<double>(group + "/position", n, 3, {"m", "positions of the probes"},
                            [&](std::size_t i, std::span<double> row) {
                                for (std::size_t k = 0; k < 3; ++k) row[k] = table.points[i][k];
                            });
    const auto write = [&](const char* name, Harmonics<Spectrum> LightProbe::*values, const char* what) {
        file.write_rows<float>(group + name, n, harmonic_count * bands, {"W/(m^2 sr)", what},
                               [&](std::size_t i, std::span<float> row) {
                                   for (std::size_t k = 0; k < row.size(); ++k)
                                       row[k] = static_cast<float>((table.probes[i].*values)[k / bands][k % bands]);
                               });
    };
    write("/radiance", &LightProbe::radiance, "coefficients of radiance, by harmonic, then by band");
    write("/standard_error", &LightProbe::standard_error, "standard errors of the coefficients");
    file.write_rows<float>(
        group + "/back_share", n, 1, {"1", "shares of directions in which backs of surfaces are seen"},
        [&](std::size_t i, std::span<float> row) { row[0] = static_cast<float>(table.probes[i].back_share); });
    return file.commit();
}

}  // namespace

std::size_t ProbeGrid::size() const {
    std::size_t n = 1;
    for (const int c : count) n *= static_cast<std::size_t>(c);
    return n;
}

std::vector<Point> ProbeGrid::points() const {
    std::vector<Point> out;
    out.reserve(size());
    for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j)
            for (int i = 0; i < count[0]; ++i) out.push_back(origin + Vec3{i * step.x, j * step.y, k * step.z});
    return out;
}

Result<std::vector<Point>> load_points(const std::string& path) {
    std::vector<Point> out;
    if (ending(path) == ".pts") {
        Result<LineReader> lines = LineReader::open(path);
        if (!lines) return lines.error();
        while (const std::optional<std::string_view> line = lines->next_content()) {
            Point p;
            std::size_t at = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                at = line->find_first_not_of(" \t", at);
                const std::size_t end = std::min(line->find_first_of(" \t", at), line->size());
                const std::optional<double> number =
                    at < line->size() ? parse_number(line->substr(at, end - at)) : std::nullopt;
                if (!number) return lines->error("expected three numbers: x y z");
                p[k] = *number, at = end;
            }
            out.push_back(p);
        }
        if (lines->failed()) return lines->read_error();
        return out;
    }
    Result<NumberTable> table = NumberTable::open(path, {"x", "y", "z"});
    if (!table) return table.error();
    std::array<double, 3> row{};
    for (;;) {
        const Result<bool> read = table->next(row);
        if (!read) return read.error();
        if (!*read) return out;
        out.emplace_back(Point{row[0], row[1], row[2]});
    }
}

Result<void> write_light_probes(const std::string& path, const LightProbeTable& table) {
    return ending(path) == ".h5" ? write_hdf5(path, table) : write_json(path, table);
}

}  // namespace exitance
