#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"

namespace exitance {

/// A child process in its own process group. It is killed when this object is destroyed or this program ends.
class ChildProcess {
  public:
    ChildProcess() = default;
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    /// Starts a program without a shell.
    /// words    the program, looked up in PATH, and its arguments
    /// in, out, err  open files that become its standard input, output and error stream
    /// folder   its working folder; empty: the current one
    /// returns  false if the system cannot create a process
    bool start(const std::vector<std::string>& words, int in, int out, int err, const std::string& folder);
    /// Checks whether the process has ended, without waiting.
    bool has_ended();
    /// Sends SIGTERM to the process.
    void ask_to_end();

    // True if the exit status is 0. Valid once the process has ended.
    bool succeeded() const { return status() == 0; }
    int status() const;  ///< Exit status; 1000 + the signal number if a signal ended it.
    double processor_seconds() const { return processor_seconds_; }  ///< User and system time of all threads.
    std::size_t peak_bytes() const { return peak_bytes_; }           ///< Peak resident memory.

  private:
    void end();

    pid_t process_ = -1;
    int status_ = 0;
    double processor_seconds_ = 0;
    std::size_t peak_bytes_ = 0;
};

/// True if `name` is a program in PATH, or the path of one.
bool is_program(const std::string& name);

/// Result of running a program.
struct ProgramRun {
    int status = -1;  ///< See ChildProcess::status(); -1: the program could not be started.
    bool out_of_time = false, stopped = false;
    double seconds = 0, processor_seconds = 0;
    std::size_t peak_bytes = 0;
    std::string out, err;  ///< Standard output and error stream, at most 16 MB each.
};

/// Runs a program until it ends. After `max_seconds`, or when a stop is requested, the program gets SIGTERM, and two
/// seconds later SIGKILL. `input` is the path of a file for its standard input; empty: no input.
ProgramRun run_program(const std::vector<std::string>& words, const std::string& folder, double max_seconds,
                       const StopRequest& stop, const std::string& input = "");

/// Runs a program that writes the file `path`, which appears whole or not at all. On failure the message of the error
/// is the first line that the program said.
/// words_for  the program and its arguments, for the path of a part file in the same folder
Result<void> run_into_file(const std::string& path,
                           const std::function<std::vector<std::string>(const std::string& part)>& words_for,
                           double max_seconds, const StopRequest& stop);

}  // namespace exitance
