#include "exitance/io/scenes/scene_lines.hpp"

#include <fmt/format.h>

#include <charconv>

namespace exitance {

int SceneLines::add(const std::string& file, int lines) {
    const int before = files_.empty() ? 0 : files_.back().before + files_.back().lines;
    files_.push_back({file, before, lines});
    return before;
}

int SceneLines::append(const SceneLines& more) {
    const int before = add("", 0);
    files_.pop_back();
    for (const File& file : more.files_) add(file.name, file.lines);
    return before;
}

const SceneLines::File* SceneLines::find(int line) const {
    for (const File& file : files_)
        if (line > file.before && line <= file.before + file.lines) return &file;
    return nullptr;
}

void SceneLines::place(Finding& finding) const {
    constexpr std::string_view of_line = "the face of line ";
    const File* own = find(finding.line);
    if (const std::size_t at = finding.message.find(of_line); at != std::string::npos) {
        const std::size_t digits = at + of_line.size();
        int line = 0;
        const char* text = finding.message.data();
        const auto end = std::from_chars(text + digits, text + finding.message.size(), line).ptr;
        const File* other = find(line);
        if (other && other != files_.data())
            finding.message.replace(at, static_cast<std::size_t>(end - text) - at,
                                    other == own ? fmt::format("the face of line {}", line - other->before)
                                                 : fmt::format("the face of {}:{}", other->name, line - other->before));
    }
    if (own) finding.file = own->name, finding.line -= own->before;
}

}  // namespace exitance
