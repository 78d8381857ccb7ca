#pragma once

#include <map>
#include <string>

#include "exitance/samples/generate.hpp"

namespace exitance {

/// Builds a member of a scene family; aborts the test if there is no such scene.
inline Scene built_scene(const std::string& family, const std::map<std::string, std::string>& parameters = {}) {
    Result<SceneDescription> description = generate_scene(family, parameters);
    EXI_CHECK(static_cast<bool>(description));
    CheckedScene checked = make_scene(std::move(*description));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

/// A closed box of a x b x c metres with one reflectance. Its ceiling emits `exitance` W/m^2, the other faces
/// `elsewhere` W/m^2.
inline SceneDescription box_description(double a, double b, double c, double reflectance, double exitance,
                                        double elsewhere = 0) {
    SceneDescription d;
    d.file = "box.obj";
    for (const double z : {0.0, c}) d.points.insert(d.points.end(), {{0, 0, z}, {a, 0, z}, {a, b, z}, {0, b, z}});
    d.materials = {{"wall", Spectrum(reflectance), Spectrum(elsewhere)},
                   {"ceiling", Spectrum(reflectance), Spectrum(exitance)}};
    d.groups = {"box"};
    const std::vector<std::vector<std::uint32_t>> faces = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                           {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};
    for (std::size_t i = 0; i < faces.size(); ++i)
        d.faces.push_back({faces[i], i == 1 ? 1u : 0u, 0, static_cast<int>(i + 1)});
    return d;
}

/// The scene of `box_description`.
inline Scene box_scene(double a, double b, double c, double reflectance, double exitance, double elsewhere = 0) {
    CheckedScene checked = make_scene(box_description(a, b, c, reflectance, exitance, elsewhere));
    EXI_CHECK(static_cast<bool>(checked.scene));
    return std::move(*checked.scene);
}

}  // namespace exitance
