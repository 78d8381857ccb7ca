#pragma once

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "support/places.hpp"
#include "support/temporary_folder.hpp"

extern char** environ;

namespace exitance::test {

inline std::string read_text(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

inline void write_text(const std::filesystem::path& path, const std::string& text) {
    std::ofstream(path, std::ios::binary) << text;
}

/// Result of running the program.
struct Finished {
    int status = -1;  ///< Exit status; 1000 + the signal number if a signal ended it.
    std::string out, err;
};

/// Starts a program (by default the built one) with these arguments; `input` is its standard input.
class RunningProgram {
  public:
    explicit RunningProgram(const std::vector<std::string>& arguments, const std::string& input = {},
                            std::string program = test::program()) {
        write_text(folder_ / "in", input);
        posix_spawn_file_actions_t files;
        posix_spawn_file_actions_init(&files);
        posix_spawn_file_actions_addopen(&files, 0, (folder_ / "in").c_str(), O_RDONLY, 0);
        posix_spawn_file_actions_addopen(&files, 1, (folder_ / "out").c_str(), O_WRONLY | O_CREAT, 0600);
        posix_spawn_file_actions_addopen(&files, 2, (folder_ / "err").c_str(), O_WRONLY | O_CREAT, 0600);
        std::vector<std::string> words = arguments;
        std::vector<char*> pointers{program.data()};
        for (std::string& word : words) pointers.push_back(word.data());
        pointers.push_back(nullptr);
        if (posix_spawn(&process_, program.c_str(), &files, nullptr, pointers.data(), environ) != 0) process_ = -1;
        posix_spawn_file_actions_destroy(&files);
    }

    void send(int signal) { kill(process_, signal); }
    pid_t process() const { return process_; }

    /// Waits until the error stream contains `text` or the program has ended. Returns false in the latter case.
    bool wait_for(const std::string& text) {
        return wait_until([&](const std::string& err) { return err.find(text) != std::string::npos; });
    }
    /// Waits until the error stream satisfies a condition. Returns false if the program ends before.
    bool wait_until(const std::function<bool(const std::string& err)>& is_so) {
        while (!is_so(read_text(folder_ / "err"))) {
            if (siginfo_t info{}; waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
                                  info.si_pid == process_)
                return false;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return true;
    }

    Finished finish() {
        Finished finished;
        int status = 0;
        if (process_ > 0 && waitpid(process_, &status, 0) == process_)
            finished.status = WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status);
        finished.out = read_text(folder_ / "out");
        finished.err = read_text(folder_ / "err");
        return finished;
    }

  private:
    TemporaryFolder folder_;
    pid_t process_ = -1;
};

/// Runs the built program until it ends.
inline Finished run_program(const std::vector<std::string>& arguments, const std::string& input = {}) {
    return RunningProgram(arguments, input).finish();
}

}  // namespace exitance::test
