#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <string>
#include <vector>

#include "exitance/base/archive.hpp"
#include "exitance/base/check.hpp"
#include "exitance/base/memory.hpp"
#include "exitance/base/parallel.hpp"

namespace exitance {

/// Interface by which processes that solve one scene together exchange their results. Set by the layer that implements
/// it (`processes/distributed`), so that lower layers do not depend on it.
struct ResultSharing {
    std::size_t processes = 1, own = 0;
    /// Distributes blocks: the bytes of blocks[b] are given by process b % processes and are in all processes
    /// afterwards. Null: there is no such block. Collective.
    void (*exchange)(std::span<std::string* const> blocks, const char* what) = nullptr;
    /// Keeps one copy per node of the whole pages of a finished array that is equal in all processes. Collective.
    void (*share)(char* begin, std::size_t size) = nullptr;
    /// Processor time that this process has spent on its share of distributed work so far, seconds.
    double dealt_seconds = 0;
};
inline ResultSharing& result_sharing() {
    static ResultSharing sharing;
    return sharing;
}

/// Runs this process's share of a step and adds its processor time to `dealt_seconds`.
template <class Share>
void do_own_share(const Share& share) {
    const double before = processor_seconds();
    share();
    result_sharing().dealt_seconds += processor_seconds() - before;
}

/// Keeps one copy per node of finished values that are equal in all processes, instead of one per process. Applies to
/// whole pages; a process that writes to them later gets private pages again. Does nothing for small arrays, or if the
/// system cannot share pages between processes. Collective.
template <class T>
void share_on_node(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (const auto share = result_sharing().share)
        // The pointer only locates the pages; nothing is written through it.
        share(reinterpret_cast<char*>(const_cast<std::remove_const_t<T>*>(values.data())), values.size_bytes());
}
/// Like the function above, for a value that consists of several arrays.
template <class T>
requires requires(const T& value) {
    value.visit_arrays([](const auto&) {});
}
void share_on_node(const T& value) {
    value.visit_arrays([](const auto& array) { share_on_node(array); });
}

/// Assigns blocks to processes; returns the process of each block. Without forecasts (`work` empty) round robin; else
/// the most expensive block first, each to the process with the least work so far. O(blocks (log blocks + processes)).
/// Source: [Graham69].
inline std::vector<std::size_t> deal_blocks(std::size_t blocks, std::span<const double> work, std::size_t processes) {
    std::vector<std::size_t> owner(blocks);
    if (work.empty()) {
        for (std::size_t b = 0; b < blocks; ++b) owner[b] = b % processes;
        return owner;
    }
    std::vector<std::size_t> order(blocks);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return work[a] > work[b]; });
    std::vector<double> has(processes, 0.0);
    for (const std::size_t b : order) {
        const auto least = std::min_element(has.begin(), has.end());
        owner[b] = static_cast<std::size_t>(least - has.begin());
        *least += work[b];
    }
    return owner;
}

/// Computes out[i] = find(i) for all i, on all threads. If several processes work together, blocks of `grain` indices
/// are distributed to them, and all processes must make the same call. The results are the same on any number of
/// processes.
/// archive_one  archive_one(archive, value) converts a value to bytes and back
/// what         name of the step, in traces and statistics of messages
/// work         expected cost of each block, in any unit; empty: about the same for all
template <class T, class Find, class ArchiveOne>
void find_together(std::vector<T>& out, std::size_t grain, const Find& find, const ArchiveOne& archive_one,
                   const char* what, std::span<const double> work = {}) {
    const ResultSharing sharing = result_sharing();
    const std::size_t blocks = (out.size() + grain - 1) / grain;
    const std::vector<std::size_t> owner = deal_blocks(blocks, work, sharing.processes);
    const auto for_block = [&](std::size_t b, const auto& body) {
        for (std::size_t i = b * grain; i < std::min(out.size(), (b + 1) * grain); ++i) body(i);
    };
    do_own_share([&] {
        parallel_for(blocks, 1,
                     [&](std::size_t b) {
                         if (owner[b] == sharing.own) for_block(b, [&](std::size_t i) { out[i] = find(i); });
                     },
                     {what});
    });
    if (sharing.processes == 1) return;
    // Exchanged in rounds, so that only a small part of the results is held twice.
    constexpr std::size_t rounds = 16;
    const std::size_t together = blocks / rounds + 1;
    for (std::size_t first = 0; first < blocks; first += together) {
        std::vector<std::string> bytes(std::min(together, blocks - first));
        parallel_for(bytes.size(), 16, [&](std::size_t k) {
            if (owner[first + k] != sharing.own) return;
            ArchiveWriter writer;
            for_block(first + k, [&](std::size_t i) { archive_one(writer, out[i]); });
            bytes[k] = writer.take();
        });
        std::vector<std::string*> told;  // ordered so that entry i comes from process i % processes
        std::vector<std::size_t> turns(sharing.processes, 0);
        for (std::size_t k = 0; k < bytes.size(); ++k) {
            const std::size_t p = owner[first + k], at = turns[p]++ * sharing.processes + p;
            if (at >= told.size()) told.resize(at + 1, nullptr);
            told[at] = &bytes[k];
        }
        sharing.exchange(told, what);
        parallel_for(bytes.size(), 16, [&](std::size_t k) {
            if (owner[first + k] == sharing.own) return;
            ArchiveReader reader(bytes[k]);
            for_block(first + k, [&](std::size_t i) { archive_one(reader, out[i]); });
            EXI_CHECK(reader.good() && reader.left() == 0);
        });
    }
}

}  // namespace exitance
