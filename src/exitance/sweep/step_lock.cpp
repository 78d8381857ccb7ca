#include "exitance/sweep/step_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <utility>

#include "exitance/io/files/write_error.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

constexpr std::chrono::seconds renewal_interval{15};
constexpr double max_silence = 120;  ///< Seconds without renewal after which the lock of another machine is broken.
constexpr int max_attempts = 5;      ///< Attempts to take a lock that others break at the same time.

/// The content of a file; empty if it cannot be read. Files in /proc have no size, so they are read to their end.
std::string text_in(const std::string& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

std::string first_line(const std::string& text) {
    return text.substr(0, text.find('\n'));
}

/// State ('R', 'Z', ...) and start time of a process; empty if there is none of that number.
std::optional<std::pair<char, std::string>> process_state(long process) {
    const std::string stat = text_in(fmt::format("/proc/{}/stat", process));
    const std::size_t name_end = stat.rfind(')');  // names of programs may have blanks and parentheses
    if (name_end == std::string::npos) return std::nullopt;
    std::istringstream fields(stat.substr(name_end + 1));
    std::string state, field;
    constexpr int fields_between = 18;  // between the state and the start time, proc(5)
    fields >> state;
    for (int i = 0; i < fields_between; ++i) fields >> field;
    fields >> field;
    if (state.empty()) return std::nullopt;
    return std::pair(state.front(), field);
}

std::string this_machine() {
    std::error_code ignored;
    const std::string boot = first_line(text_in("/proc/sys/kernel/random/boot_id"));
    return fmt::format("{} {}", boot, fs::read_symlink("/proc/self/ns/pid", ignored).string());
}

LockOwner this_process() {
    static std::atomic<unsigned> locks{0};
    std::array<char, 256> name{};
    ::gethostname(name.data(), name.size() - 1);
    LockOwner owner{name.data(), this_machine(), ::getpid(), "", ""};
    if (const auto state = process_state(owner.process)) owner.start = state->second;
    owner.token = fmt::format("{}.{}.{}.{}", owner.host, owner.process, owner.start, locks++);
    return owner;
}

std::string content_of(const LockOwner& owner) {
    return fmt::format("host {}\nmachine {}\nprocess {}\nstart {}\ntoken {}\n", owner.host, owner.machine,
                       owner.process, owner.start, owner.token);
}

/// Seconds since the file changed, by the clock of its file system; empty if it is gone.
std::optional<double> age_of(const std::string& path) {
    std::string probe = path + ".XXXXXX";
    const int file = ::mkstemp(probe.data());
    if (file < 0) return std::nullopt;
    struct stat now, then;
    const bool is_known = ::fstat(file, &now) == 0 && ::stat(path.c_str(), &then) == 0;
    ::close(file), ::unlink(probe.c_str());
    if (!is_known) return std::nullopt;
    return std::difftime(now.st_mtim.tv_sec, then.st_mtim.tv_sec);
}

/// True if the process that wrote this lock file no longer runs.
bool is_stale(const std::string& path, const std::string& content) {
    const std::optional<LockOwner> owner = parse_lock(content);
    if (owner && owner->machine == this_machine()) {
        const auto state = process_state(owner->process);
        return !state || state->first == 'Z' || state->first == 'X' || state->second != owner->start;
    }
    const std::optional<double> age = age_of(path);
    return age && *age > max_silence;
}

/// Creates a file with its content; `flag` is O_TRUNC or O_EXCL, for a file that exists. Returns 0 or errno.
int create_file(const std::string& path, int flag, const std::string& content) {
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | flag | O_CLOEXEC, 0666);
    if (file < 0) return errno;
    const bool is_complete = ::write(file, content.data(), content.size()) == static_cast<ssize_t>(content.size());
    ::close(file);
    return is_complete ? 0 : ENOSPC;
}

/// Creates the lock file with its content, whole and only if there is none. Returns 0 or errno.
int create_lock(const std::string& path, const LockOwner& owner) {
    const std::string own = fmt::format("{}.{}", path, owner.token), content = content_of(owner);
    if (const int error = create_file(own, O_TRUNC, content); error != 0) return ::unlink(own.c_str()), error;
    int status = ::link(own.c_str(), path.c_str()) == 0 ? 0 : errno;
    // Over NFS a link may be made although its reply is lost.
    struct stat made;
    if (status != 0 && ::stat(own.c_str(), &made) == 0 && made.st_nlink == 2) status = 0;
    ::unlink(own.c_str());
    if (status != EPERM && status != EOPNOTSUPP && status != ENOSYS && status != EMLINK) return status;
    // The file system has no hard links.
    return create_file(path, O_EXCL, content);
}

