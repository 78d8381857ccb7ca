#include "exitance/lab/layers/light_layers.hpp"

#include <algorithm>

#include "exitance/base/archive.hpp"

namespace exitance {

std::size_t LightLayers::size() const {
    std::size_t sum = 0;
    for (const Sheet& sheet : sheets) sum += sheet.light.size();
    return sum;
}

std::size_t LightLayers::memory_bytes() const {
    std::size_t sum = 0;
    for (const Sheet& sheet : sheets) sum += sheet.light.memory_bytes();
    return sum;
}

Spectrum light_at(const LightLayers& layers, const Scene& scene, RegionId region, const Point& p) {
    Spectrum sum;
    if (region.is_none()) return sum;
    const auto of_region = [&](const LightLayers::Sheet& sheet) { return sheet.region.value < region.value; };
    auto sheet = std::partition_point(layers.sheets.begin(), layers.sheets.end(), of_region);
    if (sheet == layers.sheets.end() || sheet->region != region) return sum;
    const Vec2 place = layer_place(scene.regions()[region], p);
    for (; sheet != layers.sheets.end() && sheet->region == region; ++sheet)
        sum += sheet->light.at(place) * sheet->colour;
    return sum;
}

LayersForm::LayersForm(LightLayers layers) : layers_(std::move(layers)), first_{0} {
    for (const LightLayers::Sheet& sheet : layers_.sheets) first_.push_back(first_.back() + sheet.light.size());
}

QuadraticTriangle LayersForm::triangle(const Scene& scene, std::size_t i, const Spectrum& weight) const {
    const auto after = std::upper_bound(first_.begin(), first_.end(), i);
    const auto s = static_cast<std::size_t>(after - first_.begin()) - 1;
    const LightLayers::Sheet& sheet = layers_.sheets[s];
    const auto t = static_cast<std::uint32_t>(i - first_[s]);
    const Region& region = scene.regions()[sheet.region];
    const Frame frame(region.plane.n);
    const std::array<Vec2, 3> corners = sheet.light.corners(t);
    const Spectrum colour = weight * sheet.colour;
    QuadraticTriangle out{.region = sheet.region, .corners = {}, .values = {}};
    for (std::size_t k = 0; k < 3; ++k)
        out.corners[k] = region.loops.front().front() + corners[k].x * frame.u + corners[k].y * frame.v;
    constexpr Vec2 nodes[6] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};
    for (std::size_t k = 0; k < 6; ++k) out.values[k] = sheet.light.at(t, nodes[k]) * colour;
    return out;
}

namespace {

template <class Archive>
void archive_layers(Archive& a, LightLayers& layers) {
    a(layers.sources);
    std::size_t count = archive_size(a, layers.sheets.size(), 1);
    for (std::size_t i = 0; i < count; ++i) {
        LightLayers::Sheet sheet{.region = {}, .source = 0, .colour = {}, .light = LightLayer(LightLayer::Contents())};
        LightLayer::Contents c;
        if constexpr (!Archive::reads) sheet = layers.sheets[i], c = sheet.light.contents();
        a(sheet.region, sheet.source, sheet.colour, c.form, c.lo, c.size, c.scale, c.vertices, c.edges, c.faces);
        a(c.half_vertices, c.half_edges, c.narrow, c.wide);
        if constexpr (Archive::reads) {
            sheet.light = LightLayer(std::move(c));
            sheet.light.make_grid();
            layers.sheets.push_back(std::move(sheet));
        }
    }
}

}  // namespace

std::string LayersForm::packed() const {
    ArchiveWriter writer;
    LightLayers copy = layers_;
    archive_layers(writer, copy);
    return writer.take();
}

LightFormPointer LayersForm::unpack(std::string_view bytes) {
    ArchiveReader reader(bytes);
    LightLayers layers;
    archive_layers(reader, layers);
    return std::make_shared<LayersForm>(std::move(layers));
}

const LightLayers& layers_of(const Solution& solution) {
    static const LightLayers none;
    const auto* form = dynamic_cast<const LayersForm*>(solution.layers.get());
    return form ? form->layers() : none;
}

Vec2 layer_place(const Region& region, const Point& p) {
    const Frame frame(region.plane.n);
    const Vec3 d = p - region.loops.front().front();
    return {dot(frame.u, d), dot(frame.v, d)};
}

}  // namespace exitance
