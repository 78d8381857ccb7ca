#include "exitance/sweep/sweep_template.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "exitance/base/nearest.hpp"
#include "exitance/base/words.hpp"

namespace exitance {
namespace {

/// A placeholder "{{name}}" of a template.
struct TemplateMark {
    std::size_t begin = 0, end = 0;
    std::string_view name;  ///< Name in the placeholder; empty if it has no name or is not closed on its line.
};

/// The first placeholder at or after `at`.
std::optional<TemplateMark> next_mark(const std::string& content, std::size_t at) {
    const std::size_t begin = content.find("{{", at);
    if (begin == std::string::npos) return std::nullopt;
    const std::size_t line_end = std::min(content.find('\n', begin), content.size());
    const std::size_t end = content.find("}}", begin);
    if (end >= line_end) return TemplateMark{begin, line_end, {}};
    const std::string_view name = without_blanks(std::string_view(content).substr(begin + 2, end - begin - 2));
    if (name.find_first_of("{}") != std::string_view::npos) return TemplateMark{begin, line_end, {}};
    return TemplateMark{begin, end + 2, name};
}

}  // namespace

Result<std::string> fill_in_template(const SweepPlan& plan, const SweepSetting& variant, const std::string& path,
                                     const std::string& content) {
    std::string out;
    std::size_t at = 0;
    while (const std::optional<TemplateMark> mark = next_mark(content, at)) {
        out += content.substr(at, mark->begin - at);
        const auto value =
            std::find_if(variant.begin(), variant.end(), [&](const auto& v) { return v.first == mark->name; });
        if (value == variant.end()) {
            const auto line =
                std::count(content.begin(), content.begin() + static_cast<std::ptrdiff_t>(mark->begin), '\n');
            const std::string where = fmt::format("{}:{}", path, line + 1);
            if (mark->name.empty())
                return Error{ErrorCode::bad_input, "'{{' is not followed by a name and '}}'", where,
                             "write a placeholder as {{name}}, in one line"};
            const std::string near = nearest(mark->name, plan.parameters);
            return Error{ErrorCode::bad_input,
                         fmt::format("there is no parameter '{}' for this placeholder", mark->name.substr(0, 40)),
                         where,
                         near.empty() ? fmt::format("parameters are in the plan {}", plan.path)
                                      : fmt::format("did you mean {{{{{}}}}}?", near)};
        }
        out += text_of(value->second);
        at = mark->end;
    }
    return out + content.substr(at);
}

std::set<std::string> names_in_template(const std::string& content) {
    std::set<std::string> names;
    std::size_t at = 0;
    while (const std::optional<TemplateMark> mark = next_mark(content, at)) {
        names.emplace(mark->name);
        at = mark->end;
    }
    return names;
}

}  // namespace exitance
