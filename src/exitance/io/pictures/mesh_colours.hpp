#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/io/pictures/png.hpp"
#include "exitance/io/pictures/text.hpp"
#include "exitance/measure/pictures/mesh_view.hpp"

namespace exitance {

/// A colour of a legend with its meaning.
struct KeyEntry {
    std::string name;  ///< Text in ASCII.
    Rgb colour;
};

/// Draws faces in full light, in penumbra and in umbra, and emitters, each in one colour. Backs of surfaces and pixels
/// without a surface are nearly black.
Image shadow_class_image(const SixNodeMesh& mesh, const Scene& scene, const MeshView& view);
std::vector<KeyEntry> shadow_class_key();

/// Draws edges in the colours of their orders; edges without a discontinuity are faint.
void draw_ordered_edges(Image& image, std::span<const std::optional<CurveOrder>> edges);
std::vector<KeyEntry> edge_order_key();

/// Draws a legend into the upper left corner.
void draw_key(Image& image, std::span<const KeyEntry> key);

}  // namespace exitance
