#include "exitance/what_if/daylight/daylight_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/base/random.hpp"
#include "exitance/form_factors/met_directions.hpp"
#include "exitance/scene/photometric_units.hpp"
#include "exitance/transport/ray_rows.hpp"
#include "exitance/visibility/glazed_part.hpp"
#include "exitance/what_if/daylight/sensor_places.hpp"

namespace exitance {
namespace {

constexpr std::size_t max_sweeps = 200;
constexpr double max_change = 2e-4;  ///< Relative RMS change of a sweep.

/// Ends of an element's rays: leaves or patches of the sky, with their share of the rays.
struct Row {
    std::vector<std::pair<std::uint32_t, float>> leaves, patches;
};

/// The elements of the transport.
struct DaylightElements {
    DaylightElements(const Stage& stage, double count)
        : tree(stage.make_elements({.edge = edge_for_elements(stage.pieces, static_cast<std::size_t>(count))})),
          numbering(tree),
          locator(tree, stage.scene.regions().size()) {}

    ElementTree tree;
    LeafNumbering numbering;
    ElementLocator locator;
};

/// Meaning of the columns of a matrix: each is a patch of the sky, or one column is the sum of all under a given sky.
struct Columns {
    std::size_t count = 0;
    std::span<const double> sky, reflected;  ///< Luminances of the patches of the one column; empty for a column each.

    std::size_t of(std::size_t patch) const { return sky.empty() ? patch : 0; }
    double weight_of_sky(std::size_t patch) const { return sky.empty() ? 1 : sky[patch]; }
    double weight_of_reflected(std::size_t patch) const { return sky.empty() ? 1 : reflected[patch]; }
};

/// One replicate: reflected light on the elements, found by rays of its own.
class MatrixMaker {
  public:
    MatrixMaker(const Stage& stage, const SkyPatches& patches, const Columns& columns, const DaylightElements& elements,
                const DaylightOptions& options)
        : stage_(stage),
          patches_(patches),
          columns_(columns),
          options_(options),
          tree_(elements.tree),
          numbering_(elements.numbering),
          locator_(elements.locator) {}

    void cast_rows() {
        const std::vector<double> area = leaf_areas(tree_, numbering_);
        double all = 0;
        for (const double a : area) all += a;
        // A replicate has few rays of its own; more than its share would make small elements dear.
        const RayBudget budget{.average = options_.rays_an_element, .least = 2};
        rows_.resize(area.size());
        parallel_ranges(area.size(), 16, [&](std::size_t begin, std::size_t end) {
            Ends ends;
            for (std::size_t i = begin; i < end; ++i) {
                const ElementId e = numbering_.leaves[i];
                const unsigned rays = budget.rays(area[i], all / static_cast<double>(area.size()));
                const Patch& patch = tree_.patch(e);
                const std::uint64_t key = hash(options_.seed, static_cast<std::uint64_t>(Stream::rows), i);
                cast(rays, key, tree_.region(e), tree_.region(e), stage_.scene.regions()[tree_.region(e)].plane.n, ends,
                     [&](double u, double v) { return patch.at(tree_.uniform(e, u, v)); });
                count(ends.leaves, rays, rows_[i].leaves);
                count(ends.patches, rays, rows_[i].patches);
            }
        });
    }

    /// Solves for rho E of every leaf and every column. Returns the number of sweeps.
    std::size_t solve() {
        const std::size_t n = rows_.size(), m = columns_.count;
        std::vector<float> rho(n), fresh(n * m);
        for (std::size_t i = 0; i < n; ++i)
            rho[i] =
                static_cast<float>(luminous_sum(stage_.scene.material(tree_.region(numbering_.leaves[i])).reflectance));
        reflected_.assign(n * m, 0);
        for (std::size_t sweep = 1; sweep <= max_sweeps; ++sweep) {
            parallel_for(n, 16, [&](std::size_t i) {
                const std::span<float> out(&fresh[i * m], m);
                std::fill(out.begin(), out.end(), 0.0f);
                if (rho[i] == 0) return;
                for (const auto& [patch, share] : rows_[i].patches)
                    out[columns_.of(patch)] += static_cast<float>(pi * columns_.weight_of_reflected(patch)) * share;
                add(rows_[i].leaves, out);
                for (float& v : out) v *= rho[i];
            });
            struct Norms {
                double change = 0, size = 0;
                Norms& operator+=(const Norms& o) { return change += o.change, size += o.size, *this; }
            };
            const Norms norms = parallel_sum<Norms>(n * m, [&](std::size_t k) {
                const double change = double(fresh[k]) - double(reflected_[k]);
                return Norms{change * change, double(fresh[k]) * double(fresh[k])};
            });
            reflected_.swap(fresh);
            if (norms.change <= max_change * max_change * norms.size) return sweep;
        }
        return max_sweeps;
    }

