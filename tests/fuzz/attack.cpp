#include "fuzz/attack.hpp"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <new>

#include "fuzz/mutator.hpp"
#include "fuzz/watch.hpp"

namespace exitance::fuzz {
namespace {

constexpr int max_cpu_seconds = 5;      // seconds of processor time
constexpr int max_wait_minutes = 10;    // minutes, for a reader that waits for something that never happens
constexpr std::uint64_t batch = 256;    // files per worker
enum WorkerEnd { done, faulty, lost };  // exit status of a worker; lost: ended in the first step, which is allowed

enum class Step { none, rehearsing, reading };

/// Current state, shared with workers.
struct AtWork {
    std::uint64_t round = 0;
    Step step = Step::none;
    double slowest = 0;
    std::size_t most = 0;
};
AtWork* at_work = nullptr;
bool is_worker = false;
const char* bytes_at_work = nullptr;  // content for path_at_work; null if the file exists
std::size_t size_at_work = 0;
char path_at_work[256] = "";

void say(const char* text) {
    (void)!::write(STDERR_FILENO, text, std::strlen(text));
}

[[noreturn]] void end(const char* what) {
    if (is_worker) ::_exit(at_work->step == Step::rehearsing ? lost : faulty);
    if (bytes_at_work) {
        const int file = ::open(path_at_work, O_WRONLY | O_CREAT | O_TRUNC, 0644);
        (void)!::write(file, bytes_at_work, size_at_work);
    }
    say(what), say(path_at_work), say("\n");
    ::_exit(faulty);
}

void end_by_crash(int) {
    end("crashes: ");
}

/// Handles the timers, which keep running across files, so that starting a file needs no system call. Ends the process
/// if too many ticks in a row found the same file.
void check_time(int signal) {
    static std::uint64_t seen[2];
    static int times[2];
    const int kind = signal == SIGALRM ? 1 : 0;
    const bool same = at_work->step != Step::none && seen[kind] == at_work->round;
    seen[kind] = at_work->round;
    times[kind] = same ? times[kind] + 1 : 0;
    if (times[kind] >= (kind == 1 ? max_wait_minutes : max_cpu_seconds)) end("hangs: ");
}

void set_timers(bool on) {
    const itimerval second = {{on, 0}, {on, 0}}, minute = {{60 * on, 0}, {60 * on, 0}};
    ::setitimer(ITIMER_PROF, &second, nullptr);
    ::setitimer(ITIMER_REAL, &minute, nullptr);
}

std::size_t limit_for(std::size_t bytes) {
    return 10 * bytes + (std::size_t(64) << 20);
}

/// Runs `work` with the memory limit of a process copy that reads the smallest file.
template <class Work>
bool with_little_memory(const Work& work) {
    std::size_t pages = 0;
    rlimit space{};
    if (!(std::ifstream("/proc/self/statm") >> pages) || ::getrlimit(RLIMIT_AS, &space) != 0) return work();
    const rlim_t before = space.rlim_cur;
    space.rlim_cur = pages * static_cast<std::size_t>(::sysconf(_SC_PAGESIZE)) + limit_for(0);
    ::setrlimit(RLIMIT_AS, &space);
    const bool result = work();
    space.rlim_cur = before;
    ::setrlimit(RLIMIT_AS, &space);
    return result;
}

void read_watched(const Target& target, const std::string& bytes) {
    limit_memory(limit_for(bytes.size()));
    at_work->step = Step::reading;
    target.read(bytes);
    at_work->step = Step::none;
    at_work->most = std::max(at_work->most, most_held());
    limit_memory(0);
}

/// Reads the damaged files of one seed.
class Attack {
  public:
    Attack(const Target& target, const AttackOptions& options)
        : target_(target), options_(options), corpus_(target.corpus()), mutator_(corpus_, options.seed) {}

