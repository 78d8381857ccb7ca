#include <fmt/format.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/lab/growing_cells/cells_method.hpp"

namespace exitance {
namespace {

constexpr std::size_t least_units = 8, usual_least = 256, usual_most = 2048;
constexpr std::size_t least_pool = 1 << 15, points_a_unit = 64;  ///< Of the pool that samples come from.

/// Light of the cells on the leaves of the projection: linear and bilinear, for all that reads elements.
void put_on_elements(const Stage& stage, const CellFunction& E, GlobalLight& light) {
    const std::size_t n = light.numbering.leaves.size();
    light.indirect.resize(n), light.indirect_corners.resize(n);
    parallel_for(n, 16, [&](std::size_t i) {
        const ElementId e = light.numbering.leaves[i];
        const RegionId region = light.tree.region(e);
        const Normal& normal = stage.scene.regions()[region].plane.n;
        const Patch& patch = light.tree.patch(e);
        // Corners lie on folds, where cells of both sides are near: the values are taken a little inside.
        constexpr double inside = 0.05;
        const Vec2 centre{patch.is_triangle() ? 1.0 / 3 : 0.5, patch.is_triangle() ? 1.0 / 3 : 0.5};
        Spectrum sum;
        for (int k = 0; k < patch.corner_count(); ++k) {
            const Vec2 uv = patch.corner_uv(k) + inside * (centre - patch.corner_uv(k));
            sum += light.indirect_corners[i][static_cast<std::size_t>(k)] = E.at(patch.at(uv), normal);
        }
        light.indirect[i] = sum / static_cast<double>(patch.corner_count());
    });
}

/// RMS of what the elements are off from the cells, by the RMS of these, at the leaves' centres.
double projection_error(const Stage& stage, const CellFunction& E, const GlobalLight& light) {
    struct Sums {
        double off = 0, all = 0;
        Sums& operator+=(const Sums& o) { return off += o.off, all += o.all, *this; }
    };
    const Sums sums = parallel_sum<Sums>(light.numbering.leaves.size(), [&](std::size_t i) {
        const ElementId e = light.numbering.leaves[i];
        const Spectrum there =
            E.at(light.tree.patch(e).at(light.tree.centre(e)), stage.scene.regions()[light.tree.region(e)].plane.n);
        const double area = light.tree.area(e);
        return Sums{area * squared(there - light.indirect[i]), area * squared(there)};
    });
    return sums.all > 0 ? std::sqrt(sums.off / sums.all) : 0;
}

}  // namespace

std::size_t units_of(const Stage& stage, const Knobs& knobs, const SolveOptions& options) {
    if (options.max_units) return std::max(least_units, *options.max_units);
    const double edge = knobs.solve_mesh.edge;
    const double wanted = edge > 0 ? stage.area / (edge * edge) : 0;
    return static_cast<std::size_t>(
        std::clamp(wanted, static_cast<double>(usual_least), static_cast<double>(usual_most)));
}

void keep_network(const KernelNetwork& network, CellLight& light) {
    if (network.sample_count() == 0) return;
    const GrowingCells& cells = network.cells();
    const std::vector<GrowingCells::Unit> units = cells.units();
    std::vector<std::uint32_t> number(cells.complex().unit_end());
    for (const GrowingCells::Unit u : units) {
        number[u] = static_cast<std::uint32_t>(light.kernel.size());
        Spectrum value;
        const auto out = cells.output(u);
        for (std::size_t b = 0; b < bands; ++b) value[b] = out[out.size() == 1 ? 0 : b];
        light.kernel.push_back({network.place_x(u), network.place_y(u), cells.width(u), value});
    }
    for (const GrowingCells::Unit u : units)
        for (const GrowingCells::Unit v : cells.complex().neighbours(u))
            if (u < v) light.kernel_edges.push_back({number[u], number[v]});
}

/// Growing cells: a network of dimension four learns how light flows from y to x by sample rays, one of dimension two
/// learns the surfaces; both grow where their error is [Fritzke94]. The mesh is not cut from polygons. Bohn's method of
/// 2002 (`--gcs classic`), and as docs/growing_cells.md improves it. O(units^2) memory and O(units^2) kernels; rays in
/// proportion to units.
GlobalLight solve_growing_cells(const MethodInput& input) {
    const bool classic = input.options.gcs == CellsKind::classic;
    GlobalLight light{.tree = input.direct.tree, .numbering = LeafNumbering(input.direct.tree)};
    const std::vector<Spectrum> rho = leaf_reflectances(input.stage.scene, light.tree, light.numbering);
    light.direct = classic ? std::vector<Spectrum>(rho.size()) : leaf_means(input.direct, light.numbering);
    light.on_projection = !classic;
    light.holds_direct = classic;
    const SurfacePool pool(input.stage,
                           std::max(least_pool, points_a_unit * units_of(input.stage, input.knobs, input.options)),
                           input.options.seed);
    LearnedLight learned = classic ? learn_flow(input, pool) : learn_visibility(input, pool);
    const auto form = std::make_shared<const CellsForm>(std::move(learned.light));
    const CellFunction& E = form->function();
    if (!form->light().cells.empty()) light.own_form = form;
    put_on_elements(input.stage, E, light);
    for (std::size_t i = 0; i < rho.size(); ++i)
        light.reflected.push_back(rho[i] * (light.direct[i] + light.indirect[i]));
    light.report = learned.report;
    light.rays = learned.rays, light.form_factors = learned.kernels;
    input.progress.note(fmt::format(
        "{} units of the shading network, {} of the kernel network; on elements the light is "
        "{:.2f}% off from theirs",
        form->light().cells.size(), form->light().kernel.size(), 100 * projection_error(input.stage, E, light)));
    return light;
}

}  // namespace exitance
