#include <fmt/format.h>

#include <cmath>

#include "exitance/base/parallel.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/lab/growing_cells/cells_method.hpp"

namespace exitance {
namespace {

constexpr std::size_t min_units = 8, default_min_units = 256, default_max_units = 2048;
/// minimum size of the pool of samples; points per unit
constexpr std::size_t min_pool = 1 << 15, points_per_unit = 64;

/// Evaluates the cells' light on the leaves of the projection, as means and linear or bilinear polynomials.
void put_on_elements(const Stage& stage, const CellFunction& E, GlobalLight& light) {
    const std::size_t n = light.numbering.leaves.size();
    light.indirect.resize(n), light.indirect_corners.resize(n);
    parallel_for(n, 16, [&](std::size_t i) {
        const ElementId e = light.numbering.leaves[i];
        const RegionId region = light.tree.region(e);
        const Normal& normal = stage.scene.regions()[region].plane.n;
        const Patch& patch = light.tree.patch(e);
        // Corners are on folds, where cells of both sides are near: evaluate slightly inside.
        constexpr double step_inside = 0.05;
        const Vec2 centre{patch.is_triangle() ? 1.0 / 3 : 0.5, patch.is_triangle() ? 1.0 / 3 : 0.5};
        Spectrum sum;
        for (int k = 0; k < patch.corner_count(); ++k) {
            const Vec2 uv = patch.corner_uv(k) + step_inside * (centre - patch.corner_uv(k));
            sum += light.indirect_corners[i][static_cast<std::size_t>(k)] = E.at(patch.at(uv), normal);
        }
        light.indirect[i] = sum / static_cast<double>(patch.corner_count());
    });
}

/// RMS difference between elements and cells at the leaves' centres, relative to the RMS of the cells.
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
    if (options.max_units) return std::max(min_units, *options.max_units);
    const double edge = knobs.solve_mesh.edge;
    const double wanted = edge > 0 ? stage.area / (edge * edge) : 0;
    return static_cast<std::size_t>(
        std::clamp(wanted, static_cast<double>(default_min_units), static_cast<double>(default_max_units)));
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

/// Growing cells: a network of dimension four learns from sample rays how light flows from y to x; one of dimension two
/// learns the surfaces. Both grow where their error is large [Fritzke94]. The mesh does not depend on the polygons.
/// Either Bohn's method of 2002 (`--gcs classic`) or its improvement described in docs/methods/growing_cells.md.
/// O(units^2) memory and kernels; the number of rays is proportional to units.
GlobalLight solve_growing_cells(const MethodInput& input) {
    const bool classic = input.options.gcs == CellsKind::classic;
    GlobalLight light{.tree = input.direct.tree, .numbering = LeafNumbering(input.direct.tree)};
    const std::vector<Spectrum> rho = leaf_reflectances(input.stage.scene, light.tree, light.numbering);
    light.direct = classic ? std::vector<Spectrum>(rho.size()) : leaf_means(input.direct, light.numbering);
    light.on_projection = !classic;
    if (classic) light.delivery = MethodDelivery::all_light;
    const SurfacePool pool(input.stage,
                           std::max(min_pool, points_per_unit * units_of(input.stage, input.knobs, input.options)),
                           input.options.seed);
    LearnedLight learned = classic ? learn_flow(input, pool) : learn_visibility(input, pool);
    const auto form = std::make_shared<const CellsForm>(std::move(learned.light));
    const CellFunction& E = form->function();
    if (!form->light().cells.empty()) light.own_form = form;
    put_on_elements(input.stage, E, light);
    for (std::size_t i = 0; i < rho.size(); ++i)
        light.reflected.push_back(rho[i] * (light.direct[i] + light.indirect[i]));
    light.report = learned.report;
    light.work.rays = learned.rays, light.work.form_factors = learned.kernels;
    input.progress.note(fmt::format(
        "{} units of the shading network, {} of the kernel network; on elements the light is "
        "{:.2f}% off from theirs",
        form->light().cells.size(), form->light().kernel.size(), 100 * projection_error(input.stage, E, light)));
    return light;
}

}  // namespace exitance
