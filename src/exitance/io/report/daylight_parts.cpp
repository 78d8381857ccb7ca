#include "exitance/io/report/daylight_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <regex>

#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/files/write_error.hpp"

namespace exitance {
namespace {

constexpr std::size_t block_sensors = 256;

std::size_t numbers_of_results() {
    std::size_t count = 0;
    SensorResults results;
    for_each_number(results, [&](double) { ++count; });
    return count;
}

std::string in(const std::string& folder, const char* name) {
    return (std::filesystem::path(folder) / name).string();
}

/// The open files of a part.
class PartReader {
  public:
    static Result<PartReader> open(const std::string& folder, const DaylightTask& task, std::size_t sensors,
                                   const std::string& fingerprint) {
        const Result<std::string> found = read_whole_file(in(folder, "part.txt"));
        if (!found)
            return Error{ErrorCode::bad_input, "holds no complete part", folder, "run this part with --part first"};
        if (*found != fingerprint + "\n")
            return Error{ErrorCode::bad_input, "is the part of another scene, weather, table of sensors or option",
                         folder, "run this part again"};
        Result<NpyReader> illuminance = NpyReader::open(in(folder, "illuminance.npy")),
                          sun = NpyReader::open(in(folder, "sun.npy")),
                          matrix = NpyReader::open(in(folder, "matrix.npy")),
                          results = NpyReader::open(in(folder, "results.npy"));
        for (const Result<NpyReader>* const file : {&illuminance, &sun, &matrix, &results})
            if (!*file) return file->error();
        const std::size_t hours = task.hours.size();
        const auto fits = [&](const NpyReader& file, NpyType type, std::size_t columns) {
            return file.type() == type && file.rows() == sensors && file.columns() == columns;
        };
        if (!fits(*illuminance, NpyType::float32, hours) || !fits(*sun, NpyType::float32, hours) ||
            !fits(*matrix, NpyType::float32, matrix->columns()) || matrix->columns() % 2 != 0 ||
            !fits(*results, NpyType::float64, numbers_of_results()))
            return Error{ErrorCode::bad_input, "holds tables whose sizes do not match this simulation", folder,
                         "run this part again"};
        return PartReader(std::move(*illuminance), std::move(*sun), std::move(*matrix), std::move(*results));
    }

    Result<DaylightBlock> read(std::size_t first, std::size_t count) {
        Result<std::vector<float>> illuminance = illuminance_.read<float>(first, count),
                                   sun = sun_.read<float>(first, count), matrix = matrix_.read<float>(first, count);
        Result<std::vector<double>> numbers = results_.read<double>(first, count);
        for (const Result<std::vector<float>>* const read : {&illuminance, &sun, &matrix})
            if (!*read) return read->error();
        if (!numbers) return numbers.error();
        DaylightBlock block;
        block.illuminance = std::move(*illuminance), block.sun = std::move(*sun);
        const std::size_t m = matrix_.columns() / 2;
        block.matrix.patches = m;
        for (std::size_t i = 0; i < count; ++i) {
            const auto row = matrix->begin() + static_cast<std::ptrdiff_t>(2 * i * m);
            const auto middle = row + static_cast<std::ptrdiff_t>(m);
            block.matrix.direct.insert(block.matrix.direct.end(), row, middle);
            block.matrix.reflected.insert(block.matrix.reflected.end(), middle,
                                          middle + static_cast<std::ptrdiff_t>(m));
        }
        block.results.resize(count);
        auto next = numbers->begin();
        for (SensorResults& results : block.results) for_each_number(results, [&](double& v) { v = *next++; });
        return block;
    }

  private:
    PartReader(NpyReader illuminance, NpyReader sun, NpyReader matrix, NpyReader results)
        : illuminance_(std::move(illuminance)),
          sun_(std::move(sun)),
          matrix_(std::move(matrix)),
          results_(std::move(results)) {}

