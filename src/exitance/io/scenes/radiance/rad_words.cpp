#include "exitance/io/scenes/radiance/rad_words.hpp"

#include <fmt/format.h>

#include "exitance/io/files/text_lines.hpp"

namespace exitance {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\f' || c == '\v';
}

}  // namespace

void RadWords::pass_blanks() {
    while (!rest_.empty()) {
        if (rest_.front() == '#')
            while (!rest_.empty() && rest_.front() != '\n') pass();
        else if (is_blank(rest_.front()))
            pass();
        else
            return;
    }
}

std::optional<std::string_view> RadWords::next() {
    pass_blanks();
    line_ = at_;
    if (rest_.empty()) return std::nullopt;
    const char quote = rest_.front();
    was_quoted_ = quote == '\'' || quote == '"';
    std::size_t n = 0;
    if (was_quoted_) {
        rest_.remove_prefix(1);
        while (n < rest_.size() && rest_[n] != quote && rest_[n] != '\n') ++n;
        open_quote_ = n == rest_.size() || rest_[n] != quote;
        if (open_quote_) return std::nullopt;
    } else {
        while (n < rest_.size() && !is_blank(rest_[n])) ++n;
    }
    const std::string_view word = rest_.substr(0, n);
    rest_.remove_prefix(was_quoted_ ? n + 1 : n);
    return word;
}

std::string RadWords::rest_of_command() {
    std::string out;
    while (!rest_.empty() && rest_.front() != '\n') {
        const bool goes_on = rest_.starts_with("\\\n") || rest_.starts_with("\\\r\n");
        if (goes_on)
            while (rest_.front() != '\n') pass();
        else
            out += rest_.front();
        pass();
    }
    return out;
}

std::optional<RadFault> read_primitive(RadWords& words, RadPrimitive& out) {
    const auto ended = [&](int line, const std::string& within) {
        if (words.is_open_quote()) return RadFault{words.line(), "a quoted word does not end on its line"};
        return RadFault{line, "the file ends within " + within};
    };
    const auto type = words.next(), name = type ? words.next() : std::nullopt;
    out.line = words.line();
    if (!name) return ended(out.line, "a primitive");
    out.type = *type, out.name = *name;
    const std::string shown_name = fmt::format("'{}'", shown(out.name));
    if (out.type == "alias") {
        const auto old = words.next();
        if (!old) return ended(out.line, "an alias");
        out.words = {std::string(*old)};
        return std::nullopt;
    }
    for (int list = 0; list < 3; ++list) {  // the three argument lists: words, integers, numbers
        const auto word = words.next();
        if (!word && words.is_open_quote()) return ended(words.line(), shown_name);
        const std::optional<long long> count = parse_integer(word.value_or(""));
        if (!count || *count < 0)
            return RadFault{words.line(), fmt::format("'{}' is not a number of arguments (of {})",
                                                      shown(word.value_or("")), shown_name)};
        for (long long i = 0; i < *count; ++i) {
            const auto argument = words.next();
            double value = 0;
            if (!argument) return ended(out.line, shown_name);
            if (list == 0) {
                out.words.emplace_back(*argument);
            } else if (number_of_word(*argument, value) != NumberKind::finite) {
                return RadFault{words.line(), fmt::format("'{}' is not a finite number", shown(*argument))};
            } else if (list == 2) {
                out.numbers.push_back(value);
            }
        }
    }
    return std::nullopt;
}

}  // namespace exitance
