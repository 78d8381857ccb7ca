#pragma once

#include "exitance/io/scenes/scene_file.hpp"

namespace exitance {

/// A choice of panes. Empty: all panes.
struct PaneChoice {
    std::vector<std::string> materials, objects;  ///< Accepted materials and objects: a pane needs one of them.
    std::optional<Box> box;                       ///< Box in which a pane must lie, metres; empty: anywhere.
};

/// Returns whether each pane of the scene belongs to a choice. `named`: the panes before they were cut into convex
/// ones.
std::vector<bool> chosen_panes(const PaneChoice& choice, const Scene& scene, std::span<const NamedPane> named);

}  // namespace exitance
