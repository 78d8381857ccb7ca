#include "exitance/io/report/report_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>

#include "exitance/io/files/toml_keys.hpp"
#include "exitance/io/files/whole_file.hpp"
#include "exitance/io/report/german_words.hpp"

namespace exitance {
namespace {

constexpr std::array<const char*, 13> section_names{"requirements", "rooms",  "luminaires", "pictures", "walk",
                                                    "grids",        "glare",  "materials",  "surfaces", "energy",
                                                    "error",        "method", "warnings"};
constexpr std::array<const char*, 12> unit_names{"m",    "m²", "lx", "W/m²", "lm/m²", "cd/m²",
                                                 "lm/W", "lm", "W",  "s",    "MB",    "sr"};

/// Splits text at every {}.
std::vector<std::string> split_at_gaps(const std::string& text) {
    std::vector<std::string> out(1);
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text.compare(i, 2, "{}") == 0)
            out.emplace_back(), ++i;
        else
            out.back() += text[i];
    }
    return out;
}

std::size_t size_of(const std::vector<std::string>& pieces) {
    std::size_t count = 0;
    for (const std::string& piece : pieces) count += piece.size();
    return count;
}

/// The texts that stand for the {} between `pieces`; none if the text is another one.
std::optional<std::vector<std::string>> match_pieces(const std::string& text, const std::vector<std::string>& pieces) {
    const std::string &first = pieces.front(), &last = pieces.back();
    if (text.size() < first.size() + last.size() || !text.starts_with(first) || !text.ends_with(last)) return {};
    std::vector<std::string> out;
    std::size_t at = first.size();
    const std::size_t end = text.size() - last.size();
    for (std::size_t i = 1; i < pieces.size(); ++i) {
        const std::size_t next = i + 1 == pieces.size() ? end : text.find(pieces[i], at);
        if (next == std::string::npos || next > end || next < at) return {};
        out.push_back(text.substr(at, next - at));
        at = next + pieces[i].size();
    }
    return out;
}

/// True if a word is a number, a sign between numbers, or a unit. The version of a program has two points and is none.
bool is_numeric_word(const std::string& word) {
    constexpr std::array<const char*, 5> signs{"±", "×", "x", "–", "&lt;"};
    return std::find(unit_names.begin(), unit_names.end(), word) != unit_names.end() ||
           std::find(signs.begin(), signs.end(), word) != signs.end() ||
           (word.find_first_not_of("0123456789.,+-%()e;") == std::string::npos && word.find('.') == word.rfind('.'));
}

/// True if text consists of numbers, signs and units.
bool is_numeric(const std::string& text) {
    if (text.find_first_of("0123456789") == std::string::npos) return false;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t to = std::min(text.find(' ', from), text.size());
        if (!is_numeric_word(text.substr(from, to - from))) return false;
        from = to + 1;
    }
    return true;
}

std::pair<std::size_t, std::size_t> range_without_blanks(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \n\t");
    if (first == std::string::npos) return {text.size(), text.size()};
    return {first, text.find_last_not_of(" \n\t") + 1};
}

}  // namespace

std::string known_report_words(const std::string& name) {
    return name == "german" ? german_words : "";
}

Result<ReportWords> ReportWords::load(const std::string& name_or_path) {
    const std::string known = known_report_words(name_or_path);
    if (!known.empty()) return parse(known, "german");
    const Result<std::string> text = read_whole_file(name_or_path);
    if (!text) return text.error();
    return parse(*text, name_or_path);
}

Result<ReportWords> ReportWords::parse(const std::string& text, const std::string& file) {
    return read_toml(text, file, [&](const toml::table& table) {
        TomlKeys keys(table, file);
        ReportWords out;
        keys.take("language", out.language_);
        keys.take("decimal_comma", out.decimal_comma_);
        keys.take("sections", out.sections_);
        for (const std::string& section : out.sections_)
            if (std::find(section_names.begin(), section_names.end(), section) == section_names.end())
                keys.fail(*keys.find("sections"), fmt::format("there is no section '{}'", section),
                          fmt::format("choose from {}", fmt::join(section_names, ", ")));
        const toml::node* words = keys.find("words");
        keys.finish();
        if (words && !words->is_table()) keys.fail(*words, "'words' is not a table", "begin it with [words]");
        if (words)
            for (const auto& [key, node] : *words->as_table()) {
                const std::string english(key.str());
                const std::optional<std::string> other = node.value_exact<std::string>();
                if (!other) keys.fail(node, fmt::format("'{}' is not text in quotes", english));
                Pattern pattern{split_at_gaps(english), split_at_gaps(*other)};
                if (pattern.pieces.size() != pattern.translated.size())
                    keys.fail(node, fmt::format("the translation of '{}' has another number of {{}}", english));
                if (pattern.pieces.size() == 1)
                    out.exact_[english] = *other;
                else
                    out.patterns_.push_back(std::move(pattern));
            }
        std::stable_sort(out.patterns_.begin(), out.patterns_.end(),
                         [](const Pattern& a, const Pattern& b) { return size_of(a.pieces) > size_of(b.pieces); });
        return out;
    });
}

/// Decimal commas in numbers, and semicolons between them.
std::string ReportWords::number(const std::string& text) const {
    if (!decimal_comma_ || !is_numeric(text)) return text;
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool is_last = i + 1 == text.size();
        if (text[i] == ',' && !is_last && text[i + 1] == ' ')
            out += ';';
        else if (text[i] == '.' && !is_last && std::isdigit(static_cast<unsigned char>(text[i + 1])))
            out += ',';
        else
            out += text[i];
    }
    return out;
}

std::string ReportWords::text(const std::string& english) const {
    const auto found = exact_.find(english);
    if (found != exact_.end()) return found->second;
    if (is_numeric(english)) return number(english);
    for (const Pattern& pattern : patterns_) {
        const std::optional<std::vector<std::string>> values = match_pieces(english, pattern.pieces);
        if (!values) continue;
        std::string out = pattern.translated.front();
        for (std::size_t i = 0; i < values->size(); ++i) out += text((*values)[i]) + pattern.translated[i + 1];
        return out;
    }
    return english;
}

std::string ReportWords::page(const std::string& html) const {
    std::string out;
    const auto add = [&](const std::string& english) {
        const auto [first, end] = range_without_blanks(english);
        out += english.substr(0, first) + text(english.substr(first, end - first)) + english.substr(end);
    };
    for (std::size_t at = 0; at < html.size();) {
        const std::size_t tag = std::min(html.find('<', at), html.size());
        if (tag > at) add(html.substr(at, tag - at));
        if (tag == html.size()) break;
        std::size_t end = html.find('>', tag);
        for (const char* raw : {"<script", "<style"})
            if (html.compare(tag, std::string(raw).size(), raw) == 0)
                end = html.find('>', html.find(std::string("</") + (raw + 1), tag));
        end = std::min(end, html.size() - 1);
        std::string element = html.substr(tag, end + 1 - tag);
        for (const std::string attribute : {" alt=\"", " aria-label=\""}) {
            const std::size_t from = element.starts_with("<script") ? std::string::npos : element.find(attribute);
            if (from == std::string::npos) continue;
            const std::size_t begin = from + attribute.size(), close = element.find('"', begin);
            element.replace(begin, close - begin, text(element.substr(begin, close - begin)));
        }
        out += element;
        at = end + 1;
    }
    return out;
}

}  // namespace exitance
