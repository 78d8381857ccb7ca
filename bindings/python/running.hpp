#pragma once

#include <pybind11/pybind11.h>

#include <functional>
#include <optional>

#include "arrays.hpp"
#include "exitance/progress.hpp"

namespace python {

/// Calls work(control) in a thread of its own, without the interpreter's lock, and waits for it. Meanwhile this thread
/// handles signals (Ctrl-C raises KeyboardInterrupt) and reports progress.
/// progress  None; True: phases are printed to sys.stderr; or a function (phase, fraction), which stops the work if it
///           returns False
void run_in_thread(const py::object& progress, const std::function<void(const api::Control&)>& work);

/// Like the above, for work that returns a Result. Throws the Python exception of its error.
template <class T, class Work>
T run(const py::object& progress, const Work& work) {
    std::optional<api::Result<T>> result;
    run_in_thread(progress, [&](const api::Control& control) { result.emplace(work(control)); });
    return value_of(std::move(*result));
}

/// Calls work() without the interpreter's lock. Throws the Python exception of its error.
template <class T, class Work>
T without_lock(const Work& work) {
    std::optional<api::Result<T>> result;
    {
        const py::gil_scoped_release release;
        result.emplace(work());
    }
    if constexpr (std::is_void_v<T>)
        check(*result);
    else
        return value_of(std::move(*result));
}

}  // namespace python
