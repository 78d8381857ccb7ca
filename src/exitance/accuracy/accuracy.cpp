#include "exitance/accuracy/accuracy.hpp"

#include <algorithm>
#include <cmath>

namespace exitance {
namespace {

void apply_user_knobs(Knobs& knobs, const SolveOptions& options) {
    if (options.mesh_size) knobs.solve_mesh.edge = *options.mesh_size;
    if (options.epsilon) knobs.link_error = *options.epsilon;
    if (options.residual) knobs.residual = *options.residual;
    if (options.max_iterations) knobs.max_iterations = *options.max_iterations;
}

}  // namespace

Knobs knobs_for_error(double error, const std::vector<Piece>& pieces, const SolveOptions& options) {
    const auto count = [&](double n) { return static_cast<std::size_t>(n / error); };
    // A strip of width w along a concave edge, where light varies like w^0.7, has a share of w^1.2 in the error.
    const int strips = static_cast<int>(std::ceil(std::log2(std::max(1.0, 0.25 / error)) / 1.2));
    Knobs knobs;
    // Half of them beyond those that the pieces are: a thousand books are no reason to leave the floor whole.
    const std::size_t elements = std::max(count(16), pieces.size() + count(8));
    knobs.solve_mesh = {edge_for_elements(pieces, elements), strips + (error < 0.01 ? 1 : 0)};
    knobs.solve_rays = {.average = std::clamp(1.5 / error, 32.0, 256.0), .least = 16, .most = 1024};
    // What is projected is only gathered from, and its means are right; unless it is what is delivered.
    knobs.direct_tolerance = (options.visibility == VisibilityKind::fractional ? 2.5 : 4) * error;
    knobs.residual = 0.02 * error;
    knobs.link_error = 0.45 * error;
    // Curved elements may be larger; and they are sampled at more places, so that fewer rays do for each. An element
    // takes about as many rays whatever its size: few elements to begin with, and where light turns sooner they are
    // cut.
    knobs.gather_curved = error < 0.03;
    knobs.gather_mesh = {edge_for_elements(pieces, count(!knobs.gather_curved ? 5 : error < 0.015 ? 2 : 1)), strips};
    const double rays = (knobs.gather_curved ? 0.3 : 0.55) * std::pow(0.5 / error, 4.0 / 3);
    const double least = std::max(knobs.gather_curved ? 8.0 : 16.0, rays / 4);
    knobs.gather_rays = {.average = rays, .least = static_cast<unsigned>(least), .most = 16384};
    // What hides from all places of an element weighs more where there is less noise to hide in.
    knobs.gather_noise = 0.75 * error * std::pow(std::min(1.0, error / 0.02), 0.15);
    knobs.gather_tolerance = (knobs.gather_curved ? 0.5 : 0.4) * error;
    knobs.gather_element_share = 0.05 * error;
    apply_user_knobs(knobs, options);
    return knobs;
}

Knobs knobs_for_sums(const Knobs& knobs, double error, const std::vector<Piece>& pieces, const SolveOptions& options) {
    Knobs out = knobs;
    // Summed light costs by the element that is summed, not by the element that it is summed for.
    const auto edge_for = [&](double e) { return edge_for_elements(pieces, static_cast<std::size_t>(4 / e)); };
    // Places cost alike on any element, so that more straight elements cost less than places to bend fewer by.
    out.gather_curved = false;
    if (error < 0.01) {
        // The gather smooths what the method has, and its own elements are cut where they have to be.
        out.solve_mesh.edge *= 2, out.solve_rays.average *= 0.5;
        out.gather_mesh.edge = 2 * edge_for(error);
        // At an edge, too, light is to be right: two strips more than the mean square needs, cut to squares at open
        // ends, and no strip with so few rays that its noise is seen from the strip across the edge.
        out.gather_mesh.grading_levels += 2;
        out.solve_mesh.longest_end = out.gather_mesh.longest_end = 2;
        out.solve_rays.least = 64;
        out.gather_tolerance = 0.6 * error;
        // Well above what the sum itself may miss, a few shares: finer elements would follow that for ever.
        out.gather_relative_tolerance = 3 * error;
        out.gather_element_share = 0.2 * error;
        apply_user_knobs(out, options);
        return out;
    }
    // What is gathered is refined, so that the method may be rough; but the certificate follows late reflections on its
    // elements, and through fewer of them sees too little. Light of so many reflections solves no equation to refine
    // by; and where much is allowed, the method is below it by itself, on more elements of fewer rays.
    constexpr double much = 0.03;
    out.refined = options.bounces < 0 && error < much;
    constexpr double coarsest = 0.05;
    const double coarser = std::clamp(2.5 * error, error, std::max(error, coarsest));
    const Knobs coarse = knobs_for_error(coarser, pieces, options);
    const auto fewer = [](int levels, int less) { return std::max(0, levels - less); };
    const double larger = out.refined ? std::sqrt(2.0) : 1;
    out.solve_mesh = {larger * coarse.solve_mesh.edge, fewer(coarse.gather_mesh.grading_levels, 2)};
    out.solve_rays = coarse.solve_rays, out.solve_rays.average = out.refined ? 128 : 64;
    out.gather_mesh = {std::sqrt(2.0) * edge_for(coarser), fewer(knobs.gather_mesh.grading_levels, 1)};
    out.gather_tolerance = 0.4 * coarser, out.gather_element_share = 0.035 * coarser;
    apply_user_knobs(out, options);
    return out;
}

Tightened tightened(const Knobs& knobs, const ErrorParts& parts, double target, const SolveOptions& options) {
    // The method may have half of the target, or all of it where nothing is gathered. Its light is smoothed by the
    // gather, and much finer is soon much dearer.
    const double methods_share = parts.noise > 0 || parts.interpolation > 0 ? 0.5 : 1;
    constexpr double least = 0.2, most = 0.9;  // of a factor: no step too large to be foreseen or too small to help
    Tightened out{knobs};
    double method = parts.method;
    const double local = std::hypot(parts.noise, parts.interpolation);
    // Where all parts are small, their sum is not: the error is one that reflects to and fro, which is the method's.
    out.method = method > methods_share * target || std::hypot(method, local) <= target;
    if (out.method) {
        const double factor = std::clamp(0.8 * methods_share * target / method, least, 0.7);
        out.knobs.solve_mesh.edge *= std::sqrt(factor);
        out.knobs.solve_mesh.grading_levels += 1;
        out.knobs.solve_rays.average = std::min(knobs.solve_rays.average / factor, 1024.0);
        out.knobs.direct_tolerance *= factor;
        out.knobs.residual *= factor;
        out.knobs.link_error *= factor;
        method *= factor;
        out.work = 1 / factor;
    }
    const double allowed = std::sqrt(std::max(0.25 * target * target, target * target - method * method));
    if (local > allowed) {
        // Each part is given its share by itself: one that is small already is not made smaller for the other's sake.
        const auto share_of = [&](double part, double share) {
            return part > share * allowed ? std::clamp(share * allowed / part, least, most) : 1.0;
        };
        const double noise = share_of(parts.noise, 0.8), interpolation = share_of(parts.interpolation, 0.55);
        out.knobs.gather_noise *= noise < 1 ? noise * std::min(1.0, parts.noise / knobs.gather_noise) : 1;
        out.knobs.gather_rays.average *= std::pow(noise, -4.0 / 3);
        out.knobs.gather_tolerance *= interpolation;
        out.knobs.gather_element_share *= interpolation;
        out.work = std::max(out.work, std::pow(std::min(noise, interpolation), -4.0 / 3));
    }
    apply_user_knobs(out.knobs, options);
    return out;
}

}  // namespace exitance