/// Removes the lock file `path` if it still has this content and its process has ended. Only one process of all that
/// break locks does so at a time, so that none removes a lock that another one has just taken.
void break_lock(const std::string& path, const std::string& content, const std::string& unfinished) {
    const std::string guard = (fs::path(path).parent_path() / ".guard").string();
    const int file = ::open(guard.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (file >= 0) ::flock(file, LOCK_EX);
    if (text_in(path) == content && is_stale(path, content)) {
        std::error_code ignored;
        if (const std::optional<LockOwner> owner = parse_lock(content))
            fs::remove_all(fmt::format("{}.{}", unfinished, owner->token), ignored);
        ::unlink(path.c_str());
    }
    if (file >= 0) ::close(file);
}

}  // namespace

std::optional<LockOwner> parse_lock(const std::string& content) {
    std::istringstream lines(content);
    LockOwner owner;
    std::string process;
    for (const auto& [name, target] :
         {std::pair("host ", &owner.host), std::pair("machine ", &owner.machine), std::pair("process ", &process),
          std::pair("start ", &owner.start), std::pair("token ", &owner.token)}) {
        std::string line;
        if (!std::getline(lines, line) || !line.starts_with(name)) return std::nullopt;
        *target = line.substr(std::strlen(name));
    }
    owner.process = std::strtol(process.c_str(), nullptr, 10);
    // The token is part of a path that is removed.
    if (owner.process <= 0 || owner.token.empty() || owner.token.find('/') != std::string::npos) return std::nullopt;
    return owner;
}

LockRenewal::LockRenewal() : thread_([this] { renew(); }) {}

LockRenewal::~LockRenewal() {
    {
        const std::lock_guard lock(mutex_);
        is_over_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void LockRenewal::renew() {
    std::unique_lock lock(mutex_);
    while (!changed_.wait_for(lock, renewal_interval, [this] { return is_over_; }))
        for (const std::string& path : paths_) ::utimensat(AT_FDCWD, path.c_str(), nullptr, 0);
}

void LockRenewal::add(const std::string& path) {
    const std::lock_guard lock(mutex_);
    paths_.insert(path);
}

void LockRenewal::remove(const std::string& path) {
    const std::lock_guard lock(mutex_);
    paths_.erase(path);
}

Result<std::optional<StepLock>> StepLock::take(const std::string& path, const std::string& unfinished,
                                               LockRenewal& renewal) {
    for (int attempt = 0; attempt < max_attempts; ++attempt) {
        const LockOwner owner = this_process();
        const int status = create_lock(path, owner);
        if (status == 0) return std::optional(StepLock(path, owner.token, renewal));
        if (status != EEXIST) return cannot_write(path, status);
        const std::string content = text_in(path);
        struct stat present;
        if (::stat(path.c_str(), &present) != 0) continue;  // the lock was released in between, so try again
        if (!is_stale(path, content)) return std::optional<StepLock>();
        break_lock(path, content, unfinished);
    }
    return std::optional<StepLock>();
}

bool StepLock::is_held(const std::string& path) {
    struct stat present;
    return ::stat(path.c_str(), &present) == 0 && !is_stale(path, text_in(path));
}

StepLock::StepLock(std::string path, std::string token, LockRenewal& renewal)
    : path_(std::move(path)), token_(std::move(token)), renewal_(&renewal) {
    renewal_->add(path_);
}

StepLock::StepLock(StepLock&& other) noexcept
    : path_(std::exchange(other.path_, {})), token_(std::move(other.token_)), renewal_(other.renewal_) {}

StepLock::~StepLock() {
    if (path_.empty()) return;
    renewal_->remove(path_);
    const std::optional<LockOwner> owner = parse_lock(text_in(path_));
    if (owner && owner->token == token_) ::unlink(path_.c_str());
}

}  // namespace exitance