    /// Gathers reflected light at a sensor.
    void gather(const Receiver& sensor, std::size_t number, std::span<float> out) const {
        Ends ends;
        std::vector<std::pair<std::uint32_t, float>> leaves;
        cast(options_.rays_a_sensor, hash(options_.seed, static_cast<std::uint64_t>(Stream::gather), number),
             sensor.own, RegionId(), sensor.n, ends, [&](double, double) { return sensor.x; });
        count(ends.leaves, options_.rays_a_sensor, leaves);
        std::fill(out.begin(), out.end(), 0.0f);
        add(leaves, out);
    }

  private:
    struct Ends {
        std::vector<Point> origins;
        std::vector<Vec3> directions;
        std::vector<RayHit> hits;
        std::vector<std::uint32_t> leaves, patches;
    };

    /// `sides`: the region if rays leave a diffusing pane from both sides, otherwise none.
    template <class Place>
    void cast(unsigned rays, std::uint64_t key, RegionId own, RegionId sides, const Normal& n, Ends& ends,
              const Place& place) const {
        const ScrambledSobol points(key);
        ends.origins.clear(), ends.directions.clear(), ends.leaves.clear(), ends.patches.clear();
        for (std::uint32_t k = 0; k < rays; ++k) {
            ends.origins.push_back(place(points(k, 2), points(k, 3)));
            ends.directions.push_back(met_direction(stage_.scene, sides, n, points(k, 0), points(k, 1)));
        }
        ends.hits.resize(rays);
        stage_.tracer.nearest(ends.origins, ends.directions, own, ends.hits, Mirrored::followed);
        for (std::size_t k = 0; k < rays; ++k) {
            const RayHit& hit = ends.hits[k];
            if (hit.surface.is_none())
                ends.patches.push_back(static_cast<std::uint32_t>(
                    patches_.of(normalized(arriving(stage_.scene, hit, ends.directions[k])))));
            else if (hit.front)
                ends.leaves.push_back(
                    locator_.find_leaf(hit.region, place_of(stage_.scene, hit, ends.origins[k], ends.directions[k]))
                        .leaf);
        }
    }

    static void count(std::vector<std::uint32_t>& numbers, unsigned rays,
                      std::vector<std::pair<std::uint32_t, float>>& out) {
        std::sort(numbers.begin(), numbers.end());
        out.clear();
        for (const std::uint32_t number : numbers) {
            if (number == ElementLocator::no_leaf) continue;
            if (out.empty() || out.back().first != number) out.push_back({number, 0.0f});
            out.back().second += 1.0f / static_cast<float>(rays);
        }
    }

    void add(std::span<const std::pair<std::uint32_t, float>> leaves, std::span<float> out) const {
        const std::size_t m = out.size();
        for (const auto& [leaf, share] : leaves) {
            const float* from = &reflected_[leaf * m];
            for (std::size_t k = 0; k < m; ++k) out[k] += share * from[k];
        }
    }

    const Stage& stage_;
    const SkyPatches& patches_;
    const Columns& columns_;
    const DaylightOptions options_;
    const ElementTree& tree_;
    const LeafNumbering& numbering_;
    const ElementLocator& locator_;
    std::vector<Row> rows_;
    std::vector<float> reflected_;  ///< rho E, one row per leaf.
};

/// Directions of a patch's facet, bounded by planes through the sensor.
struct Cone {
    std::vector<Vec3> inward;
    std::uint32_t patch = 0;
    bool below = false;
};

std::vector<Cone> cones_of(const SkyPatches& patches) {
    std::vector<Cone> out;
    for (std::size_t i = 0; i < patches.facets().size(); ++i) {
        const std::vector<Vec3>& corners = patches.facets()[i].corners;
        Cone cone{{}, patches.patch_of_facet()[i], patches.patch_of_facet()[i] == 0};
        for (std::size_t k = 0; k < corners.size(); ++k)
            cone.inward.push_back(normalized(cross(corners[k + 1 == corners.size() ? 0 : k + 1], corners[k])));
        out.push_back(std::move(cone));
    }
    return out;
}

/// Clips a convex polygon to a cone, in place; empty if they do not overlap.
void clip_to(const Cone& cone, std::vector<Vec3>& polygon, std::vector<Vec3>& room) {
    for (const Vec3& n : cone.inward)
        if (std::all_of(polygon.begin(), polygon.end(), [&](const Vec3& r) { return dot(n, r) <= 0; }))
            return polygon.clear();
    for (const Vec3& n : cone.inward) {
        room.clear();
        for (std::size_t i = 0, m = polygon.size(); i < m; ++i) {
            const Vec3 &p = polygon[i], &q = polygon[i + 1 == m ? 0 : i + 1];
            const double a = dot(n, p), b = dot(n, q);
            if (a >= 0) room.push_back(p);
            if ((a > 0 && b < 0) || (a < 0 && b > 0)) room.push_back(p + (a / (a - b)) * (q - p));
        }
        polygon.swap(room);
        if (polygon.size() < 3) return polygon.clear();
    }
}

/// Exact visible part of every patch at a sensor: visible parts of the upper and lower half of the sky, clipped to the
/// patches.
class PatchView {
  public:
    PatchView(const Stage& stage, const std::vector<Cone>& cones, const Columns& columns)
        : stage_(stage), cones_(cones), columns_(columns) {}

