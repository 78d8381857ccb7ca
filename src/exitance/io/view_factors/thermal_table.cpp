#include "exitance/io/view_factors/thermal_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "exitance/base/words.hpp"
#include "exitance/io/files/text_lines.hpp"
#include "exitance/io/files/text_table.hpp"

namespace exitance {
namespace {

constexpr std::array<std::string_view, 4> column_names{"surface", "emissivity", "temperature", "heat"};
constexpr double missing = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string_view> fields_of(std::string_view line) {
    std::vector<std::string_view> out;
    while (true) {
        const std::size_t comma = line.find(',');
        out.push_back(without_quotes(line.substr(0, comma)));
        if (comma == std::string_view::npos) return out;
        line.remove_prefix(comma + 1);
    }
}

/// Index in `column_names` of every column of the file.
Result<std::vector<std::size_t>> read_header(LineReader& lines) {
    const auto header = lines.next_content();
    if (lines.failed()) return lines.read_error();
    const std::string hint = "the columns are surface and any of emissivity, temperature and heat, separated by commas";
    if (!header) return lines.error("the table is empty", hint);
    std::vector<std::size_t> out;
    for (const std::string_view name : fields_of(*header)) {
        const auto known = std::find(column_names.begin(), column_names.end(), name);
        if (known == column_names.end()) return lines.error(fmt::format("unknown column '{}'", shown(name)), hint);
        const auto column = static_cast<std::size_t>(known - column_names.begin());
        if (std::find(out.begin(), out.end(), column) != out.end())
            return lines.error(fmt::format("column '{}' occurs twice", name), hint);
        out.push_back(column);
    }
    if (std::find(out.begin(), out.end(), std::size_t(0)) == out.end())
        return lines.error("there is no column surface", hint);
    return out;
}

/// Values of one row in the order of `column_names`; empty fields are missing.
Result<std::array<double, 4>> read_row(const LineReader& lines, std::string_view line,
                                       const std::vector<std::size_t>& columns, const std::vector<std::string>& names) {
    const std::vector<std::string_view> fields = fields_of(line);
    if (fields.size() != columns.size())
        return lines.error(fmt::format("there are {} fields under {} columns", fields.size(), columns.size()),
                           "separate them by commas, and leave a field empty to keep its value");
    std::array<double, 4> row{missing, missing, missing, missing};
    for (std::size_t k = 0; k < fields.size(); ++k) {
        if (fields[k].empty()) continue;
        std::optional<double> value = parse_number(fields[k]);
        if (columns[k] == 0 && !value) {
            const auto named = std::find(names.begin(), names.end(), fields[k]);
            if (named == names.end())
                return lines.error(fmt::format("there is no surface '{}'", shown(fields[k])),
                                   "the column surface holds numbers from 1, 0 for all, or names of rows");
            value = static_cast<double>(named - names.begin() + 1);
        }
        // Empty cells are unknown values, stored as NaN. A cell with the word "nan" is an error.
        if (!value || std::isnan(*value)) return lines.error(fmt::format("'{}' is not a number", shown(fields[k])), "");
        row[columns[k]] = *value;
    }
    return row;
}

/// A fault of a row, with its remedy.
std::pair<std::string, std::string> fault_of(const std::array<double, 4>& row, std::size_t surfaces) {
    const auto& [number, emissivity, temperature, heat] = row;
    if (!(number == std::floor(number) && number >= 0 && number <= static_cast<double>(surfaces)))
        return {
            std::isnan(number) ? "the number of the surface is missing" : fmt::format("there is no surface {}", number),
            fmt::format("surfaces are numbered from 1 to {}; 0 stands for all", surfaces)};
    if (!std::isnan(temperature) && !std::isnan(heat))
        return {"both temperature and heat are given", "one of them follows from the other: leave one field empty"};
    if (!std::isnan(emissivity) && !(emissivity >= min_emissivity && emissivity <= 1))
        return {fmt::format("emissivity {} is not from {} to 1", emissivity, min_emissivity),
                "mirror-like metals have 0.02 or more"};
    if (!std::isnan(temperature) && !(temperature >= 0 && temperature < 1e5))
        return {fmt::format("temperature {} is out of range", temperature), "temperatures are in kelvins"};
    return {};
}

void apply(const std::array<double, 4>& row, ThermalSurface& surface) {
    const auto& [number, emissivity, temperature, heat] = row;
    if (!std::isnan(emissivity)) surface.emissivity = emissivity;
    if (!std::isnan(heat)) surface.heat = heat, surface.temperature.reset();
    if (!std::isnan(temperature)) surface.temperature = temperature;
}

}  // namespace

std::vector<ThermalSurface> emissivities_of(const SparseFactors& factors) {
    std::vector<ThermalSurface> out(factors.size());
    for (std::size_t i = 0; i < std::min(out.size(), factors.emittances.size()); ++i)
        out[i].emissivity = factors.emittances[i];
    return out;
}

Result<std::vector<ThermalSurface>> read_thermal_table(const std::string& path, const SparseFactors& factors) {
    std::vector<ThermalSurface> out = emissivities_of(factors);
    Result<LineReader> lines = LineReader::open(path);
    if (!lines) return lines.error();
    const Result<std::vector<std::size_t>> columns = read_header(*lines);
    if (!columns) return columns.error();
    while (const auto line = lines->next_content()) {
        const Result<std::array<double, 4>> row = read_row(*lines, *line, *columns, factors.names);
        if (!row) return row.error();
        if (const auto [fault, hint] = fault_of(*row, out.size()); !fault.empty()) return lines->error(fault, hint);
        const auto number = static_cast<std::size_t>((*row)[0]);
        if (number > 0)
            apply(*row, out[number - 1]);
        else
            for (ThermalSurface& surface : out) apply(*row, surface);
    }
    if (lines->failed()) return lines->read_error();
    return out;
}

std::string heat_csv(const SparseFactors& factors, const std::vector<ThermalSurface>& surfaces,
                     const GrayExchange& exchange) {
    std::string text = "surface,area,emissivity,temperature,radiosity,heat\n";
    for (std::size_t i = 0; i < surfaces.size(); ++i)
        text += fmt::format("{},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", i + 1, factors.areas[i],
                            surfaces[i].emissivity, exchange.temperature[i], exchange.radiosity[i], exchange.heat[i]);
    return text;
}

std::string exchange_csv(const SparseFactors& factors, const std::vector<ThermalSurface>& surfaces,
                         const std::vector<std::vector<double>>& f) {
    std::string text = "surface,area,emissivity";
    for (std::size_t j = 1; j <= f.size(); ++j) text += fmt::format(",f_{}", j);
    text += '\n';
    for (std::size_t i = 0; i < f.size(); ++i) {
        text += fmt::format("{},{:.17g},{:.17g}", i + 1, factors.areas[i], surfaces[i].emissivity);
        for (const double value : f[i]) text += fmt::format(",{:.17g}", value);
        text += '\n';
    }
    return text;
}

}  // namespace exitance
