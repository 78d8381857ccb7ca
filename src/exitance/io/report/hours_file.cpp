#include "exitance/io/report/hours_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>

#include "exitance/io/files/npy_file.hpp"
#include "exitance/io/solution/hdf5_file.hpp"

namespace exitance {
namespace {

/// How HDF5 files store illuminances: numbers of the type `Number` in a unit of so many lux.
template <class Number>
struct Stored {
    static constexpr double unit = 1;
    static float of(float lux) { return lux; }
};
template <>
struct Stored<Half> {
    static constexpr double unit = lux_per_half;
    static Half of(float lux) { return to_half(lux / static_cast<float>(lux_per_half)); }
};

/// hours.h5
template <class Number>
class Hdf5Hours final : public HoursFile {
  public:
    Hdf5Hours(const std::string& path, const DaylightTask& task) : file_(path), hours_(task.hours.size()) {
        const std::size_t sensors = task.sensors.size(), hours = task.hours.size();
        std::vector<std::int32_t> times;
        for (const DaylightHour& hour : task.hours)
            for (const int v : {hour.time.month, hour.time.day, hour.hour}) times.push_back(v);
        file_.write("hours", times, 3, {"1", "month, day, and end of each hour, 1 to 24"});
        file_.write_rows<double>("sensors", sensors, 6, {"m", "position and direction of each sensor"},
                                 [&](std::size_t i, std::span<double> row) {
                                     const auto& [x, n] = task.sensors[i];
                                     std::ranges::copy(std::array{x.x, x.y, x.z, n.x, n.y, n.z}, row.begin());
                                 });
        const auto open = [&](const char* name, const char* text) {
            Hdf5Rows rows = file_.open_rows<Number>(name, sensors, hours, {"lx", text});
            file_.set_attribute(name, "scale", Stored<Number>::unit);
            return rows;
        };
        illuminance_ = open("illuminance", "illuminance over scale; a row per sensor, a column per hour");
        sun_ = open("sun", "direct sunlight in illuminance over scale");
    }

    /// Adds both rows of a sensor before the next ones, so that the places in the file do not depend on the blocks.
    void add(const DaylightBlock& block) override {
        for (std::size_t first = 0; first < block.illuminance.size(); first += hours_) {
            append(illuminance_, std::span(block.illuminance).subspan(first, hours_));
            append(sun_, std::span(block.sun).subspan(first, hours_));
        }
    }
    Result<void> finish() override { return file_.commit(); }

  private:
    void append(Hdf5Rows& set, std::span<const float> lux) {
        std::vector<Number> stored(lux.size());
        std::transform(lux.begin(), lux.end(), stored.begin(), Stored<Number>::of);
        file_.append(set, std::span<const Number>(stored));
    }

    Hdf5Writer file_;
    std::size_t hours_;
    Hdf5Rows illuminance_, sun_;
};

/// Two files, of illuminance and of direct sunlight in it.
template <class File>
class TwoFiles final : public HoursFile {
  public:
    TwoFiles(File illuminance, File sun) : illuminance_(std::move(illuminance)), sun_(std::move(sun)) {}

    void add(const DaylightBlock& block) override { illuminance_.append(block.illuminance), sun_.append(block.sun); }
    Result<void> finish() override {
        const Result<void> written = illuminance_.commit();
        return written ? sun_.commit() : written;
    }

  private:
    File illuminance_, sun_;
};

/// A table with a row per hour and a column per sensor. Rows of sensors are kept in a temporary file until the last has
/// arrived.
class HoursTable {
  public:
    HoursTable(AtomicFile table, AtomicFile rows, const DaylightTask& task)
        : table_(std::move(table)), rows_(std::move(rows)), task_(task) {}

    void append(std::span<const float> lux) {
        rows_.write_at(place_, std::as_bytes(lux));
        place_ += lux.size_bytes();
    }

    Result<void> commit() {
        constexpr std::size_t slab_numbers = std::size_t{1} << 24;  // 64 MB
        const std::size_t n = task_.sensors.size(), hours = task_.hours.size(),
                          together = std::clamp<std::size_t>(slab_numbers / std::max<std::size_t>(n, 1), 1, hours);
        if (rows_.failed()) return rows_.commit();
        table_.write("month,day,hour");
        for (std::size_t i = 0; i < n; ++i) table_.write(fmt::format(",E_{}", i));
        std::vector<float> slab(n * together);
        for (std::size_t first = 0; first < hours; first += together) {
            const std::size_t count = std::min(together, hours - first);
            for (std::size_t i = 0; i < n; ++i)
                rows_.read_at((i * hours + first) * sizeof(float),
                              std::as_writable_bytes(std::span(slab).subspan(i * together, count)));
            for (std::size_t k = 0; k < count; ++k)
                write_row(task_.hours[first + k], std::span(slab).subspan(k), together);
        }
        table_.write("\n");
        return table_.commit();
    }

  private:
    /// Writes the row of an hour. `column`: begins with the first sensor's value; the values of further sensors follow
    /// at intervals of `stride`.
    void write_row(const DaylightHour& hour, std::span<const float> column, std::size_t stride) {
        fmt::memory_buffer row;
        fmt::format_to(std::back_inserter(row), "\n{},{},{}", hour.time.month, hour.time.day, hour.hour);
        for (std::size_t i = 0; i < task_.sensors.size(); ++i) {
            const float v = column[i * stride];
            if (v == 0)
                fmt::format_to(std::back_inserter(row), ",0");
            else
                fmt::format_to(std::back_inserter(row), ",{:.5g}", v);
        }
        table_.write(std::string_view(row.data(), row.size()));
    }

    AtomicFile table_;
    AtomicFile rows_;  ///< Never committed, so that the file is removed with this object.
    const DaylightTask& task_;
    std::size_t place_ = 0;  ///< End of `rows_`, bytes.
};

Result<HoursTable> make_table(const std::string& path, const DaylightTask& task) {
    Result<AtomicFile> table = AtomicFile::create(path);
    if (!table) return table.error();
    Result<AtomicFile> rows = AtomicFile::create(path + ".rows");
    if (!rows) return rows.error();
    return HoursTable(std::move(*table), std::move(*rows), task);
}

}  // namespace

Result<std::unique_ptr<HoursFile>> make_hours_file(const std::string& folder, HoursFormat format,
                                                   const DaylightTask& task) {
    const auto in = [&](const char* name) { return (std::filesystem::path(folder) / name).string(); };
    using Made = std::unique_ptr<HoursFile>;
    if (format == HoursFormat::hdf5) return Made(std::make_unique<Hdf5Hours<Half>>(in("hours.h5"), task));
    if (format == HoursFormat::hdf5_float) return Made(std::make_unique<Hdf5Hours<float>>(in("hours.h5"), task));
    if (format == HoursFormat::npy) {
        const auto make = [&](const char* name) {
            return NpyWriter::create(in(name), NpyType::float32, task.sensors.size(), task.hours.size());
        };
        Result<NpyWriter> illuminance = make("illuminance.npy"), sun = make("sun.npy");
        if (!illuminance) return illuminance.error();
        if (!sun) return sun.error();
        return Made(std::make_unique<TwoFiles<NpyWriter>>(std::move(*illuminance), std::move(*sun)));
    }
    Result<HoursTable> illuminance = make_table(in("illuminance.csv"), task), sun = make_table(in("sun.csv"), task);
    if (!illuminance) return illuminance.error();
    if (!sun) return sun.error();
    return Made(std::make_unique<TwoFiles<HoursTable>>(std::move(*illuminance), std::move(*sun)));
}

}  // namespace exitance
