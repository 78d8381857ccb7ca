#include "exitance/io/report/lighting_tasks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "exitance/io/files/toml_keys.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/report/known_tasks.hpp"

namespace exitance {
namespace {

constexpr std::array<const char*, 7> quantities{"Em", "U0", "UGR", "Ra", "Ez", "walls", "ceiling"};

LightingTask read_task(TomlKeys keys, const std::string& edition) {
    LightingTask out;
    out.edition = edition;
    keys.need("name", out.name);
    keys.take("words", out.words);
    for (const char* quantity : quantities) {
        double value = 0;
        const toml::node* node = keys.find(quantity);
        keys.take(quantity, value);
        if (node && !(value > 0 && std::isfinite(value)))
            keys.fail(*node, fmt::format("'{}' is not a positive number", quantity));
        if (node) out.limits.push_back({quantity, value});
    }
    if (out.name.empty() || out.name.find('=') != std::string::npos)
        keys.fail(keys.table(), "a task needs a name without '='");
    if (out.limits.empty())
        keys.fail(keys.table(), fmt::format("task '{}' requires nothing", out.name), "for example Em = 500");
    keys.finish();
    return out;
}

Result<std::vector<LightingTask>> read_tasks(const std::string& text, const std::string& file) {
    return read_toml(text, file, [&](const toml::table& table) {
        TomlKeys keys(table, file);
        std::string edition;
        keys.take("edition", edition);
        const toml::node* list = keys.find("task");
        keys.finish();
        if (!list || !list->is_array_of_tables()) keys.fail(table, "there are no tasks", "begin each with [[task]]");
        std::vector<LightingTask> out;
        for (const toml::node& node : *list->as_array())
            out.push_back(read_task(TomlKeys(*node.as_table(), file), edition));
        return out;
    });
}

std::string names_of(std::span<const LightingTask> tasks) {
    std::string out;
    for (const LightingTask& task : tasks) out += (out.empty() ? "" : ", ") + task.name;
    return out;
}

std::optional<std::size_t> room_called(const std::string& word, const FloorRooms& rooms) {
    for (std::size_t i = 0; i < rooms.count(); ++i)
        if (word == rooms.label(i) || word == rooms[i].name || word == std::to_string(i + 1) ||
            word == fmt::format("room {}", i + 1))
            return i;
    return std::nullopt;
}

Requirement requirement_of(const LightingTask& task, const std::string& room) {
    const std::string edition = task.edition.empty() ? "" : fmt::format(" ({})", task.edition);
    return {fmt::format("{}: {}{}", room, task.name, edition), task.limits};
}

}  // namespace

Result<std::vector<LightingTask>> load_tasks(const std::string& path) {
    Result<std::vector<LightingTask>> known = read_tasks(known_tasks, "tasks of the program");
    if (!known || path.empty()) return known;
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    const Result<std::vector<LightingTask>> own = read_tasks(*text, path);
    if (!own) return own.error();
    for (const LightingTask& task : *own) {
        std::erase_if(*known, [&](const LightingTask& k) { return k.name == task.name; });
        known->push_back(task);
    }
    return known;
}

Result<std::vector<Requirement>> require_tasks(std::span<const std::string> words, std::span<const LightingTask> tasks,
                                               const FloorRooms& rooms) {
    std::vector<const LightingTask*> task_of(rooms.count());
    for (const std::string& word : words) {
        const std::size_t sign = word.find('=');
        const std::string name = sign == std::string::npos ? word : word.substr(sign + 1);
        const auto task =
            std::find_if(tasks.begin(), tasks.end(), [&](const LightingTask& t) { return t.name == name; });
        if (task == tasks.end())
            return Error{ErrorCode::usage, fmt::format("no task is called '{}'", name), "--task",
                         fmt::format("choose one of {}, or add it by --tasks FILE", names_of(tasks))};
        if (sign == std::string::npos) {
            std::fill(task_of.begin(), task_of.end(), &*task);
            continue;
        }
        const std::optional<std::size_t> room = room_called(word.substr(0, sign), rooms);
        if (!room)
            return Error{ErrorCode::usage, fmt::format("there is no room '{}'", word.substr(0, sign)), "--task",
                         fmt::format("name it by its number, 1 to {}, or by its name", rooms.count())};
        task_of[*room] = &*task;
    }
    std::vector<Requirement> out;
    for (std::size_t i = 0; i < rooms.count(); ++i)
        if (task_of[i]) out.push_back(requirement_of(*task_of[i], rooms.label(i)));
    return out;
}

std::string table_of_tasks(std::span<const LightingTask> tasks) {
    std::string out = fmt::format("{:<22}", "task");
    for (const char* quantity : quantities) out += fmt::format("{:>8}", quantity);
    out += "  source; activity\n";
    for (const LightingTask& task : tasks) {
        out += fmt::format("{:<22}", task.name);
        for (const char* quantity : quantities) {
            const auto limit = std::find_if(task.limits.begin(), task.limits.end(),
                                            [&](const Requirement::Limit& l) { return l.quantity == quantity; });
            out += limit == task.limits.end() ? fmt::format("{:>8}", "-") : fmt::format("{:>8g}", limit->value);
        }
        out += fmt::format("  {}; {}\n", task.edition.empty() ? "own" : task.edition, task.words);
    }
    return out;
}

}  // namespace exitance
