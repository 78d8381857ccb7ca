#pragma once

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "run_program.hpp"

namespace exitance::test {

/// Starts several processes; empty if the build has no MPI.
inline const std::string launcher = mpirun();

/// Allows more processes than processors, and root in containers; mpirun would reject both.
inline void allow_any_processes() {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1), ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    ::setenv("OMPI_MCA_rmaps_base_oversubscribe", "1", 1), ::setenv("OMPI_MCA_hwloc_base_binding_policy", "none", 1);
}

/// Arguments of the launcher that start the built program as several processes.
inline std::vector<std::string> launched(int processes, const std::vector<std::string>& words) {
    std::vector<std::string> all{"-n", std::to_string(processes), test::program()};
    all.insert(all.end(), words.begin(), words.end());
    return all;
}

/// Runs the built program as several processes until they end.
inline Finished run_on(int processes, const std::vector<std::string>& words, const std::string& input = {}) {
    if (processes == 1) return run_program(words, input);
    return RunningProgram(launched(processes, words), input, launcher).finish();
}

/// The child process that `parent` started last.
inline pid_t last_child(pid_t parent) {
    const std::string number = std::to_string(parent);
    std::istringstream children(read_text("/proc/" + number + "/task/" + number + "/children"));
    pid_t last = 0;
    for (pid_t child; children >> child;) last = child;
    return last > 0 ? last : parent;
}

/// Number of occurrences of `text` in `all`.
inline std::size_t times(const std::string& all, const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = all.find(text); at != std::string::npos; at = all.find(text, at + 1)) ++count;
    return count;
}

}  // namespace exitance::test
