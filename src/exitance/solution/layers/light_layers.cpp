#include "exitance/solution/layers/light_layers.hpp"

#include <algorithm>
#include <charconv>

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

namespace {

/// Sum of the layers whose sources are wanted at a point of a region: irradiance, W/m^2.
template <class IsWanted>
Spectrum sum_of_layers(const LightLayers& layers, const Scene& scene, RegionId region, const Point& p,
                       const IsWanted& is_wanted) {
    Spectrum sum;
    if (region.is_none()) return sum;
    const auto of_region = [&](const LightLayers::Sheet& sheet) { return sheet.region.value < region.value; };
    auto sheet = std::partition_point(layers.sheets.begin(), layers.sheets.end(), of_region);
    if (sheet == layers.sheets.end() || sheet->region != region) return sum;
    const Vec2 place = layer_place(scene.regions()[region], p);
    for (; sheet != layers.sheets.end() && sheet->region == region; ++sheet)
        if (is_wanted(sheet->source)) sum += layers.factor(sheet->source) * sheet->light.at(place) * sheet->colour;
    return sum;
}

}  // namespace

Spectrum light_at(const LightLayers& layers, const Scene& scene, RegionId region, const Point& p) {
    return sum_of_layers(layers, scene, region, p, [](std::uint32_t) { return true; });
}

Spectrum light_at(const LightLayers& layers, const Scene& scene, RegionId region, const Point& p,
                  std::span<const std::uint32_t> among) {
    return sum_of_layers(layers, scene, region, p,
                         [&](std::uint32_t source) { return std::binary_search(among.begin(), among.end(), source); });
}

std::vector<std::uint32_t> named_sources(const LightLayers& layers, const Scene& scene, const std::string& word) {
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool is_number = error == std::errc() && end == word.data() + word.size();
    std::vector<std::uint32_t> out;
    for (std::uint32_t i = 0; i < layers.sources.size(); ++i) {
        const RegionId r = layers.sources[i];
        const bool is_named =
            r.is_none() ? word == "others" || (i < layers.groups.size() && layers.groups[i] == word)
                        : scene.material(r).name == word ||
                              scene.groups()[scene.surfaces()[scene.regions()[r].surfaces.front()].group] == word;
        if (is_number ? i + 1 == number : is_named && !word.empty()) out.push_back(i);
    }
    return out;
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
    const Spectrum colour = layers_.factor(sheet.source) * weight * sheet.colour;
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
    a(layers.sources, layers.groups, layers.factors, layers.mesh);
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

LightFormPointer LayersForm::dimmed(GroupFactors factors) const {
    LightLayers out = layers_;
    out.factors.assign(out.sources.size(), 1.0);
    for (std::size_t i = 0; i < out.sources.size(); ++i) {
        const std::string group = i < out.groups.size() ? out.groups[i] : std::string();
        const auto known =
            std::find_if(factors.begin(), factors.end(), [&](const auto& f) { return f.first == group; });
        if (group.empty() || known == factors.end()) return {};
        out.factors[i] = known->second;
    }
    return std::make_shared<LayersForm>(std::move(out));
}

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
