#include "exitance/io/view_factors/solver_formats.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace exitance {
namespace {

/// A name as a field of EnergyPlus, in which commas, semicolons and exclamation marks have a meaning.
std::string field_of(std::string name) {
    std::replace_if(
        name.begin(), name.end(), [](char c) { return c == ',' || c == ';' || c == '!'; }, '_');
    return name;
}

std::string name_of(const SparseFactors& table, std::size_t i) {
    return table.names.empty() ? fmt::format("Surface {}", i + 1) : field_of(table.names[i]);
}

std::string foam_header(const char* kind, const char* object, std::size_t rows) {
    return fmt::format(
        "FoamFile\n{{\n    version     2.0;\n    format      ascii;\n    class       {};\n    location    "
        "\"constant\";\n    object      {};\n}}\n\n{}\n(\n",
        kind, object, rows);
}

}  // namespace

void EnergyPlus::begin(std::string& text) const {
    text = fmt::format("ZoneProperty:UserViewFactors:BySurfaceName,\n  {}", field_of(zone_));
}

void EnergyPlus::add_row(std::string& text, std::size_t i) const {
    const std::string from = name_of(table_, i);
    std::size_t j = 0;
    for_all_columns(i, [&](double F) { text += fmt::format(",\n  {},{},{:.9g}", from, name_of(table_, j++), F); });
    if (i + 1 == table_.size()) text += ";\n";
}

void FactorPairs::add_row(std::string& text, std::size_t i) const {
    const auto add = [&](std::size_t j, double F) {
        append_formatted(text, "%zu,%zu,", i, j), append_exactly(text, F);
        text += '\n';
    };
    for (std::size_t k = 0; k < table_.row_columns(i).size(); ++k)
        add(table_.row_columns(i)[k], table_.row_values(i)[k]);
    if (with_sky_) add(table_.size(), table_.sky[i]), add(table_.size() + 1, table_.back[i]);
}

void OpenFoamFactors::begin(std::string& text) const {
    text = foam_header("scalarListList", "F", table_.size());
}

void OpenFoamFactors::add_row(std::string& text, std::size_t i) const {
    append_formatted(text, "%zu(", table_.row_values(i).size());
    for (const double F : table_.row_values(i)) append_exactly(text, F), text += ' ';
    text += ")\n";
}

void OpenFoamColumns::begin(std::string& text) const {
    text = foam_header("labelListList", "globalFaceFaces", table_.size());
}

void OpenFoamColumns::add_row(std::string& text, std::size_t i) const {
    append_formatted(text, "%zu(", table_.row_columns(i).size());
    for (const std::uint32_t j : table_.row_columns(i)) append_formatted(text, "%u ", j);
    text += ")\n";
}

}  // namespace exitance
