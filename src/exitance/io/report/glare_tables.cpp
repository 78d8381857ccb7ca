#include "exitance/io/report/glare_tables.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/npy_file.hpp"
#include "exitance/io/files/write_error.hpp"

namespace exitance {
namespace {

std::string view_rows(std::span<const ProbePoint> views, std::span<const GlareYear> years) {
    std::string text = "x,y,z,dx,dy,dz,DGP_exceeded_5,DGP_largest,above_0.35,above_0.40,above_0.45,level\n";
    for (std::size_t i = 0; i < views.size(); ++i) {
        const auto& [x, d] = views[i];
        const GlareStatistics& s = years[i].statistics;
        text += fmt::format("{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.10g},{:.4f},{:.4f},{:.6g},{:.6g},{:.6g},{}\n",
                            x.x, x.y, x.z, d.x, d.y, d.z, s.reached, s.worst, s.exceeded[0], s.exceeded[1],
                            s.exceeded[2], s.level());
    }
    return text;
}

Result<void> write_table(const std::string& path, std::span<const GlareYear> years,
                         std::span<const DaylightHour> hours) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    file->write("month,day,hour");
    for (std::size_t i = 0; i < years.size(); ++i) file->write(fmt::format(",DGP_{}", i));
    for (std::size_t h = 0; h < hours.size(); ++h) {
        std::string row = fmt::format("\n{},{},{}", hours[h].time.month, hours[h].time.day, hours[h].hour);
        for (const GlareYear& year : years) fmt::format_to(std::back_inserter(row), ",{:.4g}", year.probability[h]);
        file->write(row);
    }
    file->write("\n");
    return file->commit();
}

Result<void> write_array(const std::string& path, std::span<const GlareYear> years, std::size_t hours) {
    Result<NpyWriter> file = NpyWriter::create(path, NpyType::float32, years.size(), hours);
    if (!file) return file.error();
    for (const GlareYear& year : years) file->append(year.probability);
    return file->commit();
}

}  // namespace

Result<void> write_glare(const std::string& folder, std::span<const ProbePoint> views, std::span<const GlareYear> years,
                         std::span<const DaylightHour> hours, HoursFormat format) {
    if (const Result<void> made = make_folder(folder); !made) return made.error();
    const auto in = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    const Result<void> written = format == HoursFormat::csv ? write_table(in("glare_hours.csv"), years, hours)
                                                            : write_array(in("glare_hours.npy"), years, hours.size());
    return written ? write_file(in("glare.csv"), view_rows(views, years)) : written;
}

}  // namespace exitance
