#include <cstdlib>

#include "exitance/processes/distributed.hpp"
#include "exitance/processes/run_apart.hpp"

// Implementation for builds without MPI: there is one process.

namespace exitance {

Result<void> join_processes() {
    const char* const size = std::getenv("OMPI_COMM_WORLD_SIZE");
    if (!size || std::atol(size) <= 1) return {};
    return Error{ErrorCode::usage, "this program was built without MPI, and runs alone", "mpirun",
                 "install MPI and build again, or start it without mpirun"};
}
void leave_processes() {}

std::size_t processes() {
    return 1;
}
std::size_t own_process() {
    return 0;
}

StopTogether::StopTogether(const StopRequest&, StopRequest&) {}
StopTogether::~StopTogether() = default;

bool stops_within_loop(const StopRequest& agreed) {
    return agreed.requested();
}

double common_seconds_left(const StopRequest& agreed) {
    return agreed.seconds_left();
}

std::string as_first(std::string bytes, const char*) {
    return bytes;
}
Result<void> by_first(const std::function<Result<void>()>& work) {
    return work();
}
void run_apart(const std::function<void()>& work) {
    work();
}
void hide_launcher() {}
std::size_t processes_on_node() {
    return 1;
}
double sum_on_node(double value) {
    return value;
}
double largest_of_all(double value) {
    return value;
}
double sum_of_all(double value) {
    return value;
}

const std::map<std::string, Traffic>& traffic() {
    static const std::map<std::string, Traffic> none;
    return none;
}

ExchangeTime exchange_time() {
    return {};
}

const std::map<std::string, DealtTime>& dealt_time() {
    static const std::map<std::string, DealtTime> none;
    return none;
}

std::size_t shared_memory_bytes() {
    return 0;
}

void parallel_own_ranges(std::size_t count, std::size_t grain,
                         const std::function<void(std::size_t, std::size_t)>& body, const Work& work) {
    parallel_ranges(count, grain, body, work);
}

namespace detail {
void send_from_first(void*, std::size_t, const char*) {}
void meet(std::size_t, const char*) {}
std::span<char> open_in_common(std::span<char>) {
    return {};
}
void close_in_common(std::span<char>) {}
void count_as_sent(std::size_t, const char*) {}
void count_fetched(const Fetched&, std::size_t) {}
void share_pages(char*, std::size_t) {}
void exchange(std::span<char>, std::span<const std::size_t>, const char*) {}
}  // namespace detail

}  // namespace exitance
