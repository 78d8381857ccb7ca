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

// Several processes that solve one scene together, each with threads of its own. All of them take the same steps: what
// is cheap each computes for itself; the indices of what is expensive are dealt out, and what they give is sent to all.
// So every process goes on from the same bits, which are those of one process alone. Every function that says "all"
// has to be called by all processes, in the same order, by the thread that drives the work.

/// Finds out whether this process was started as one of several (by mpirun or a batch system) and joins the others. To
/// be called once, first of all. A program that runs alone does nothing here.
Result<void> join_processes();
/// The end of that, for all.
void leave_processes();

/// How many there are, and which of them this is.
std::size_t processes();
std::size_t own_process();
/// The one that reads files, writes them, and speaks.
inline bool is_first_process() {
    return own_process() == 0;
}

/// While it lives, a stop that any process is asked for (`asked`: its signals, its clock) becomes one that all have
/// agreed on (`agreed`, which the work looks at): at the end of every shared loop, so that no process goes on with less
/// than others have. Within a shared loop a process that is asked stops its own part at once. One at a time.
class StopTogether {
  public:
    StopTogether(const StopRequest& asked, StopRequest& agreed);
    ~StopTogether();
    StopTogether(const StopTogether&) = delete;
    StopTogether& operator=(const StopTogether&) = delete;
};

/// Seconds until the deadline, as the first process sees it; `agreed` as in StopTogether. All.
double seconds_left(const StopRequest& agreed);

namespace detail {
void send_from_first(void* data, std::size_t size, const char* what);
}

/// The first process's value, for all.
template <class T>
requires std::is_trivially_copyable_v<T> T as_first(T value) {
    if (processes() > 1) detail::send_from_first(&value, sizeof value, "agreement");
    return value;
}
/// The same for bytes of any number.
std::string as_first(std::string bytes, const char* what);
/// What only the first process does, with the threads of all that are on its node; how it went, for all.
Result<void> by_first(const std::function<Result<void>()>& work);

/// How many processes have memory in common with this one, itself among them: those of its node.
std::size_t processes_on_node();
/// The sum of their values, the same for all of them. All.
double sum_on_node(double value);
/// The largest of all processes' values; their sum, in the order of the processes. All.
double largest_of_all(double value);
double sum_of_all(double value);

/// What this process sends: messages to other processes, as if each exchange went straight from one to the other, and
/// their bytes.
struct Traffic {
    std::size_t exchanges = 0, messages = 0, bytes = 0;
    /// Of what goes to those alone who read it (`count_fetched`): with twice as many processes. Else 0.
    std::size_t messages_of_twice = 0, bytes_of_twice = 0;
};
/// By what was sent.
const std::map<std::string, Traffic>& traffic();

/// Wall time that this process has spent so far until the others came to where it was, and on sending, seconds.
struct ExchangeTime {
    double waiting = 0, sending = 0;
};
ExchangeTime exchange_time();

/// Processor time from one end of a shared loop to the next, by what ended it, seconds: this process's of what was
/// dealt out, and that of whichever process took most, which are the same where all have as much to do; and this one's
/// of everything else, which all repeat or one does while others wait.
struct DealtTime {
    double own = 0, longest = 0, repeated = 0;
};
const std::map<std::string, DealtTime>& dealt_time();

/// Are the indices around i, `grain` of them a block, this process's? Blocks are dealt out like cards: neighbours cost
/// alike, so all processes have about the same work.
inline bool is_own(std::size_t i, std::size_t grain) {
    return i / grain % processes() == own_process();
}

/// `parallel_ranges` over this process's own blocks of `grain` indices. Hears of stops.
void parallel_own_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body, const Work& work = {});

