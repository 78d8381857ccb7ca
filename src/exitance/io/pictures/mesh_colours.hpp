#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exitance/io/pictures/bitmap_font.hpp"
#include "exitance/io/pictures/png.hpp"
#include "exitance/measure/pictures/mesh_view.hpp"

namespace exitance {

/// A colour and what it means.
struct KeyEntry {
    std::string name;  ///< Small letters and digits.
    Rgb colour;
};

/// Faces in full light, penumbra and umbra, and emitters, each in a plain colour; backs of surfaces and what shows none
/// are nearly black.
Image shadow_class_image(const SixNodeMesh& mesh, const Scene& scene, const MeshView& view);
std::vector<KeyEntry> shadow_class_key();

/// Draws edges in the colours of their orders, those that no event made faintly.
void draw_ordered_edges(Image& image, std::span<const std::optional<CurveOrder>> edges);
std::vector<KeyEntry> edge_order_key();

/// Draws what colours mean into the upper left corner.
void draw_key(Image& image, std::span<const KeyEntry> key);

}  // namespace exitance
