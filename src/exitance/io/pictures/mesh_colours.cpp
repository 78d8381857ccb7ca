#include "exitance/io/pictures/mesh_colours.hpp"

#include <algorithm>

namespace exitance {
namespace {

constexpr Rgb pure_white{255, 255, 255}, background{20, 20, 24};
constexpr Rgb lit{246, 226, 138}, penumbra{176, 122, 150}, umbra{58, 62, 110};
constexpr Rgb value_breaks{222, 30, 40}, slope_breaks{0, 150, 90}, curvature_breaks{40, 110, 245}, conic{170, 60, 200},
    border{0, 0, 0};

Rgb colour_of(ShadowClass c) {
    return c == ShadowClass::lit ? lit : c == ShadowClass::penumbra ? penumbra : umbra;
}

}  // namespace

Image shadow_class_image(const SixNodeMesh& mesh, const Scene& scene, const MeshView& view) {
    Image image(view.size.width, view.size.height);
    std::uint8_t* out = image.rgb.data();
    for (const MeshView::Pixel& pixel : view.pixels) {
        Rgb colour = background;
        if (!pixel.region.is_none() && scene.material(pixel.region).emits())
            colour = pure_white;
        else if (pixel.triangle != SixNodeLocator::none)
            colour = colour_of(mesh.shadow[pixel.triangle]);
        out = std::copy(colour.begin(), colour.end(), out);
    }
    return image;
}

std::vector<KeyEntry> shadow_class_key() {
    return {{"source", pure_white}, {"lit", lit}, {"penumbra", penumbra}, {"umbra", umbra}};
}

void draw_ordered_edges(Image& image, std::span<const std::optional<CurveOrder>> edges) {
    for (std::size_t i = 0; i < edges.size(); ++i) {
        if (!edges[i]) continue;
        std::uint8_t* pixel = image.rgb.data() + 3 * i;
        if (*edges[i] == CurveOrder::none) {
            for (std::size_t c = 0; c < 3; ++c) pixel[c] = static_cast<std::uint8_t>(pixel[c] / 4 * 3);
            continue;
        }
        const Rgb& colour = *edges[i] == CurveOrder::d0    ? value_breaks
                            : *edges[i] == CurveOrder::d1  ? slope_breaks
                            : *edges[i] == CurveOrder::d2  ? curvature_breaks
                            : *edges[i] == CurveOrder::eee ? conic
                                                           : border;
        std::copy(colour.begin(), colour.end(), pixel);
    }
}

std::vector<KeyEntry> edge_order_key() {
    return {{"D0: value", value_breaks},
            {"D1: slope", slope_breaks},
            {"D2: curvature", curvature_breaks},
            {"EEE: conic", conic}};
}

void draw_key(Image& image, std::span<const KeyEntry> key) {
    const int s = std::max(1, std::min(image.width / 600, image.height / 375));
    const int margin = 7 * s, row = 16 * s, swatch = 11 * s, size = 11 * s;
    int widest = 0;
    for (const KeyEntry& entry : key) widest = std::max(widest, text_width(entry.name, size));
    const int height = static_cast<int>(key.size()) * row + 2 * margin;
    fill_rectangle(image, margin, margin, widest + swatch + 3 * margin, height, background);
    int y = 2 * margin;
    for (const KeyEntry& entry : key) {
        fill_rectangle(image, 2 * margin, y, swatch, swatch, entry.colour);
        draw_text(image, 3 * margin + swatch, y + 2 * s, entry.name, size, pure_white);
        y += row;
    }
}

}  // namespace exitance
