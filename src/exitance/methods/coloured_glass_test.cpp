// Light through coloured glass: every band is that of grey glass with the transmission of the band.
#include <gtest/gtest.h>

#include <cmath>

#include "exitance/base/sanitizers.hpp"
#include "exitance/evaluate/radiosity_function.hpp"
#include "exitance/methods/solve_scene.hpp"
#include "exitance/reference/path_reference.hpp"
#include "support/checked_scene.hpp"
#include "support/solved.hpp"

namespace exitance {
namespace {

/// Transmissivity of the glass; it differs between bands.
Spectrum tint() {
    Spectrum out;
    for (std::size_t b = 0; b < bands; ++b) out[b] = 0.9 / (1.0 + static_cast<double>(b));
    return out;
}

/// A box of 3 x 1 x 1 m that a wall at x = 0 lights, with `panes` panes across it; turned about the vertical.
Scene glazed_box(const Spectrum& transmissivity, int panes, double turn = 0) {
    const auto place = [&](double x, double y, double z) {
        return Point{std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y, z};
    };
    SceneDescription d;
    d.file = "glass.obj";
    d.materials = {{"grey", Spectrum(0.5), {}}, {"lamp", Spectrum(0.5), Spectrum(100.0)}};
    d.groups = {"all"};
    for (const double x : {0.0, 3.0})
        for (const double y : {0.0, 1.0})
            for (const double z : {0.0, 1.0}) d.points.push_back(place(x, y, z));
    d.faces = {{{0, 2, 3, 1}, 1, 0, 0}, {{4, 5, 7, 6}, 0, 0, 0}, {{0, 1, 5, 4}, 0, 0, 0},
               {{2, 6, 7, 3}, 0, 0, 0}, {{0, 4, 6, 2}, 0, 0, 0}, {{1, 3, 7, 5}, 0, 0, 0}};
    for (int i = 0; i < panes; ++i) {
        const double x = 1 + 0.5 * i;
        Pane pane;
        pane.corners = {place(x, 0, 0), place(x, 1, 0), place(x, 1, 1), place(x, 0, 1)};
        pane.transmissivity = transmissivity;
        d.panes.push_back(pane);
    }
    return checked_scene(std::move(d));
}

/// Places on the floor behind the panes.
std::vector<ProbePoint> places_behind_glass(double turn) {
    const double c = std::cos(turn), s = std::sin(turn);
    std::vector<ProbePoint> out;
    for (const double x : {2.2, 2.7}) out.push_back({{c * x - s * 0.4, s * x + c * 0.4, 0}, {0, 0, 1}});
    return out;
}

/// Mean light by paths at these places, and its standard error in `error`.
Spectrum behind_glass(const Scene& scene, double turn, Spectrum& error) {
    const std::vector<ProbePoint> points = places_behind_glass(turn);
    Progress quiet;
    Spectrum sum;
    error = {};
    for (const ReferenceLight& light : reference_light(scene, points, 32768, 3, quiet, StopRequest())) {
        sum += light.irradiance / 2;
        error += light.standard_error / 2;
    }
    return sum;
}

TEST(ColouredGlass, EveryBandOfPathsIsThatOfGreyGlass) {
    for (const int panes : {1, 2})
        for (const double turn : {0.0, 0.7}) {
            Spectrum noise;
            const Spectrum coloured = behind_glass(glazed_box(tint(), panes, turn), turn, noise);
            for (std::size_t b = 0; b < bands; ++b) {
                Spectrum grey_noise;
                const double grey = behind_glass(glazed_box(Spectrum(tint()[b]), panes, turn), turn, grey_noise)[b];
                EXPECT_NEAR(coloured[b], grey, 4 * (noise[b] + grey_noise[b])) << panes << ", " << turn << ", " << b;
                EXPECT_LT(noise[b], 0.04 * grey) << "too noisy to find a fault of a fifth";
            }
        }
}

TEST(ColouredGlass, EveryBandOfASolutionIsThatOfGreyGlass) {
    constexpr double demand = 0.05;
    for (const Method method : {Method::matrix, Method::wavelet, Method::monte_carlo}) {
        if (has_address_sanitizer && method != Method::matrix) continue;
        const auto behind = [&](const Spectrum& t) {
            const Solution solution = solved(glazed_box(t, 1), {.method = method, .error = demand});
            EXPECT_LE(solution.statistics.relative_error_estimate, demand);
            Spectrum sum;
            for (const Light& light : RadiosityFunction(solution).at(places_behind_glass(0))) sum += light.irradiance;
            return sum;
        };
        const Spectrum coloured = behind(tint());
        for (std::size_t b = 0; b < bands; ++b) {
            // Light behind the glass is dimmer than the mean, to which the demand refers. Light by the mean of the
            // bands differs by more than a fifth there.
            constexpr double dim_places = 0.12;
            EXPECT_NEAR(coloured[b] / behind(Spectrum(tint()[b]))[b], 1, dim_places)
                << static_cast<int>(method) << ", " << b;
        }
    }
}

}  // namespace
}  // namespace exitance
