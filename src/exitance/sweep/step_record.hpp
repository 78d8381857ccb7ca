#pragma once

#include <optional>
#include <string>

#include "exitance/base/result.hpp"

namespace exitance {

/// Name of the record of a finished step in its folder: the exit status of its command, and the names and sizes of all
/// files.
inline constexpr const char* step_record_file = "status.txt";

/// State of the folder of a finished step.
struct StepCondition {
    int status = 0;      ///< Exit status of the step's command.
    std::string damage;  ///< Difference from the record, such as "room.h5 is missing"; empty: none.
};

/// Writes the record of a step into its complete folder. Error: cannot_write.
Result<void> write_step_record(const std::string& folder, int status);
/// Compares the folder of a step with its record: files may neither be missing nor have another size. Further files do
/// not matter. Empty if there is no such folder. O(files).
std::optional<StepCondition> step_condition(const std::string& folder);

}  // namespace exitance
