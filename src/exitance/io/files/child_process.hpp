#pragma once

#include <sys/types.h>

#include <cstddef>
#include <string>
#include <vector>

#include "exitance/base/progress.hpp"
#include "exitance/base/result.hpp"

namespace exitance {

/// A program in a process group of its own, which does not outlive this object, nor this program.
class ChildProcess {
  public:
    ChildProcess() = default;
    ChildProcess(const ChildProcess&) = delete;
    ChildProcess& operator=(const ChildProcess&) = delete;
    ~ChildProcess();

    /// Starts `words` (the first is looked up in PATH) in `folder` (empty: this one) with these open files as its
    /// standard input, output and error stream. No shell has a hand in it. False where the system has no process left.
    bool start(const std::vector<std::string>& words, int in, int out, int err, const std::string& folder);
    /// Does not wait.
    bool has_ended();
    /// Asks it to end (SIGTERM).
    void ask_to_end();

    // Of one that has ended.
    bool succeeded() const { return status() == 0; }
    int status() const;  ///< Its exit status; 1000 + the signal's number when a signal ended it.
    double processor_seconds() const { return processor_seconds_; }  ///< Of user and system, all threads.
    std::size_t peak_bytes() const { return peak_bytes_; }           ///< Of resident memory.

  private:
    void end();

    pid_t process_ = -1;
    int status_ = 0;
    double processor_seconds_ = 0;
    std::size_t peak_bytes_ = 0;
};

/// Is there a program of this name in PATH, or at this path?
bool is_program(const std::string& name);

/// How a run of a program ended.
struct ProgramRun {
    int status = -1;  ///< As of ChildProcess; -1: it could not be started.
    bool out_of_time = false, stopped = false;
    double seconds = 0, processor_seconds = 0;
    std::size_t peak_bytes = 0;
    std::string out, err;  ///< The first 16 MB of each.
};

/// Runs a program to its end. After `most_seconds`, or when a stop is asked for, it is asked to end, and made to two
/// seconds later. Its standard input is `input`, a file (empty: nothing).
ProgramRun run_program(const std::vector<std::string>& words, const std::string& folder, double most_seconds,
                       const StopRequest& stop, const std::string& input = "");

}  // namespace exitance
