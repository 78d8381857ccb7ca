#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "exitance/base/parallel.hpp"
#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"
#include "exitance/base/shared_results.hpp"

namespace exitance {

// Several processes solve one scene together, each with its own threads. All processes execute the same steps. Cheap
// results are computed by every process; the indices of expensive loops are distributed, and the results are sent to
// all. Every process therefore continues from the same bits, and these are the bits of a single process. A function
// marked "Collective" must be called by all processes, in the same order, by the thread that runs the solve.

/// Joins the other processes if this one was started as one of several (by mpirun or a batch system). Must be called
/// once, before anything else. Does nothing in a program that runs alone.
Result<void> join_processes();
/// Disconnects from the other processes. Collective.
void leave_processes();

/// Number of processes, and the index of this one.
std::size_t processes();
std::size_t own_process();
/// True in the process that reads and writes files and prints messages.
inline bool is_first_process() {
    return own_process() == 0;
}

/// Makes stop requests common to all processes during its lifetime. `asked` is a request to one process (signals, its
/// deadline); `agreed` is the common request that the work checks. At the end of every shared loop a request to any
/// process becomes a request to all, so that no process continues with fewer results than others. All then know the
/// same cause. Within a shared loop a process with a request stops its own part at once. Only one object may exist at a
/// time.
class StopTogether {
  public:
    StopTogether(const StopRequest& asked, StopRequest& agreed);
    ~StopTogether();
    StopTogether(const StopTogether&) = delete;
    StopTogether& operator=(const StopTogether&) = delete;
};

/// Returns whether this process or all processes are requested to stop. Use it only inside long bodies of shared loops,
/// which would delay a stop too much: elsewhere, processes could disagree. `agreed` as in StopTogether.
bool stops_within_loop(const StopRequest& agreed);

/// Seconds until the deadline, by the clock of the first process; `agreed` as in StopTogether. Collective.
double common_seconds_left(const StopRequest& agreed);

namespace detail {
void send_from_first(void* data, std::size_t size, const char* what);
}

/// Returns the first process's value in all processes. Collective.
template <class T>
requires std::is_trivially_copyable_v<T> T as_first(T value) {
    if (processes() > 1) detail::send_from_first(&value, sizeof value, "agreement");
    return value;
}
/// Like the above, for a byte string of any length.
std::string as_first(std::string bytes, const char* what);
/// Runs `work` in the first process only, with the threads of all processes of its node. Returns its result in all
/// processes. Collective.
Result<void> by_first(const std::function<Result<void>()>& work);

/// Number of processes on this node, including this one.
std::size_t processes_on_node();
/// Sum of the values of the node's processes, the same in each of them. Collective.
double sum_on_node(double value);
/// Largest value of all processes, and the sum of their values in the order of the processes. Collective.
double largest_of_all(double value);
double sum_of_all(double value);

/// Messages that this process sends to other processes, and their size in bytes. Counted as if every exchange went
/// directly from sender to receiver.
struct Traffic {
    std::size_t exchanges = 0, messages = 0, bytes = 0;
    /// Predicted numbers for twice as many processes, for data sent only to the processes that read them
    /// (`count_fetched`); else 0.
    std::size_t messages_of_twice = 0, bytes_of_twice = 0;
};
/// Traffic by kind of data.
const std::map<std::string, Traffic>& traffic();

/// Wall time that this process has spent waiting for the others and sending data, seconds.
struct ExchangeTime {
    double waiting = 0, sending = 0;
};
ExchangeTime exchange_time();

/// Processor time between the ends of consecutive shared loops, by the name of the loop that ended the interval,
/// seconds. `own`: distributed work of this process; `longest`: that of the slowest process, equal to `own` if the load
/// is balanced; `repeated`: all other work of this process, done by every process or by one while others wait.
struct DealtTime {
    double own = 0, longest = 0, repeated = 0;
};
const std::map<std::string, DealtTime>& dealt_time();

/// True if the block of `grain` indices that contains i belongs to this process. Blocks are assigned to processes in
/// turn: neighbouring indices have similar cost, so that the load is balanced.
inline bool is_own(std::size_t i, std::size_t grain) {
    return i / grain % processes() == own_process();
}

/// Number of the indices below `count` that belong to this process.
inline std::size_t own_count(std::size_t count, std::size_t grain) {
    const std::size_t blocks = (count + grain - 1) / grain, own = own_process(), all = processes();
    if (blocks <= own) return 0;
    const std::size_t missing = is_own(blocks * grain - 1, grain) ? blocks * grain - count : 0;  // in the last block
    return (blocks - own + all - 1) / all * grain - missing;
}

/// Runs `parallel_ranges` over this process's own blocks of `grain` indices. Observes stop requests.
void parallel_own_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body, const Work& work = {});