namespace detail {

/// The end of a shared loop over `count` things: all agree on stops, and make sure that they are at the same place.
void meet(std::size_t count, const char* what);
/// Everybody's bytes to everybody: process p's stand from first[p] on in `all`, `own` among them already.
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

/// value(i) of every i in blocks [block, end), whose bytes are together as many as given by process.
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

/// Sends value(i), a reference to a plain value or a span of them that is as long everywhere, from the process whose i
/// is to all others, for every i in [0, count). In rounds, so that little memory is needed. All.
template <class Value>
void exchange_values(std::size_t count, std::size_t grain, const Value& value, const char* what) {
    if (processes() == 1) return;
    detail::meet(count, what);
    constexpr std::size_t most_bytes = std::size_t(32) << 20;  // of a round, of all processes together
    const std::size_t blocks = (count + grain - 1) / grain;
    for (std::size_t block = 0, end = 0; block < blocks; block = end) {
        std::vector<std::size_t> first(processes() + 1);
        for (std::size_t bytes = 0; end < blocks && bytes < most_bytes; ++end)
            for (std::size_t i = end * grain; i < count && i < (end + 1) * grain; ++i) {
                decltype(auto) held = value(i);
                const std::size_t size = detail::bytes_of(held).size();
                first[end % processes() + 1] += size, bytes += size;
            }
        for (std::size_t p = 0; p < processes(); ++p) first[p + 1] += first[p];
        detail::exchange_blocks(block, end, count, grain, first, value, what);
    }
}

/// Sends to all the values of `blocks` blocks, as many each, of which block b is process b % processes()'s. For few
/// values, where all have met just before: in one round, without agreeing on stops. All.
template <class T>
void exchange_equal_blocks(std::span<T> values, std::size_t blocks, const char* what) {
    const std::size_t each = blocks > 0 ? values.size() / blocks : 0, all = processes();
    std::vector<std::size_t> first(all + 1, 0);
    for (std::size_t p = 0; p < all; ++p)
        first[p + 1] = first[p] + (blocks / all + (p < blocks % all ? 1 : 0)) * each * sizeof(T);
    detail::exchange_blocks(
        0, blocks, blocks, 1, first, [&](std::size_t b) { return values.subspan(b * each, each); }, what);
}

/// `parallel_ranges`, dealt out to all processes: body(first, last) writes value(i), a reference to a plain value, for
/// each i of its range and nothing else that lasts; afterwards all processes have all values. All.
template <class Value>
void shared_ranges(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body,
                   const Value& value, const Work& work) {
    parallel_own_ranges(count, grain, body, work);
    exchange_values(count, grain, value, work.name);
}

namespace detail {
/// Whole pages of an array that all processes hold alike, from here on one memory that all of them write to; empty, and
/// nothing is done, where not all can see one another's memory, or the array is small. To be closed before the next.
std::span<char> open_in_common(std::span<char> array);
/// Each process has what stands there now; whoever writes to it gets pages of its own.
void close_in_common(std::span<char> pages);
/// Counts bytes as sent that the processes have in common.
void count_as_sent(std::size_t bytes, const char* what);
/// What this process has fetched, as Traffic has it: counted by who gets it.
struct Fetched {
    std::size_t messages = 0, values = 0, messages_of_twice = 0, values_of_twice = 0;
};
void count_fetched(const Fetched& fetched, std::size_t bytes_each);
/// `share_on_node` of bytes.
void share_pages(char* begin, std::size_t size);
}  // namespace detail

/// `shared_ranges` where value(i) stands in `array`, which all hold alike and which lasts: on one node it stands there
/// once, each process writes its own part of it, and nothing is sent. All.
template <class T, class Value>
void shared_ranges_of(std::span<T> array, std::size_t count, std::size_t grain,
                      const std::function<void(std::size_t, std::size_t)>& body, const Value& value, const Work& work) {
    using Held = std::remove_reference_t<decltype(value(0))>;
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_copyable_v<Held>);
    constexpr std::size_t sparse = 4;  // of an array little of which is written, more is moved than is sent
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
    // What stands in the pages around them is sent.
    exchange_values(
        count, grain, [&](std::size_t i) { return std::span<Held>(&value(i), is_common(i) ? 0 : 1); }, work.name);
    detail::close_in_common(pages);
    detail::count_as_sent(bytes, work.name);
}

/// Makes an array of parts, part i of which is [first[i], first[i + 1]): body(begin, end) writes those of its range and
/// nothing else that lasts; afterwards all processes have all of it. On one node it stands there once from the
/// beginning. All.
template <class T>
void shared_parts(std::vector<T>& array, std::span<const std::uint32_t> first, std::size_t grain,
                  const std::function<void(std::size_t, std::size_t)>& body, const Work& work) {
    static_assert(std::is_trivially_copyable_v<T>);
    constexpr std::size_t largest_page = std::size_t(1) << 16;  // of systems that there are: room up to its end
    const std::size_t count = first.size() - 1, size = first.back();
    array = {};
    array.reserve(size + largest_page / sizeof(T) + 1);
    const std::span<char> all(reinterpret_cast<char*>(array.data()), size * sizeof(T));
    const std::span<char> pages =
        processes() > 1 ? detail::open_in_common({all.data(), all.size() + largest_page}) : std::span<char>();
    array.resize(size);
    if (!pages.empty()) detail::meet(count, work.name);  // before anybody writes, all have made it zero
    parallel_own_ranges(count, grain, body, work);
    const auto part = [&](std::size_t i) {
        return all.subspan(first[i] * sizeof(T), (first[i + 1] - first[i]) * sizeof(T));
    };
    if (pages.empty()) return exchange_values(count, grain, part, work.name);
    // What stands before the first whole page is sent.
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

/// Of what this process holds, bytes that stand once a node.
std::size_t shared_memory_bytes();

}  // namespace exitance
