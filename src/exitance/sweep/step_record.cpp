#include "exitance/sweep/step_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "exitance/io/files/atomic_file.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/files/write_error.hpp"

namespace exitance {
namespace {

namespace fs = std::filesystem;

/// Names may have line ends, which the lines of a record may not.
std::string with_escapes(const std::string& name) {
    std::string out;
    for (const char c : name) {
        if (c == '\\' || c == '\n') out += '\\';
        out += c == '\n' ? 'n' : c;
    }
    return out;
}

std::string without_escapes(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_escape = text[i] == '\\' && i + 1 < text.size();
        if (!is_escape)
            out += text[i];
        else
            out += text[++i] == 'n' ? '\n' : text[i];
    }
    return out;
}

/// The number that begins `text`, up to `end`, which is removed with it; empty if there is none.
std::optional<std::uintmax_t> take_number(std::string_view& text, char end) {
    std::uintmax_t number = 0;
    const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const std::size_t size = static_cast<std::size_t>(stop - text.data());
    if (error != std::errc() || size >= text.size() || text[size] != end) return std::nullopt;
    text.remove_prefix(size + 1);
    return number;
}

/// The first difference between the files of a folder and the lines "SIZE NAME" of its record.
std::string difference(const std::string& folder, std::string_view lines, std::uintmax_t count) {
    for (; count > 0; --count) {
        const std::optional<std::uintmax_t> size = take_number(lines, ' ');
        const std::size_t end = lines.find('\n');
        if (!size || end == std::string_view::npos) return fmt::format("{} is incomplete", step_record_file);
        const std::string name = without_escapes(lines.substr(0, end));
        std::error_code failed;
        const std::uintmax_t present = fs::file_size(fs::path(folder) / name, failed);
        if (failed) return fmt::format("{} is missing", name);
        if (present != *size) return fmt::format("{} has {} bytes, and had {}", name, present, *size);
        lines.remove_prefix(end + 1);
    }
    return "";
}

}  // namespace

Result<void> write_step_record(const std::string& folder, int status) {
    std::vector<std::string> lines;
    std::error_code failed;
    for (auto at = fs::recursive_directory_iterator(folder, failed); !failed && at != fs::end(at);
         at.increment(failed)) {
        if (!at->is_regular_file(failed) || failed) continue;
        const std::string name = at->path().lexically_relative(folder).string();
        lines.push_back(fmt::format("{} {}\n", at->file_size(failed), with_escapes(name)));
    }
    if (failed) return cannot_write(folder, failed.value());
    std::sort(lines.begin(), lines.end());
    std::string text = fmt::format("{}\nfiles {}\n", status, lines.size());
    for (const std::string& line : lines) text += line;
    return write_file((fs::path(folder) / step_record_file).string(), text);
}

std::optional<StepCondition> step_condition(const std::string& folder) {
    std::error_code ignored;
    if (!fs::exists(folder, ignored)) return std::nullopt;
    const Result<std::string> text = read_whole_file((fs::path(folder) / step_record_file).string());
    if (!text) return StepCondition{0, fmt::format("{} is missing", step_record_file)};
    std::string_view rest = *text;
    const std::optional<std::uintmax_t> status = take_number(rest, '\n');
    constexpr std::string_view files = "files ";
    const bool has_files = rest.starts_with(files);
    if (has_files) rest.remove_prefix(files.size());
    const std::optional<std::uintmax_t> count = has_files ? take_number(rest, '\n') : std::nullopt;
    if (!status || !count) return StepCondition{0, fmt::format("{} is incomplete", step_record_file)};
    return StepCondition{static_cast<int>(*status), difference(folder, rest, *count)};
}

}  // namespace exitance
