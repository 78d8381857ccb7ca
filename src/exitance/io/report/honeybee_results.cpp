#include "exitance/io/report/honeybee_results.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "exitance/io/files/atomic_file.hpp"

namespace exitance {
namespace {

/// Middle of an hour, in hours since the beginning of a year of 365 days.
double hour_of_year(const DaylightHour& hour) {
    constexpr std::array<int, 12> days_before{0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    const int day = days_before[static_cast<std::size_t>(hour.time.month - 1)] + hour.time.day - 1;
    return 24 * day + hour.hour - 0.5;
}

/// Indices of the hours in which some sensor receives light.
std::vector<std::size_t> lit_hours(const DaylightTask& task, const DaylightResults& results) {
    const std::size_t n = task.sensors.size();
    std::vector<std::size_t> out;
    for (std::size_t h = 0; h < task.hours.size(); ++h) {
        const auto row = results.year.illuminance.begin() + static_cast<std::ptrdiff_t>(h * n);
        if (std::any_of(row, row + static_cast<std::ptrdiff_t>(n), [](float v) { return v > 0; })) out.push_back(h);
    }
    return out;
}

/// Names of files for the grids: identifiers with other characters than Honeybee's, and those that were used before,
/// are changed.
std::vector<std::string> file_names(std::span<const SensorGrid> grids) {
    std::vector<std::string> out;
    for (const SensorGrid& grid : grids) {
        std::string name = grid.name;
        for (char& c : name)
            if (!std::isalnum(static_cast<unsigned char>(c)) && c != '_' && c != '-' && c != '.') c = '_';
        if (name.empty() || name[0] == '.') name = "grid" + name;
        while (std::find(out.begin(), out.end(), name) != out.end()) name += '_';
        out.push_back(std::move(name));
    }
    return out;
}

Result<void> write_grid(const std::string& path, const DaylightResults& results, const std::vector<std::size_t>& hours,
                        std::size_t first, std::size_t count) {
    Result<AtomicFile> file = AtomicFile::create(path);
    if (!file) return file.error();
    std::string row;
    for (std::size_t i = first; i < first + count; ++i) {
        row.clear();
        for (const std::size_t h : hours)
            row += fmt::format("{:.5g} ", results.year.illuminance[h * results.year.sensors + i]);
        row += '\n';
        file->write(row);
    }
    return file->commit();
}

}  // namespace

Result<void> write_honeybee_results(const std::string& folder, const DaylightTask& task,
                                    const DaylightResults& results) {
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) return Error{ErrorCode::cannot_write, "cannot be made: " + failure.message(), folder, ""};
    const auto in = [&](const std::string& name) { return (std::filesystem::path(folder) / name).string(); };
    const std::vector<std::size_t> hours = lit_hours(task, results);
    nlohmann::ordered_json info = nlohmann::ordered_json::array();
    const std::vector<SensorGrid>& grids = task.grids;
    const std::vector<std::string> names = file_names(grids);
    std::size_t first = 0;
    for (std::size_t g = 0; g < grids.size(); ++g) {
        const std::size_t count = grids[g].count;
        const Result<void> written = write_grid(in(names[g] + ".ill"), results, hours, first, count);
        if (!written) return written.error();
        first += count;
        info.push_back({{"name", names[g]},
                        {"identifier", grids[g].name},
                        {"full_id", names[g]},
                        {"count", count},
                        {"group", ""}});
    }
    std::string times;
    for (const std::size_t h : hours) times += fmt::format("{:.1f}\n", hour_of_year(task.hours[h]));
    if (const Result<void> written = write_file(in("sun-up-hours.txt"), times); !written) return written.error();
    return write_file(in("grids_info.json"), info.dump(2) + "\n");
}

}  // namespace exitance
