#include "exitance/sweep/sweep_plan.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "exitance/base/nearest.hpp"
#include "exitance/base/words.hpp"

namespace exitance {
namespace {

/// Placeholders that do not belong to parameters: the folder of results, and the scene.
constexpr std::string_view folder_mark = "dir", scene_mark = "scene";

bool is_name(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

const SweepValue* find_value(const SweepSetting& variant, std::string_view name) {
    const auto at =
        std::find_if(variant.begin(), variant.end(), [&](const auto& entry) { return entry.first == name; });
    return at == variant.end() ? nullptr : &at->second;
}

Error unknown_placeholder(const SweepPlan& plan, const std::string& name, int line) {
    std::vector<std::string> known = plan.parameters;
    known.emplace_back(folder_mark);
    if (!plan.scene.empty()) known.emplace_back(scene_mark);
    const std::string near = nearest(name, known);
    return {ErrorCode::bad_input, fmt::format("there is no parameter '{}' for the placeholder {{{}}}", name, name),
            fmt::format("{}:{}", plan.path, line),
            near.empty() ? fmt::format("the parameters are {}", fmt::join(known, ", "))
                         : fmt::format("did you mean {{{}}}?", near)};
}

Error no_single_word(const SweepPlan& plan, const std::string& name, int line) {
    return {ErrorCode::bad_input, fmt::format("the value of '{}' is a list, and {{{}}} is part of a word", name, name),
            fmt::format("{}:{}", plan.path, line), "lists replace placeholders that are words of their own"};
}

/// Fills in one word that is not a single placeholder.
Result<std::string> fill_in_word(const SweepPlan& plan, const std::string& word, const SweepSetting& variant,
                                 int line) {
    std::string out;
    for (std::size_t at = 0; at < word.size();) {
        const std::size_t end = word[at] == '{' ? word.find('}', at) : std::string::npos;
        const std::string name = end == std::string::npos ? "" : word.substr(at + 1, end - at - 1);
        if (!is_name(name)) {
            out += word[at++];
            continue;
        }
        if (name == folder_mark)
            out += "{dir}";
        else if (name == scene_mark && !plan.scene.empty())
            out += plan.scene;
        else if (const SweepValue* value = find_value(variant, name); !value)
            return unknown_placeholder(plan, name, line);
        else if (value->size() != 1)
            return no_single_word(plan, name, line);
        else
            out += value->front();
        at = end + 1;
    }
    return out;
}

}  // namespace

std::string text_of(const SweepValue& value) {
    return fmt::format("{}", fmt::join(value, " "));
}

std::string with_plain_placeholders(const std::string& text) {
    std::string out;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = text[at] == '{' ? text.find('}', at) : std::string::npos;
        const std::string_view name =
            end == std::string::npos ? "" : without_blanks(std::string_view(text).substr(at + 1, end - at - 1));
        if (is_name(name))
            out += fmt::format("{{{}}}", name), at = end + 1;
        else
            out += text[at++];
    }
    return out;
}

std::string path_in_folder(const std::string& path) {
    std::string out = std::filesystem::path(path).relative_path().lexically_normal().string();
    if (out.ends_with('/')) out.pop_back();
    return out == "." || out == ".." || out.starts_with("../") ? "" : out;
}

Result<std::vector<std::string>> fill_in(const SweepPlan& plan, const std::vector<std::string>& words,
                                         const SweepSetting& variant, int line) {
    std::vector<std::string> out;
    for (const std::string& word : words) {
        const bool is_placeholder = word.size() > 2 && word.front() == '{' && word.find('}') == word.size() - 1;
        const SweepValue* const value = is_placeholder ? find_value(variant, word.substr(1, word.size() - 2)) : nullptr;
        if (value) {
            out.insert(out.end(), value->begin(), value->end());
            continue;
        }
        Result<std::string> filled = fill_in_word(plan, word, variant, line);
        if (!filled) return filled.error();
        out.push_back(std::move(*filled));
    }
    return out;
}

}  // namespace exitance
