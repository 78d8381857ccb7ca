#pragma once

#include <span>
#include <string>
#include <vector>

#include "exitance/io/report/report.hpp"

namespace exitance {

/// A visual task or an area with the light that a standard requires for it.
struct LightingTask {
    std::string name;     ///< "office"
    std::string words;    ///< "writing, reading, data processing"
    std::string edition;  ///< "EN 12464-1:2021"
    std::vector<Requirement::Limit> limits;
};

/// Returns the built-in tasks, then those of a TOML file (none: ""). A task of the file replaces one of
/// the same name. Errors: a file that cannot be read, unknown keys, numbers that are not positive.
Result<std::vector<LightingTask>> load_tasks(const std::string& path);

/// Parses the choice of tasks, "office" for all rooms or "room 2=corridor", "kitchen=corridor" for one, by its label,
/// number or name; a later choice replaces an earlier one of the room. Error (usage): unknown task or room.
Result<std::vector<Requirement>> require_tasks(std::span<const std::string> words, std::span<const LightingTask> tasks,
                                               const FloorRooms& rooms);

/// Formats tasks as a table for terminals.
std::string table_of_tasks(std::span<const LightingTask> tasks);

}  // namespace exitance
