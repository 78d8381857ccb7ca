#include "exitance/error/tolerance/accuracy.hpp"

#include <algorithm>
#include <cmath>

#include "exitance/calibration/error_budget.hpp"

namespace exitance {
namespace {

void apply_user_knobs(Knobs& knobs, const SolveOptions& options) {
    if (options.mesh_size) knobs.solve_mesh.edge = *options.mesh_size;
    if (options.epsilon) knobs.link_error = *options.epsilon;
    if (options.residual) knobs.residual = *options.residual;
    if (options.max_iterations) knobs.max_iterations = *options.max_iterations;
}

}  // namespace

Knobs knobs_for_error(double error, const LitSpaces& lit, const SolveOptions& options) {
    namespace c = calibrated;
    const std::vector<Piece>& pieces = lit.pieces;
    const auto count = [&](double n) { return static_cast<std::size_t>(lit.multiplicity * n / error); };
    const auto round_up = [](double n) { return static_cast<int>(std::ceil(n)); };
    // A strip of width w along a concave edge, where the light varies like w^0.7, contributes w^1.2 to the error
    // (derived from [Atkinson00]).
    const double strips = std::log2(std::max(1.0, c::strip_share / error)) / 1.2;
    const double further = std::clamp(std::log2(c::finer_strips_below / error), 0.0, 1.0);
    Knobs knobs;
    // At least half of the elements are additional to the pieces, so that a scene with a thousand books still has a
    // mesh on its floor.
    const std::size_t elements =
        std::max(count(c::solve_elements), pieces.size() + count(c::solve_elements_beyond_pieces));
    knobs.solve_mesh = {edge_for_elements(pieces, elements), round_up(strips + further)};
    knobs.solve_rays = {.average = std::clamp(c::row_rays / error, c::min_row_average, c::max_row_average),
                        .min = static_cast<unsigned>(c::min_rays_per_sample),
                        .max = static_cast<unsigned>(c::max_row_rays)};
    // The projected direct light is only used for gathering, and its means are exact, so that a large misfit is
    // acceptable; unless it is itself delivered.
    const bool is_delivered = options.visibility == VisibilityKind::fractional;
    const ErrorBudget budget(error);
    knobs.direct_tolerance = budget.direct_projection(is_delivered);
    knobs.body_error = budget.body_part();
    knobs.residual = budget.residual();
    knobs.link_error = budget.links();
    // Curved elements may be larger. They are sampled at more points, so that fewer rays per point are sufficient. The
    // number of rays of an element hardly depends on its size: start with few elements, which are split where the light
    // varies.
    const bool curved = knobs.gather_curved = error < c::curved_below;
    const double of_curved = 0.5 * c::curved_gather_elements * std::clamp(c::finer_gather_below / error, 1.0, 2.0);
    knobs.gather_mesh = {edge_for_elements(pieces, count(curved ? of_curved : c::straight_gather_elements)),
                         round_up(strips)};
    const double rays = (curved ? c::curved_gather_rays : c::straight_gather_rays) * std::pow(0.5 / error, 4.0 / 3);
    const double least = std::max(curved ? c::min_curved_rays : c::min_rays_per_sample, rays / 4);
    knobs.gather_rays = {.average = rays, .min = static_cast<unsigned>(least), .max = 16384};
    knobs.gather_noise = budget.gather_noise();
    knobs.gather_tolerance = budget.gather_misfit(curved);
    apply_user_knobs(knobs, options);
    return knobs;
}

namespace {

/// The cost of a sum grows with the number of source elements, not of receivers.
double edge_for_sums(const LitSpaces& lit, double error) {
    return edge_for_elements(lit.pieces, static_cast<std::size_t>(lit.multiplicity * 4 / error));
}

/// Settings for errors at which every point must be accurate, not only the mean square.
Knobs knobs_for_fine_sums(const Knobs& knobs, double error, const LitSpaces& lit) {
    namespace c = calibrated;
    Knobs out = knobs;
    // The gather smooths the method's solution, and its own elements are split as needed.
    out.solve_mesh.edge *= 2, out.solve_rays.average *= 0.5;
    out.gather_mesh.edge = 2 * edge_for_sums(lit, error);
    // Light must be accurate at edges, too: that takes two strips more than the mean square needs.
    out.gather_mesh.grading_levels += 2;
    // The strips are split into squares at open ends, and get enough rays that their noise is not visible from the
    // strip across the edge.
    out.solve_mesh.longest_end = out.gather_mesh.longest_end = c::fine_longest_end;
    out.solve_rays.min = static_cast<unsigned>(c::min_fine_rays);
    out.gather_tolerance = c::fine_sum_tolerance * error;
    // At least 15 element shares. A tighter tolerance would refine the error of the sum itself and never end.
    out.gather_relative_tolerance = c::fine_relative_tolerance * error;
    out.gather_element_share = c::fine_element_share * error;
    return out;
}

/// The summed light is refined, so that the method may be inaccurate. But the certificate follows late reflections on
/// the method's elements and underestimates them if the elements are too few.
Knobs knobs_for_refined_sums(const Knobs& knobs, double error, const LitSpaces& lit, const SolveOptions& options) {
    namespace c = calibrated;
    Knobs out = knobs;
    const double coarser = std::max(error, std::min(c::refined_coarsening * error, c::coarsest_refined));
    const Knobs coarse = knobs_for_error(coarser, lit, options);
    const auto fewer = [](int levels, int less) { return std::max(0, levels - less); };
    out.solve_mesh = {std::sqrt(2.0) * coarse.solve_mesh.edge, fewer(coarse.gather_mesh.grading_levels, 2)};
    out.solve_rays = coarse.solve_rays, out.solve_rays.average = c::refined_row_rays;
    out.gather_mesh = {std::sqrt(2.0) * edge_for_sums(lit, coarser), fewer(knobs.gather_mesh.grading_levels, 1)};
    out.gather_tolerance = ErrorBudget(coarser).gather_misfit(false);
    out.gather_element_share = c::refined_element_share * coarser;
    return out;
}

/// Interpolates two sets of settings logarithmically: t = 0 gives a, t = 1 gives b.
Knobs between(const Knobs& a, const Knobs& b, double t) {
    const auto of = [t](double x, double y) { return std::pow(x, 1 - t) * std::pow(y, t); };
    const auto mesh = [&](const MeshSize& x, const MeshSize& y) {
        const double levels = (1 - t) * x.grading_levels + t * y.grading_levels;
        // `a` has no limit on strip ends, so that the limit grows without bound as t approaches 0.
        return MeshSize{of(x.edge, y.edge), static_cast<int>(std::lround(levels)), y.longest_end / t};
    };
    Knobs out = a;
    out.solve_mesh = mesh(a.solve_mesh, b.solve_mesh), out.gather_mesh = mesh(a.gather_mesh, b.gather_mesh);
    out.solve_rays.average = of(a.solve_rays.average, b.solve_rays.average);
    out.solve_rays.min = static_cast<unsigned>(of(a.solve_rays.min, b.solve_rays.min));
    out.gather_tolerance = of(a.gather_tolerance, b.gather_tolerance);
    out.gather_relative_tolerance = b.gather_relative_tolerance / t;
    out.gather_element_share = of(a.gather_element_share, b.gather_element_share);
    return out;
}

}  // namespace

Knobs knobs_for_sums(const Knobs& knobs, double error, const LitSpaces& lit, const SolveOptions& options) {
    namespace c = calibrated;
    Knobs straight = knobs;
    // Cost per gather point does not depend on the element, so that more straight elements cost less than the points
    // that curved ones need.
    straight.gather_curved = false;
    Knobs out = straight;
    const double t = std::clamp(
        std::log(c::refined_sums_from / error) / std::log(c::refined_sums_from / c::fine_sums_below), 0.0, 1.0);
    if (t < 1) out = knobs_for_refined_sums(straight, error, lit, options);
    if (t > 0) {
        const Knobs fine = knobs_for_fine_sums(straight, error, lit);
        out = t < 1 ? between(out, fine, t) : fine;
    }
    // Correcting sums (`corrected_sums`) iterates the equation for all reflections, so it cannot be used
    // for a limited number of them. For large errors, and where all settings are fine (t = 1), it is not needed.
    out.corrects_sums = options.bounces < 0 && t < 1 && error < c::refined_below;
    apply_user_knobs(out, options);
    return out;
}

namespace {

/// Tightens the local pass if its parts exceed the error allowed for both together.
void tighten_local(Tightened& out, const ErrorParts& parts, double allowed) {
    namespace c = calibrated;
    if (std::hypot(parts.noise, parts.interpolation) <= allowed) return;
    // Each part has its own share: a part that is within its share is not tightened because of the other.
    const auto share_of = [&](double part, double share) {
        return part > share * allowed
                   ? std::clamp(share * allowed / part, c::min_attempt_factor, c::max_tightening_factor)
                   : 1.0;
    };
    const double noise = share_of(parts.noise, c::part_aim),
                 interpolation = share_of(parts.interpolation, c::interpolation_share);
    out.knobs.gather_noise *= noise < 1 ? noise * std::min(1.0, parts.noise / out.knobs.gather_noise) : 1;
    out.knobs.gather_rays.average *= std::pow(noise, -4.0 / 3);
    out.knobs.gather_tolerance *= interpolation;
    out.knobs.gather_element_share *= interpolation;
    out.work = std::max(out.work, std::pow(std::min(noise, interpolation), -4.0 / 3));
}

/// Returns the error allowed for the local pass, given that of the method.
double allowed_locally(double target, double method) {
    constexpr double min_share = ErrorBudget::min_local_share;
    return std::sqrt(std::max(min_share * min_share * target * target, target * target - method * method));
}

}  // namespace

Tightened tightened(const Knobs& knobs, const ErrorParts& parts, double target, const SolveOptions& options) {
    namespace c = calibrated;
    const bool is_gathered = parts.noise > 0 || parts.interpolation > 0;
    const double methods_share = is_gathered ? ErrorBudget::method_share : 1;
    Tightened out{knobs};
    double method = parts.method;
    const double local = std::hypot(parts.noise, parts.interpolation);
    // Each part is below its limit but their sum is not: the excess comes from interreflection, so refine the method.
    out.method = method > methods_share * target || std::hypot(method, local) <= target;
    if (out.method) {
        const double factor =
            std::clamp(c::part_aim * methods_share * target / method, c::min_attempt_factor, c::max_method_factor);
        out.knobs.solve_mesh.edge *= std::sqrt(factor);
        out.knobs.solve_mesh.grading_levels += 1;
        out.knobs.solve_rays.average = std::min(knobs.solve_rays.average / factor, c::max_row_rays);
        out.knobs.direct_tolerance *= factor;
        out.knobs.residual *= factor;
        out.knobs.link_error *= factor;
        method *= factor;
        out.left = factor, out.work = 1 / factor;
    }
    tighten_local(out, parts, allowed_locally(target, method));
    apply_user_knobs(out.knobs, options);
    return out;
}

Tightened tightened_for_step(const Knobs& knobs, const ErrorParts& parts, double left, double limit, double target,
                             const SolveOptions& options) {
    Tightened out{.knobs = knobs, .method = true, .left = left};
    const double method = left * parts.method, local = std::hypot(parts.noise, parts.interpolation);
    // Further steps follow until the method's part is at most its share of the target.
    if (std::hypot(method, local) > limit)
        tighten_local(out, parts, allowed_locally(target, std::min(method, ErrorBudget::method_share * target)));
    apply_user_knobs(out.knobs, options);
    return out;
}

}  // namespace exitance
