#pragma once

#include <map>
#include <string>

#include "exitance/samples/generate.hpp"
#include "support/checked_scene.hpp"

namespace exitance {

/// Builds a member of a scene family; aborts the test if there is no such scene.
inline Scene built_scene(const std::string& family, const std::map<std::string, std::string>& parameters = {}) {
    Result<SceneDescription> description = generate_scene(family, parameters);
    EXI_CHECK(static_cast<bool>(description));
    return checked_scene(std::move(*description));
}

/// Faces of a closed box whose fronts are inside. Corners 0 to 3 go around its floor, 4 to 7 are above them.
inline const std::vector<std::vector<std::uint32_t>> box_faces = {{0, 1, 2, 3}, {4, 7, 6, 5}, {0, 4, 5, 1},
                                                                  {1, 5, 6, 2}, {2, 6, 7, 3}, {3, 7, 4, 0}};

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
    for (std::size_t i = 0; i < box_faces.size(); ++i)
        d.faces.push_back({box_faces[i], i == 1 ? 1u : 0u, 0, static_cast<int>(i + 1)});
    return d;
}

/// The scene of `box_description`.
inline Scene box_scene(double a, double b, double c, double reflectance, double exitance, double elsewhere = 0) {
    return checked_scene(box_description(a, b, c, reflectance, exitance, elsewhere));
}

}  // namespace exitance
