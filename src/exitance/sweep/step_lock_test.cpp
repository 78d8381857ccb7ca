#include "exitance/sweep/step_lock.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <filesystem>
#include <fstream>
#include <thread>
#include <vector>

#include "support/temporary_folder.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

bool can_take(const std::string& path, LockRenewal& renewal) {
    const auto lock = StepLock::take(path, path + ".work", renewal);
    return lock && *lock;
}

void write_lock(const std::string& path, const std::string& machine, long process, const std::string& token) {
    std::ofstream(path) << "host other\nmachine " << machine << "\nprocess " << process << "\nstart 1\ntoken " << token
                        << "\n";
}

/// The machine in a lock of this process.
std::string own_machine(const TemporaryFolder& folder, LockRenewal& renewal) {
    const auto lock = StepLock::take(folder / "probe.lock", folder / "none", renewal);
    std::ifstream in(folder / "probe.lock");
    const std::string content(std::istreambuf_iterator<char>(in), {});
    return parse_lock(content)->machine;
}

void set_age(const std::string& path, std::chrono::seconds age) {
    fs::last_write_time(path, fs::file_time_type::clock::now() - age);
}

}  // namespace

TEST(StepLock, IsHeldOnceAndReleased) {
    const TemporaryFolder folder;
    LockRenewal renewal;
    const std::string path = folder / "a.lock";
    {
        const auto lock = StepLock::take(path, folder / "a", renewal);
        ASSERT_TRUE(lock && *lock);
        EXPECT_FALSE(can_take(path, renewal));
        EXPECT_TRUE(StepLock::is_held(path));
    }
    EXPECT_FALSE(fs::exists(path));
    EXPECT_TRUE(can_take(path, renewal));
}

TEST(StepLock, OfAnEndedProcessIsBrokenAtOnceAndItsUnfinishedWorkRemoved) {
    const TemporaryFolder folder;
    LockRenewal renewal;
    const std::string machine = own_machine(folder, renewal), path = folder / "a.lock";
    const pid_t ended = ::fork();
    if (ended == 0) ::_exit(0);
    ::waitpid(ended, nullptr, 0);
    write_lock(path, machine, ended, "t1");
    fs::create_directories(folder / "a.t1/deep");
    fs::create_directories(folder / "a.t2");
    EXPECT_FALSE(StepLock::is_held(path));
    const auto lock = StepLock::take(path, folder / "a", renewal);
    EXPECT_TRUE(lock && *lock);
    EXPECT_FALSE(fs::exists(folder / "a.t1"));
    EXPECT_TRUE(fs::exists(folder / "a.t2")) << "belongs to another lock";
}

/// A process number that the system has given to another process since has another start time.
TEST(StepLock, OfAReusedProcessNumberIsBroken) {
    const TemporaryFolder folder;
    LockRenewal renewal;
    write_lock(folder / "a.lock", own_machine(folder, renewal), ::getpid(), "t");
    EXPECT_TRUE(can_take(folder / "a.lock", renewal));
}

TEST(StepLock, OfAnotherMachineIsBrokenOnlyAfterItsSilence) {
    const TemporaryFolder folder;
    LockRenewal renewal;
    const std::string path = folder / "a.lock";
    write_lock(path, "elsewhere pid:[1]", 1, "t");
    EXPECT_FALSE(can_take(path, renewal));
    set_age(path, std::chrono::seconds(100));
    EXPECT_TRUE(StepLock::is_held(path));
    set_age(path, std::chrono::seconds(150));
    EXPECT_FALSE(StepLock::is_held(path));
    EXPECT_TRUE(can_take(path, renewal));
}

TEST(StepLock, ThatIsDamagedCountsAsOneOfAnotherMachine) {
    const TemporaryFolder folder;
    LockRenewal renewal;
    const std::string path = folder / "a.lock";
    std::ofstream(path) << "host";
    EXPECT_FALSE(can_take(path, renewal));
    set_age(path, std::chrono::seconds(150));
    EXPECT_TRUE(can_take(path, renewal));
    EXPECT_FALSE(parse_lock("host a\nmachine b\nprocess 1\nstart 1\ntoken ../../x\n")) << "tokens are parts of paths";
}

/// Locks of many threads over a stale one: never are two held at a time, and all threads get their turn.
TEST(StepLock, ExcludesThreadsThatBreakAStaleLockTogether) {
    const TemporaryFolder folder;
    LockRenewal renewal;
    const std::string path = folder / "a.lock";
    std::atomic<int> holders{0}, crowds{0}, turns{0};
    std::vector<std::thread> threads;
    write_lock(path, own_machine(folder, renewal), ::getpid(), "stale");
    for (int i = 0; i < 8; ++i)
        threads.emplace_back([&] {
            for (int turn = 0; turn < 20;) {
                const auto lock = StepLock::take(path, folder / "a", renewal);
                if (!lock || !*lock) continue;
                if (++holders > 1) ++crowds;
                std::this_thread::yield();
                --holders, ++turn, ++turns;
            }
        });
    for (std::thread& thread : threads) thread.join();
    EXPECT_EQ(crowds, 0);
    EXPECT_EQ(turns, 160);
}

}  // namespace exitance
