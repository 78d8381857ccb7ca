#include "exitance/io/report/hours_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "run_program.hpp"

namespace exitance {
namespace {

/// Writes hours.h5 with made-up light, in blocks of `together` sensors. Returns the file's bytes.
std::string file_in_blocks(const DaylightTask& task, std::size_t together) {
    const TemporaryFolder folder;
    Result<std::unique_ptr<HoursFile>> file = make_hours_file(folder / ".", HoursFormat::hdf5, task);
    if (!file) return ADD_FAILURE() << file.error().message, "";
    const std::size_t n = task.sensors.size(), hours = task.hours.size();
    for (std::size_t first = 0; first < n; first += together) {
        DaylightBlock block;
        block.first = first, block.results.resize(std::min(together, n - first));
        for (std::size_t k = first * hours; k < (first + block.results.size()) * hours; ++k)
            block.illuminance.push_back(static_cast<float>(k % 1000)), block.sun.push_back(static_cast<float>(k % 7));
        (*file)->add(block);
    }
    EXPECT_TRUE((*file)->finish());
    return test::read_text(folder / "hours.h5");
}

}  // namespace

TEST(HoursFile, BytesDoNotDependOnTheBlocksOfSensors) {
    DaylightTask task;
    task.sensors.resize(2700), task.hours.resize(8760);  // more than the file buffers of each set
    EXPECT_TRUE(file_in_blocks(task, 256) == file_in_blocks(task, 85));
}

}  // namespace exitance
