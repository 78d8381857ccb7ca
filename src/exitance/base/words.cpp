#include "exitance/base/words.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace exitance {
namespace {

/// Appends the words of `text` to `words`. Returns the quote that is not closed, or 0.
char scan_words(const std::string& text, std::vector<std::string>& words) {
    bool in_word = false;
    char quote = 0;
    for (const char c : text) {
        const bool blank = c == ' ' || c == '\t' || c == '\n' || c == '\r';
        if (quote == 0 && blank) {
            in_word = false;
            continue;
        }
        if (!in_word) words.emplace_back(), in_word = true;
        if (quote == 0 && (c == '"' || c == '\''))
            quote = c;
        else if (c == quote)
            quote = 0;
        else
            words.back() += c;
    }
    return quote;
}

std::string shell_word(const std::string& word) {
    constexpr std::string_view plain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=.,:/@%";
    if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
    std::string out = "'";
    for (const char c : word) {
        if (c == '\'')
            out += "'\\''";
        else
            out += c;
    }
    out += '\'';
    return out;
}

}  // namespace

std::vector<std::string> split_words(const std::string& text) {
    std::vector<std::string> words;
    scan_words(text, words);
    return words;
}

std::vector<std::string> split_at_commas(const std::string& text) {
    std::vector<std::string> parts;
    for (std::size_t begin = 0; begin <= text.size();) {
        const std::size_t end = std::min(text.find(',', begin), text.size());
        parts.push_back(text.substr(begin, end - begin));
        begin = end + 1;
    }
    return parts;
}

char open_quote(const std::string& text) {
    std::vector<std::string> unused;
    return scan_words(text, unused);
}

std::string shell_text(const std::vector<std::string>& words) {
    std::string out;
    for (const std::string& word : words) {
        if (!out.empty()) out += ' ';
        out += shell_word(word);
    }
    return out;
}

namespace {

/// Returns `text` without any of `letters` at both ends.
std::string_view without(std::string_view letters, std::string_view text) {
    const std::size_t first = text.find_first_not_of(letters);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(letters) - first + 1);
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = static_cast<unsigned char>(text[i++]);
        std::size_t more = byte < 0x80 ? 0 : byte >= 0xc2 && byte < 0xe0 ? 1 : byte >= 0xe0 && byte < 0xf0 ? 2 : 3;
        if (byte >= 0xf5 || (byte >= 0x80 && byte < 0xc2)) return false;
        // The second byte excludes longer forms of short codes, surrogates, and codes above the last one [RFC 3629].
        unsigned least = byte == 0xe0 ? 0xa0 : byte == 0xf0 ? 0x90 : 0x80;
        unsigned most = byte == 0xed ? 0x9f : byte == 0xf4 ? 0x8f : 0xbf;
        for (; more > 0; --more, ++i, least = 0x80, most = 0xbf)
            if (i == text.size() || static_cast<unsigned char>(text[i]) < least ||
                static_cast<unsigned char>(text[i]) > most)
                return false;
    }
    return true;
}

}  // namespace

std::string_view without_blanks(std::string_view text) {
    return without(" \t\r\n", text);
}

std::string_view without_quotes(std::string_view text) {
    return without(" \t\r\n\"", text);
}

std::string filled_in(std::string text, const std::vector<std::pair<std::string, std::string>>& values) {
    for (const auto& [name, value] : values) {
        const std::string mark = "{" + name + "}";
        for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + value.size()))
            text.replace(at, mark.size(), value);
    }
    return text;
}

std::string json_text(std::string_view text) {
    const bool utf8 = is_utf8(text);
    std::string out(1, '"');
    for (char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            out += '\\', out += c;
        else if (byte < 0x20 || (byte >= 0x80 && !utf8))  // text that is not UTF-8 is read as Latin-1
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(byte));
        else
            out += c;
    }
    out += '"';
    return out;
}

}  // namespace exitance
