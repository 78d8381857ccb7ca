#pragma once

#include <functional>

namespace exitance {

/// Runs `work` in this process as if there were no others: within it, processes() is 1, loops are not shared, and
/// nothing is collective. For work that differs between processes, such as whole runs that are dealt out.
void run_apart(const std::function<void()>& work);

/// Removes the variables by which the launcher marks its processes from the environment, so that programs started by
/// this process run alone. This process stays one of several.
void hide_launcher();

}  // namespace exitance
