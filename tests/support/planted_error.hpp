#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "exitance/error/certificate.hpp"
#include "exitance/transport/direct_projection.hpp"
#include "support/built_scene.hpp"

namespace exitance::test {

/// One or more separate furnaces with known exact indirect light, and a delivered function with a planted error, given
/// relative to the emitted light.
struct PlantedError {
    double rho = 0.5, exact = rho / (1 - rho);  // E_ind of M = 1
    Scene scene;
    Stage stage{scene};
    GlobalLight light;
    ElementFunction delivered;

    explicit PlantedError(const std::function<double(const Point&)>& error, double edge = 0.5,
                          Scene furnace = box_scene(2, 1, 1.5, 0.5, 1, 1), double reflectance = 0.5)
        : rho(reflectance), scene(std::move(furnace)) {
        stage.rooms = find_light_rooms(stage, 1, StopRequest());
        light.tree = stage.make_elements({.edge = edge, .grading_levels = 0});
        light.numbering = LeafNumbering(light.tree);
        for (ElementId e : light.numbering.leaves) {
            const double m = emitted(light.tree.region(e));
            light.direct.emplace_back(m);
            light.indirect.emplace_back(m * exact);
            light.reflected.emplace_back(m * rho * (1 + exact));
        }
        delivered.tree = light.tree;
        delivered.first_value.resize(light.tree.size(), 0);
        for (ElementId e : light.numbering.leaves) {
            delivered.first_value[e] = static_cast<std::uint32_t>(delivered.values.size());
            const Point middle = light.tree.patch(e).at(light.tree.centre(e));
            for (int i = 0; i < light.tree.patch(e).corner_count(); ++i)
                delivered.add_value(Spectrum(emitted(light.tree.region(e)) * (exact + error(middle))));
        }
    }

    /// Returns the exitance of a region, which is also the direct light on it.
    double emitted(RegionId region) const { return mean(scene.material(region).exitance); }
    double reflected(const ElementLocator& locator, RegionId region, const Point& y) const {
        return rho * (emitted(region) + mean(delivered.at(locator.find(region, y))));
    }

    /// Returns the certificate after this many calls of `measure`.
    Certificate certificate(std::uint64_t seed, int looks = 1, std::size_t points = 1280,
                            bool keeps_flux = false) const {
        const ElementLocator locator(delivered.tree, scene.regions().size());
        const PointwiseLight b(
            [&](RegionId region, const Point& y) { return Spectrum(reflected(locator, region, y)); });
        Certifier certifier(stage, light, delivered, b,
                            {.error = 0.02, .seed = seed, .points = points, .keeps_flux = keeps_flux});
        for (int look = 1; look < looks; ++look) certifier.measure();
        return certifier.measure();
    }

    /// Returns a certificate that includes the 99th percentile.
    Certificate with_p99(std::uint64_t seed) const {
        const ElementLocator locator(delivered.tree, scene.regions().size());
        const PointwiseLight b(
            [&](RegionId region, const Point& y) { return Spectrum(reflected(locator, region, y)); });
        Certifier certifier(stage, light, delivered, b, {.error = 0.02, .seed = seed, .points = 1280});
        Certificate out = certifier.measure();
        certifier.measure_p99(out);
        return out;
    }

    /// Returns the light of every room over the mean light.
    std::vector<double> light_by_room() const {
        std::vector<double> light_in(stage.rooms.count());
        const double mean_light = light.mean_reflected(stage.area);
        for (std::size_t i = 0; i < light.reflected.size(); ++i) {
            const ElementId e = light.numbering.leaves[i];
            const std::size_t room = stage.rooms.of(light.tree, e);
            light_in[room] += light.tree.area(e) * mean(light.reflected[i]) / (stage.rooms.area(room) * mean_light);
        }
        return light_in;
    }

    /// Returns the errors of the rooms, in descending order of area.
    std::vector<RoomError> rooms(std::uint64_t seed) const {
        const ElementLocator locator(delivered.tree, scene.regions().size());
        const PointwiseLight b(
            [&](RegionId region, const Point& y) { return Spectrum(reflected(locator, region, y)); });
        const std::vector<double> light_in = light_by_room();
        Certifier certifier(
            stage, light, delivered, b,
            {.error = 0.02, .seed = seed, .keeps_flux = true, .light_in = light_in, .allowed_in = light_in});
        certifier.measure();
        return certifier.rooms();
    }

    /// Returns the certificate from sums over the elements, without rays.
    Certificate summed_certificate(std::uint64_t seed) const {
        ElementFunction reflected = delivered;
        for (std::array<float, bands>& value : reflected.values)
            for (float& v : value) v = static_cast<float>(rho * (1 + static_cast<double>(v)));
        const SummedLight summed{{ElementGather(stage, reflected)}, {}, 1e-3};
        const PointwiseLight unread([](RegionId, const Point&) { return Spectrum(); });
        return Certifier(stage, light, delivered, unread, {.error = 0.02, .seed = seed, .summed = &summed}).measure();
    }

    /// Returns the relative RMS of the planted error of B.
    double error(const std::function<double(const Point&)>& planted) const {
        double square = 0;
        for (ElementId e : light.numbering.leaves)
            square += light.tree.area(e) * std::pow(rho * planted(light.tree.patch(e).centre()), 2);
        return std::sqrt(square / stage.area) / (rho * (1 + exact));
    }
};

/// An error of the same size everywhere, whose sign changes between neighbouring elements.
inline double rough(const Point& p) {
    return std::sin(40 * p.x) * std::cos(37 * p.y) * std::sin(43 * p.z + 1) > 0 ? 0.1 : -0.1;
}

/// Two separate furnaces, one a hundredth as bright as the other.
inline Scene bright_and_dark_furnace() {
    SceneDescription d;
    d.materials = {{"bright", Spectrum(0.5), Spectrum(1.0)}, {"dark", Spectrum(0.5), Spectrum(0.01)}};
    d.groups = {"bright", "dark"};
    const std::vector<std::vector<std::uint32_t>> box = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                         {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::uint32_t room = 0; room < 2; ++room) {
        const double x = 5 * room, size = 2 - 0.2 * room;
        for (const double z : {0.0, size})
            d.points.insert(d.points.end(), {{x, 0, z}, {x + size, 0, z}, {x + size, size, z}, {x, size, z}});
        for (std::vector<std::uint32_t> face : box) {
            for (std::uint32_t& corner : face) corner += 8 * room;
            d.faces.push_back({face, room, room, 1});
        }
    }
    return std::move(*make_scene(std::move(d)).scene);
}

}  // namespace exitance::test
