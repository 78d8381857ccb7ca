#include "exitance/lab/layers/source_layers.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>

#include "exitance/base/parallel.hpp"
#include "exitance/calibration/numbers.hpp"
#include "exitance/discontinuity/exact_places.hpp"
#include "exitance/lab/layers/winged_edge_bytes.hpp"
#include "exitance/methods/light/mesh_of_layers.hpp"
#include "exitance/scene/emitter_groups.hpp"
#include "exitance/what_if/light_groups/group_direct.hpp"
#include "exitance/what_if/light_groups/light_groups.hpp"

namespace exitance {
namespace {

/// The source of one layer: an emitter, or other emitters together.
struct LayerSource {
    RegionId region;                      ///< Region that emits; none for other emitters.
    std::vector<std::uint32_t> emitters;  ///< Emitters of the scene with this source's lights only.
    std::string group;                    ///< Light group; empty if it has several.
    const Scene* lit;                     ///< The scene with the lights of this group only, or with all lights.
};

/// The sources of a stage's layers, and the scenes of single light groups that they need.
class LayerSources {
  public:
    explicit LayerSources(const Stage& stage) : stage_(stage) {
        const DirectLight& direct = stage.direct;
        const std::vector<EmitterGroup> groups = separate_groups();
        for (const std::uint32_t e : brightest()) {
            const RegionId region = direct.emitters()[e].region;
            sources_.push_back({region, {e}, group_of(groups, region), &stage.scene});
            is_single_.insert(region.value);
        }
        const bool has_rest = direct.emitters().size() > is_single_.size() || !direct.beams().empty();
        if (!has_rest) return;
        if (groups.size() < 2) {
            add_rest(direct, groups.empty() ? std::string() : groups.front().name, stage.scene);
            return;
        }
        for (const EmitterGroup& group : groups) {
            const Scene& lit = *scenes_.emplace_back(std::make_unique<Scene>(alone(stage.scene, group)));
            add_rest(DirectLight(lit, stage.occluders), group.name, lit);
        }
    }

    const std::vector<LayerSource>& all() const { return sources_; }

  private:
    /// Light groups, if each emitting material belongs to a single one of them.
    std::vector<EmitterGroup> separate_groups() const {
        std::vector<EmitterGroup> groups = find_emitter_groups(stage_.scene);
        std::set<std::uint32_t> known;
        for (const EmitterGroup& group : groups)
            for (const MaterialId m : group.materials)
                if (!known.insert(m.value).second) return {};
        return groups.size() <= max_light_groups ? std::move(groups) : std::vector<EmitterGroup>();
    }

    std::string group_of(const std::vector<EmitterGroup>& groups, RegionId region) const {
        const MaterialId material = stage_.scene.regions()[region].material;
        for (const EmitterGroup& group : groups)
            if (std::find(group.materials.begin(), group.materials.end(), material) != group.materials.end())
                return group.name;
        return {};
    }

    /// The emitters that get a layer of their own, in the order of the scene.
    std::vector<std::uint32_t> brightest() const {
        constexpr std::size_t max_single_layers = 64;  // limit, since each layer processes all regions
        const auto& emitters = stage_.direct.emitters();
        const auto power = [&](std::uint32_t e) {
            return mean(emitters[e].exitance) * stage_.scene.regions()[emitters[e].region].area;
        };
        std::vector<std::uint32_t> out;
        for (std::uint32_t e = 0; e < emitters.size(); ++e)
            if (!stage_.direct.is_distant(e)) out.push_back(e);
        std::stable_sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) { return power(a) > power(b); });
        if (out.size() > max_single_layers) out.resize(max_single_layers);
        std::sort(out.begin(), out.end());
        return out;
    }

    /// Adds one source for all emitters and punctual lights of a scene that have no layer of their own.
    void add_rest(const DirectLight& direct, std::string group, const Scene& lit) {
        LayerSource rest{RegionId(), {}, std::move(group), &lit};
        for (std::uint32_t e = 0; e < direct.emitters().size(); ++e)
            if (direct.is_distant(e) || !is_single_.contains(direct.emitters()[e].region.value))
                rest.emitters.push_back(e);
        if (!rest.emitters.empty() || !direct.beams().empty()) sources_.push_back(std::move(rest));
    }

    const Stage& stage_;
    std::set<std::uint32_t> is_single_;  ///< Regions that have a layer of their own.
    std::vector<std::unique_ptr<const Scene>> scenes_;
    std::vector<LayerSource> sources_;
};