    void run() {
        set_timers(true);
        while (goes_on()) {
            read_whole();
            if (target_.rehearse) check_copies(), send_worker();
        }
        std::printf(
            "%s: %llu files in %.0f s, the slowest %.2f s; at most %.1f MiB held, %.1f by copies; nothing found\n",
            std::string(target_.name).c_str(), static_cast<unsigned long long>(at_work->round), elapsed(),
            at_work->slowest, mebibytes(at_work->most), mebibytes(most_by_copies_));
    }

  private:
    using Clock = std::chrono::steady_clock;

    static double mebibytes(std::size_t bytes) { return static_cast<double>(bytes) / (1 << 20); }
    double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
    bool goes_on() const { return at_work->round < options_.rounds && elapsed() < options_.seconds; }

    void make() {
        const std::uint64_t round = at_work->round++;
        bytes_ = mutator_.make(round);
        if (target_.mend && round % 2 == 0) target_.mend(bytes_);
        bytes_at_work = bytes_.data(), size_at_work = bytes_.size();
        std::snprintf(path_at_work, sizeof path_at_work, "fuzz-%s-%llu-%llu.bin", target_.name.data(),
                      static_cast<unsigned long long>(options_.seed), static_cast<unsigned long long>(round));
    }

    /// Makes the next file and reads it with the unchanged reader.
    void read_whole() {
        make();
        const double before = elapsed();
        read_watched(target_, bytes_);
        at_work->slowest = std::max(at_work->slowest, elapsed() - before);
    }

    void check_copies() {
        most_by_copies_ = most_held_by_copies();
        if (most_by_copies_ <= limit_for(bytes_.size())) return;
        say("memory: a copy of the process held more than ten times the file's size and 64 MiB\n");
        end("grows: ");
    }

    /// Lets a worker read the next files.
    void send_worker() {
        set_timers(false);
        const pid_t worker = ::fork();
        if (worker == 0) work();
        int status = 0;
        while (worker > 0 && ::waitpid(worker, &status, 0) < 0 && errno == EINTR) continue;
        set_timers(true);
        const bool well = WIFEXITED(status) && WEXITSTATUS(status) == done;
        if (!well && at_work->step == Step::reading) --at_work->round, read_whole();
        at_work->step = Step::none;
    }

    [[noreturn]] void work() {
        is_worker = true;
        set_timers(true);
        for (std::uint64_t n = 0; n < batch && goes_on(); ++n) work_once();
        ::_exit(done);
    }

    void work_once() {
        make();
        const double before = elapsed();
        try {
            at_work->step = Step::rehearsing;
            const bool goes_on = with_little_memory([&] { return target_.rehearse(bytes_); });
            at_work->step = Step::reading;
            limit_memory(limit_for(bytes_.size()));
            if (goes_on) target_.read_rehearsed();
        } catch (const std::exception&) {
            end("");
        }
        at_work->step = Step::none;
        at_work->most = std::max(at_work->most, most_held());
        limit_memory(0);
        at_work->slowest = std::max(at_work->slowest, elapsed() - before);
    }

    const Target& target_;
    const AttackOptions& options_;
    std::vector<std::string> corpus_;
    Mutator mutator_;
    std::string bytes_;
    Clock::time_point start_ = Clock::now();
    std::size_t most_by_copies_ = 0;
};

}  // namespace

void watch_signals() {
    void* const shared = ::mmap(nullptr, sizeof(AtWork), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (shared == MAP_FAILED) std::abort();
    at_work = new (shared) AtWork;
    for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) ::signal(signal, end_by_crash);
    for (const int signal : {SIGALRM, SIGPROF}) ::signal(signal, check_time);
}

void end_with_fault() {
    end("fails: ");
}

void read_file_watched(const Target& target, const std::string& path) {
    std::snprintf(path_at_work, sizeof path_at_work, "%s", path.c_str());
    std::ifstream in(path, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(in), {});
    set_timers(true);
    ++at_work->round;
    read_watched(target, bytes);
}

void attack(const Target& target, const AttackOptions& options) {
    Attack(target, options).run();
}

}  // namespace exitance::fuzz
