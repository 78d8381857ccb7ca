#include "exitance/processes/distributed.hpp"

#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <tuple>

#include "exitance/processes/run_apart.hpp"
#include "exitance/processes/team.hpp"

namespace exitance {

Team team;

void end_job(const char* why) {
    std::fprintf(stderr, "error: process %zu of %zu: %s\n", team.own, team.size, why);
    MPI_Abort(MPI_COMM_WORLD, 1);
    std::abort();
}

void wait_for(MPI_Request& request) {
    constexpr int eager = 200;
    constexpr double share = 0.05, longest = 5000;  // share of the time waited; microseconds: the longest interval
    const Stopwatch watch;
    int done = 0;
    for (int looks = 0; !done; ++looks) {
        if (looks >= eager)
            usleep(static_cast<useconds_t>(std::clamp(share * 1e6 * watch.seconds(), 20.0, longest)));
        else if (looks > 0)
            sched_yield();
        MPI_Test(&request, &done, MPI_STATUS_IGNORE);
    }
}

namespace {

/// Environment variables that launchers set.
constexpr std::array launcher_variables{"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMI_RANK", "PMIX_RANK"};

/// True if a launcher started this process as one of several.
bool was_launched() {
    for (const char* name : launcher_variables)
        if (const char* value = std::getenv(name); value && *value)
            return std::string(name).ends_with("_SIZE") ? std::atol(value) > 1 : true;
    return false;
}

void count(const char* what, std::size_t bytes) {
    Traffic& t = team.traffic[*what ? what : "other"];
    ++t.exchanges, t.messages += team.size - 1, t.bytes += bytes * (team.size - 1);
}

void exchange_results(std::span<std::string* const> blocks, const char* what) {
    std::vector<std::uint64_t> sizes(blocks.size());
    for (std::size_t b = 0; b < blocks.size(); ++b) sizes[b] = blocks[b] ? blocks[b]->size() : 0;
    exchange_values(
        blocks.size(), 1, [&](std::size_t b) { return std::span(&sizes[b], blocks[b] ? 1 : 0); }, what);
    for (std::size_t b = 0; b < blocks.size(); ++b)
        if (blocks[b]) blocks[b]->resize(sizes[b]);
    exchange_values(
        blocks.size(), 1, [&](std::size_t b) { return blocks[b] ? std::span<char>(*blocks[b]) : std::span<char>(); },
        what);
}

}  // namespace

Result<void> join_processes() {
    if (team.joined || !was_launched()) return {};
    int provided = 0, size = 1, rank = 0;
    if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided) != MPI_SUCCESS ||
        provided < MPI_THREAD_FUNNELED)
        return Error{ErrorCode::failure, "MPI does not support programs with threads", "", ""};
    MPI_Comm_size(MPI_COMM_WORLD, &size);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank);
    team.joined = true;
    team.size = static_cast<std::size_t>(size), team.own = static_cast<std::size_t>(rank);
    if (size > 1) result_sharing() = {team.size, team.own, exchange_results, detail::share_pages};
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank, MPI_INFO_NULL, &team.node);
    MPI_Comm_size(team.node, &team.node_size);
    return {};
}

void leave_processes() {
    if (team.joined) MPI_Comm_free(&team.node), MPI_Finalize();
    team.joined = false;
}

std::size_t processes() {
    return team.size;
}

std::size_t own_process() {
    return team.own;
}

StopTogether::StopTogether(const StopRequest& asked, StopRequest& agreed) {
    team.asked = &asked, team.agreed = &agreed;
}

StopTogether::~StopTogether() {
    team.asked = nullptr, team.agreed = nullptr;
}

bool stops_within_loop(const StopRequest& agreed) {
    if (team.asked && team.asked->requested()) team.agreed->interrupt(team.asked->cause());
    return agreed.requested();
}

double common_seconds_left(const StopRequest& agreed) {
    return as_first((team.asked ? *team.asked : agreed).seconds_left());
}

const std::map<std::string, Traffic>& traffic() {
    return team.traffic;
}

ExchangeTime exchange_time() {
    return team.time;
}

const std::map<std::string, DealtTime>& dealt_time() {
    return team.dealt;
}

std::size_t shared_memory_bytes() {
    return team.shared_bytes;
}

std::string as_first(std::string bytes, const char* what) {
    if (team.size == 1) return bytes;
    bytes.resize(as_first(bytes.size()));
    detail::send_from_first(bytes.data(), bytes.size(), what);
    return bytes;
}

void run_apart(const std::function<void()>& work) {
    const ResultSharing sharing = std::exchange(result_sharing(), ResultSharing());
    const auto [size, own, node_size] = std::tuple(team.size, team.own, team.node_size);
    team.size = 1, team.own = 0, team.node_size = 1;
    work();
    team.size = size, team.own = own, team.node_size = node_size;
    result_sharing() = sharing;
}

void hide_launcher() {
    for (const char* name : launcher_variables) unsetenv(name);
}

Result<void> by_first(const std::function<Result<void>()>& work) {
    const int own_threads = threads();
    // The other processes of the node sleep, so that their processors are available as far as this process may use
    // them.
    const int all_threads = own_threads * team.node_size;
    const bool is_first = is_first_process();
    if (is_first && all_threads > own_threads) set_threads(all_threads);
    Result<void> done;
    run_apart([&] {
        if (is_first) done = work();
    });
    if (is_first && all_threads > own_threads) set_threads(own_threads);
    if (team.size == 1 || as_first(static_cast<bool>(done))) return done;
    const Error none, &own = done ? none : done.error();
    Error error{as_first(own.code), {}, {}, {}};
    error.message = as_first(own.message, "agreement");
    error.where = as_first(own.where, "agreement");
    error.hint = as_first(own.hint, "agreement");
    return error;
}

