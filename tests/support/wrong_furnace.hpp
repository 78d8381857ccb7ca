#pragma once

#include <vector>

#include "exitance/error/late_paths.hpp"
#include "support/built_scene.hpp"

namespace exitance {

/// A furnace of reflectance 1/2. Its delivered light is too large by `delta` everywhere; exact is E_ind = 1.
struct WrongFurnace {
    static constexpr double rho = 0.5, delta = 0.3;
    /// Parts of the error of radiosity, -rho delta, W/m^2: the residual, and what arrives by way of other surfaces.
    static constexpr double residual = -rho * (1 - rho) * delta, late_part = -rho * rho * delta;
    Scene scene = box_scene(2, 1, 1.5, rho, 1, 1);
    Stage stage{scene};
    ElementFunction delivered;
    PathTracer paths{stage};
    std::vector<CheckPlan> plans{CheckPlan{}};
    DirectCheck check{stage, paths, {}, LightAccuracy()};
    PointwiseLight b{[](RegionId, const Point&) { return Spectrum(rho * (1 + 1 + delta)); }};
    std::vector<ResidualSample> samples;

    WrongFurnace() {
        for (const auto& [region, patch] : stage.pieces) {
            const ElementId e = delivered.tree.add_root(region, patch);
            delivered.first_value.resize(delivered.tree.size(), 0);
            delivered.first_value[e] = static_cast<std::uint32_t>(delivered.values.size());
            for (int k = 0; k < patch.corner_count(); ++k) delivered.add_value(Spectrum(1 + delta));
            for (int k = 0; k < 100; ++k) {
                const double u = (k % 10 + 0.5) / 10, v = (k / 10 + 0.5) / 10;
                ResidualSample s;
                s.place = {e, {u, v}}, s.region = region, s.weight = patch.area(), s.leaf = 0;
                samples.push_back(s);
            }
        }
    }

    LatePaths late_paths() const { return {stage, delivered, b, check, plans, false}; }
};

}  // namespace exitance
