#include "exitance/methods/options/solve_option_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "exitance/methods/options/option_rows.hpp"
#include "exitance/methods/options/support.hpp"
#include "exitance/methods/options/value_kinds.hpp"

namespace exitance {
namespace {

std::string key_of(const OptionRow& row) {
    std::string key = row.name.substr(2);
    std::replace(key.begin(), key.end(), '-', '_');
    return json_text(key);
}

/// JSON members ("key": value, ...) of the options in a section.
std::string members(std::string_view section, const SolveRequest& request) {
    std::string out;
    for (const OptionRow& row : solve_option_table())
        if (row.section == section)
            out += fmt::format("{}{}: {}", out.empty() ? "" : ", ", key_of(row), row.value.json(request));
    return out;
}

}  // namespace

std::span<const OptionRow> solve_option_table() {
    static const std::vector<OptionRow> table =
        option_rows::joined({option_rows::for_users(), option_rows::for_experts(), option_rows::of_laboratory()});
    return table;
}

const OptionRow* find_option(std::string_view name) {
    const auto table = solve_option_table();
    const auto row = std::find_if(table.begin(), table.end(), [&](const OptionRow& r) { return r.name == name; });
    return row == table.end() ? nullptr : &*row;
}

std::string recorded_options(const SolveRequest& request) {
    std::string out = members("", request);
    if (request.options.discontinuity.any())
        out += fmt::format(", \"discontinuity\": {{{}}}", members("discontinuity", request));
    if (form_of(request.options) == Form::published)
        out += fmt::format(", \"classical\": {{{}}}", members("classical", request));
    return "{" + out + "}";
}

std::string help_of(const OptionRow& row) {
    std::string out = row.does + ".";
    if (!row.initial.empty()) out += fmt::format(" Default {}.", row.initial);
    if (!row.when.empty()) out += fmt::format(" {}.", row.when);
    return out;
}

bool is_among(std::string_view word, std::string_view values) {
    while (!values.empty()) {
        const std::size_t bar = std::min(values.find('|'), values.size());
        if (values.substr(0, bar) == word) return true;
        values.remove_prefix(std::min(bar + 1, values.size()));
    }
    return false;
}

}  // namespace exitance