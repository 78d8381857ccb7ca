#include "exitance/io/scenes/radiance/rad_command.hpp"

#include <fmt/format.h>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {

Result<std::vector<CommandWords>> parse_command(std::string_view command) {
    const auto bad = [&](const char* why) {
        return Error{ErrorCode::bad_input, fmt::format("the command '!{}' is not run: {}", shown(command), why), "",
                     "run it yourself, write its output to a file, and name the file in a line '!xform FILE'"};
    };
    std::vector<CommandWords> out(1);
    std::string word;
    bool in_word = false;
    const auto end_word = [&] {
        if (in_word) out.back().push_back(std::move(word));
        word.clear(), in_word = false;
    };
    for (std::size_t i = 0; i < command.size(); ++i) {
        const char c = command[i];
        if (c == '\'' || c == '"') {
            const std::size_t end = command.find(c, i + 1);
            if (end == std::string_view::npos) return bad("a quoted word does not end");
            const std::string_view quoted = command.substr(i + 1, end - i - 1);
            if (c == '"' && quoted.find_first_of("$`\\") != std::string_view::npos) return bad("it needs a shell");
            word += quoted, in_word = true;
            i = end;
        } else if (c == '|') {
            end_word();
            if (out.back().empty()) return bad("a program is missing");
            out.emplace_back();
        } else if (c == ' ' || c == '\t' || c == '\r' || c == '\n') {
            end_word();
        } else if (std::string_view(";<>&$`\\*?[]~#").find(c) != std::string_view::npos) {
            return bad("it needs a shell");
        } else {
            word += c, in_word = true;
        }
    }
    end_word();
    if (out.back().empty()) return bad("a program is missing");
    return out;
}

}  // namespace exitance
