#include "exitance/io/scenes/view3d_controls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>

#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/whole_file.hpp"

namespace exitance {
namespace {

/// The text after the first word of a line.
std::string title_of(std::string_view line) {
    const std::size_t word = line.find_first_not_of(" \t");
    const std::size_t end = line.find_first_of(" \t", word);
    const std::size_t first = end == std::string_view::npos ? end : line.find_first_not_of(" \t", end);
    if (first == std::string_view::npos) return "";
    return std::string(line.substr(first, line.find_last_not_of(" \t\r") + 1 - first));
}

}  // namespace

std::string view3d_control_name(std::string_view word) {
    std::string name(word);
    std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
    return name;
}

std::string view3d_items(std::string_view line) {
    std::string out(line.substr(0, line.find_first_of("!/")));
    std::replace_if(
        out.begin(), out.end(), [](char c) { return c == ',' || c == '='; }, ' ');
    return out;
}

bool is_view3d_control(std::string_view name) {
    static constexpr std::array<std::string_view, 12> names{"eps",  "out",  "encl", "emit", "row",  "col",
                                                            "list", "maxu", "maxo", "mino", "maxv", "prjd"};
    return std::find(names.begin(), names.end(), name) != names.end();
}

Result<View3dControls> read_view3d_controls(const std::string& path) {
    const Result<std::string> text = read_whole_file(path);
    if (!text) return text.error();
    View3dControls out;
    double row = 0, col = 0, encl = 0, emit = 0, format = 0;
    const std::map<std::string, double*> known{{"eps", &out.eps}, {"row", &row},   {"col", &col},
                                               {"encl", &encl},   {"emit", &emit}, {"out", &format}};
    for (TextLines lines(*text); lines.next();) {
        const std::string line = view3d_items(lines.rest());
        TextLines items(line);
        if (!items.next()) continue;
        const int kind = std::tolower(static_cast<unsigned char>(items.word().front()));
        if (kind == 't') out.title = title_of(lines.rest());
        if (kind == 'e' || kind == '*') break;
        if (kind != 'c') continue;
        while (!items.rest().empty()) {
            const auto control = known.find(view3d_control_name(items.word()));
            double value = 0;
            if (number_of_word(items.word(), value) != NumberKind::finite) break;  // read_view3d() warns of it
            if (control == known.end()) continue;
            if (control->second != &out.eps && (value != std::floor(value) || value < 0 || value > 1e6))
                return Error{ErrorCode::bad_input,
                             fmt::format("control {}={} is not a number of a choice", control->first, value), path,
                             "give a whole number"};
            *control->second = value;
        }
    }
    out.row = static_cast<int>(row), out.col = static_cast<int>(col), out.out = static_cast<int>(format);
    out.is_enclosure = encl != 0, out.has_emittances = emit != 0;
    return out;
}

}  // namespace exitance
