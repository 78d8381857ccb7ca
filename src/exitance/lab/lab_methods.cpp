#include "exitance/lab/laboratory.hpp"

#include "exitance/lab/bsp/ordered_light.hpp"
#include "exitance/lab/classical/classical.hpp"
#include "exitance/lab/dm_tree/tree_cutter.hpp"
#include "exitance/lab/growing_cells/cell_function.hpp"
#include "exitance/lab/growing_cells/cells_method.hpp"
#include "exitance/lab/layers/source_layers.hpp"
#include "exitance/lab/layers/winged_edge_bytes.hpp"
#include "exitance/lab/local_passes/solve_by_lines.hpp"
#include "exitance/lab/tasks/solve_by_tasks.hpp"
#include "exitance/methods/extensions.hpp"
#include "exitance/solution/layers/light_layers.hpp"

namespace exitance {
namespace {

void choose_structures(const DiscontinuityChoice& choice, DiscontinuityOptions& options) {
    const TriangulationScheme scheme = choice.triangulation.value_or(TriangulationScheme::delaunay);
    if (scheme != TriangulationScheme::delaunay) {
        const TreeCut cut{.scheme = scheme,
                          .grid = choice.premesh == Premesh::coarse,
                          .penumbra_first = choice.premesh == Premesh::penumbra_first};
        options.cutter = [cut](const ReceiverCurves& receiver, double tolerance) {
            return cut_by_tree(receiver, cut, tolerance);
        };
    }
    const bool is_merged = choice.structure == OccluderStructure::merged;
    if (is_merged || choice.structure == OccluderStructure::bsp)
        options.search = [is_merged](const DirectLight& direct) {
            return std::make_unique<OrderedLight>(direct, is_merged);
        };
}

std::map<std::string, double> single_mesh_figures(const SixNodeMesh& mesh) {
    return {{"layer_bytes", 0}, {"winged_edge_bytes", static_cast<double>(winged_edge_bytes(mesh))}};
}

constexpr DiscontinuityExtension discontinuity{choose_structures, make_layered_light, single_mesh_figures};

/// A method in a published form, without an estimate of its error.
constexpr MethodEntry published(Method id, SolveMethod solve, const char* basis, ForecastMethod forecast = nullptr,
                                Form form = Form::published) {
    return {.id = id, .solve = solve, .basis = basis, .forecast = forecast, .form = form, .has_estimate = false};
}

/// The laboratory's rows of the table of methods.
constexpr MethodEntry lab_methods[] = {
    {.id = Method::growing_cells, .solve = solve_growing_cells, .basis = "gaussian", .forecast = forecast_cells},
    {.id = Method::discontinuity, .solve = solve_by_lines, .basis = "quadratic", .form = Form::local_passes},
    published(Method::hierarchical, solve_by_tasks, "haar", nullptr, Form::tasks),
    published(Method::matrix, solve_classical_matrix, "constant", forecast_classical_matrix),
    published(Method::progressive, solve_classical_shooting, "constant", forecast_classical_shooting),
    published(Method::substructuring, solve_classical_substructuring, "constant", forecast_classical_shooting),
    published(Method::hierarchical, solve_classical_hierarchical, "haar"),
    published(Method::wavelet, solve_classical_wavelet, "multiwavelet2"),
};

}  // namespace

void install_lab_methods() {
    if (extensions().discontinuity) return;
    extensions() = {.methods = {std::begin(lab_methods), std::end(lab_methods)}, .discontinuity = &discontinuity};
    add_light_form({LayersForm::name, LayersForm::unpack});
    add_light_form({CellsForm::name, CellsForm::unpack});
}

}  // namespace exitance
