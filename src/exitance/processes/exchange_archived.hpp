#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/base/archive.hpp"
#include "exitance/base/check.hpp"
#include "exitance/processes/distributed.hpp"

namespace exitance {

/// Sends every value from the process that has computed it (`is_own` for blocks of `grain` values) to all others, like
/// `exchange_values`, but for values that hold vectors or strings.
/// archive_one  archive_one(archive, value) converts a value to bytes and back
/// Holds the bytes of all values at once. Does nothing with one process. Collective.
template <class T, class ArchiveOne>
void exchange_archived(std::span<T> values, std::size_t grain, const ArchiveOne& archive_one, const char* what) {
    if (processes() == 1) return;
    const std::size_t blocks = (values.size() + grain - 1) / grain;
    const auto block = [&](std::size_t b) {
        return values.subspan(b * grain, std::min(grain, values.size() - b * grain));
    };
    std::vector<std::string> bytes(blocks);
    std::vector<std::string*> all;
    for (std::size_t b = 0; b < blocks; ++b) {
        all.push_back(&bytes[b]);
        if (!is_own(b, 1)) continue;
        ArchiveWriter writer;
        for (T& value : block(b)) archive_one(writer, value);
        bytes[b] = writer.take();
    }
    result_sharing().exchange(all, what);
    for (std::size_t b = 0; b < blocks; ++b) {
        if (is_own(b, 1)) continue;
        ArchiveReader reader(bytes[b]);
        for (T& value : block(b)) archive_one(reader, value);
        EXI_CHECK(reader.good() && reader.left() == 0);
    }
}

/// Returns the first process's value in all processes, for a value that holds vectors or strings; `archive_one` as in
/// `exchange_archived`. Collective.
template <class T, class ArchiveOne>
T as_first_archived(T value, const ArchiveOne& archive_one, const char* what) {
    if (processes() == 1) return value;
    ArchiveWriter writer;
    if (is_first_process()) archive_one(writer, value);
    const std::string bytes = as_first(writer.take(), what);
    if (is_first_process()) return value;
    ArchiveReader reader(bytes);
    archive_one(reader, value);
    EXI_CHECK(reader.good() && reader.left() == 0);
    return value;
}

}  // namespace exitance
