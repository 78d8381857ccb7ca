#include "exitance/io/files/child_process.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <sstream>

namespace exitance {
namespace {

constexpr std::size_t max_output_bytes = std::size_t{16} << 20;
constexpr double kill_delay = 2;  // seconds between SIGTERM and SIGKILL
constexpr int first_poll_ms = 1;  // milliseconds between checks whether the child has ended: the first, and the longest
constexpr int max_poll_ms = 50;

using File = std::unique_ptr<std::FILE, int (*)(std::FILE*)>;

double seconds_of(const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
}

std::string content(std::FILE* file) {
    std::rewind(file);
    std::string text;
    std::array<char, 65536> block;
    for (std::size_t n = 0;
         text.size() < max_output_bytes && (n = std::fread(block.data(), 1, block.size(), file)) > 0;)
        text.append(block.data(), n);
    return text;
}

}  // namespace

ChildProcess::~ChildProcess() {
    if (process_ > 0) end();
}

bool ChildProcess::start(const std::vector<std::string>& words, int in, int out, int err, const std::string& folder) {
    std::vector<std::string> copies = words;
    std::vector<char*> pointers;
    for (std::string& word : copies) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ > 0) ::setpgid(process_, process_);  // parent and child both set it, so it is set whichever runs first
    if (process_ != 0) return process_ > 0;
    // Only async-signal-safe system calls are allowed below: another thread may have held any lock during fork().
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (const int signal : {SIGINT, SIGTERM, SIGPIPE}) ::signal(signal, SIG_DFL);
    if (::getppid() != parent || ::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0 ||
        (!folder.empty() && ::chdir(folder.c_str()) != 0))
        ::_exit(126);
    ::execvp(pointers[0], pointers.data());
    ::_exit(127);
}

bool ChildProcess::has_ended() {
    if (process_ <= 0) return true;
    rusage used{};
    if (::wait4(process_, &status_, WNOHANG, &used) != process_) return false;
    process_ = -1;
    processor_seconds_ = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    peak_bytes_ = static_cast<std::size_t>(used.ru_maxrss) << 10;
    return true;
}

void ChildProcess::ask_to_end() {
    if (process_ > 0) ::kill(process_, SIGTERM);
}

int ChildProcess::status() const {
    return WIFEXITED(status_) ? WEXITSTATUS(status_) : 1000 + WTERMSIG(status_);
}

void ChildProcess::end() {
    ::kill(-process_, SIGKILL), ::kill(process_, SIGKILL);
    ::waitpid(process_, &status_, 0);
    process_ = -1;
}

bool is_program(const std::string& name) {
    if (name.find('/') != std::string::npos) return ::access(name.c_str(), X_OK) == 0;
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (!folder.empty() && ::access((folder + "/" + name).c_str(), X_OK) == 0) return true;
    return false;
}

ProgramRun run_program(const std::vector<std::string>& words, const std::string& folder, double max_seconds,
                       const StopRequest& stop, const std::string& input) {
    ProgramRun run;
    const File in(std::fopen(input.empty() ? "/dev/null" : input.c_str(), "r"), &std::fclose);
    const File out(std::tmpfile(), &std::fclose), err(std::tmpfile(), &std::fclose);
    ChildProcess child;
    const Stopwatch watch;
    if (!in || !out || !err ||
        !child.start(words, ::fileno(in.get()), ::fileno(out.get()), ::fileno(err.get()), folder))
        return run;
    double asked_at = -1;
    bool ended = false;
    for (int glance = first_poll_ms; !(ended = child.has_ended()); glance = std::min(2 * glance, max_poll_ms)) {
        run.stopped |= stop.requested();
        run.out_of_time |= watch.seconds() > max_seconds;
        if (asked_at < 0 && (run.stopped || run.out_of_time)) child.ask_to_end(), asked_at = watch.seconds();
        if (asked_at >= 0 && watch.seconds() > asked_at + kill_delay) break;
        ::poll(nullptr, 0, glance);
    }
    run.seconds = watch.seconds();
    run.status = ended ? child.status() : 1000 + SIGKILL;
    run.processor_seconds = child.processor_seconds(), run.peak_bytes = child.peak_bytes();
    run.out = content(out.get()), run.err = content(err.get());
    return run;
}

Result<void> run_into_file(const std::string& path,
                           const std::function<std::vector<std::string>(const std::string& part)>& words_for,
                           double max_seconds, const StopRequest& stop) {
    namespace fs = std::filesystem;
    const fs::path target = fs::absolute(path);
    const fs::path part =
        target.parent_path() / fmt::format(".{}.part{}", target.stem().string(), target.extension().string());
    const ProgramRun run = run_program(words_for(part.string()), "", max_seconds, stop);
    std::error_code failed;
    if (run.status == 0 && fs::exists(part)) {
        fs::rename(part, target, failed);
        if (!failed) return {};
    }
    fs::remove(part, failed);
    std::string said = run.err.substr(0, run.err.find('\n'));
    return Error{ErrorCode::cannot_write, said.empty() ? "it said nothing" : std::move(said), path, ""};
}

}  // namespace exitance
