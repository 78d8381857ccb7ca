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

/// How processes that solve one scene together tell one another what they have found. The layer that knows them sets
/// it; those below it need not.
struct ResultSharing {
    std::size_t processes = 1, own = 0;
    /// The bytes of blocks[b] are known to process b % processes, and to all afterwards; null: there is no such block.
    /// All processes call it.
    void (*exchange)(std::span<std::string* const> blocks, const char* what) = nullptr;
    /// Whole pages of a finished array, which all processes hold alike, stand once a node from here on. All call it.
    void (*share)(char* begin, std::size_t size) = nullptr;
    double dealt_seconds = 0;  ///< Processor time of this process so far on what was dealt to it.
};
inline ResultSharing& result_sharing() {
    static ResultSharing sharing;
    return sharing;
}

/// Does what is this process's own share of a step, so that its processor time counts as dealt out.
template <class Share>
void do_own_share(const Share& share) {
    const double before = processor_seconds();
    share();
    result_sharing().dealt_seconds += processor_seconds() - before;
}

/// Finished values that all processes hold alike stand once in the memory of a node from here on, instead of once a
/// process: whole pages of them. Whoever writes to them all the same gets pages of its own again. Where the system does
/// not let processes have pages in common, and where values are few, nothing is done. All processes call it alike.
template <class T>
void share_on_node(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    if (const auto share = result_sharing().share)
        // Only the place matters, which is not written to here.
        share(reinterpret_cast<char*>(const_cast<std::remove_const_t<T>*>(values.data())), values.size_bytes());
}
/// The same of what stands in several arrays.
template <class T>
requires requires(const T& value) {
    value.visit_arrays([](const auto&) {});
}
void share_on_node(const T& value) {
    value.visit_arrays([](const auto& array) { share_on_node(array); });
}

/// Whose each of some blocks is. Without forecasts of what they take they are dealt out like cards; else each,
/// beginning with the one that takes most, goes to whoever has least so far. Source: [Graham69]. O(blocks (log blocks +
/// processes)).
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

/// out[i] = find(i) for all i of `out`, on all threads and, where several processes work together, dealt out to them by
/// blocks of `grain`: then all of them call this alike. `archive_one(archive, value)` takes a value to bytes and back.
/// The same values on any number of processes.
/// work   what each block is expected to take, in any unit; empty: about as much as its neighbours
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
    // Told in rounds, so that little stands twice.
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
        std::vector<std::string*> told;  // by turns of all processes
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
