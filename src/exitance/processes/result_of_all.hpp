#pragma once

#include <utility>

#include "exitance/base/result.hpp"

namespace exitance {

/// Makes an error of any process the error of all: returns the error of the first process that failed, in the order of
/// the processes, else success. Collective.
Result<void> result_of_all(Result<void> own);

/// Returns this process's value if all processes have one, else the error of `result_of_all`. Collective.
template <class T>
Result<T> all_or_none(Result<T> own) {
    Result<void> all = result_of_all(own ? Result<void>() : Result<void>(own.error()));
    if (!all) return all.error();
    return own;
}

}  // namespace exitance