namespace detail {

/// Ends a shared loop over `count` items: the processes agree on stop requests and check that all are at the same loop.
void meet(std::size_t count, const char* what);
/// All-to-all exchange of bytes: process p's bytes start at first[p] in `all`. The own bytes must already be in place.
void exchange(std::span<char> all, std::span<const std::size_t> first, const char* what);

template <class T>
std::span<char> bytes_of(T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<char*>(&value), sizeof value};
}
template <class T>
std::span<char> bytes_of(std::span<T> values) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<char*>(values.data()), values.size_bytes()};
}

/// Exchanges value(i) for every i in blocks [block, end). Process p's values start at byte first[p] of the exchanged
/// buffer.
template <class Value>
void exchange_blocks(std::size_t block, std::size_t end, std::size_t count, std::size_t grain,
                     std::span<const std::size_t> first, const Value& value, const char* what) {
    std::vector<char> all(first.back());
    std::vector<std::size_t> at(first.begin(), first.end());
    const auto for_each = [&](const auto& take) {
        at.assign(first.begin(), first.end());
        for (std::size_t b = block; b < end; ++b) {
            const std::size_t owner = b % processes();
            for (std::size_t i = b * grain; i < count && i < (b + 1) * grain; ++i) {
                decltype(auto) held = value(i);
                const std::span<char> bytes = bytes_of(held);
                if (!bytes.empty()) take(owner, bytes, all.data() + at[owner]);
                at[owner] += bytes.size();
            }
        }
    };
    const std::size_t own = own_process();
    for_each([&](std::size_t owner, std::span<char> bytes, char* sent) {
        if (owner == own) std::copy(bytes.begin(), bytes.end(), sent);
    });
    exchange(all, first, what);
    for_each([&](std::size_t owner, std::span<char> bytes, const char* sent) {
        if (owner != own) std::copy(sent, sent + bytes.size(), bytes.begin());
    });
}

}  // namespace detail

/// Sends value(i), i in [0, count), from the process that owns i to all others. value(i) is a reference to a plain
/// value, or a span of plain values that has the same length in every process. Works in rounds of about 32 MB to limit
/// memory. Collective.
template <class Value>
void exchange_values(std::size_t count, std::size_t grain, const Value& value, const char* what) {
    if (processes() == 1) return;
    detail::meet(count, what);
    constexpr std::size_t max_bytes = std::size_t(32) << 20;  // maximum per round, summed over all processes
    const std::size_t blocks = (count + grain - 1) / grain;
    for (std::size_t block = 0, end = 0; block < blocks; block = end) {
        std::vector<std::size_t> first(processes() + 1);
        for (std::size_t bytes = 0; end < blocks && bytes < max_bytes; ++end)
            for (std::size_t i = end * grain; i < count && i < (end + 1) * grain; ++i) {
                decltype(auto) held = value(i);
                const std::size_t size = detail::bytes_of(held).size();
                first[end % processes() + 1] += size, bytes += size;
            }
        for (std::size_t p = 0; p < processes(); ++p) first[p + 1] += first[p];
        detail::exchange_blocks(block, end, count, grain, first, value, what);
    }
}

/// Sends the values of `blocks` blocks of equal size to all; block b belongs to process b % processes(). For few
/// values, right after a step in which all processes agreed on stops: uses one round and does not agree on stops.
/// Collective.
template <class T>
void exchange_equal_blocks(std::span<T> values, std::size_t blocks, const char* what) {
    const std::size_t each = blocks > 0 ? values.size() / blocks : 0, all = processes();
    std::vector<std::size_t> first(all + 1, 0);
    for (std::size_t p = 0; p < all; ++p)
        first[p + 1] = first[p] + (blocks / all + (p < blocks % all ? 1 : 0)) * each * sizeof(T);
    detail::exchange_blocks(
        0, blocks, blocks, 1, first, [&](std::size_t b) { return values.subspan(b * each, each); }, what);
}

/// Distributes `parallel_ranges` over all processes. body(first, last) writes value(i), a reference to a plain value,
/// for each i of its range and no other lasting data; afterwards all processes have all values. Collective.
template <class Value>
void shared_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                   const Value& value, const Work& work) {
    parallel_own_ranges(count, grain, body, work);
    exchange_values(count, grain, value, work.name);
}