/// A region's triangles in its own plane, once per band; only the values differ.
std::array<LayerTriangles, bands> flat_triangles(const SixNodeMesh& mesh, std::span<const std::uint32_t> triangles,
                                                 const Region& region) {
    std::array<LayerTriangles, bands> out;
    std::map<std::uint32_t, std::uint32_t> number;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_of;
    const auto add = [&](std::uint32_t node) {
        const auto id = static_cast<std::uint32_t>(out[0].points.size());
        for (std::size_t b = 0; b < bands; ++b) {
            out[b].points.push_back(layer_place(region, mesh.points[node]));
            out[b].values.push_back(static_cast<double>(mesh.values[node][b]));
        }
        return id;
    };
    for (const std::uint32_t t : triangles) {
        const auto& n = mesh.nodes[t];
        std::array<std::uint32_t, 3> corner;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [at, is_new] = number.try_emplace(n[k], 0);
            if (is_new) at->second = add(n[k]);
            corner[k] = at->second;
        }
        // If light jumps across an edge between two shared corners, this side gets corners of its own.
        for (std::size_t k = 0; k < 3; ++k) {
            const auto ends = std::minmax(corner[k], corner[(k + 1) % 3]);
            if (middle_of.try_emplace(ends, n[3 + k]).first->second != n[3 + k])
                corner[k] = add(n[k]), corner[(k + 1) % 3] = add(n[(k + 1) % 3]);
        }
        for (std::size_t b = 0; b < bands; ++b) {
            out[b].corners.push_back(corner);
            auto& middle = out[b].middles.emplace_back();
            for (std::size_t k = 0; k < 3; ++k) middle[k] = static_cast<double>(mesh.values[n[3 + k]][b]);
        }
    }
    return out;
}

/// If all light has the same colour, stores its mean over the bands in band 0 and returns true with that colour.
bool join_bands(std::array<LayerTriangles, bands>& of_band, Spectrum& colour) {
    constexpr double rounding = 1e-6;  // relative rounding error of 32-bit floats
    Spectrum sum;
    double largest = 0;
    const auto for_all = [&](const auto& visit) {
        for (std::size_t p = 0; p < of_band[0].values.size(); ++p)
            visit([&](std::size_t b) -> double& { return of_band[b].values[p]; });
        for (std::size_t t = 0; t < of_band[0].middles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                visit([&](std::size_t b) -> double& { return of_band[b].middles[t][k]; });
    };
    for_all([&](const auto& value) {
        for (std::size_t b = 0; b < bands; ++b) sum[b] += value(b), largest = std::max(largest, std::abs(value(b)));
    });
    if (!(mean(sum) > 0)) return false;
    colour = sum / mean(sum);
    bool alike = true;
    for_all([&](const auto& value) {
        double light = 0;
        for (std::size_t b = 0; b < bands; ++b) light += value(b) / static_cast<double>(bands);
        for (std::size_t b = 0; b < bands; ++b) alike &= std::abs(value(b) - colour[b] * light) <= rounding * largest;
    });
    if (!alike) return false;
    for_all([&](const auto& value) {
        double light = 0;
        for (std::size_t b = 0; b < bands; ++b) light += value(b) / static_cast<double>(bands);
        value(0) = light;
    });
    return true;
}

std::vector<std::vector<std::uint32_t>> triangles_by_region(const SixNodeMesh& mesh, std::size_t regions) {
    std::vector<std::vector<std::uint32_t>> out(regions);
    for (std::uint32_t t = 0; t < mesh.size(); ++t) out[mesh.region[t].value].push_back(t);
    return out;
}

void add_sheets(const SixNodeMesh& mesh, const Scene& scene, std::uint32_t source, LightLayer::Form form,
                std::vector<LightLayers::Sheet>& out, LayersReport& report) {
    const std::size_t regions = scene.regions().size();
    const auto of_region = triangles_by_region(mesh, regions);
    std::vector<std::vector<LightLayers::Sheet>> made(regions);
    parallel_for(regions, 16, [&](std::size_t r) {
        if (of_region[r].empty()) return;
        const RegionId region(static_cast<std::uint32_t>(r));
        std::array<LayerTriangles, bands> flat = flat_triangles(mesh, of_region[r], scene.regions()[region]);
        Spectrum colour;
        const bool one = join_bands(flat, colour);
        for (std::size_t b = 0; b < (one ? 1 : bands); ++b) {
            if (!one) colour = Spectrum(), colour[b] = 1;
            LightLayer light(flat[b], form);
            if (light.size() == 0) continue;
            light.make_grid();
            made[r].push_back({region, source, colour, std::move(light)});
        }
    });
    for (auto& sheets : made)
        for (LightLayers::Sheet& sheet : sheets) out.push_back(std::move(sheet));
    report.triangles += mesh.size(), report.winged_edge_bytes += winged_edge_bytes(mesh);
}

/// Adds the numbers and times of one mesh to those of all meshes.
void add_report(const DiscontinuityReport& own, LayersReport& sum) {
    DiscontinuityCounts& counts = sum.counts;
    const auto before = static_cast<double>(counts.triangles), more = static_cast<double>(own.counts.triangles);
    if (before + more > 0) {
        counts.mean_radius_ratio =
            (before * counts.mean_radius_ratio + more * own.counts.mean_radius_ratio) / (before + more);
        sum.candidate_share = (before * sum.candidate_share + more * own.candidate_share) / (before + more);
    }
    for (std::size_t DiscontinuityCounts::*const count :
         {&DiscontinuityCounts::d0, &DiscontinuityCounts::d1, &DiscontinuityCounts::d2, &DiscontinuityCounts::eee,
          &DiscontinuityCounts::left_out, &DiscontinuityCounts::wedges, &DiscontinuityCounts::lit,
          &DiscontinuityCounts::penumbra, &DiscontinuityCounts::umbra, &DiscontinuityCounts::triangles})
        counts.*count += own.counts.*count;
    sum.plane_tests += own.plane_tests, sum.fragments += own.fragments, sum.tree_bytes += own.tree_bytes;
    sum.mesh_seconds += own.mesh_seconds, sum.direct_seconds += own.direct_seconds;
    sum.parallel += own.parallel;
}

void sort_by_region(std::vector<LightLayers::Sheet>& sheets) {
    std::stable_sort(sheets.begin(), sheets.end(),
                     [](const auto& a, const auto& b) { return a.region.value < b.region.value; });
}

}  // namespace

