#pragma once

#include "exitance/base/result.hpp"

namespace exitance {

/// Exit status of the program; part of its interface.
enum class ExitCode {
    done = 0,
    failure = 1,
    usage = 2,
    bad_input = 3,
    demand_not_reached = 4,  ///< A result is written, but the requested error was not reached.
    no_result = 5,           ///< No result: it cannot be written, or a limit is too small.
    interrupted = 130,       ///< Stopped by SIGINT; the state so far is written.
    terminated = 143,        ///< Stopped by SIGTERM; the state so far is written.
};

inline ExitCode exit_code(ErrorCode code) {
    switch (code) {
        case ErrorCode::usage:
            return ExitCode::usage;
        case ErrorCode::bad_input:
        case ErrorCode::cannot_read:
            return ExitCode::bad_input;
        case ErrorCode::cannot_write:
        case ErrorCode::limit:
            return ExitCode::no_result;
        case ErrorCode::failure:
            break;
    }
    return ExitCode::failure;
}

}  // namespace exitance
