#include "exitance/io/files/rehearsal.hpp"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <new>

#include "exitance/base/sanitizers.hpp"

namespace exitance {
namespace {

constexpr int crash_signals[] = {SIGSEGV, SIGBUS, SIGABRT, SIGFPE, SIGILL, SIGXCPU};

/// Elapsed seconds after which the copy is ended. It is then waiting, e.g. for a lock that another thread held at the
/// fork, which does not show that the file is bad.
unsigned max_wait_seconds(rlim_t seconds) {
    return static_cast<unsigned>(std::min<rlim_t>(30 + 10 * seconds, std::numeric_limits<int>::max()));
}

enum Outcome { went_well, failed, lacks_memory };  ///< Exit status of the copy.

/// Limits the address space of this process to its current size plus `bytes`.
void limit_memory(std::size_t bytes) {
    std::size_t pages = 0;
    if (has_address_sanitizer || !(std::ifstream("/proc/self/statm") >> pages)) return;
    const std::size_t mapped = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    if (bytes > std::numeric_limits<std::size_t>::max() - mapped) return;
    rlimit space{};
    ::getrlimit(RLIMIT_AS, &space);
    space.rlim_cur = std::min<rlim_t>(mapped + bytes, space.rlim_max);
    ::setrlimit(RLIMIT_AS, &space);
}

[[noreturn]] void perform(const std::function<bool()>& work, rlim_t seconds, std::size_t memory) {
    for (const int signal : crash_signals) ::signal(signal, SIG_DFL);
    ::signal(SIGALRM, SIG_DFL);
    ::alarm(max_wait_seconds(seconds));
    const rlimit time = {seconds, seconds + 1}, no_core = {0, 0};
    ::setrlimit(RLIMIT_CPU, &time);
    ::setrlimit(RLIMIT_CORE, &no_core);
    const int nowhere = ::open("/dev/null", O_WRONLY);
    if (nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);  // hides the C library's messages about a corrupt heap
    limit_memory(memory);
    try {
        ::_exit(work() ? went_well : failed);
    } catch (const std::bad_alloc&) {
        ::_exit(lacks_memory);
    }
}

}  // namespace

std::optional<std::string> rehearse(const std::function<bool()>& work, double seconds, std::size_t memory) {
    const auto limit = static_cast<rlim_t>(std::ceil(seconds));
    const pid_t copy = ::fork();
    if (copy < 0) return {};
    if (copy == 0) perform(work, limit, memory);
    int status = 0;
    while (::waitpid(copy, &status, 0) < 0)
        if (errno != EINTR) return {};  // another thread has already waited for the copy
    if (WIFEXITED(status) && WEXITSTATUS(status) == lacks_memory)
        return "needs more than " + std::to_string((memory >> 20) + 1) + " MiB";
    if (WIFEXITED(status) && WEXITSTATUS(status) == failed) return "fails";
    if (WIFEXITED(status))
        return WEXITSTATUS(status) == went_well ? std::nullopt : std::optional<std::string>("crashes");
    const int signal = WTERMSIG(status);
    if (signal == SIGXCPU) return "takes more than " + std::to_string(limit) + " s";
    for (const int crash : crash_signals)
        if (signal == crash) return "crashes";
    return {};  // ended by another process, or by the limit of elapsed time
}

}  // namespace exitance