LightLayers make_light_layers(const Stage& stage, const DiscontinuityOptions& options, LayersReport& report,
                              const StopRequest& stop, const ShowLayers& show) {
    const double share = calibrated::layers_share;
    constexpr double rounding_of_halves = 1.0 / 2048;
    const ExactPlaces places(stage, options.direct_weight, options.indirect, options.seed, stop);
    const LayerSources sources(stage);
    const LightLayer::Form form =
        4 * rounding_of_halves <= options.error ? LightLayer::Form::halves : LightLayer::Form::floats;
    Stage alone(stage.scene);
    const double together = std::sqrt(static_cast<double>(std::max<std::size_t>(1, sources.all().size())));
    DiscontinuityOptions one = options;
    one.indirect = {}, one.direct_weight = Spectrum(1.0), one.secondary = {}, one.safe_points = nullptr;
    one.scale = places.mean_light(), one.brightest = places.largest_light();
    one.error = share * options.error / together, one.largest_error = share * options.largest_error / together;
    LightLayers out;
    constexpr int max_attempts = 4;
    for (int attempt = 1;; ++attempt) {
        const double mesh_seconds = report.mesh_seconds, direct_seconds = report.direct_seconds;
        report = {}, out = {};
        report.mesh_seconds = mesh_seconds, report.direct_seconds = direct_seconds;
        for (const LayerSource& source : sources.all()) {
            alone.direct = DirectLight(*source.lit, alone.occluders);
            alone.direct.keep_only(source.emitters, source.region.is_none());
            DiscontinuityReport own;
            const SixNodeMesh mesh = make_discontinuity_mesh(alone, one, own, stop);
            report.interrupted = own.interrupted;
            if (own.interrupted) return {};
            add_sheets(mesh, stage.scene, static_cast<std::uint32_t>(out.sources.size()), form, out.sheets, report);
            add_report(own, report);
            out.sources.push_back(source.region), out.groups.push_back(source.group), out.factors.push_back(1);
            sort_by_region(out.sheets);
            if (show && attempt == 1) show(std::make_shared<LayersForm>(out));
        }
        const double error = places.error([&](RegionId r, const Point& p) {
            const Spectrum light = options.direct_weight * light_at(out, stage.scene, r, p);
            return options.indirect ? light + options.indirect(r, p) : light;
        });
        report.error = places.mean_light() > 0 ? error / places.mean_light() : 0;
        if (report.error <= share * options.error || attempt == max_attempts) return out;
        one.error *= calibrated::attempt_aim * share * options.error / report.error;
    }
}

LayeredLight make_layered_light(const Stage& stage, const DiscontinuityOptions& options, const SolveOptions& solve,
                                const ShowLayers& show, const StopRequest& stop) {
    LayersReport report;
    LightLayers layers = make_light_layers(stage, options, report, stop, show);
    LayeredLight out{.form = {}, .report = report};
    if (layers.empty()) return out;
    layers.mesh = describe_mesh(solve);
    out.figures = {{"layer_bytes", static_cast<double>(layers.memory_bytes())},
                   {"winged_edge_bytes", static_cast<double>(report.winged_edge_bytes)},
                   {"layers", static_cast<double>(layers.sources.size())},
                   {"layer_triangles", static_cast<double>(report.triangles)},
                   {"lit_layer_triangles", static_cast<double>(layers.size())}};
    out.form = std::make_shared<LayersForm>(std::move(layers));
    return out;
}

}  // namespace exitance