namespace detail {
/// Maps the whole pages of an array that is equal in all processes to memory that all of them write to, and returns
/// these pages. Returns an empty span and does nothing if the processes are not all on one node, or if the array is
/// small. Must be closed before the next call.
std::span<char> open_in_common(std::span<char> array);
/// Ends the sharing: each process keeps the present contents, and gets private pages where it writes.
void close_in_common(std::span<char> pages);
/// Counts bytes in common memory as if they had been sent.
void count_as_sent(std::size_t bytes, const char* what);
/// Values that this process has fetched from others, and the messages that carried them.
struct Fetched {
    std::size_t messages = 0, values = 0;
    std::size_t messages_of_twice = 0, values_of_twice = 0;  ///< Predicted for twice as many processes, see Traffic.
};
void count_fetched(const Fetched& fetched, std::size_t bytes_each);
/// `share_on_node` for bytes.
void share_pages(char* begin, std::size_t size);
}  // namespace detail

/// Like `shared_ranges`, for values in `array`, which is equal in all processes and outlives the call. Processes of one
/// node share one copy: each writes its own part of it, and nothing is sent. Collective.
template <class T, class Value>
void shared_ranges_of(std::span<T> array, std::size_t count, std::size_t grain,
                      const std::function<void(std::size_t, std::size_t)>& body, const Value& value, const Work& work) {
    using Held = std::remove_reference_t<decltype(value(0))>;
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_copyable_v<Held>);
    constexpr std::size_t sparse =  // if less than 1 / sparse of an array is written, sending moves fewer bytes
        4;
    const bool is_dense = sparse * count * sizeof(Held) >= array.size_bytes();
    const std::span<char> pages =
        processes() > 1 && is_dense ? detail::open_in_common(detail::bytes_of(array)) : std::span<char>();
    if (pages.empty()) return shared_ranges(count, grain, body, value, work);
    parallel_own_ranges(count, grain, body, work);
    const auto is_common = [&](std::size_t i) {
        const char* const at = reinterpret_cast<const char*>(&value(i));
        return at >= pages.data() && at + sizeof(Held) <= pages.data() + pages.size();
    };
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (is_own(i, grain) && is_common(i)) bytes += sizeof(Held);
    // Values outside the shared pages are sent.
    exchange_values(
        count, grain, [&](std::size_t i) { return std::span<Held>(&value(i), is_common(i) ? 0 : 1); }, work.name);
    detail::close_in_common(pages);
    detail::count_as_sent(bytes, work.name);
}

/// Fills an array of parts, part i being [first[i], first[i + 1]). body(begin, end) writes the parts of its range and
/// no other lasting data; afterwards all processes have the whole array. Processes of one node share one copy from the
/// start. Collective.
template <class T>
void shared_parts(std::vector<T>& array, std::span<const std::uint32_t> first, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body, const Work& work) {
    static_assert(std::is_trivially_copyable_v<T>);
    constexpr std::size_t largest_page = std::size_t(1)
                                         << 16;  // of all supported systems: room for the end of the last page
    const std::size_t count = first.size() - 1, size = first.back();
    array = {};
    array.reserve(size + largest_page / sizeof(T) + 1);
    const std::span<char> all(reinterpret_cast<char*>(array.data()), size * sizeof(T));
    const std::span<char> pages =
        processes() > 1 ? detail::open_in_common({all.data(), all.size() + largest_page}) : std::span<char>();
    array.resize(size);
    if (!pages.empty())
        detail::meet(count, work.name);  // all processes must have zeroed the array before any of them writes
    parallel_own_ranges(count, grain, body, work);
    const auto part = [&](std::size_t i) {
        return all.subspan(first[i] * sizeof(T), (first[i + 1] - first[i]) * sizeof(T));
    };
    if (pages.empty()) return exchange_values(count, grain, part, work.name);
    // The parts before the first whole page are sent.
    const auto before = static_cast<std::size_t>(pages.data() - all.data());
    const auto sent = [&](std::size_t i) {
        return part(i).first(std::min(part(i).size(), before - std::min(before, first[i] * sizeof(T))));
    };
    std::size_t bytes = 0;
    for (std::size_t i = 0; i < count; ++i)
        if (is_own(i, grain)) bytes += part(i).size() - sent(i).size();
    exchange_values(count, grain, sent, work.name);
    detail::close_in_common(pages);
    detail::count_as_sent(bytes, work.name);
}

/// Bytes of this process's memory of which there is one copy per node.
std::size_t shared_memory_bytes();

}  // namespace exitance
