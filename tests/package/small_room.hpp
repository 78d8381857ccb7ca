#pragma once

#include <exitance/scene.hpp>

/// A closed grey room of 4 x 3 x 2.5 m with a square lamp that hangs below its ceiling.
inline exitance::api::Result<exitance::api::Scene> small_room(bool light_groups = false) {
    exitance::api::SceneDescription d;
    d.vertices = {{0, 0, 0},   {4, 0, 0},   {4, 3, 0},   {0, 3, 0},   {0, 0, 2.5}, {4, 0, 2.5},
                  {4, 3, 2.5}, {0, 3, 2.5}, {1.5, 1, 2}, {2.5, 1, 2}, {2.5, 2, 2}, {1.5, 2, 2}};
    d.corners = {0, 1, 2, 3, 7, 6, 5, 4, 0, 4, 5, 1, 1, 5, 6, 2, 2, 6, 7, 3, 3, 7, 4, 0, 11, 10, 9, 8};
    d.corner_counts = {4, 4, 4, 4, 4, 4, 4};
    d.materials = {{"grey", exitance::api::Spectrum(0.5), exitance::api::Spectrum()},
                   {"lamp", exitance::api::Spectrum(), exitance::api::Spectrum(30)}};
    d.material = {0, 0, 0, 0, 0, 0, 1};
    d.groups = {"walls", "lamp"};
    d.group = {0, 0, 0, 0, 0, 0, 1};
    d.light_groups = light_groups;
    return exitance::api::make_scene(d);
}
