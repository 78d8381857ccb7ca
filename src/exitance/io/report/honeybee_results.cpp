#include "exitance/io/report/honeybee_results.hpp"
#include "exitance/io/files/write_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <iterator>
#include <nlohmann/json.hpp>

namespace exitance {
namespace {

/// Middle of an hour, in hours since the beginning of a year of 365 days.
double hour_of_year(const DaylightHour& hour) {
    constexpr std::array<int, 12> days_before{0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334};
    const int day = days_before[static_cast<std::size_t>(hour.time.month - 1)] + hour.time.day - 1;
    return 24 * day + hour.hour - 0.5;
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

}  // namespace

HoneybeeResults::HoneybeeResults(std::string folder, const DaylightTask& task)
    : folder_(std::move(folder)), task_(&task), names_(file_names(task.grids)) {
    for (std::size_t h = 0; h < task.hours.size(); ++h)
        if (has_light(task.hours[h])) lit_.push_back(h);
}

Result<HoneybeeResults> HoneybeeResults::create(const std::string& folder, const DaylightTask& task) {
    if (const Result<void> made = make_folder(folder); !made) return made.error();
    return HoneybeeResults(folder, task);
}

std::string HoneybeeResults::path(const std::string& name) const {
    return (std::filesystem::path(folder_) / name).string();
}

/// Opens the file of the next grid, and completes those of grids without sensors.
Result<void> HoneybeeResults::open_grid() {
    while (!file_ && grid_ < names_.size()) {
        Result<AtomicFile> file = AtomicFile::create(path(names_[grid_] + ".ill"));
        if (!file) return file.error();
        if (task_->grids[grid_].count > 0) {
            file_.emplace(std::move(*file));
        } else {
            if (const Result<void> written = file->commit(); !written) return written;
            ++grid_;
        }
    }
    return {};
}

Result<void> HoneybeeResults::add(const DaylightBlock& block) {
    const std::size_t hours = task_->hours.size();
    std::string row;
    for (std::size_t i = 0; i < block.results.size(); ++i) {
        if (const Result<void> opened = open_grid(); !opened) return opened;
        row.clear();
        for (const std::size_t h : lit_)
            fmt::format_to(std::back_inserter(row), "{:.5g} ", block.illuminance[i * hours + h]);
        row += '\n';
        file_->write(row);
        if (++rows_ < task_->grids[grid_].count) continue;
        if (const Result<void> written = file_->commit(); !written) return written;
        file_.reset(), rows_ = 0, ++grid_;
    }
    return {};
}

Result<void> HoneybeeResults::finish() {
    if (const Result<void> opened = open_grid(); !opened) return opened;
    nlohmann::ordered_json info = nlohmann::ordered_json::array();
    for (std::size_t g = 0; g < names_.size(); ++g)
        info.push_back({{"name", names_[g]},
                        {"identifier", task_->grids[g].name},
                        {"full_id", names_[g]},
                        {"count", task_->grids[g].count},
                        {"group", ""}});
    std::string times;
    for (const std::size_t h : lit_) times += fmt::format("{:.1f}\n", hour_of_year(task_->hours[h]));
    if (const Result<void> written = write_file(path("sun-up-hours.txt"), times); !written) return written.error();
    return write_file(path("grids_info.json"), info.dump(2) + "\n");
}

}  // namespace exitance