    NpyReader illuminance_, sun_, matrix_, results_;
};

}  // namespace

std::string DaylightPart::folder(const std::string& output) const {
    return in(output, fmt::format("part-{:05}-of-{:05}", part, parts).c_str());
}

Result<DaylightPartWriter> DaylightPartWriter::create(const std::string& folder, const DaylightTask& task,
                                                      std::size_t sensors, std::size_t patches,
                                                      const std::string& fingerprint) {
    if (const Result<void> made = make_folder(folder); !made) return made.error();
    std::error_code failure;
    // without this file the part counts as incomplete, until it is written at the end
    std::filesystem::remove(in(folder, "part.txt"), failure);
    const std::size_t hours = task.hours.size();
    Result<NpyWriter> illuminance = NpyWriter::create(in(folder, "illuminance.npy"), NpyType::float32, sensors, hours),
                      sun = NpyWriter::create(in(folder, "sun.npy"), NpyType::float32, sensors, hours),
                      matrix = NpyWriter::create(in(folder, "matrix.npy"), NpyType::float32, sensors, 2 * patches),
                      results =
                          NpyWriter::create(in(folder, "results.npy"), NpyType::float64, sensors, numbers_of_results());
    for (const Result<NpyWriter>* const file : {&illuminance, &sun, &matrix, &results})
        if (!*file) return file->error();
    return DaylightPartWriter(folder, fingerprint, std::move(*illuminance), std::move(*sun), std::move(*matrix),
                              std::move(*results));
}

void DaylightPartWriter::add(const DaylightBlock& block) {
    illuminance_.append(block.illuminance), sun_.append(block.sun);
    const std::size_t m = block.matrix.patches;
    for (std::size_t i = 0; i < block.results.size(); ++i) {
        matrix_.append(std::span(block.matrix.direct).subspan(i * m, m));
        matrix_.append(std::span(block.matrix.reflected).subspan(i * m, m));
        std::vector<double> numbers;
        for_each_number(block.results[i], [&](double v) { numbers.push_back(v); });
        results_.append(numbers);
    }
}

Result<void> DaylightPartWriter::finish() {
    for (NpyWriter* const file : {&illuminance_, &sun_, &matrix_, &results_})
        if (const Result<void> written = file->commit(); !written) return written;
    return write_file(in(folder_, "part.txt"), fingerprint_ + "\n");
}

Result<std::size_t> count_daylight_parts(const std::string& output) {
    static const std::regex pattern("part-[0-9]{5}-of-([0-9]{5})");
    std::size_t parts = 0;
    std::error_code failure;
    for (const auto& entry : std::filesystem::directory_iterator(output, failure)) {
        std::smatch match;
        const std::string name = entry.path().filename().string();
        if (!std::regex_match(name, match, pattern)) continue;
        const std::size_t of = std::stoul(match[1]);
        if (parts != 0 && of != parts)
            return Error{ErrorCode::bad_input, fmt::format("holds parts of {} and of {}", parts, of), output,
                         "remove the folders of those that do not belong to this simulation"};
        parts = of;
    }
    if (parts == 0) return Error{ErrorCode::bad_input, "holds no parts", output, "run the parts with --part first"};
    return parts;
}

Result<void> merge_daylight_parts(const std::string& output, std::size_t parts, const DaylightTask& task,
                                  const std::string& fingerprint, const DaylightSink& sink) {
    for (std::size_t part = 1; part <= parts; ++part) {
        const SensorRange range = sensors_of_part(part, parts, task.sensors.size());
        Result<PartReader> reader =
            PartReader::open(DaylightPart{part, parts}.folder(output), task, range.count, fingerprint);
        if (!reader) return reader.error();
        for (std::size_t at = 0; at < range.count; at += block_sensors) {
            Result<DaylightBlock> block = reader->read(at, std::min(block_sensors, range.count - at));
            if (!block) return block.error();
            block->first = range.first + at;
            if (const Result<void> taken = sink(*block); !taken) return taken;
        }
    }
    return {};
}

}  // namespace exitance
