#pragma once

#include "exitance/base/result.hpp"

namespace exitance {

/// How the program ends: part of its interface.
enum class ExitCode {
    done = 0,
    failure = 1,
    usage = 2,
    bad_input = 3,
    demand_not_reached = 4,  ///< A result is written, but the error asked for was not reached.
    no_result = 5,           ///< Cannot write, or a limit is too small for any result.
    interrupted = 130,       ///< After SIGINT, the state so far written.
    terminated = 143,        ///< After SIGTERM, the state so far written.
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
