#include "exitance/methods/accuracy.hpp"

namespace exitance {
namespace {

void apply_user_knobs(Knobs& knobs, const SolveOptions& options) {
    if (options.mesh_size) knobs.solve_mesh.edge = *options.mesh_size;
    if (options.residual) knobs.residual = *options.residual;
    if (options.max_iterations) knobs.max_iterations = *options.max_iterations;
}

}  // namespace

Knobs knobs_for_error(double error, const std::vector<Piece>& pieces, const SolveOptions& options) {
    const auto count = [&](double n) { return static_cast<std::size_t>(n / error); };
    // A strip of width w along a concave edge, where light varies like w^0.7, has a share of w^1.2 in the error.
    const int strips = static_cast<int>(std::ceil(std::log2(std::max(1.0, 0.25 / error)) / 1.2));
    Knobs knobs;
    knobs.solve_mesh = {edge_for_elements(pieces, count(16)), strips + (error < 0.01 ? 1 : 0)};
    knobs.solve_rays = {.average = std::clamp(1.5 / error, 32.0, 256.0), .least = 16, .most = 1024};
    knobs.direct_tolerance = 2.5 * error;
    knobs.residual = 0.05 * error;
    // Two strips more where the light is delivered than its mean square needs: at an edge, too, it is to be right.
    knobs.gather_mesh = {edge_for_elements(pieces, count(5)), strips + (error < 0.01 ? 2 : 0)};
    const double rays = std::pow(0.5 / error, 4.0 / 3);
    knobs.gather_rays = {
        .average = rays, .least = static_cast<unsigned>(std::max(16.0, rays / (error < 0.01 ? 1 : 4))), .most = 16384};
    knobs.gather_noise = 0.5 * error;
    knobs.gather_tolerance = 0.4 * error;
    apply_user_knobs(knobs, options);
    return knobs;
}

Knobs tightened(const Knobs& knobs, double factor, const SolveOptions& options) {
    Knobs out = knobs;
    out.solve_mesh.edge *= std::sqrt(factor);
    out.solve_mesh.grading_levels += 1;
    out.solve_rays.average = std::min(out.solve_rays.average / factor, 1024.0);
    out.direct_tolerance *= factor;
    out.residual *= factor;
    out.gather_rays.average *= std::pow(factor, -4.0 / 3);
    out.gather_noise *= factor;
    out.gather_tolerance *= factor;
    apply_user_knobs(out, options);
    return out;
}

}  // namespace exitance
