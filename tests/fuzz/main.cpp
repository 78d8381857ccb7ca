// exitance-fuzz READER [--seconds N] [--rounds N] [--seed N] [FILE...]
//
// Gives a reader damaged files until the time is over, or the files named. Ends with status 1 and the path of the file
// when one makes the reader crash, run for more than 5 s (of its own: it may have to wait for the processor), or ask at
// a time for more memory than ten times the file's size and 64 MiB, or makes a copy of the process, in which a reader
// tries a file out, hold as much.

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>

#include "exitance/core/parallel.hpp"
#include "fuzz/mutator.hpp"
#include "fuzz/target.hpp"
#include "fuzz/watch.hpp"

namespace exitance::fuzz {
namespace {

constexpr unsigned longest = 5;         // seconds of processor time
constexpr unsigned longest_wait = 600;  // seconds: for a file that is never there
char current[256] = "";                 // where the file being read stands

void die(int signal) {
    const char* what = signal == SIGALRM || signal == SIGPROF ? "hangs: " : "crashes: ";
    (void)!::write(STDERR_FILENO, what, std::strlen(what));
    (void)!::write(STDERR_FILENO, current, std::strlen(current));
    (void)!::write(STDERR_FILENO, "\n", 1);
    ::_exit(1);
}

void read_watched(const Target& target, const std::string& bytes) {
    static std::size_t most = 0;
    const std::size_t limit = 10 * bytes.size() + (std::size_t(64) << 20);
    limit_memory(limit);
    const auto watch_time = [](unsigned own, unsigned wall) {
        const itimerval time = {{0, 0}, {own, 0}};
        ::setitimer(ITIMER_PROF, &time, nullptr);
        ::alarm(wall);
    };
    watch_time(longest, longest_wait);
    target.read(bytes);
    watch_time(0, 0);
    if (most_held_by_copies() <= most) return;
    most = most_held_by_copies();
    if (most <= limit) return;
    std::fprintf(stderr, "memory: a copy of the process held %.1f MiB\n", static_cast<double>(most) / (1 << 20));
    die(SIGABRT);
}

struct Options {
    double seconds = 60;
    std::uint64_t rounds = ~std::uint64_t(0), seed = 1;
    std::vector<std::string> files;
};

void attack(const Target& target, const Options& options) {
    using Clock = std::chrono::steady_clock;
    const std::vector<std::string> corpus = target.corpus();
    const Mutator mutator(corpus, options.seed);
    const auto start = Clock::now();
    const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
    std::uint64_t round = 0;
    std::size_t most = 0;
    double slowest = 0;
    for (; round < options.rounds && elapsed() < options.seconds; ++round) {
        std::string bytes = mutator.make(round);
        if (target.mend && round % 2 == 0) target.mend(bytes);
        std::ofstream(current, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        const double before = elapsed();
        read_watched(target, bytes);
        most = std::max(most, most_held());
        limit_memory(0);
        slowest = std::max(slowest, elapsed() - before);
    }
    std::remove(current);
    std::printf(
        "%s: %llu files in %.0f s, the slowest %.2f s; at most %.1f MiB held, %.1f by copies; nothing "
        "found\n",
        std::string(target.name).c_str(), static_cast<unsigned long long>(round), elapsed(), slowest,
        static_cast<double>(most) / (1 << 20), static_cast<double>(most_held_by_copies()) / (1 << 20));
}

int usage() {
    std::fprintf(stderr, "exitance-fuzz READER [--seconds N] [--rounds N] [--seed N] [FILE...]\nreaders:");
    for (const Target& target : targets()) std::fprintf(stderr, " %s", std::string(target.name).c_str());
    std::fprintf(stderr, "\n");
    return 2;
}

int run(int count, char** words) {
    const Target* target = count > 1 ? find_target(words[1]) : nullptr;
    if (!target) return usage();
    Options options;
    for (int i = 2; i < count; ++i) {
        const std::string word = words[i];
        if (word.rfind("--", 0) != 0) {
            options.files.push_back(word);
            continue;
        }
        if (i + 1 == count) return usage();
        if (word == "--seconds")
            options.seconds = std::atof(words[++i]);
        else if (word == "--rounds")
            options.rounds = std::strtoull(words[++i], nullptr, 10);
        else if (word == "--seed")
            options.seed = std::strtoull(words[++i], nullptr, 10);
        else
            return usage();
    }
    set_threads(1);
    for (const int signal : {SIGALRM, SIGPROF, SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL}) ::signal(signal, die);
    for (const std::string& file : options.files) {
        std::snprintf(current, sizeof current, "%s", file.c_str());
        std::ifstream in(file, std::ios::binary);
        read_watched(*target, {std::istreambuf_iterator<char>(in), {}});
        std::printf("%s: read\n", file.c_str());
    }
    std::snprintf(current, sizeof current, "fuzz-%s-%llu.bin", words[1], static_cast<unsigned long long>(options.seed));
    if (options.files.empty()) attack(*target, options);
    return 0;
}

}  // namespace
}  // namespace exitance::fuzz

int main(int count, char** words) {
    try {
        return exitance::fuzz::run(count, words);
    } catch (const std::exception& e) {
        std::fprintf(stderr, "throws %s: ", e.what());
        exitance::fuzz::die(SIGABRT);
    }
}