std::size_t processes_on_node() {
    return static_cast<std::size_t>(team.node_size);
}

double sum_on_node(double value) {
    if (team.node_size == 1) return value;
    double out = value;
    reduce(&value, &out, 1, MPI_DOUBLE, MPI_SUM, team.node);
    return out;
}

double largest_of_all(double value) {
    if (team.size == 1) return value;
    double out = value;
    reduce(&value, &out, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    count("agreement", sizeof value);
    return out;
}

double sum_of_all(double value) {
    if (team.size == 1) return value;
    std::vector<double> all(team.size);
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgather(&value, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, MPI_COMM_WORLD, &request);
    wait_for(request);
    count("agreement", sizeof value);
    double sum = 0;
    for (double v : all) sum += v;
    return sum;
}

void parallel_own_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body, const Work& work) {
    if (team.size == 1) return parallel_ranges(count, grain, body, work);
    const std::size_t blocks = (count + grain - 1) / grain;
    const std::size_t own = blocks > team.own ? (blocks - team.own + team.size - 1) / team.size : 0;
    const double before = processor_seconds();
    const auto first_of = [&](std::size_t k) { return (k * team.size + team.own) * grain; };
    Work of_own{work.name, {}, work.by_polygon};
    if (work.polygon_of) of_own.polygon_of = [&](std::size_t k) { return work.polygon_of(first_of(k)); };
    parallel_ranges(
        own, 1,
        [&](std::size_t begin, std::size_t end) {
            for (std::size_t k = begin; k < end; ++k) {
                if (team.agreed) stops_within_loop(*team.agreed);
                body(first_of(k), std::min(count, first_of(k) + grain));
            }
        },
        of_own);
    result_sharing().dealt_seconds += processor_seconds() - before;
}

namespace detail {

void count_as_sent(std::size_t bytes, const char* what) {
    team.traffic[what].bytes += bytes * (team.size - 1);
}

void count_fetched(const Fetched& fetched, std::size_t bytes_each) {
    Traffic& t = team.traffic["fetch"];
    ++t.exchanges;
    t.messages += fetched.messages, t.bytes += bytes_each * fetched.values;
    t.messages_of_twice += fetched.messages_of_twice, t.bytes_of_twice += bytes_each * fetched.values_of_twice;
}

void send_from_first(void* data, std::size_t size, const char* what) {
    constexpr std::size_t max_message = std::size_t(1) << 28;  // MPI counts are of type int
    for (std::size_t done = 0; done < size; done += max_message) {
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Ibcast(static_cast<char*>(data) + done, static_cast<int>(std::min(max_message, size - done)), MPI_BYTE, 0,
                   MPI_COMM_WORLD, &request);
        wait_for(request);
    }
    Traffic& t = team.traffic[what];
    ++t.exchanges;
    if (is_first_process()) t.messages += team.size - 1, t.bytes += size * (team.size - 1);
}

void meet(std::size_t things, const char* what) {
    if (team.agreed) stops_within_loop(*team.agreed);
    const auto cause = static_cast<std::uint64_t>(team.agreed ? team.agreed->cause() : StopRequest::Cause::none);
    const std::uint64_t place = ++team.meetings << 40 ^ things;
    constexpr double ticks = 1e9;  // per second
    const double dealt = result_sharing().dealt_seconds, since = dealt - std::exchange(team.dealt_before, dealt),
                 taken = processor_seconds(), all_since = taken - std::exchange(team.taken_before, taken);
    std::array<std::uint64_t, 4> own{place, ~place, cause, static_cast<std::uint64_t>(ticks * since)}, all{};
    const Stopwatch watch;
    reduce(own.data(), all.data(), 4, MPI_UINT64_T, MPI_MAX, MPI_COMM_WORLD);
    DealtTime& of_step = team.dealt[what];
    of_step.own += since, of_step.longest += static_cast<double>(all[3]) / ticks, of_step.repeated += all_since - since;
    team.time.waiting += watch.seconds();
    count("agreement", sizeof own);
    if (all[0] != place || all[1] != ~place)
        end_job((std::string("the processes have come to different places, here at: ") + what).c_str());
    if (all[2] != 0 && team.agreed) team.agreed->agree_on(static_cast<StopRequest::Cause>(all[2]));
}

void exchange(std::span<char> all, std::span<const std::size_t> first, const char* what) {
    const Stopwatch watch;
    std::vector<int> sizes, places;
    for (std::size_t p = 0; p < team.size; ++p) {
        sizes.push_back(static_cast<int>(first[p + 1] - first[p]));
        places.push_back(static_cast<int>(first[p]));
    }
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Iallgatherv(MPI_IN_PLACE, 0, MPI_DATATYPE_NULL, all.data(), sizes.data(), places.data(), MPI_BYTE,
                    MPI_COMM_WORLD, &request);
    wait_for(request);
    team.time.sending += watch.seconds();
    count(what, first[team.own + 1] - first[team.own]);
}

}  // namespace detail

}  // namespace exitance