    void see(const Receiver& at, const Spectrum& weights, std::span<float> out) {
        std::fill(out.begin(), out.end(), 0.0f);
        const Occluders& occluders = stage_.occluders;
        for (const PieceId piece : occluders.distant_pieces()) {
            visible_fragments(occluders, at, piece, {}, scratch_, fragments_);
            for (const std::vector<Vec3>& fragment : fragments_) {
                double lowest = 0;
                for (const Vec3& r : fragment) lowest = std::min(lowest, r.z / norm(r));
                constexpr double rounding = 1e-9;
                for (const Cone& cone : cones_) {
                    if (cone.below != (lowest < -rounding)) continue;
                    part_ = fragment;
                    clip_to(cone, part_, room_);
                    if (part_.empty()) continue;
                    const Spectrum F = transmitted_form_factor(occluders, at, piece, part_, {});
                    for (std::size_t b = 0; b < bands; ++b)
                        out[columns_.of(cone.patch)] +=
                            static_cast<float>(pi * columns_.weight_of_sky(cone.patch) * weights[b] * F[b]);
                }
            }
        }
    }

  private:
    const Stage& stage_;
    const std::vector<Cone>& cones_;
    const Columns& columns_;
    VisibilityWorkspace scratch_;
    Fragments fragments_;
    std::vector<Vec3> part_, room_;
};

/// The settings of one replicate.
DaylightOptions share_of(DaylightOptions options, std::size_t replicate) {
    options.seed = hash(options.seed, replicate);
    options.rays_an_element /= static_cast<double>(daylight_replicates);
    options.rays_a_sensor = std::max<unsigned>(1, options.rays_a_sensor / daylight_replicates);
    return options;
}

DaylightMatrix make_columns(Scene scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                            const Columns& columns, const DaylightOptions& options, Progress& progress) {
    DistantLight light;
    SkyModel below = uniform_sky();
    below.below = true;
    light.domes = {{uniform_sky(), Spectrum(pi)}, {below, Spectrum(pi)}};
    scene.put_under(std::move(light));
    progress.phase("rays");
    Stage stage(scene);
    stage.rooms = find_light_rooms(stage, options.seed, StopRequest());
    const DaylightElements elements(stage, options.elements);
    std::vector<MatrixMaker> makers;
    for (std::size_t k = 0; k < daylight_replicates; ++k)
        makers.emplace_back(stage, patches, columns, elements, share_of(options, k)).cast_rows();
    progress.phase("solve");
    for (MatrixMaker& maker : makers) maker.solve();
    progress.phase("sensors");
    DaylightMatrix out;
    const std::size_t m = out.patches = columns.count;
    out.direct.resize(sensors.size() * m), out.reflected.resize(sensors.size() * m);
    for (std::vector<float>& replicate : out.replicates) replicate.resize(sensors.size() * m);
    const std::vector<Receiver> places = sensor_places(scene, stage.occluders, sensors);
    const Spectrum weights = luminous_weights();
    const std::vector<Cone> cones = cones_of(patches);
    parallel_ranges(sensors.size(), 4, [&](std::size_t begin, std::size_t end) {
        PatchView view(stage, cones, columns);
        for (std::size_t i = begin; i < end; ++i) {
            view.see(places[i], weights, std::span(&out.direct[i * m], m));
            for (std::size_t k = 0; k < daylight_replicates; ++k) {
                const std::span<float> row(&out.replicates[k][i * m], m);
                makers[k].gather(places[i], i, row);
                for (std::size_t p = 0; p < m; ++p)
                    out.reflected[i * m + p] += row[p] / static_cast<float>(daylight_replicates);
            }
        }
    });
    return out;
}

}  // namespace

DaylightMatrix make_daylight_matrix(Scene scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                                    const DaylightOptions& options, Progress& progress) {
    return make_columns(std::move(scene), sensors, patches, {patches.size(), {}, {}}, options, progress);
}

DaylightMatrix make_daylight_column(Scene scene, std::span<const ProbePoint> sensors, const SkyPatches& patches,
                                    std::span<const double> sky, std::span<const double> reflected,
                                    const DaylightOptions& options, Progress& progress) {
    EXI_CHECK(sky.size() == patches.size() && reflected.size() == patches.size());
    return make_columns(std::move(scene), sensors, patches, {1, sky, reflected}, options, progress);
}

}  // namespace exitance
