#pragma once

#include <condition_variable>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <thread>

#include "exitance/base/result.hpp"

namespace exitance {

/// A process, as lock files name it: enough to decide on its own machine whether it still runs.
struct LockOwner {
    std::string host;
    std::string machine;  ///< Boot of the system and namespace of process numbers.
    long process = 0;     ///< Process number.
    std::string start;    ///< Time at which the process started, in the system's ticks.
    std::string token;    ///< Unique name of this lock.
};

/// Parses the content of a lock file; empty if it is damaged.
std::optional<LockOwner> parse_lock(const std::string& content);

/// Renews the lock files that this process holds, so that other machines see that it still runs. Thread-safe.
class LockRenewal {
  public:
    LockRenewal();
    LockRenewal(const LockRenewal&) = delete;
    LockRenewal& operator=(const LockRenewal&) = delete;
    ~LockRenewal();

    void add(const std::string& path);
    void remove(const std::string& path);

  private:
    void renew();

    std::mutex mutex_;
    std::condition_variable changed_;
    bool is_over_ = false;
    std::set<std::string> paths_;
    std::thread thread_;
};

/// Exclusive lock by a file, among processes on this and on other machines with the same file system. A lock whose
/// process has ended is broken: at once if the process was on this machine, else after it was not renewed for two
/// minutes. If locks fail, work is done twice but not wrongly: results are complete when they appear.
class StepLock {
  public:
    /// Takes the lock file `path`. Empty if another process holds it. When a lock is broken, the unfinished folders
    /// that its owner left, `unfinished` + "." + token, are removed. Error: cannot_write.
    static Result<std::optional<StepLock>> take(const std::string& path, const std::string& unfinished,
                                                LockRenewal& renewal);
    /// True if a running process holds the lock file `path`.
    static bool is_held(const std::string& path);

    StepLock(StepLock&& other) noexcept;
    StepLock& operator=(StepLock&&) = delete;
    ~StepLock();

    const std::string& token() const { return token_; }

  private:
    StepLock(std::string path, std::string token, LockRenewal& renewal);

    std::string path_, token_;
    LockRenewal* renewal_;
};

}  // namespace exitance
