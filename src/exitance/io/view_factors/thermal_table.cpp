#include "exitance/io/view_factors/thermal_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "exitance/io/files/text_table.hpp"

namespace exitance {
namespace {

void apply(ThermalSurface& surface, double emissivity, double temperature, double heat) {
    if (!std::isnan(emissivity)) surface.emissivity = emissivity;
    if (!std::isnan(heat)) surface.heat = heat, surface.temperature.reset();
    if (!std::isnan(temperature)) surface.temperature = temperature;
}

}  // namespace

Result<std::vector<ThermalSurface>> read_thermal_table(const std::string& path, const SparseFactors& factors) {
    std::vector<ThermalSurface> out(factors.size());
    for (std::size_t i = 0; i < std::min(out.size(), factors.emittances.size()); ++i)
        out[i].emissivity = factors.emittances[i];
    Result<NumberTable> table = NumberTable::open(path, {"surface"}, {"emissivity", "temperature", "heat"});
    if (!table) return table.error();
    std::array<double, 4> row;
    while (true) {
        const Result<bool> there = table->next(row);
        if (!there) return there.error();
        if (!*there) return out;
        const auto& [number, emissivity, temperature, heat] = row;
        if (number != std::floor(number) || number < 0 || number > static_cast<double>(out.size()))
            return table->lines().error(
                fmt::format("there is no surface {}", number),
                fmt::format("surfaces are numbered from 1 to {}; 0 stands for all", out.size()));
        if (number > 0)
            apply(out[static_cast<std::size_t>(number) - 1], emissivity, temperature, heat);
        else
            for (ThermalSurface& surface : out) apply(surface, emissivity, temperature, heat);
    }
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
